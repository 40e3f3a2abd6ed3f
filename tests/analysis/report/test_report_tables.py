"""The CSV files and the summary of a report folder."""

import csv
import json
from pathlib import Path

import arviz as az
import pytest

from analysis.report import write_report
from analysis.report.summary import known_comparisons
from analysis.report.tables import neutralised, write_csv
from data.study_file import read_study


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_every_table_has_the_columns_that_others_rely_on(study_report):
    headers = {
        path.name: path.read_text(encoding="utf-8").splitlines()[0] for path in study_report.glob("*.csv")
    }
    promised = {
        "worth.csv": "question,mode,ability_mean,ability_sd,worth_mean,worth_sd,worth_hdi_low,worth_hdi_high,"
        "p_best,rank_mean",
        "pairwise.csv": "question,mode_i,mode_j,p_i_above_j,n,wins_i,ties,wins_j",
        "parameters.csv": "question,name,mean,sd,hdi_low,hdi_high",
        "stuck.csv": "mode,comparisons,stuck,rate_mean,rate_hdi_low,rate_hdi_high",
    }
    assert {name: headers[name] for name in promised} == promised


def test_worths_and_chances_to_rank_first_add_up_to_one_in_every_question(study_report):
    rows = rows_of(study_report / "worth.csv")
    for question in ("Q2", "Q3", "Q6"):
        own = [row for row in rows if row["question"] == question]
        assert [row["mode"] for row in own] == ["M1", "M2", "M3"]
        assert sum(float(row["worth_mean"]) for row in own) == pytest.approx(1, abs=1e-12)
        assert sum(float(row["p_best"]) for row in own) == pytest.approx(1, abs=1e-12)
        assert sum(float(row["ability_mean"]) for row in own) == pytest.approx(0, abs=1e-10)
        assert sum(float(row["rank_mean"]) for row in own) == pytest.approx(6, abs=1e-12)
        for row in own:
            assert (
                0
                <= float(row["worth_hdi_low"])
                <= float(row["worth_mean"])
                <= float(row["worth_hdi_high"])
                <= 1
            )


def test_the_planted_order_comes_out(study_report):
    own = {
        row["mode"]: float(row["worth_mean"])
        for row in rows_of(study_report / "worth.csv")
        if row["question"] == "Q2"
    }
    assert own["M1"] > own["M2"] > own["M3"]


def test_numbers_are_written_without_loss(study_report, study_case):
    first = study_case.fit.questions[0].modes[0]
    row = rows_of(study_report / "worth.csv")[0]
    assert float(row["worth_mean"]) == first.worth_mean
    assert float(row["ability_sd"]) == first.ability_sd


def test_a_pair_read_from_the_other_side_has_the_other_chance_and_the_other_wins(study_report, study_case):
    rows = {(r["question"], r["mode_i"], r["mode_j"]): r for r in rows_of(study_report / "pairwise.csv")}
    assert len(rows) == 3 * 6
    for (question, i, j), row in rows.items():
        other = rows[question, j, i]
        assert float(row["p_i_above_j"]) + float(other["p_i_above_j"]) == pytest.approx(1, abs=1e-12)
        assert (row["n"], row["ties"], row["wins_i"]) == (other["n"], other["ties"], other["wins_j"])
        assert int(row["n"]) == int(row["wins_i"]) + int(row["ties"]) + int(row["wins_j"])
    once = sum(int(row["n"]) for row in rows.values()) / 2
    assert once == study_case.table.rows["count"].sum()


def test_parameters_are_named_as_in_the_model(study_report):
    names = {row["name"] for row in rows_of(study_report / "parameters.csv") if row["question"] == "Q2"}
    assert names == {"side_effect", "cut_1", "cut_2", "subject_sd"}


def test_stuck_rates_count_the_comparisons_of_each_mode(study_report):
    rows = {row["mode"]: row for row in rows_of(study_report / "stuck.csv")}
    assert {mode: (row["comparisons"], row["stuck"]) for mode, row in rows.items()} == {
        "M1": ("24", "5"),
        "M2": ("24", "0"),
        "M3": ("24", "0"),
    }
    assert float(rows["M1"]["rate_mean"]) == pytest.approx(6 / 26, abs=1e-9)


def test_there_is_no_stuck_table_where_nothing_is_known_of_trials(refused_report):
    assert not (refused_report / "stuck.csv").exists()


