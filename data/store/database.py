"""The connection to a store's database: durable, one writer at a time, errors in one plain line."""

import re
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

from sqlalchemy import Connection, Engine, create_engine, event, text
from sqlalchemy.exc import DBAPIError, StatementError

from data.errors import ElbowroomError, InputError
from data.locations import cannot_write
from data.records import Clock
from data.store.address import Address

BUSY_TIMEOUT_S = 20
_WRITES = {"elbowroom_writes": True}
_ONE_WRITER = text("SELECT pg_advisory_xact_lock(20170529)")


class Database:
    """Transactions over a store's database.

    A write is committed, and with SQLite synced to the disk, before its method returns.
    """

    def __init__(self, address: Address, clock: Clock) -> None:
        self.address = address
        self.clock = clock
        self._engine = _engine(address)
        self._local = threading.local()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give back the connections; with SQLite the write-ahead log is merged into the file."""
        try:
            self._engine.dispose()
        except DBAPIError as error:
            raise in_one_line(error, self.address) from None

    @property
    def recordings_folder(self) -> Path:
        """Where this store's recordings are; made when first asked for."""
        try:
            self.address.recordings.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.address.recordings, error) from None
        return self.address.recordings

    @contextmanager
    def transaction(self) -> Iterator[Connection]:
        """All writes of the block are committed together when it ends well, or none of them is.

        Blocks may be nested: the outermost commits. Only one writer is at work at any time, so what
        is read in the block stays true until its end.
        """
        current: Connection | None = getattr(self._local, "connection", None)
        if current is not None:
            yield current
            return
        with self._begin(_WRITES) as connection:
            self._local.connection = connection
            try:
                yield connection
            finally:
                self._local.connection = None

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """One consistent view of the store, inside a transaction of this thread if there is one."""
        current: Connection | None = getattr(self._local, "connection", None)
        if current is not None:
            yield current
            return
        with self._begin({}) as connection:
            yield connection

    @contextmanager
    def _begin(self, options: dict[str, Any]) -> Iterator[Connection]:
        try:
            with self._engine.execution_options(**options).begin() as connection:
                if options and connection.dialect.name == "postgresql":
                    connection.execute(_ONE_WRITER)
                yield connection
        except DBAPIError as error:
            raise in_one_line(error, self.address) from None
        except StatementError as error:
            raise ElbowroomError(f"{self.address.shown}: {_first_line(error.orig or error)}") from None


def _engine(address: Address) -> Engine:
    if address.file is None:
        try:
            return create_engine(address.url)
        except ModuleNotFoundError:
            raise ElbowroomError(
                f"{address.shown}: PostgreSQL needs the package psycopg: pip install 'psycopg[binary]'"
            ) from None
    engine = create_engine(address.url, connect_args={"timeout": BUSY_TIMEOUT_S})
    event.listen(engine, "connect", _prepare_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _prepare_sqlite(connection: Any, _: object) -> None:
    # Transactions are begun by _begin_sqlite: Python's own begin comes too late for a reader.
    connection.isolation_level = None
    # What a participant withdraws is overwritten, not just unlinked.
    for pragma in ("synchronous=FULL", "foreign_keys=ON", "secure_delete=ON"):
        connection.execute(f"PRAGMA {pragma}")
    _log_ahead(connection)


def _log_ahead(connection: Any) -> None:
    """Turn on the write-ahead log; unlike all else, SQLite does not wait for its turn to do that."""
    give_up = time.monotonic() + BUSY_TIMEOUT_S
    while True:
        try:
            connection.execute("PRAGMA journal_mode=WAL")
            return
        except sqlite3.OperationalError as error:
            if "locked" not in str(error) or time.monotonic() > give_up:
                raise
            time.sleep(0.02)


def _begin_sqlite(connection: Connection) -> None:
    writes = connection.get_execution_options().get("elbowroom_writes")
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


_PLAIN: tuple[tuple[str, type[ElbowroomError], str], ...] = (
    ("file is not a database", InputError, "is not an Elbowroom store (not a SQLite file)"),
    ("is not a database", InputError, "is not an Elbowroom store (not a SQLite file)"),
    ("database or disk is full", ElbowroomError, "cannot be written: the disk is full"),
    ("disk i/o error", ElbowroomError, "cannot be written: the disk is full or fails"),
    ("readonly database", ElbowroomError, "cannot be written: it is read-only"),
    (
        "unable to open",
        ElbowroomError,
        "cannot be opened: no permission, or its folder is read-only",
    ),
    ("database is locked", ElbowroomError, f"another program has kept it busy for {BUSY_TIMEOUT_S} s"),
    ("malformed", ElbowroomError, "is damaged; restore it from a copy"),
    ("no such table", ElbowroomError, "is damaged: a table is missing; restore it from a copy"),
    ("append-only", ElbowroomError, "the audit log is append-only"),
)


def in_one_line(error: DBAPIError, address: Address) -> ElbowroomError:
    """What a database's error means for the user."""
    said = str(error.orig).lower()
    for sign, kind, meaning in _PLAIN:
        if sign in said:
            return kind(f"{address.shown}: {meaning}")
    return ElbowroomError(f"{address.shown}: the database refused: {_first_line(error.orig)}")


def _first_line(error: BaseException | None) -> str:
    line = (str(error).strip() or type(error).__name__).splitlines()[0]
    return re.sub(r"^\([\w.]+\) ", "", line)
