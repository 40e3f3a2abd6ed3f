"""The participant's pages of text as the script makes them: what they say, and what their buttons store."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from streamlit.testing.v1 import AppTest

from app.participant import pages
from app.participant.thanks import completion_code
from app.server.desk import open_desk
from app.server.visitors import Visitor
from tests.conftest import PATIENCE_S

from .participant_study import GUIDED_STUDY, Guest, guest, with_protocol

STUDY = with_protocol(
    GUIDED_STUDY,
    "break_every = 1",
    "returning_within_h = 24",
    'finish_url = "https://panel.example/done?cc={code}&amp=1"',
)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Guest]:
    with guest(tmp_path, STUDY) as someone:
        open_desk(someone.desk)

        def known(*_: object) -> Visitor:
            return Visitor(someone.cookie, someone.store.participant(someone.participant.id))

        monkeypatch.setattr(pages, "visitor", known)
        yield someone


def run() -> AppTest:
    def script() -> None:
        from app.participant.pages import show_study

        show_study()

    return AppTest.from_function(script, default_timeout=PATIENCE_S).run()


def click(page: AppTest, label: str) -> AppTest:
    (button,) = [button for button in page.button if button.label == label]
    return button.click().run()


def html(page: AppTest) -> str:
    found: list[Any] = list(page.get("html"))
    return "\n".join(str(element.proto.body) for element in found)


def test_the_form_says_what_is_missing_at_the_question_and_stores_nothing_until_then(here: Guest) -> None:
    page = run()
    assert page.title[0].value == "A few questions about you"
    assert [radio.label for radio in page.radio] == ["Have you guided a robot by hand before? (optional)"]
    assert page.number_input[0].label == "How old are you?"
    page.text_input[0].set_value("nurse")
    page = click(page, "Continue")
    assert "Please give a number from 18 to 99" in html(page)
    assert here.progress.participant.background_at is None

    page.number_input[0].set_value(17.0)
    page = click(page, "Continue")
    assert "Please give a number from 18 to 99" in html(page)

    page.number_input[0].set_value(33.0)
    page.radio[0].set_value("Often")
    page = click(page, "Continue")
    assert dict(here.progress.participant.background) == {"pflaume": "Often", "years": "33", "work": "nurse"}
    assert page.title[0].value == "What you will do"


def test_the_device_is_stored_when_the_participant_goes_on_and_not_before(here: Guest) -> None:
    here.tell_background()
    page = click(run(), "Continue")
    assert page.title[0].value == "How you guide the robot"
    assert page.radio[0].options == ["Mouse", "Keyboard", "Touch screen", "Gamepad"]
    assert page.radio[0].value == "mouse"
    page = page.radio[0].set_value("gamepad").run()
    assert "trigger" in html(page)
    assert here.progress.participant.device is None
    page = click(page, "Continue")
    assert here.progress.participant.device == "gamepad"
    assert here.place == "practice"
    assert list(page.title) == []


def test_continue_begins_the_comparison_that_comes_next(here: Guest) -> None:
    here.tell_background()
    here.choose_device()
    here.practise()
    page = run()
    assert page.title[0].value == "Next: compare two methods"
    assert any("2 short questions" in text.value for text in page.markdown)
    click(page, "Continue")
    assert here.place == "comparison"
    here.answer()
    page = run()
    assert page.title[0].value == "Time for a break"
    assert page.subheader[0].value == "Next: comparison 2 of 3"
    assert html(page).count('<i class="done">') == 1
    click(page, "Continue")
    opened = here.progress.comparison
    assert opened is not None
    assert opened.position == 2


def test_the_last_page_has_the_code_and_leads_on_with_it(here: Guest) -> None:
    for _ in range(3):
        here.begin()
        here.answer()
    page = run()
    code = completion_code(here.participant)
    assert page.title[0].value == "Thank you"
    assert page.code[0].value == code
    assert f'href="https://panel.example/done?cc={code}&amp;amp=1"' in html(page)


def test_after_the_hours_and_after_withdrawal_there_is_a_plain_page_and_no_button(here: Guest) -> None:
    here.begin()
    here.wait(hours=24)
    page = run()
    assert page.title[0].value == "This study is over for you"
    assert list(page.button) == []
    here.store.withdraw(here.participant.id, "researcher")
    page = run()
    assert page.title[0].value == "Your data were deleted"
    assert list(page.button) == []


def test_a_fault_of_ours_is_said_in_our_words(here: Guest, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise KeyError("Zwetschge")

    monkeypatch.setattr(pages, "progress_of", broken)
    page = run()
    assert page.title[0].value == "Something doesn't work on our side"
    assert list(page.exception) == []
