"""Which page a participant is shown, from consent to thanks, and for how long they may come back."""

from pathlib import Path

import pytest

from app.participant.progress import may_still_take_part

from .conftest import TINY_STUDY
from .participant_study import GUIDED_STUDY, Guest, guest, with_protocol


def reach(here: Guest, place: str) -> None:
    """Go on until a place before or in the first comparison."""
    steps = (here.tell_background, here.choose_device, here.practise, here.begin)
    for step in steps:
        if here.place == place:
            return
        step()
    assert here.place == place


def test_a_guided_study_leads_through_its_places_in_order(tmp_path: Path) -> None:
    with guest(tmp_path, with_protocol(GUIDED_STUDY, "break_every = 2")) as here:
        seen = [here.place]
        for step in (
            here.tell_background,
            here.choose_device,
            here.practise,
            *(here.begin, here.answer),
            *(here.begin, here.answer),
            *(here.begin, here.answer),
        ):
            step()
            seen.append(here.place)
    assert seen == [
        "background", "instructions", "practice", "ready",
        "comparison", "between", "comparison", "break", "comparison", "thanks",
    ]  # fmt: skip


def test_an_observed_study_has_no_device_and_no_practice(tmp_path: Path) -> None:
    with guest(tmp_path, TINY_STUDY) as here:
        assert here.place == "instructions"
        here.begin()
        assert here.place == "comparison"
        here.answer()
        assert here.place == "thanks"


def test_without_practice_the_device_leads_to_the_first_comparison(tmp_path: Path) -> None:
    with guest(tmp_path, GUIDED_STUDY + "[practice]\nlaps = 0\n") as here:
        here.tell_background()
        here.choose_device()
        assert here.place == "ready"


def test_without_break_every_there_is_no_break(tmp_path: Path) -> None:
    with guest(tmp_path, with_protocol(GUIDED_STUDY, "break_every = 0")) as here:
        reach(here, "comparison")
        here.answer()
        assert here.place == "between"


def test_the_last_comparison_leads_to_thanks_even_where_a_break_is_due(tmp_path: Path) -> None:
    with guest(tmp_path, with_protocol(TINY_STUDY, "break_every = 1")) as here:
        here.begin()
        here.answer()
        assert here.place == "thanks"


@pytest.mark.parametrize(
    "place", ["background", "instructions", "practice", "ready", "comparison", "between"]
)
def test_when_the_hours_are_over_every_open_place_is_closed(tmp_path: Path, place: str) -> None:
    with guest(tmp_path, with_protocol(GUIDED_STUDY, "returning_within_h = 24")) as here:
        if place == "between":
            reach(here, "comparison")
            here.answer()
        else:
            reach(here, place)
        here.wait(hours=23.99)
        assert here.place == place
        here.wait(hours=0.01)
        assert here.place == "closed"
        assert not may_still_take_part(here.desk.study, here.participant, here.desk.clock())


def test_who_has_finished_keeps_the_last_page_after_the_hours(tmp_path: Path) -> None:
    with guest(tmp_path, with_protocol(TINY_STUDY, "returning_within_h = 1")) as here:
        here.begin()
        here.answer()
        here.wait(hours=5)
        assert here.place == "thanks"


def test_without_hours_one_may_come_back_for_ever(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        here.wait(days=4000)
        assert here.place == "background"


def test_who_was_withdrawn_is_told_so_and_may_not_go_on(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        reach(here, "comparison")
        here.store.withdraw(here.participant.id, "researcher")
        assert here.place == "withdrawn"
        gone = here.store.participant(here.participant.id)
        assert not may_still_take_part(here.desk.study, gone, here.desk.clock())
