"""What goes to a participant's browser for guiding and practice, and the words they read."""

import json
import re
from pathlib import Path
from typing import get_args

import pytest

from app.participant.blinding import guide_data, picture_data, practice_data, questions_data
from app.participant.device import controls, likely_device
from app.participant.texts import texts
from app.participant.thanks import completion_code, finish_address
from data.records import Device

from .conftest import SECRETS
from .participant_study import GUIDED_STUDY, Guest, guest

KEYS = {
    "comparison", "comparisons", "maze", "wall_x", "path", "tilt", "texts", "required_s", "exposure", "laps",
    "device", "practice", "live_address",
}  # fmt: skip


def told(here: Guest) -> list[dict[str, object]]:
    """Everything that the pages are told up to the questions of the first comparison."""
    here.tell_background()
    here.choose_device()
    before = [picture_data(here.desk.study), practice_data(here.desk.study, here.progress)]
    here.practise()
    comparison = here.begin()
    here.wait(seconds=90)
    here.guide("A", 30, is_whole=True)
    here.guide("A", 12.5)
    here.guide("B", 20)
    return [
        *before,
        guide_data(here.desk.study, here.store, here.progress, comparison),
        questions_data(here.desk.study, here.progress, comparison),
    ]


def test_no_page_is_told_a_secret_of_the_study(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        said = json.dumps(told(here)).lower()
        stored = here.desk.stored_study
        hidden = [*SECRETS, "pflaume", stored.sha256[:6], here.participant.id, "seed"]
    assert [secret for secret in hidden if secret.lower() in said] == []


def test_the_guided_page_is_told_what_was_guided_and_no_more(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        _, practice, guided, _ = told(here)
    assert set(guided) == set(practice) == KEYS
    assert (guided["comparison"], guided["comparisons"]) == (1, 3)
    assert (guided["exposure"], guided["laps"]) == ({"A": 42.5, "B": 20.0}, {"A": 1, "B": 0})
    assert (guided["device"], guided["practice"], guided["required_s"]) == ("touch", False, 0.5)
    assert (practice["practice"], practice["required_s"]) == (True, 0.0)


def test_practice_is_on_its_own_rectangle(tmp_path: Path) -> None:
    with guest(tmp_path, GUIDED_STUDY + "[practice]\nright_y_m = -0.4\n") as here:
        _, practice, guided, _ = told(here)
        right = here.desk.study.maze.right_y_m
    wide, narrow = guided["maze"], practice["maze"]
    assert isinstance(wide, dict)
    assert isinstance(narrow, dict)
    assert (wide["right"], narrow["right"]) == (right, -0.4)
    assert {**wide, "right": 0} == {**narrow, "right": 0}


def test_both_pages_of_the_robot_in_hand_have_all_their_words(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        _, practice, guided, _ = told(here)
    for page, title in ((practice, "Practice"), (guided, "Comparison 1 of 3")):
        words = page["texts"]
        assert isinstance(words, dict)
        assert words["title"] == title
        assert {"unlock", *get_args(Device)} <= set(words)


def test_every_device_has_the_same_words() -> None:
    of = {device: set(texts()[f"guide.{device}"]) for device in get_args(Device)}
    assert set.intersection(*of.values()) >= {"line", "let_go", "key_move", "key_spray", "key_tilt"}
    for device in get_args(Device):
        shown = controls(device)
        assert shown.count("<dt>") == shown.count("<dd>") >= 3
        assert texts()[f"guide.{device}"]["key_move"] in shown


@pytest.mark.parametrize(
    ("agent", "device"),
    [
        ("Mozilla/5.0 (X11; Linux x86_64) Chrome/140", "mouse"),
        ("Mozilla/5.0 (iPad; CPU OS 18_0) Safari", "touch"),
        ("Mozilla/5.0 (Linux; Android 15) Chrome/140 Mobile", "touch"),
        ("", "mouse"),
    ],
)
def test_the_device_that_a_browser_is_probably_used_with_is_chosen_beforehand(
    agent: str, device: str
) -> None:
    assert likely_device({"User-Agent": agent} if agent else {}) == device


def test_no_text_says_what_participants_are_not_told() -> None:
    never = re.compile(
        r"\b(modes?|damp\w*|singular\w*|lock(ed)?|elbow\w*|errors?|fail\w*|wrong|better|worse|best)\b",
        re.IGNORECASE,
    )
    said = {f"{page}.{name}": text for page, words in texts().items() for name, text in words.items()}
    assert {name: text for name, text in said.items() if never.search(text)} == {}


def test_the_completion_code_is_the_participant_s_own_and_names_nobody(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        code = completion_code(here.participant)
        assert re.fullmatch(r"[0-9A-F]{4}-[0-9A-F]{4}", code)
        assert code == completion_code(here.store.participant(here.participant.id))
        assert code.replace("-", "").lower() not in here.participant.id


def test_the_code_is_filled_into_the_address_that_follows() -> None:
    assert finish_address("https://panel.example/done?cc={code}&x=1", "AB12-CD34") == (
        "https://panel.example/done?cc=AB12-CD34&x=1"
    )
    assert finish_address("", "AB12-CD34") == ""
