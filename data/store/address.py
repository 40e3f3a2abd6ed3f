"""Where a store is: a path or a database URL, checked and made plain."""

import re
from dataclasses import dataclass
from pathlib import Path

import platformdirs
from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError

from data.errors import InputError

VALID = ("sqlite:///PATH", "postgresql+psycopg://USER@HOST/DATABASE")


@dataclass(frozen=True)
class Address:
    """A store's place.

    Attributes
    ----------
    url : URL
        What the database is reached by.
    file : Path or None
        The SQLite file; None for a database server.
    recordings : Path
        The folder of recordings that belongs to the store.
    shown : str
        How the store is called in messages: its path, or the URL without password.
    """

    url: URL
    file: Path | None
    recordings: Path
    shown: str


def parse_address(store: str | Path) -> Address:
    """The address of a store, from a path or a SQLAlchemy URL.

    Raises
    ------
    InputError
        One line that lists the valid forms.
    """
    text = str(store)
    if isinstance(store, str) and _looks_like_url(text):
        return _from_url(text)
    if not text or "\0" in text:
        raise InputError(f"--store: {text!r} is no path; valid: a path, {', '.join(VALID)}")
    return _from_path(Path(text))


def _looks_like_url(text: str) -> bool:
    # A single letter before the colon is a drive of Windows; a file may have a colon in its name.
    return "://" in text or (re.match(r"[A-Za-z][\w+.-]+:", text) is not None and not Path(text).exists())


def _from_url(text: str) -> Address:
    try:
        url = make_url(text)
    except (ArgumentError, ValueError):
        raise InputError(f"--store: {text!r} is no database URL; valid: a path, {', '.join(VALID)}") from None
    backend, _, driver = url.drivername.partition("+")
    if backend == "sqlite" and driver in ("", "pysqlite"):
        if not url.database or url.database == ":memory:" or url.query or url.host:
            raise InputError(f"--store: {text!r} names no file; valid: a path, {', '.join(VALID)}")
        return _from_path(Path(url.database))
    if url.drivername in ("postgresql", "postgresql+psycopg") and url.database:
        url = url.set(drivername="postgresql+psycopg")
        home = Path(platformdirs.user_data_dir("elbowroom", appauthor=False))
        shown = url.render_as_string(hide_password=True)
        return Address(url, None, home / "recordings" / str(url.database), shown)
    shown = url.render_as_string(hide_password=True)
    raise InputError(f"--store: {shown!r} cannot be used; valid: a path, {', '.join(VALID)}")


def _from_path(path: Path) -> Address:
    file = path.absolute()
    url = URL.create("sqlite", database=str(file))
    return Address(url, file, file.with_name(f"{file.stem}.recordings"), str(path))
