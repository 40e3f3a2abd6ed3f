"""A participant's live session: what is stored, what survives a dropped socket, what a page is told."""

import json
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from itertools import pairwise

import pytest

from data.records import Participant
from sim_trials.recording import read
from sim_trials.trial import replay

from .conftest import SECRETS, Server
from .live_browser import STUDY, AroundTheMaze, LiveBrowser, still


@pytest.fixture
def at_the_wall(guided_server: Server) -> tuple[str, Participant]:
    """A participant whose first comparison is open; the workers are warm."""
    cookie, participant = guided_server.join()
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        browser.wait_for_the_robot()
    return cookie, participant


def comparison_of(participant: Participant) -> str:
    return f"{participant.id}.c1"


def test_a_guided_lap_is_stored_with_a_recording_that_replays(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, participant = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        begun = len(browser.told)
        ended = browser.guide_to_the_end(AroundTheMaze())
        assert (ended["outcome"], ended["slot"], ended["next_in_s"]) == ("completed", "A", 1.5)
        # The lap is stored before the next one begins, or after.
        stored, again = (browser.until(kind, since=begun) for kind in ("stored", "trial"))
        assert (again["slot"], again["lap"], again["resumed"]) == ("A", 2, False)
    (trial,) = guided_server.store.trials(comparison=comparison_of(participant))
    comparison = guided_server.store.comparison(trial.comparison)
    assert (trial.outcome, trial.source, trial.mode) == ("completed", "guided", comparison.mode_a)
    assert stored["exposure"] == {"A": round(trial.duration_s, 3), "B": 0.0}
    assert stored["laps"] == {"A": 1, "B": 0}
    recording = read(guided_server.store.recording_path(trial), trial.recording_sha256)
    result = replay(recording, STUDY)
    assert (result.outcome, result.duration_s) == (trial.outcome, trial.duration_s)
    for name, value in result.metrics.items():
        assert trial.metrics[name] == pytest.approx(value, nan_ok=True), name
    assert trial.metrics["ticks"] == recording.triggers.size
    assert trial.metrics["latency_median_ms"] == 20.0
    assert trial.metrics["lap"] == 1.0
    assert trial.metrics["frame_rate_hz"] == pytest.approx(60)


def test_a_turn_to_the_other_slot_ends_the_trial_and_is_stored(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, participant = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        browser.guide(0.5)
        assert browser.open("B")["slot"] == "B"
        browser.guide(0.5)
        assert browser.open("A")["slot"] == "A"
        browser.guide(0.5)
        browser.tell("finish")
        finished = browser.until("finished")
        store = guided_server.store
        trials = store.trials(comparison=comparison_of(participant))
        assert [(trial.slot, trial.number, trial.outcome) for trial in trials] == [
            ("A", 1, "abandoned"),
            ("A", 2, "abandoned"),
            ("B", 1, "abandoned"),
        ]
        assert [switch.slot for switch in store.switches(comparison_of(participant))] == ["A", "B", "A"]
        a = sum(trial.duration_s for trial in trials if trial.slot == "A")
        assert finished["exposure"]["A"] == pytest.approx(a, abs=1e-3)
        assert a >= 2 * 0.5


def test_a_dropped_socket_finds_its_trial_again_at_rest_and_all_that_was_painted(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, participant = at_the_wall
    with LiveBrowser(guided_server, cookie) as before:
        number = before.open("A")["trial"]
        before.guide(1.0)
        painted = before.points(number)
        assert before.state is not None
        seen = before.state.view
    with LiveBrowser(guided_server, cookie) as after:
        assert after.until("welcome")["slot"] == "A"
        resumed = after.open("A")
        assert (resumed["trial"], resumed["resumed"]) == (number, True)
        at_rest = after.until_seen(lambda state: state.view.is_resting)
        assert at_rest.view.share >= seen.share > 0.0
        assert at_rest.view.time_s >= seen.time_s
        # At rest its clock stands still.
        later = after.until_seen(lambda state: state.frame > at_rest.frame)
        assert later.view.time_s == at_rest.view.time_s
        after.guide(0.3)
        assert after.points(number)[: len(painted)] == painted
        after.tell("finish")
        after.until("finished")
    (trial,) = guided_server.store.trials(comparison=comparison_of(participant))
    assert trial.duration_s >= at_rest.view.time_s + 0.3


def test_a_second_window_takes_over_and_the_first_is_told(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, _ = at_the_wall
    with LiveBrowser(guided_server, cookie) as first:
        number = first.open("A")["trial"]
        with LiveBrowser(guided_server, cookie) as second:
            assert first.until("elsewhere") == {"type": "elsewhere"}
            assert first.until_closed() == 4001
            assert second.open("A")["trial"] == number
            second.guide(0.3)


def test_the_hand_of_a_window_that_says_nothing_lets_go(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, _ = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        browser.guide(0.4)
        browser.until_seen(lambda state: not state.view.is_enabled)


def test_a_restart_begins_another_trial_of_the_same_lap(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, participant = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        first = browser.open("A")
        browser.guide(0.4)
        begun = len(browser.told)
        browser.tell("restart")
        second = browser.until("trial")
        assert (second["slot"], second["lap"]) == (first["slot"], first["lap"])
        assert second["trial"] == first["trial"] + 1
        browser.until("stored", since=begun)
    (trial,) = guided_server.store.trials(comparison=comparison_of(participant))
    assert trial.outcome == "abandoned"


def test_a_trial_in_which_the_robot_was_never_held_is_not_stored(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, participant = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        browser.press(0.5, still, buttons=0)
        browser.tell("finish")
        assert browser.until("finished")["exposure"] == {"A": 0.0, "B": 0.0}
    assert guided_server.store.trials(comparison=comparison_of(participant)) == ()


def test_practice_is_kept_once_a_lap_is_done_and_its_trials_are_not(guided_server: Server) -> None:
    cookie, participant = guided_server.join(starts=False)
    guided_server.store.record_device(participant.id, "mouse")
    with LiveBrowser(guided_server, cookie) as browser:
        assert browser.until("welcome")["practice"] is True
        browser.open("A")
        begun = len(browser.told)
        ended = browser.guide_to_the_end(AroundTheMaze(STUDY.practice_study))
        assert ended["outcome"] == "completed"
        assert browser.until("practised", since=begun) == {"type": "practised"}
        assert guided_server.store.participant(participant.id).practised_at is not None
    assert guided_server.store.trials(comparison=comparison_of(participant)) == ()
    assert guided_server.store.switches(comparison_of(participant)) == ()


def test_after_the_answers_the_window_is_told_to_move_on(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, _ = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        for slot in "AB":
            browser.open(slot)
            browser.guide(1.0)
        browser.tell("finish")
        browser.until("finished")
        content = {"comparison": 1, "answers": {"Q1": "A>B", "Q2": "B>A"}}
        assert guided_server.ask("/answers", "POST", cookie=cookie, content=content).status == 200
        assert browser.until("moved") == {"type": "moved"}
        assert browser.until_closed() == 4002
    with LiveBrowser(guided_server, cookie) as late:
        assert late.until("moved") == {"type": "moved"}


def test_watching_counts_for_nothing_where_people_guide(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, participant = at_the_wall
    run = {"kind": "run", "slot": "A", "lap": 1, "number": 1, "watched_s": 30.0}
    body = {"comparison": 1, "events": [run]}
    assert guided_server.ask("/watched", "POST", cookie=cookie, content=body).status == 404
    assert guided_server.ask("/laps/A/1", cookie=cookie).status == 404
    assert guided_server.store.trials(comparison=comparison_of(participant)) == ()


def test_states_come_as_often_as_inputs_and_each_says_which_input_it_used(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, _ = at_the_wall
    with LiveBrowser(guided_server, cookie) as browser:
        browser.open("A")
        browser.received.clear()

        def frames() -> list[bytes]:
            return [message for message in browser.received if isinstance(message, bytes) and message[0] == 2]

        def used() -> list[int]:
            return [int.from_bytes(frame[12:16], "little") for frame in frames()]

        browser.guide_until(lambda: len(set(used())) > 30)
        assert used() == sorted(used())
        counted = [int.from_bytes(frame[8:12], "little") for frame in frames()]
        assert all(later > earlier for earlier, later in pairwise(counted))


def test_nothing_that_goes_down_names_a_mode(
    guided_server: Server, at_the_wall: tuple[str, Participant]
) -> None:
    cookie, _ = at_the_wall
    keys: set[str] = set()
    with LiveBrowser(guided_server, cookie) as browser:
        for slot in "AB":
            browser.open(slot)
            browser.guide(0.4)
        browser.tell("finish")
        browser.until("finished")
        for message in browser.received:
            text = message if isinstance(message, str) else message.decode("latin-1")
            assert not any(secret.lower() in text.lower() for secret in SECRETS)
        for said in browser.told:
            keys |= said.keys()
            assert json.dumps(said).isascii()
    assert keys <= {"type", "practice", "slot", "exposure", "laps", "trial", "lap", "resumed"}


def test_two_people_are_at_the_robot_at_once(guided_server: Server) -> None:
    with ExitStack() as stack:
        cookies = [guided_server.join()[0] for _ in range(2)]
        browsers = [stack.enter_context(LiveBrowser(guided_server, cookie)) for cookie in cookies]
        for browser in browsers:
            browser.open("A")
            browser.wait_for_the_robot()
        with ThreadPoolExecutor() as threads:
            for done in [threads.submit(browser.guide_until, moved(browser)) for browser in browsers]:
                done.result()


def moved(browser: LiveBrowser) -> Callable[[], bool]:
    """Whether the robot has come along the first edge."""
    return lambda: browser.state is not None and browser.state.view.cursor_y_m < 0.34
