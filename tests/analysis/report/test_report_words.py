"""The paragraph and the warnings a report writes."""

from dataclasses import replace

from analysis.closer_look import closer_look
from analysis.predictive import PredictiveCheck, PredictiveChecks
from analysis.report.cautions import cautions
from analysis.report.compose import _about_findings
from analysis.report.findings import findings, lead
from analysis.report.model_cautions import model_cautions
from analysis.report.page import _chance, _mean
from analysis.report.parameter_cautions import about_priors
from analysis.results import Quantity
from analysis.stuck import stuck_rates


def words(case, tag="", unanswered=()):
    return "".join(phrase.text for phrase in lead(findings(case.fit), (), tag, unanswered))


def with_chances(case, chances):
    """The case's fit with other chances to rank first, question by question."""
    questions = tuple(
        replace(q, modes=tuple(replace(m, p_best=p) for m, p in zip(q.modes, own, strict=True)))
        for q, own in zip(case.fit.questions, chances, strict=True)
    )
    return replace(case, fit=replace(case.fit, questions=questions))


def test_a_first_place_is_likely_from_eighty_per_cent_on(study_case):
    case = with_chances(study_case, [(0.8, 0.1, 0.1), (0.79, 0.11, 0.1), (0.1, 0.85, 0.05)])
    assert [f.reading for f in findings(case.fit)] == ["likely", "open", "likely"]
    assert [f.first for f in findings(case.fit)] == ["M1", "M1", "M2"]


def test_different_first_places_are_not_made_into_one(study_case):
    said = words(with_chances(study_case, [(0.9, 0.05, 0.05), (0.05, 0.9, 0.05), (0.4, 0.3, 0.3)]))
    assert said.startswith(
        "No mode comes first on every question. M1 likely ranks first for “most responsive” "
        "(a chance of 90 %)"
    )
    assert "M2 for “most force” (90 %, which isn't better)" in said
    assert "For “safest” the first place is open" in said


def test_open_answers_are_called_open(study_case):
    said = words(with_chances(study_case, [(0.4, 0.3, 0.3)] * 3))
    assert said.startswith("The answers don't settle a first place on any question yet.")
    assert "likely ranks first" not in said


def test_the_closest_rival_is_the_one_least_surely_below(study_case):
    found = findings(study_case.fit)[0]
    above = {
        p.mode_j if p.mode_i == found.first else p.mode_i: p.p_i_above_j
        if p.mode_i == found.first
        else 1 - p.p_i_above_j
        for p in found.question.pairs
        if found.first in (p.mode_i, p.mode_j)
    }
    assert found.rival == min(above, key=above.get)
    assert found.above_rival == above[found.rival]


def test_ties_are_a_share_of_all_answers(study_case):
    found = findings(study_case.fit)[2]
    rows = study_case.table.rows
    own = rows[rows["question"] == "Q6"]
    assert found.ties == (own["response"] == "A=B").sum() / len(own)


def test_warnings_of_the_fit_reach_the_reader_once(study_case):
    questions = tuple(replace(q, warnings=("Something is odd.",)) for q in study_case.fit.questions)
    fit = replace(study_case.fit, questions=questions, warnings=("All of it is odd.",))
    said = cautions(study_case.table, fit, findings(fit), None, 4)
    assert said.count("Something is odd.") == 1
    assert "All of it is odd." in said
    assert "4 answers to attention checks are left out of the model." in said


def with_parameter(case, name, mean, spread=0.4, **more):
    """A fit of the first question alone, with one parameter as it is told."""
    question = case.fit.questions[0]
    parameters = tuple(
        replace(p, mean=mean, hdi_low=mean - spread, hdi_high=mean + spread) if p.name == name else p
        for p in question.parameters
    )
    return replace(case.fit, questions=(replace(question, parameters=parameters, **more),))


def test_a_side_that_was_favoured_is_named_and_never_called_corrected(study_case):
    def said(mean, **more):
        fit = with_parameter(study_case, "side_effect", mean, **more)
        return " ".join(cautions(study_case.table, fit, findings(fit), None, 0))

    ordinary, beyond, confounded = said(0.5), said(-1.3), said(0.5, is_side_told_apart=False)
    assert "Q2: whatever was shown as A was favoured. The model has a side effect for that" in ordinary
    assert "Q2: whatever was shown as B was favoured by more than the model's side effect can" in beyond
    assert "In Q2 the side effect lies beyond what its prior expects (-1.3 logits" in beyond
    assert "no pair was shown with its sides exchanged" in confounded
    assert "The model has a side effect for that" not in beyond + confounded
    assert "correct" not in ordinary + beyond + confounded
    assert "favoured" not in said(0.3)


