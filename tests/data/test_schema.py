"""The store's schema: migrations make what the tables say, and nothing foreign is touched."""

import sqlite3
from contextlib import closing

import pytest
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import create_engine, inspect

from data.errors import InputError
from data.store import Store
from data.store.schema import KNOWN, NEWEST
from data.store.tables import metadata


def test_the_migrations_make_what_the_tables_declare(store):
    engine = create_engine(store.address.url)
    with engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, metadata) == []
    engine.dispose()


def test_the_migrations_make_every_check_that_the_tables_declare(store, tmp_path):
    declared = create_engine(f"sqlite:///{tmp_path / 'declared.sqlite'}")
    metadata.create_all(declared)
    migrated = create_engine(store.address.url)
    for table in metadata.tables:
        expected, found = (
            {(c["name"], c["sqltext"]) for c in inspect(engine).get_check_constraints(table)}
            for engine in (declared, migrated)
        )
        assert expected == found, table
    declared.dispose()
    migrated.dispose()


def test_the_newest_schema_is_the_last_migration():
    config = Config()
    config.set_main_option("script_location", "data.store:migrations")
    scripts = ScriptDirectory.from_config(config)
    assert scripts.get_current_head() == NEWEST
    assert {script.revision for script in scripts.walk_revisions()} == set(KNOWN)


def test_a_store_of_a_newer_version_is_refused_and_left_alone(store):
    store.close()
    with closing(sqlite3.connect(store.address.file)) as database:
        database.execute("UPDATE alembic_version SET version_num = '0999'")
        database.commit()
    before = store.address.file.read_bytes()
    with pytest.raises(InputError, match=r"newer Elbowroom \(schema 0999"):
        Store.open(store.address.file)
    assert store.address.file.read_bytes() == before


def test_a_database_of_another_program_is_refused_and_left_alone(tmp_path):
    path = tmp_path / "other.sqlite"
    with closing(sqlite3.connect(path)) as database:
        database.execute("CREATE TABLE cats (name TEXT)")
    with pytest.raises(InputError, match=r"not an Elbowroom store \(its tables: cats\)"):
        Store.open(path)
    with closing(sqlite3.connect(path)) as database:
        assert database.execute("SELECT name FROM sqlite_master").fetchall() == [("cats",)]


def test_a_migration_that_fails_leaves_the_store_empty(tmp_path, monkeypatch):
    from alembic import command

    upgrade = command.upgrade

    def fails(config, revision):
        upgrade(config, revision)
        raise KeyError

    monkeypatch.setattr(command, "upgrade", fails)
    with pytest.raises(KeyError):
        Store.open(tmp_path / "study.sqlite")
    with closing(sqlite3.connect(tmp_path / "study.sqlite")) as database:
        assert database.execute("SELECT count(*) FROM sqlite_master").fetchone() == (0,)


def test_sqlite_is_durable_and_checks_references(store):
    with store.reading() as connection:
        told = {
            pragma: connection.exec_driver_sql(f"PRAGMA {pragma}").scalar()
            for pragma in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout", "secure_delete")
        }
    assert told == {
        "journal_mode": "wal",
        "synchronous": 2,
        "foreign_keys": 1,
        "busy_timeout": 20_000,
        "secure_delete": 1,
    }
