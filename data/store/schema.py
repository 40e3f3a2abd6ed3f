"""Bringing a store's schema up to date when it is opened: whole, once, and never backwards."""

from importlib import resources

from sqlalchemy import Connection, inspect, text

from data.errors import InputError
from data.store.database import Database

NEWEST = "0002"
"""The schema this Elbowroom writes; the last file of ``migrations/versions``."""
KNOWN = ("0001", "0002")


def prepare_schema(database: Database, *, create: bool) -> None:
    """Make the tables of a new store, or migrate those of an older one.

    Everything happens in one transaction under the writer's lock: of two processes that open a new
    store at once, the second finds it ready, and an interrupted migration leaves the store as it was.

    Raises
    ------
    InputError
        If the database is not an Elbowroom store, or one of a newer Elbowroom.
    """
    with database.reading() as connection:
        version = _version(connection, database.address.shown)
    if version == NEWEST:
        return
    if version is None and not create:
        raise InputError(f"{database.address.shown}: is not an Elbowroom store (it is empty)")
    with database.transaction() as connection:
        if _version(connection, database.address.shown) != NEWEST:
            _migrate(connection)


def _version(connection: Connection, shown: str) -> str | None:
    """The schema's version, or None for an empty database."""
    names = set(inspect(connection).get_table_names())
    if not names:
        return None
    if not {"alembic_version", "studies", "audit"} <= names:
        raise InputError(f"{shown}: is not an Elbowroom store (its tables: {', '.join(sorted(names)[:5])})")
    version = connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
    if version not in KNOWN:
        raise InputError(
            f"{shown}: was written by a newer Elbowroom (schema {version}, this one knows {NEWEST}); upgrade"
        )
    return str(version)


def _migrate(connection: Connection) -> None:
    # Alembic is slow to import and needed only here.
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option(
        "script_location", str(resources.files("data.store") / "migrations").replace("%", "%%")
    )
    config.attributes["connection"] = connection
    command.upgrade(config, NEWEST)
