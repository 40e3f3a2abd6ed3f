"""A participant who was withdrawn is known by the cookie, and cannot take part again with it."""

from pathlib import Path

import pytest

from app.server.visitors import PARTICIPANT_COOKIE, admit, new_participant_cookie, visitor
from data.store import LinkRefused, token_sha256

from .participant_study import guest


def test_the_cookie_of_a_withdrawn_participant_leads_to_them_and_not_to_consent(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        here.store.withdraw(here.participant.id, "researcher")
        found = visitor(here.desk, {PARTICIPANT_COOKIE: here.cookie})
        assert found is not None
        assert found.participant is not None
        assert found.participant.withdrawn_at is not None


def test_agreeing_again_after_withdrawal_is_refused(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        here.store.withdraw(here.participant.id, "researcher")
        with pytest.raises(LinkRefused, match="withdrawn"):
            admit(here.desk, here.cookie)
        assert here.store.comparisons(participant=here.participant.id) == ()


def test_another_browser_with_the_same_link_is_someone_else(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        here.store.withdraw(here.participant.id, "researcher")
        cookie = new_participant_cookie(here.desk, "token")
        assert cookie is not None
        found = visitor(here.desk, {PARTICIPANT_COOKIE: cookie})
        assert found is not None
        assert found.participant is None


def test_a_personal_link_leads_to_the_withdrawn_in_every_browser_that_followed_it(tmp_path: Path) -> None:
    with guest(tmp_path) as here:
        here.store.create_link("personal", here.desk.stored_study, token_sha256("own"))
        first, second = (new_participant_cookie(here.desk, "own") for _ in range(2))
        assert first is not None
        assert second is not None
        who = admit(here.desk, first)
        third = new_participant_cookie(here.desk, "own")
        here.store.withdraw(who.id, "researcher")
        for cookie in (first, second, third):
            found = visitor(here.desk, {PARTICIPANT_COOKIE: str(cookie)})
            assert found is not None
            assert found.participant is not None
            assert found.participant.id == who.id