def test_the_same_fit_gives_the_same_bytes_in_every_file_that_people_read(study_case, study_report, tmp_path):
    study = read_study("carmichael2017")
    write_report(study_case.table, study_case.fit, tmp_path / "again", study_case.stuck, study)
    compared = [p for p in study_report.rglob("*") if p.is_file() and p.suffix != ".nc"]
    assert len(compared) == 37
    for path in compared:
        assert path.read_bytes() == (tmp_path / "again" / path.relative_to(study_report)).read_bytes(), (
            path.name
        )


def test_the_summary_says_how_the_report_came_about(study_report, study_case):
    summary = json.loads((study_report / "summary.json").read_text(encoding="utf-8"))
    assert summary["engine"] == "fast"
    assert summary["seed"] == 2017
    assert summary["data_sha256"] == study_case.table.sha256
    assert summary["simulated"] is False
    assert summary["converged"] is True
    assert summary["questions"]["Q2"] | {"ranked": True, "reason": ""} == summary["questions"]["Q2"]
    assert summary["counts"]["participants"] == 6
    assert summary["counts"]["responses"] == 108
    assert summary["rhat_max"] == study_case.fit.rhat_max


def test_a_question_that_nobody_answered_stays_in_the_summary_with_the_reason(study_report):
    summary = json.loads((study_report / "summary.json").read_text(encoding="utf-8"))
    assert set(summary["questions"]) == {"Q1", "Q2", "Q3", "Q4", "Q5", "Q6"}
    assert summary["questions"]["Q1"]["ranked"] is False
    assert summary["questions"]["Q1"]["reason"] == "Nobody answered this question."
    assert summary["ranked"] is False


def test_comparisons_that_every_participant_numbers_alike_are_counted_for_each(study_case):
    rows = study_case.table.rows
    alike = rows.assign(comparison=rows["comparison"].str.partition(".")[2])
    assert known_comparisons(rows) == 36
    assert known_comparisons(alike) == 36
    assert known_comparisons(rows.assign(comparison="")) == 0


def test_the_rate_over_people_stands_among_the_parameters(study_report):
    rows = {row["name"]: row for row in rows_of(study_report / "parameters.csv")}
    assert rows["stuck_rate_M1"]["question"] == ""
    assert 0 < float(rows["stuck_rate_M3"]["mean"]) < float(rows["stuck_rate_M1"]["mean"]) < 1


def test_arviz_opens_the_posterior(study_report):
    posterior = az.from_netcdf(study_report / "posterior.nc")
    assert "posterior" in posterior.groups()


def test_an_unranked_question_has_no_worths_and_no_chances_but_its_counts(refused_report):
    assert {row["question"] for row in rows_of(refused_report / "worth.csv")} == {"Q2"}
    assert {row["question"] for row in rows_of(refused_report / "parameters.csv")} == {"Q2"}
    pairs = [row for row in rows_of(refused_report / "pairwise.csv") if row["question"] == "Q3"]
    assert {row["p_i_above_j"] for row in pairs} == {""}
    assert {(r["mode_i"], r["mode_j"]): int(r["n"]) for r in pairs}["M1", "M2"] == 12
    summary = json.loads((refused_report / "summary.json").read_text(encoding="utf-8"))
    assert summary["ranked"] is False
    assert summary["questions"]["Q3"]["ranked"] is False
    assert "M3" in summary["questions"]["Q3"]["reason"]
    assert ["M1", "M3"] in summary["questions"]["Q3"]["missing_pairs"]


@pytest.mark.parametrize("name", ["=1+1", "+1", "-1", "@sum"])
def test_a_name_that_a_spreadsheet_would_run_is_written_with_an_apostrophe(name):
    assert neutralised(name) == f"'{name}"


def test_any_text_survives_the_csv(tmp_path):
    texts = ['a "b", c', "line\nbreak", "carriage\rreturn", " space ", "plain", "", "a,b"]
    write_csv(tmp_path / "t.csv", ("text", "number"), [(text, 0.1 + 0.2) for text in texts])
    rows = rows_of(tmp_path / "t.csv")
    assert [row["text"] for row in rows] == texts
    assert {float(row["number"]) for row in rows} == {0.1 + 0.2}


def test_hostile_names_come_back_from_the_tables_and_the_summary_says_which_were_changed(
    hostile_case, hostile_report
):
    names = {row["mode"] for row in rows_of(hostile_report / "worth.csv")}
    assert names == {neutralised(mode) for mode in hostile_case.table.modes}
    summary = json.loads((hostile_report / "summary.json").read_text(encoding="utf-8"))
    changed = [warning for warning in summary["warnings"] if "spreadsheet" in warning]
    assert len(changed) == 1
    assert "=cmd" in changed[0]
    assert "@sum(1)" in changed[0]