def test_a_fit_that_did_not_converge_says_so(study_case):
    fit = replace(study_case.fit, converged=False, rhat_max=1.3)
    said = " ".join(cautions(study_case.table, fit, findings(fit), None, 0))
    assert "The sampler did not converge" in said
    assert "R-hat 1.300" in said


def test_a_question_that_is_not_ranked_is_not_called_open(study_case):
    case = with_chances(study_case, [(0.9, 0.05, 0.05)] * 3)
    first, *others = case.fit.questions
    questions = (first, *(replace(q, ranked=False, reason="No.", modes=()) for q in others))
    said = words(replace(case, fit=replace(case.fit, questions=questions)))
    assert said.startswith("Every question that could be ranked has a likely first place. M1 likely ranks")
    assert "open" not in said


def test_modes_stuck_in_more_of_fewer_comparisons_are_not_said_to_have_fewer(study_case):
    rate = stuck_rates(study_case.stuck, ("M1",))[0]
    rates = tuple(
        replace(rate, mode=f"M{k}", stuck=stuck, comparisons=n)
        for k, (stuck, n) in enumerate([(2, 4), (2, 5), (1, 4), (9, 90)])
    )
    said = "".join(phrase.text for phrase in lead((), rates, ""))
    assert said == (
        "The robot got stuck in 2 of 4 comparisons with M0 (2 of 6 people), in 2 of 5 with M1 "
        "(2 of 6 people), in 1 of 4 with M2 (2 of 6 people) and at no higher rate with 1 more mode."
    )


def test_one_of_a_kind_is_told_in_the_singular(study_case):
    fit = replace(study_case.fit, divergences=1)
    said = " ".join(cautions(study_case.table, fit, findings(fit), None, 1))
    assert "1 divergent draw." in said
    assert "1 answer to an attention check is left out of the model." in said


def test_a_sampler_that_failed_is_not_blamed_on_the_answers(study_case):
    def unranked(question):
        return replace(question, ranked=False, reason="No.", modes=())

    sampled = tuple(unranked(q) for q in study_case.fit.questions)
    never = tuple(replace(q, draws=None) for q in sampled)
    for questions, said in (
        (sampled, "The modes are not ranked on any question. No. "),
        (sampled[:1], "The modes are not ranked. No. "),
        (never, "The answers cannot rank the modes on any question. No. "),
        (never[:1], "The answers cannot rank the modes. No. "),
    ):
        assert words(replace(study_case, fit=replace(study_case.fit, questions=questions))) == said


def test_a_question_that_nobody_answered_is_not_passed_over(study_case):
    said = words(with_chances(study_case, [(0.9, 0.05, 0.05)] * 3), unanswered=["safest of all"])
    assert said.startswith("One mode is likely first on every question that was answered.")
    assert "Nobody answered “safest of all”." in said


def test_answers_that_are_partly_simulated_are_not_said_to_be_all_simulated(study_case):
    assert words(study_case, "simulated data").startswith("These answers were simulated")
    assert words(study_case, "partly simulated data").startswith("Some of these answers were simulated")


def test_one_participants_answers_are_said_to_be_one_participants(study_case):
    questions = tuple(replace(q, n_participants=1) for q in study_case.fit.questions)
    said = words(replace(study_case, fit=replace(study_case.fit, questions=questions)))
    assert said.startswith("All answers are one participant's: they tell little about other people.")


def test_of_many_modes_those_that_may_be_first_are_named(many_case):
    chances = [(0.5, 0.3, 0.16, *[0.04 / 9] * 9)]
    said = words(with_chances(many_case, chances))
    assert "Its closest rival" not in said
    found = replace(many_case.fit.questions[0], modes=with_chances(many_case, chances).fit.questions[0].modes)
    twice = replace(many_case.fit, questions=(found, replace(found)))
    text = "".join(phrase.text for phrase in lead(findings(twice), (), ""))
    assert "it is mode 00, mode 01 or mode 02 with a chance of 96 %." in text


