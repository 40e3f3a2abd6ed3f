"""Stuck rates in words and tables: what is of these comparisons, and what of people in general."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.claims import expected_wrong
from analysis.report.findings import lead
from analysis.report.methods import methods
from analysis.report.stuck import contrasts_section, likely_difference, stuck_claims, stuck_section
from analysis.stuck import stuck_rates
from analysis.stuck_contrasts import stuck_contrasts
from data.responses import StuckTable


def table_of(stuck: dict[str, tuple[int, ...]], minutes: float = 53 / 28) -> StuckTable:
    """How many of four comparisons each person got stuck in, by mode."""
    rows = [
        (f"p{person}", f"p{person}.c{k}", mode, k < events, 60.0 * minutes)
        for mode, people in stuck.items()
        for person, events in enumerate(people)
        for k in range(4)
    ]
    return StuckTable(
        pd.DataFrame(rows, columns=["participant", "comparison", "mode", "stuck", "exposure_s"])
    )


def in_words(table: StuckTable) -> str:
    rates = stuck_rates(table)
    return " ".join(stuck_section(rates, stuck_contrasts(table, rates), "").words)


FOUR_PEOPLE = {"M1": (4, 4, 2, 1, 0, 0, 0), "M2": (0,) * 7}
ALIKE = {"M1": (1, 0, 1, 0, 2, 0, 1), "M2": (0, 1, 0, 1, 1, 1, 0)}
NEVER = {"M1": (0,) * 7, "M2": (0,) * 7}


def test_rates_are_named_by_whom_they_speak_of():
    text = in_words(table_of(FOUR_PEOPLE))
    assert text.startswith(
        "M1: stuck in 11 of 28 comparisons and with 4 of 7 people. For these people and comparisons that is "
        "a share of 40 % (24 to 57 %); for people in general, of 41 % (18 to 65 %), and 0.27 (0.00 to 0.70) "
        "a minute for the median person."
    )


def test_a_difference_is_claimed_of_people_by_what_counts_people():
    table = table_of(FOUR_PEOPLE)
    rates = stuck_rates(table)
    (contrast,) = contrasts = stuck_contrasts(table, rates)
    (claim,) = stuck_claims(contrasts, rates)
    assert claim.probability == contrast.p_i_above_j_people < contrast.p_i_above_j
    assert claim.text == "In people in general the robot gets stuck more often under M1 than under M2."
    text = in_words(table)
    assert (
        "In people in general one difference is likely: M1's rate is above M2's: over 99 %, and 4 people got "
        "stuck more often under M1, 0 under M2 (exact test by people: p = 0.125). Of this 1 statement "
        "fewer than 0.01 are expected to be wrong. For these 7 people and their comparisons alone, taken as "
        "independent, the chance is over 99 %; that says nothing about other people."
    ) in text
    assert expected_wrong([claim]) == pytest.approx(1 - contrast.p_i_above_j_people)


def test_where_no_difference_is_likely_none_is_claimed():
    table = table_of(ALIKE)
    rates = stuck_rates(table)
    contrasts = stuck_contrasts(table, rates)
    assert stuck_claims(contrasts, rates) == ()
    assert likely_difference(contrasts, rates) == ""
    text = in_words(table)
    assert "In people in general no difference between two modes is likely. The surest: M1's rate" in text
    assert "expected to be wrong" not in text


def test_modes_that_nobody_got_stuck_under_are_not_compared():
    # With more comparisons of one of them its rate is likely lower, which nothing that happened says.
    table = table_of(NEVER)
    more = table.rows[table.rows["mode"] == "M1"]
    many = [more.assign(participant=more["participant"] + f"x{k}") for k in range(30)]
    rates = stuck_rates(StuckTable(pd.concat([table.rows, *many], ignore_index=True)))
    contrasts = stuck_contrasts(table, rates)
    assert abs(contrasts[0].p_i_above_j_people - 0.5) > 0.3
    assert stuck_claims(contrasts, rates) == ()
    assert likely_difference(contrasts, rates) is None
    assert contrasts_section(contrasts, rates) is None


def test_never_stuck_has_a_limit_for_these_comparisons_and_one_for_people():
    assert in_words(table_of(NEVER)) == (
        "The robot never got stuck under any mode. That does not make a rate 0: with so many comparisons "
        "rates of up to 9 % of the comparisons go with it, if comparisons are independent, and of up to 12 % "
        "in people in general."
    )


def test_a_rate_that_every_comparison_is_stuck_at_has_only_a_lower_end():
    text = in_words(table_of({"M1": (4,) * 7, "M2": (0,) * 7}))
    assert "(0.46 to 36.10) a minute for the median person, of which only the lower end comes from" in text
    assert "only the lower end" not in in_words(table_of(FOUR_PEOPLE))


def test_the_lead_says_what_happened_and_what_is_likely_of_people():
    table = table_of(FOUR_PEOPLE)
    rates = stuck_rates(table)
    difference = likely_difference(stuck_contrasts(table, rates), rates)
    text = "".join(p.text for p in lead((), rates, "", (), difference))
    assert text == (
        "The robot got stuck in 11 of 28 comparisons with M1 (4 of 7 people) and in none with M2. That is of "
        "these comparisons; in people in general M1's rate is likely above M2's (a chance of over 99 %)."
    )
    simulated = "".join(p.text for p in lead((), rates, "simulated data", (), ""))
    assert simulated.endswith(
        "in simulated people in general no difference between two modes' rates is likely."
    )


def test_every_column_of_a_contrast_says_of_whom_it_speaks():
    table = table_of(FOUR_PEOPLE)
    rates = stuck_rates(table)
    section = contrasts_section(stuck_contrasts(table, rates), rates)
    cells = dict(zip(section.table.columns, section.table.rows[0], strict=True))
    assert cells["i higher, these"] == ">99 %"
    assert cells["p, within people, these"] == "<0.0001"
    assert cells["p, by people"] == "0.125"
    assert cells["people i : j"] == "4 : 0"
    assert section.words[0].startswith("These people and comparisons: ")
    assert section.words[1].startswith("People in general: ")


def test_without_participants_nothing_is_said_of_people_in_general(study_case):
    table = table_of(FOUR_PEOPLE)
    table = replace(table, rows=table.rows.assign(participant=""))
    rates = stuck_rates(table)
    contrasts = stuck_contrasts(table, rates)
    assert np.isnan(contrasts[0].p_by_people)
    assert np.isnan(contrasts[0].p_i_above_j_people)
    assert stuck_claims(contrasts, rates) == ()
    assert likely_difference(contrasts, rates) is None
    section = stuck_section(rates, contrasts, "")
    assert " ".join(section.words).endswith(
        "Who took part is not known, so nothing follows for people in general."
    )
    assert "people in general" not in section.caption
    assert "Rate, people in general" not in section.table.columns
    assert "i higher, people" not in contrasts_section(contrasts, rates).table.columns
    text = " ".join(p.text for p in methods(study_case.fit, rates=rates))
    assert "For people in general" not in text


def test_the_methods_say_model_priors_and_tests(study_case):
    text = " ".join(p.text for p in methods(study_case.fit, rates=stuck_rates(table_of(FOUR_PEOPLE))))
    assert "probability 1 − exp(−rate · t)" in text
    assert "around log 0.2 a minute with standard deviation 2" in text
    assert "half-normal prior of scale 1.5" in text
    assert "exchanges the modes within people (Basu 1980)" in text
    assert "unknown length" not in text
    unknown = table_of(FOUR_PEOPLE, minutes=0.0)
    text = " ".join(p.text for p in methods(study_case.fit, rates=stuck_rates(unknown)))
    assert "A comparison of unknown length counts as the median of the known ones, or as 2 minutes." in text
