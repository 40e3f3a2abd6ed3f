"""Coming back in a real browser: what counts as coming back, and what happens when the hours are over."""

import re
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import Page, expect
from sqlalchemy import update

from data.records import Comparison
from data.store.tables import participants

from .conftest import TINY_STUDY, Server, serving
from .participant_study import with_protocol
from .test_walk import watch_both

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
STUDY = with_protocol(TINY_STUDY, 'returning = "restart_comparison"', "returning_within_h = 48")
KEEP_SOCKETS = """
window.sockets = [];
window.WebSocket = class extends WebSocket {
  constructor(...address) { super(...address); window.sockets.push(this); }
};
"""


def open_comparison(server: Server) -> Comparison:
    (comparison,) = server.store.comparisons(server.store.studies()[0])
    return comparison


def to_robot(page: Page) -> None:
    page.get_by_role("button", name="Back to the robot").click()
    expect(page.get_by_label("Wall", exact=True)).to_be_visible()


def drop_connection(page: Page) -> None:
    """Streamlit's socket closes, and opens again by itself."""
    before = page.evaluate("() => { for (const socket of sockets) socket.close(); return sockets.length; }")
    page.wait_for_function(f"() => sockets.length > {before} && sockets.at(-1).readyState === 1")


def test_a_page_opened_again_begins_the_comparison_anew_and_nothing_less_does(
    chromium: "Browser", tmp_path: Path
) -> None:
    with serving(tmp_path, STUDY) as server:
        context = chromium.new_context()
        page = context.new_page()
        page.add_init_script(KEEP_SOCKETS)
        page.goto(server.participant_url)
        page.get_by_role("button", name="I agree to take part").click()
        page.get_by_role("button", name="Continue").click()
        watch_both(page)
        to_robot(page)
        watch_both(page)
        drop_connection(page)
        to_robot(page)
        assert open_comparison(server).restarted_at is None

        page.reload()
        expect(page.get_by_text(re.compile("then you can answer"))).to_be_visible()
        assert open_comparison(server).restarted_at is not None
        watch_both(page)

        (person,) = server.store.participants(server.store.studies()[0])
        with server.store.transaction() as connection:
            earlier = person.joined_at - timedelta(hours=48)
            here = participants.c.id == person.id
            connection.execute(update(participants).where(here).values(joined_at=earlier))
        for question in page.get_by_role("radiogroup").all():
            question.get_by_role("radio").first.check()
        page.get_by_role("button", name="Submit answers").click()
        over = page.get_by_role("heading", name="This study is over for you")
        expect(over).to_be_visible()
        assert server.store.responses(open_comparison(server).id) == ()
        context.close()
    assert "Traceback" not in server.log.read_text()
