"""The command line says what is wrong in one plain line, and does what it says."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from app.cli.main import cli, run
from app.studies import open_study
from data.study_file import study_text

RESPONSES = """participant,question,mode_a,mode_b,response
p1,Q1,M1,M2,A>>B
p1,Q1,M2,M3,B>A
p1,Q1,M3,M1,A=B
p2,Q1,M1,M2,B>A
p2,Q1,M2,M3,A>B
p2,Q1,M3,M1,B>>A
"""


def only_line(captured: str) -> str:
    lines = captured.splitlines()
    assert len(lines) == 1, captured
    assert lines[0].startswith("elbowroom: ")
    assert not set(captured) & set("╭╮╰╯│─")
    return lines[0].removeprefix("elbowroom: ")


@pytest.fixture
def responses(tmp_path: Path) -> Path:
    path = tmp_path / "answers.csv"
    path.write_text(RESPONSES)
    return path


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["study", "check", "nowhere.toml"],
            "no such file, and no built-in study (built in: beaudoin2022, carmichael2017, ",
        ),
        (["trial", "--mode", "M9"], "mode: 'M9' is not one of: M1, M2, M3"),
        (["trial", "--mode", "M1", "--operator-seed", "-1"], "--operator-seed"),
        (["report", "--store", "a.sqlite", "--responses", "b.csv", "--out", "r"], "not both"),
        (["report", "--responses", "nowhere.csv", "--out", "r"], "nowhere.csv"),
        (["report", "--responses", "x.csv", "--engine", "quick", "--out", "r"], "'fast', 'pymc', 'gibbs'"),
        (["report", "--store", "nosuch://x", "--out", "r"], "nosuch"),
        (["report", "--store", "missing.sqlite", "--out", "r"], "missing.sqlite"),
        (
            ["report", "--responses", "x.csv", "--max-latency-ms", "50", "--out", "r"],
            "a CSV of responses knows no",
        ),
        (
            ["report", "--responses", "x.csv", "--max-skipped", "1", "--out", "r"],
            "a CSV of responses knows no",
        ),
        (["report", "--max-latency-ms", "nan", "--out", "r"], "--max-latency-ms: nan is not above 0"),
        (["report", "--max-skipped", "101", "--out", "r"], "--max-skipped: 101 is not between 0 and 100"),
        (["import"], "--responses FILE.csv and --stuck FILE.csv"),
        (["sweep", "--right-edge", "1:2", "--out", "s"], "--right-edge: '1:2' is no range"),
        (["sweep", "--dwell", "3:7:1000000000000", "--out", "s"], "at most 1000 values"),
        (["no-such-command"], "no-such-command"),
        (["demo", "--participants", "0"], "--participants"),
    ],
)
def test_wrong_input_is_one_plain_line_and_exit_2_and_nothing_is_written(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    assert said in only_line(capsys.readouterr().err)
    assert list(tmp_path.iterdir()) == []


def test_a_study_file_with_an_unknown_method_is_refused_with_the_valid_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(study_text("carmichael2017").replace('method = "dls"', 'method = "dsl"', 1))
    assert run(["study", "check", str(path)]) == 2
    assert "mode M1: method: 'dsl' is not one of: asymmetric_dls, " in only_line(capsys.readouterr().err)


def test_a_mode_without_a_method_is_refused_with_the_valid_ones_where_the_robot_is_simulated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = without_methods(study_text("carmichael2017"))
    path = tmp_path / "mine.toml"
    for source in ("guided", "observed"):
        path.write_text(text.replace('trial_source = "guided"', f'trial_source = "{source}"'))
        assert run(["study", "check", str(path)]) == 2
        said = only_line(capsys.readouterr().err)
        assert said.startswith(f"{path}: modes.1.method: missing; mode M1 needs one of: asymmetric_dls, ")


def test_a_study_of_a_robot_in_the_lab_needs_no_method_but_cannot_be_simulated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "lab.toml"
    text = without_methods(study_text("carmichael2017"))
    path.write_text(text.replace('trial_source = "guided"', 'trial_source = "external"'))
    assert open_study(path).modes == ()
    assert run(["study", "check", str(path)]) == 0
    assert "external trials" in capsys.readouterr().out
    assert run(["study", "show", str(path)]) == 0
    shown = capsys.readouterr().out
    assert "A robot in the lab, which an operator tends" in shown
    assert "Practice" not in shown
    assert "Maze" not in shown
    store = tmp_path / "study.sqlite"
    assert run(["simulate", "--study", str(path), "--store", str(store), "--participants", "1"]) == 2
    assert (
        "cannot be simulated: its trials are external, and no method is named for the modes M1, M2, M3"
        in (" ".join(only_line(capsys.readouterr().err).split()))
    )
    assert run(["trial", "--study", str(path), "--mode", "M1"]) == 2
    assert "modes.1.method: missing" in only_line(capsys.readouterr().err)
    assert not store.exists()


def test_a_method_of_a_robot_in_the_lab_is_not_looked_up_until_it_is_simulated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "lab.toml"
    text = study_text("carmichael2017").replace('trial_source = "guided"', 'trial_source = "external"')
    path.write_text(text.replace('method = "dls"', 'method = "ours"', 1))
    assert run(["study", "check", str(path)]) == 0
    store = tmp_path / "study.sqlite"
    assert run(["simulate", "--study", str(path), "--store", str(store), "--participants", "1"]) == 2
    assert "mode M1: method: 'ours' is not one of: " in only_line(capsys.readouterr().err)


def test_practice_out_of_reach_is_refused_where_people_guide_and_only_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.toml"
    text = study_text("carmichael2017").replace("right_y_m = -0.50", "right_y_m = -1.2")
    path.write_text(text)
    assert run(["study", "check", str(path)]) == 2
    assert "practice.right_y_m: the robot does not reach the corner y = -1.045" in only_line(
        capsys.readouterr().err
    )
    path.write_text(text.replace('trial_source = "guided"', 'trial_source = "observed"'))
    assert run(["study", "check", str(path)]) == 0
    path.write_text(text.replace("laps = 1\n", "laps = 0\n"))
    assert run(["study", "check", str(path)]) == 0


def test_what_participants_of_a_guided_study_go_through_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["study", "show", "carmichael2017"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "Trials: Each participant guides the simulated robot in the browser" in shown
    assert "Background: robots, games, hand" in shown
    assert "Practice: 1 lap with M1, y 0.35 to -0.5 m" in shown


def test_a_mode_that_stands_still_for_good_is_valid_but_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.toml"
    servo = '[[modes]]\nname = "Servo"\nmethod = "condition_scaling"\n\n[[questions]]'
    path.write_text(study_text("carmichael2017").replace("[[questions]]", servo, 1))
    for command in ("check", "show"):
        assert run(["study", command, str(path)]) == 0
        shown = " ".join(capsys.readouterr().out.split())
        assert "mode Servo (condition_scaling) stands still below sigma 0.07" in shown
        assert shown.count("stands still") == 1, "of the other modes there is nothing to tell"


def test_show_says_how_the_modes_behave_and_where_more_of_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["study", "show", "carmichael2017"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "M3 in 0.988 0.171" in shown
    assert "M3 out 0.999 0.649" in shown
    assert "elbowroom study atlas carmichael2017 --out atlas" in shown


def without_methods(text: str) -> str:
    return re.sub(r"(?m)^(method|parameters) = .*\n", "", text)


def test_a_report_from_a_csv_ranks_and_writes_the_contract_s_files(
    responses: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "report"
    assert run(["report", "--responses", str(responses), "--out", str(out)]) == 0
    worth = pd.read_csv(out / "worth.csv")
    assert worth["worth_mean"].sum() == pytest.approx(1.0)
    summary = json.loads((out / "summary.json").read_text())
    assert summary["ranked"] is True
    for name in ("report.html", "pairwise.csv", "parameters.csv", "posterior.nc"):
        assert (out / name).stat().st_size > 0
    assert "M1" in capsys.readouterr().out


def test_an_unwritable_folder_is_exit_1_and_one_line(
    responses: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["report", "--responses", str(responses), "--out", "/proc/elbowroom/report"]) == 1
    assert "/proc/elbowroom/report: cannot be written" in only_line(capsys.readouterr().err)


def test_a_file_in_place_of_a_folder_is_wrong_input(
    responses: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    assert run(["report", "--responses", str(responses), "--out", str(blocked / "report")]) == 2
    assert f"{blocked} is a file, not a folder" in only_line(capsys.readouterr().err)


def test_every_command_has_a_help_with_an_example() -> None:
    for command in cli.registered_commands:
        assert command.callback is not None
        assert "elbowroom " in (command.callback.__doc__ or ""), command.name


def test_one_lap_as_json_says_that_it_is_simulated(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["trial", "--mode", "M2", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["simulated"] is True
    assert content["outcome"] == "completed"
    assert content["duration_s"] > 5


def test_without_a_compiler_the_doctor_says_what_is_slow_and_fast_still_ranks(
    responses: Path, tmp_path: Path
) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    environment = os.environ | {"PATH": str(empty)}
    doctor = subprocess.run(
        [sys.executable, "-m", "app.cli", "doctor"], env=environment, capture_output=True, text=True
    )
    assert "no C++ compiler" in doctor.stdout
    report = subprocess.run(
        [sys.executable, "-m", "app.cli", "report", "--responses", str(responses), "--out", "report"],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert report.returncode == 0, report.stderr
    assert "compiler" not in report.stderr


def test_the_report_on_the_cems_data_gives_the_published_estimates(tmp_path: Path) -> None:
    """Davidson's model by maximum likelihood (Dittrich, Hatzinger, Katzenbeisser 1998; BradleyTerry2).

    With 4,455 comparisons and a weak prior the posterior mean is within a tenth of a standard error.
    """
    published = {
        "Barcelona": 0.6129,
        "London": 1.8228,
        "Milano": 0.4420,
        "Paris": 1.0325,
        "St.Gallen": 0.5983,
    }
    responses = Path(__file__).parents[1] / "reference" / "cems.csv"
    options = ["--pooled", "--no-side-effect", "--link", "adjacent", "--prior-sd", "10"]
    assert run(["report", "--responses", str(responses), *options, "--out", str(tmp_path / "r")]) == 0
    ability = pd.read_csv(tmp_path / "r" / "worth.csv").set_index("mode")["ability_mean"]
    for school, estimate in published.items():
        assert ability[school] - ability["Stockholm"] == pytest.approx(estimate, abs=0.0080), school
    log_nu = pd.read_csv(tmp_path / "r" / "parameters.csv").set_index("name")["mean"]["log_nu"]
    assert log_nu == pytest.approx(-1.3172, abs=0.0049)