def test_a_robot_that_never_got_stuck_is_said_to_with_the_number_of_comparisons(study_case):
    rates = tuple(replace(r, stuck=0) for r in stuck_rates(study_case.stuck))
    said = "".join(phrase.text for phrase in lead((), rates, ""))
    assert said == "The robot never got stuck, in 24 comparisons with each mode."


def test_what_lies_beyond_its_prior_is_pointed_out(study_case):
    def said(name, mean):
        fit = with_parameter(study_case, name, mean)
        return " ".join(cautions(study_case.table, fit, findings(fit), None, 0))

    assert "In Q2 the spread between people lies beyond what its prior expects (4.2 logits" in said(
        "subject_sd", 4.2
    )
    assert "In Q2 the gap below cut-point 1 lies beyond what its prior expects (2.4" in said("cut_1", 2.4)
    assert "beyond what its prior" not in said("subject_sd", 1.9) + said("cut_1", 1.9)


def two_modes(case, above: float):
    """The case with its first question alone, on its first two modes; M1 is above M2 with this chance."""
    question = case.fit.questions[0]
    first, second = question.modes[:2]
    pair = next(p for p in question.pairs if {p.mode_i, p.mode_j} == {first.mode, second.mode})
    of_two = replace(
        question,
        modes=(replace(first, p_best=above), replace(second, p_best=1 - above)),
        pairs=(replace(pair, p_i_above_j=above if pair.mode_i == first.mode else 1 - above),),
    )
    return replace(case, fit=replace(case.fit, questions=(of_two,)))


def test_of_two_modes_the_one_chance_is_said_once(study_case):
    said = words(two_modes(study_case, 0.85))
    assert "M1 likely ranks first for “most responsive” (a chance of 85 %), above M2." in said
    assert said.count("85 %") == 1


def test_a_number_that_holds_for_each_question_is_not_said_of_all_together(study_case):
    warning = "All 13 answers that prefer a mode prefer what stands as A."
    questions = tuple(replace(q, warnings=(warning,)) for q in study_case.fit.questions)
    case = replace(study_case, fit=replace(study_case.fit, questions=questions))
    said = cautions(case.table, case.fit, findings(case.fit), None, 0)
    assert f"In each question: {warning}" in said
    assert warning not in said


def test_the_spread_of_widths_is_not_called_logits(study_case):
    wide = (Quantity("scale_sd", 1.3, 0.2, 0.9, 1.7),)
    (said, *_) = about_priors(replace(study_case.fit, questions=(with_parameters(study_case, wide),)))
    assert "(1.3 on the log scale; the prior gives less than 5 % to more than 1)" in said
    apart = (Quantity("subject_sd", 2.4, 0.2, 1.9, 2.9),)
    (said, *_) = about_priors(replace(study_case.fit, questions=(with_parameters(study_case, apart),)))
    assert "(2.4 logits; the prior gives less than 5 % to more than 2)" in said


def with_parameters(case, parameters):
    return replace(case.fit.questions[0], parameters=parameters)


UNEVEN = PredictiveCheck("Q1", "width_by_person", "", 4.0, 0.0, -1.0, 1.0, 0.0001, 0.001, True)


def test_a_scale_without_a_middle_is_not_said_to_have_one():
    """The caution on the use of the scale holds for scales of three levels and more, odd or even."""
    (said,) = model_cautions(PredictiveChecks((UNEVEN,), 0.1, 1, 10, 10))
    assert "some choose answers near the middle of the scale more often than others do" in said
    assert "“about the same”" not in said


def test_one_chance_is_not_called_several(study_case):
    look = closer_look(study_case.table, study_case.fit)
    found = findings(study_case.fit)
    assert "changes these chances by up to" in _about_findings(found, look)[-1]
    assert "changes this chance by " in _about_findings(found[:1], look)[-1]


def test_a_monte_carlo_error_is_never_printed_as_none():
    assert [_mean("0.029", e, 3) for e in (0.0002, 0.0006, None)] == [
        "0.029 ± <0.001",
        "0.029 ± 0.001",
        "0.029",
    ]
    assert [_chance(0.9, e) for e in (0.0003, 0.004)] == ["90 ± <0.1 %", "90 ± 0.4 %"]
