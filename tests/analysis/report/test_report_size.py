"""What a report says of several likely firsts, of early looks, and of claims taken together."""

import csv
import json
from dataclasses import replace

import pytest

from analysis.claims import all_right, expected_wrong
from analysis.closer_look import closer_look
from analysis.looks import earlier, looks_sentence
from analysis.observed_design import observed_design
from analysis.report import write_report
from analysis.report.claims import report_claims
from analysis.report.findings import findings, first_claims, lead
from analysis.report.size import size_cautions
from data.records import Look


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_every_claim_stands_in_findings_csv_with_what_its_section_is_worth(study_case, study_report):
    claims = report_claims(
        study_case.fit, findings(study_case.fit), closer_look(study_case.table, study_case.fit), None
    )
    rows = rows_of(study_report / "findings.csv")
    assert list(rows[0]) == ["section", "claim", "probability", "joint"]
    of_stuck = [r for r in rows if r["section"] == "How often the robot got stuck"]
    assert of_stuck
    assert [(r["section"], r["claim"]) for r in rows if r not in of_stuck] == [
        (c.section, c.text) for c in claims
    ]
    firsts = first_claims(findings(study_case.fit))
    assert len(firsts) >= 2
    own = [r for r in rows if r["section"] == "What the answers settle"]
    assert [float(r["probability"]) for r in own] == [c.probability for c in firsts]
    assert {float(r["joint"]) for r in own} == {all_right(firsts)}
    assert "Which differences matter" in {r["section"] for r in rows}


def test_the_joint_statement_stands_in_the_lead_and_below_the_first_places(study_case, study_report):
    firsts = first_claims(findings(study_case.fit))
    sentence = f"Of the {len(firsts)} named firsts {expected_wrong(firsts):.2f} are expected to be wrong"
    assert sentence in "".join(p.text for p in lead(findings(study_case.fit), (), ""))
    page = (study_report / "report.html").read_text(encoding="utf-8")
    assert page.count(sentence) == 2
    assert "Monte Carlo standard error" in page
    assert "not corrected for being several" not in page


def test_open_is_not_equal_where_so_few_cannot_show_it(study_case):
    look = closer_look(study_case.table, study_case.fit)
    assert look.equality.is_too_small
    unsettled = tuple(replace(f, reading="open") for f in findings(study_case.fit))
    said = "".join(p.text for p in lead(unsettled, (), "", equality=look.equality))
    assert "“Open” does not mean equal: so few answers cannot show that modes are equal; it" in said


def test_monte_carlo_errors_stand_beside_means_and_chances(study_report):
    rows = rows_of(study_report / "monte_carlo.csv")
    worth = {(r["question"], r["mode"]): r for r in rows_of(study_report / "worth.csv")}
    best = [r for r in rows if r["quantity"] == "p_best"]
    assert len(best) == 9
    for row in best:
        assert row["value"] == worth[row["question"], row["mode_i"]]["p_best"]
        assert 0 < float(row["mcse"]) < 0.04
    assert " ± 0.0" in (study_report / "report.html").read_text(encoding="utf-8")


def test_numbers_are_as_short_as_they_round_trip(study_report):
    """Shares of 1,200 draws, and what is left of 1, have the digits of shares."""
    for name in ("pairwise.csv", "equivalence.csv", "worth.csv"):
        for row in rows_of(study_report / name):
            for column in ("p_i_above_j", "p_equal", "p_i_above", "p_best", "rank_mean"):
                if column in row:
                    value = float(row[column])
                    assert float(row[column]) == pytest.approx(round(value * 1200) / 1200, abs=1e-12)
    pairs = {(r["question"], r["mode_i"], r["mode_j"]): r for r in rows_of(study_report / "pairwise.csv")}
    for (question, i, j), row in pairs.items():
        p, q = row["p_i_above_j"], pairs[question, j, i]["p_i_above_j"]
        assert abs(len(p) - len(q)) <= 1, (p, q)


def test_without_any_preference_several_questions_still_have_a_likely_first_mostly(study_case):
    found = findings(study_case.fit)
    (said,) = size_cautions(study_case.fit, found, (), Look(6, 108))
    assert said.startswith(
        "If nobody preferred any mode, at least one of 3 questions would still have a likely"
    )
    share = int(said.split("about ")[1].split(" %")[0])
    assert 30 < share < 50
    only = replace(study_case.fit, questions=study_case.fit.questions[:1])
    assert size_cautions(only, findings(only), (), Look(6, 36)) == []


def test_early_looks_are_counted_and_what_they_do_is_said(study_case, tmp_path):
    design = observed_design(study_case.fit)
    shown = Look(6, 108)
    looks = tuple(Look(n, 18 * n) for n in range(1, 7))
    before = earlier(looks, shown)
    assert [look.participants for look in before] == [1, 2, 3, 4, 5]
    said = looks_sentence(before, shown, design, "before this report")
    assert said.startswith(
        "The results were looked at 5 times before this report (with 1, 2, 3, 4 and 5 participants)."
    )
    once, stopping = (int(part.split(" %")[0]) for part in said.split("about ")[1:])
    assert once < stopping
    write_report(study_case.table, study_case.fit, tmp_path / "r", looks=before)
    summary = json.loads((tmp_path / "r" / "summary.json").read_text(encoding="utf-8"))
    assert said in summary["before_you_quote_this"]


def test_a_report_without_a_store_says_nothing_of_looks(study_report):
    assert "looked at" not in (study_report / "summary.json").read_text(encoding="utf-8")


def test_a_pair_that_was_never_shown_is_named_on_the_page(study_case, tmp_path):
    from analysis.fit import fit

    rows = study_case.table.rows
    kept = ~(rows[["mode_a", "mode_b"]].isin(["M1", "M3"]).all(axis=1))
    table = replace(study_case.table, rows=rows[kept].reset_index(drop=True))
    written = write_report(table, fit(table, study_case.fit.settings), tmp_path / "r")
    page = (tmp_path / "r" / "report.html").read_text(encoding="utf-8")
    assert "Never shown against each other: M1 and M3." in page
    assert "the pair was never shown: its chance follows from other pairs" in page
    assert any("Never shown" in note for note in written.notes)
