"""Links and browser sessions: only hashes of their tokens are kept, so a stolen store opens nothing."""

import hashlib
from dataclasses import dataclass
from datetime import datetime
from typing import Literal, get_args

from sqlalchemy import Connection, select, update

from data.errors import ElbowroomError, one_of
from data.records import Participant
from data.store.rows import every, first, record_of, row_of
from data.store.studies import StoredStudy
from data.store.tables import links, sessions
from data.store.withdrawal import StoredWithdrawals

LinkKind = Literal["participant", "personal", "researcher"]
"""For any number of participants, for one participant, or for a researcher once."""


class LinkRefused(ElbowroomError):
    """A link that is unknown, expired, used up or of another kind."""


@dataclass(frozen=True)
class Link:
    """A link that was given out.

    Attributes
    ----------
    participant : str or None
        Who followed a personal link.
    """

    token_sha256: str
    kind: LinkKind
    label: str
    created_at: datetime
    expires_at: datetime | None = None
    used_at: datetime | None = None
    participant: str | None = None


@dataclass(frozen=True)
class BrowserSession:
    """Who a browser belongs to: a participant, or a researcher if there is none."""

    token_sha256: str
    participant: str | None
    created_at: datetime
    study: StoredStudy


def token_sha256(token: str) -> str:
    """What is stored of a secret token."""
    return hashlib.sha256(token.encode()).hexdigest()


class StoredLinks(StoredWithdrawals):
    """The links and browser sessions of a store."""

    def create_link(
        self,
        kind: LinkKind,
        study: StoredStudy,
        token_hash: str,
        *,
        at: datetime | None = None,
        expires_at: datetime | None = None,
        label: str = "",
    ) -> Link:
        """Keep a new link's hash; the same link again changes nothing."""
        if kind not in get_args(LinkKind):
            raise one_of("kind of link", kind, get_args(LinkKind))
        with self.transaction() as connection:
            stored = first(connection, select(links).where(links.c.token_sha256 == token_hash))
            if stored is not None:
                if (stored["kind"], stored["study"]) != (kind, study.id):
                    raise ElbowroomError("this link is stored for something else")
                return record_of(Link, stored)
            link = Link(token_hash, kind, label, at or self.clock(), expires_at)
            connection.execute(links.insert(), row_of(link, links, study=study.id))
            return link

    def links(self, study: StoredStudy) -> tuple[Link, ...]:
        """The links of a study, the oldest first."""
        query = select(links).where(links.c.study == study.id)
        query = query.order_by(links.c.created_at, links.c.token_sha256)
        with self.reading() as connection:
            return tuple(record_of(Link, row) for row in every(connection, query))

    def revoke_link(self, token_hash: str, at: datetime | None = None) -> None:
        """Refuse a link from now on."""
        with self.transaction() as connection:
            here = links.c.token_sha256 == token_hash
            connection.execute(update(links).where(here).values(expires_at=at or self.clock()))

    def redeem_participant_link(
        self, token_hash: str, participant_id: str, at: datetime | None = None
    ) -> Participant:
        """The participant who follows a link: a new one with the next number.

        A personal link that was followed before leads to the same participant again.

        Parameters
        ----------
        participant_id : str
            Id for a new participant; unused if the link has one.

        Raises
        ------
        LinkRefused
            If the link is unknown, expired or for researchers, or its participant has withdrawn.
        """
        with self.transaction() as connection:
            time = at or self.clock()
            link, study = self._valid_link(connection, token_hash, ("participant", "personal"), time)
            if link.participant is not None:
                return self._participant(connection, link.participant)
            if link.kind == "participant" and self._participant_row(connection, participant_id) is not None:
                known = self._participant(connection, participant_id)
                if known.withdrawn_at is not None:
                    raise LinkRefused("whoever followed this link here has withdrawn")
                return known
            number = self._next_number(connection, study.id, "human")
            joined = self.add_participant(study, Participant(participant_id, number, "human", time))
            who = joined.id if link.kind == "personal" else None
            here = links.c.token_sha256 == token_hash
            connection.execute(
                update(links).where(here).values(used_at=link.used_at or time, participant=who)
            )
            return joined

    def redeem_researcher_link(self, token_hash: str, at: datetime | None = None) -> StoredStudy:
        """The study that a one-time link opens the console of.

        Raises
        ------
        LinkRefused
            If the link is unknown, expired, used or for participants.
        """
        with self.transaction() as connection:
            time = at or self.clock()
            link, study = self._valid_link(connection, token_hash, ("researcher",), time)
            if link.used_at is not None:
                raise LinkRefused("this link was used before: it opens once")
            here = links.c.token_sha256 == token_hash
            connection.execute(update(links).where(here).values(used_at=time))
            return study

    def open_session(
        self, token_hash: str, study: StoredStudy, participant_id: str | None, at: datetime | None = None
    ) -> None:
        """Keep whose browser holds a cookie; ``participant_id`` None for a researcher."""
        row = {
            "token_sha256": token_hash,
            "study": study.id,
            "participant": participant_id,
            "created_at": at or self.clock(),
        }
        with self.transaction() as connection:
            known = select(sessions.c.token_sha256).where(sessions.c.token_sha256 == token_hash)
            if connection.execute(known).first() is None:
                connection.execute(sessions.insert(), row)

    def session(self, token_hash: str) -> BrowserSession | None:
        """Whose browser holds a cookie; None if nobody's."""
        query = select(sessions).where(sessions.c.token_sha256 == token_hash)
        with self.reading() as connection:
            row = first(connection, query)
            if row is None:
                return None
            study = self._study_by_id(connection, row["study"])
        return BrowserSession(row["token_sha256"], row["participant"], row["created_at"], study)

    def close_session(self, token_hash: str) -> None:
        """Forget a browser."""
        with self.transaction() as connection:
            connection.execute(sessions.delete().where(sessions.c.token_sha256 == token_hash))

    def _valid_link(
        self, connection: Connection, token_hash: str, kinds: tuple[str, ...], at: datetime
    ) -> tuple[Link, StoredStudy]:
        row = first(connection, select(links).where(links.c.token_sha256 == token_hash))
        if row is None or row["kind"] not in kinds:
            raise LinkRefused("this link is not valid here")
        link = record_of(Link, row)
        if link.expires_at is not None and at >= link.expires_at:
            raise LinkRefused("this link has expired")
        return link, self._study_by_id(connection, row["study"])
