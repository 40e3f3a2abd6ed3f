"""Checking and locking a study file, and the full fit's process."""

import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.console.full_fit import FullFit, log_reading
from app.console.overview import is_locked
from app.console.study_check import check_study
from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.visitors import admit, new_token
from data.errors import InputError
from data.store import Store, token_sha256
from data.study_file import parse_study
from tests.conftest import PATIENCE_S

from .conftest import TINY_STUDY


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    with Store.open(tmp_path / "study.sqlite") as store:
        stored = store.add_study(parse_study(TINY_STUDY, "tiny.toml"), TINY_STUDY)
        yield Desk(stored, store, LapKeeper(stored.study, store.recordings_folder, 1))


def answered(desk: Desk) -> None:
    """One participant who answered one comparison."""
    token = new_token()
    desk.store.create_link("participant", desk.stored_study, token_sha256(token))
    person = admit(desk, f"{token}.nonce")
    first = desk.store.comparisons(participant=person.id)[0]
    desk.store.start_comparison(first.id, desk.clock())
    desk.store.submit_responses(first.id, {"Q1": "A>B", "Q2": "B>A"}, desk.clock())


def test_a_valid_file_is_told_apart_by_what_it_means(desk: Desk) -> None:
    served = desk.stored_study
    same = check_study((TINY_STUDY + "# a comment\n").encode(), "a.toml", served)
    assert (same.standing, same.changes) == ("same", ())
    changed = check_study(TINY_STUDY.replace("= 0.6", "= 0.7").encode(), "a.toml", served)
    assert changed.standing == "next revision"
    assert changed.changes == (("modes[2].parameters.lambda0", "0.6", "0.7"),)
    other = check_study(TINY_STUDY.replace('"tiny"', '"other"').encode(), "a.toml", served)
    assert other.standing == "another study"


def test_a_valid_file_with_a_mode_that_stands_still_for_good_says_so(desk: Desk) -> None:
    changed = TINY_STUDY.replace('method = "dls"', 'method = "condition_scaling"', 1).replace(
        "parameters = { lambda0 = 0.2, sigma_t = 0.25 }\n", "", 1
    )
    found = check_study(changed.encode(), "a.toml", desk.stored_study)
    assert found.standing == "next revision"
    (caution,) = found.cautions
    assert caution.startswith("mode Zwetschge (condition_scaling) stands still below sigma 0.0")
    assert check_study(TINY_STUDY.encode(), "a.toml", desk.stored_study).cautions == ()


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ('"dls"', '"dsl"', "dsl"),
        ("levels = 5", "levels = 4", "levels"),
        ("repetitions", "repetition", "did you mean repetitions"),
        ("[protocol]", "[maze]\nwall_x_m = 1.9\n[protocol]", "reach"),
    ],
)
def test_a_wrong_file_is_told_in_one_line(desk: Desk, old: str, new: str, why: str) -> None:
    found = check_study(TINY_STUDY.replace(old, new, 1).encode(), "a.toml", desk.stored_study)
    assert found.standing == "wrong"
    assert found.sentence.startswith("a.toml")
    assert why in found.sentence
    assert "\n" not in found.sentence


def test_a_file_in_another_encoding_is_told_in_one_line(desk: Desk) -> None:
    assert (
        check_study(b"name = \xff", "a.toml", desk.stored_study).sentence == "a.toml: not UTF-8 text (byte 7)"
    )


def test_a_study_is_locked_by_hand_once_and_logged(desk: Desk) -> None:
    assert not is_locked(desk)
    desk.store.lock_study(desk.stored_study, "researcher")
    desk.store.lock_study(desk.stored_study, "researcher")
    assert is_locked(desk)
    assert [entry.action for entry in desk.store.audit_log()] == ["lock study"]


def test_a_fit_without_answers_is_refused_before_a_process_starts(desk: Desk) -> None:
    fit = FullFit()
    with pytest.raises(InputError):
        fit.start(desk, include_simulated=False)
    assert fit.state == "idle"
    assert desk.store.audit_log() == ()


def test_one_fit_at_a_time_which_can_be_cancelled(desk: Desk) -> None:
    answered(desk)
    fit = FullFit()
    fit.start(desk, include_simulated=False)
    fit.start(desk, include_simulated=False)
    assert fit.state == "running"
    assert [entry.action for entry in desk.store.audit_log()] == ["full fit", "look at results"]
    process = fit._process
    assert process is not None
    fit.cancel()
    process.join(PATIENCE_S)
    assert not process.is_alive()
    assert (fit.state, fit.report) == ("cancelled", None)


def test_a_fit_whose_process_is_killed_says_so(desk: Desk) -> None:
    answered(desk)
    fit = FullFit()
    fit.start(desk, include_simulated=False)
    assert fit._process is not None
    fit._process.kill()
    deadline = time.monotonic() + PATIENCE_S
    while fit.state == "running" and time.monotonic() < deadline:
        time.sleep(0.05)
    assert (fit.state, fit.trouble) == ("failed", "the process that fitted was ended from outside")


def test_taking_the_report_is_logged_while_the_study_is_blinded_alone(desk: Desk) -> None:
    log_reading(desk, "read report")
    desk.store.unblind(desk.stored_study, "researcher")
    log_reading(desk, "read report")
    assert [entry.action for entry in desk.store.audit_log()] == ["read report", "unblind"]
