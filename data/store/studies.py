"""Studies in the store: every version of a study file that anyone took part in stays as it was."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from sqlalchemy import Connection, RowMapping, func, or_, select, update

from data.errors import InputError
from data.store.database import Database
from data.store.rows import every, first
from data.store.tables import participants, studies
from data.study import Study
from data.study_file import parse_study, read_study


@dataclass(frozen=True)
class StoredStudy:
    """One revision of a study file, as stored.

    Attributes
    ----------
    id : int
        Its number in this store.
    revision : int
        Counts the changes of the file under one name, from 1.
    sha256 : str
        Hash of the study's meaning.
    toml : str
        The file as it was given.
    locked : bool
        True once a person has taken part.
    study : Study
        The file's content.
    """

    id: int
    name: str
    revision: int
    version: str
    sha256: str
    toml: str
    locked: bool
    study: Study

    @property
    def label(self) -> str:
        """What names this revision alone, for ``--study``."""
        return f"{self.name}@{self.revision}"


class StoredStudies(Database):
    """The studies of a store. A revision is never changed: an edited file becomes the next one."""

    def add_study(self, study: Study, toml_text: str) -> StoredStudy:
        """Keep a study; the same content again is the same revision, a changed one the next."""
        with self.transaction() as connection:
            is_known = or_(studies.c.sha256 == study.sha256, studies.c.toml == toml_text)
            here = studies.c.name == study.name
            row = first(connection, select(studies).where(here, is_known).order_by(studies.c.revision))
            if row is None:
                newest = connection.execute(select(func.max(studies.c.revision)).where(here)).scalar()
                return self._insert_study(connection, study, toml_text, (newest or 0) + 1)
            return _stored(row)

    def _insert_study(
        self, connection: Connection, study: Study, toml_text: str, revision: int
    ) -> StoredStudy:
        row = {
            "name": study.name,
            "revision": revision,
            "version": study.version,
            "sha256": study.sha256,
            "toml": toml_text,
            "locked": False,
        }
        connection.execute(studies.insert(), row)
        here = (studies.c.name == study.name) & (studies.c.revision == revision)
        return _stored(connection.execute(select(studies).where(here)).mappings().one())

    def studies(self) -> tuple[StoredStudy, ...]:
        """All revisions of all studies, by name and revision."""
        with self.reading() as connection:
            rows = every(connection, select(studies).order_by(studies.c.name, studies.c.revision))
            return tuple(_stored(row) for row in rows)

    def study(self, name: str | None = None) -> StoredStudy:
        """The one study that is meant.

        Parameters
        ----------
        name : str, optional
            A study's name, one revision of it as ``NAME@REVISION``, or a study file. Without it, the
            study that participants took part in, if there is but one.

        Raises
        ------
        InputError
            If there is none or more than one; the line lists them.
        """
        stored = self.studies()
        if not stored:
            raise InputError(f"{self.address.shown}: holds no study yet")
        if name is None:
            meant = list(stored)
        elif "@" in name:
            meant = [s for s in stored if s.label == name]
        else:
            meant = [s for s in stored if s.name == name]
            if not meant and Path(name).is_file():
                given = read_study(name)
                meant = [s for s in stored if s.sha256 == given.sha256] or [
                    s for s in stored if s.name == given.name
                ]
        listed = ", ".join(s.label for s in stored)
        if not meant:
            raise InputError(f"--study: {name!r} is not in {self.address.shown}, which holds: {listed}")
        if len(meant) > 1:
            with self.reading() as connection:
                used = set(connection.execute(select(participants.c.study).distinct()).scalars())
            # A revision that nobody took part in is a draft; without any, the latest counts.
            taken = [s for s in meant if s.id in used]
            meant = taken or ([meant[-1]] if len({s.name for s in meant}) == 1 else meant)
        if len(meant) > 1:
            several = ", ".join(s.label for s in meant)
            raise InputError(
                f"{self.address.shown} holds several studies: say --study NAME, one of: {several}"
            )
        return meant[0]

    def _study_by_id(self, connection: Connection, study_id: int) -> StoredStudy:
        row = first(connection, select(studies).where(studies.c.id == study_id))
        assert row is not None
        return _stored(row)

    def _lock(self, connection: Connection, study_id: int) -> None:
        connection.execute(update(studies).where(studies.c.id == study_id).values(locked=True))


def _stored(row: RowMapping) -> StoredStudy:
    return StoredStudy(**row, study=_parsed(row["toml"], row["name"]))


@lru_cache(maxsize=64)
def _parsed(toml: str, name: str) -> Study:
    return parse_study(toml, where=f"the stored study {name}")
