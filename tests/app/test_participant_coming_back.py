"""Coming back to a comparison under way: resumed, or begun anew, as the study says."""

from datetime import timedelta
from pathlib import Path

import pytest

from app.participant.blinding import guide_data, questions_data
from app.participant.coming_back import GRACE_S, is_coming_back
from app.participant.watching import watched_s
from data.records import Comparison
from data.study import Study
from data.study_file import parse_study

from .participant_study import GUIDED_STUDY, NOON, Guest, guest, with_protocol

ANEW_STUDY = with_protocol(GUIDED_STUDY, 'returning = "restart_comparison"')


def parsed(text: str) -> Study:
    return parse_study(text, "study.toml")


def opened(seconds_ago: float, anew_seconds_ago: float | None = None) -> Comparison:
    anew = None if anew_seconds_ago is None else NOON - timedelta(seconds=anew_seconds_ago)
    return Comparison(
        "p.c1", "p", 1, 1, "M1", "M2", False, NOON - timedelta(seconds=seconds_ago), restarted_at=anew
    )


@pytest.mark.parametrize(
    ("comparison", "begun_here", "has_trials", "expected"),
    [
        (opened(60), (), True, True),
        (opened(60), (), False, True),
        (opened(GRACE_S + 0.1), (), False, True),
        (opened(GRACE_S - 0.1), (), False, False),
        (opened(GRACE_S - 0.1), (), True, True),
        # The page that began it: a rerun, the questions and back, a connection lost for a while.
        (opened(600), ("p.c1",), True, False),
        (opened(600), ("p.c0", "other.c1"), True, True),
        # Begun anew a moment ago, and reloaded before the robot moved.
        (opened(600, anew_seconds_ago=2), (), False, False),
        (opened(600, anew_seconds_ago=20), (), False, True),
    ],
)
def test_coming_back_is_another_page_for_a_comparison_that_has_begun(
    comparison: Comparison, begun_here: tuple[str, ...], has_trials: bool, expected: bool
) -> None:
    assert is_coming_back(parsed(ANEW_STUDY), comparison, begun_here, has_trials, NOON) is expected


def test_by_default_nothing_is_begun_anew() -> None:
    assert not is_coming_back(parsed(GUIDED_STUDY), opened(6000), (), True, NOON)


def in_comparison(here: Guest) -> Comparison:
    here.tell_background()
    here.choose_device()
    here.practise()
    return here.begin()


def test_begun_anew_neither_exposure_nor_laps_nor_draft_remain(tmp_path: Path) -> None:
    with guest(tmp_path, ANEW_STUDY) as here:
        comparison, study = in_comparison(here), here.desk.study
        here.wait(seconds=60)
        here.guide("A", 30, is_whole=True)
        here.guide("B", 20)
        before = guide_data(study, here.store, here.progress, comparison)
        draft = questions_data(study, here.progress, comparison)["draft_key"]
        assert (before["exposure"], before["laps"]) == ({"A": 30, "B": 20}, {"A": 1, "B": 0})

        here.wait(seconds=10)
        anew = here.store.restart_comparison(comparison.id, here.desk.clock())
        after = guide_data(study, here.store, here.progress, anew)
        assert (after["exposure"], after["laps"]) == ({"A": 0, "B": 0}, {"A": 0, "B": 0})
        assert questions_data(study, here.progress, anew)["draft_key"] != draft
        assert not here.progress.may_answer(study, watched_s(here.store, anew))

        here.wait(seconds=40)
        here.guide("B", 25)
        assert watched_s(here.store, anew) == {"A": 0, "B": 25}
        assert len(here.store.trials(comparison=comparison.id)) == 3


def test_a_trial_that_began_before_does_not_count_when_it_ends_after(tmp_path: Path) -> None:
    with guest(tmp_path, ANEW_STUDY) as here:
        comparison = in_comparison(here)
        here.wait(seconds=60)
        anew = here.store.restart_comparison(comparison.id, here.desk.clock())
        here.wait(seconds=1)
        here.guide("A", 30)
        assert watched_s(here.store, anew) == {"A": 0, "B": 0}
