"""The paragraph and the warnings a report writes."""

from dataclasses import replace

from analysis.report.cautions import cautions
from analysis.report.findings import findings, lead


def words(case, simulated=False):
    return "".join(phrase.text for phrase in lead(findings(case.fit), (), simulated))


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
        "No mode comes first on every question. M1 likely ranks first for “most responsive” (90 %)"
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


def test_a_side_that_was_favoured_is_named(study_case):
    question = study_case.fit.questions[0]
    parameters = tuple(
        replace(p, mean=0.5, hdi_low=0.1, hdi_high=0.9) if p.name == "side_effect" else p
        for p in question.parameters
    )
    fit = replace(study_case.fit, questions=(replace(question, parameters=parameters),))
    said = cautions(study_case.table, fit, findings(fit), None, 0)
    assert "Q2: whatever was shown as A was favoured; the ranking corrects for it." in said


def test_a_fit_that_did_not_converge_says_so(study_case):
    fit = replace(study_case.fit, converged=False, rhat_max=1.3)
    said = " ".join(cautions(study_case.table, fit, findings(fit), None, 0))
    assert "The sampler did not converge" in said
    assert "R-hat 1.300" in said
