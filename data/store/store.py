"""The store: the only place that knows SQL, opened from a path or a URL."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Self

from data.errors import ElbowroomError, InputError
from data.locations import cannot_write
from data.records import Clock
from data.store.address import Address, parse_address
from data.store.evidence import StoredEvidence
from data.store.schema import prepare_schema


def utc_now() -> datetime:
    """The present time."""
    return datetime.now(UTC)


class Store(StoredEvidence):
    """Everything that is kept of studies.

    What it can do stands in the classes it is built from, one idea each: studies, participants,
    comparisons, trials, the audit log, links, and the tables that the analysis reads. Every write can
    be repeated without harm and is committed before its method returns; writes inside a
    ``with store.transaction():`` block are committed together at its end.
    """

    @classmethod
    def open(cls, store: str | Path, create: bool = True, *, clock: Clock = utc_now) -> Self:
        """Open a store, make it if it is new, and bring its schema up to date.

        Parameters
        ----------
        store : str or Path
            A path, ``sqlite:///PATH`` or ``postgresql+psycopg://USER@HOST/DATABASE``.
        create : bool
            Whether a store that does not exist is made.
        clock : callable
            Gives the time of what the store itself writes down, such as the audit log.

        Raises
        ------
        InputError
            If it is no store, or does not exist and is not to be made.
        ElbowroomError
            If its place is read-only, full or unreachable.
        """
        address = parse_address(store)
        if address.file is not None:
            _check_file(address, address.file, create)
        opened = cls(address, clock)
        try:
            prepare_schema(opened, create=create)
        except BaseException:
            opened.close()
            raise
        return opened


def _check_file(address: Address, file: Path, create: bool) -> None:
    """Refuse what cannot be a store before SQLite touches it."""
    try:
        if file.is_dir():
            raise InputError(f"{address.shown}: is a folder; a store is a file in one")
        if not file.exists():
            if not create:
                raise InputError(f"{address.shown}: no such store")
            file.parent.mkdir(parents=True, exist_ok=True)
            return
        if not file.is_file():
            raise InputError(f"{address.shown}: is not an Elbowroom store (not a file)")
        with file.open("rb") as handle:
            start = handle.read(16)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"{address.shown}: {file.parent} is not a folder") from None
    except PermissionError:
        raise ElbowroomError(f"{address.shown}: cannot be opened: no permission") from None
    except OSError as error:
        raise cannot_write(file, error) from None
    if start and start != b"SQLite format 3\0":
        raise InputError(f"{address.shown}: is not an Elbowroom store (not a SQLite file)")
