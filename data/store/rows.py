"""From records to rows and back: columns bear the names of the records' fields."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

from sqlalchemy import Connection, RowMapping, Select, Table

Record = TypeVar("Record")


def every(connection: Connection, query: Select[Any]) -> Sequence[RowMapping]:
    """All rows of a query, their values by name."""
    return connection.execute(query).mappings().all()


def first(connection: Connection, query: Select[Any]) -> RowMapping | None:
    """The first row of a query, or None."""
    return connection.execute(query).mappings().first()


def record_of(kind: type[Record], row: RowMapping, **more: object) -> Record:
    """A record from a row of its table, and from what stands elsewhere."""
    assert is_dataclass(kind)
    known = {field.name: row[field.name] for field in fields(kind) if field.name in row}
    return kind(**known, **more)


def row_of(record: object, table: Table, **more: object) -> dict[str, Any]:
    """A record's row in its table."""
    row = {c.name: getattr(record, c.name) for c in table.columns if hasattr(record, c.name)}
    return row | more


def same(first: object, second: object) -> bool:
    """Equality of values and records in which an unknown number (NaN) equals another."""
    if isinstance(first, float) and isinstance(second, float):
        return first == second or (first != first and second != second)
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        return first.keys() == second.keys() and all(same(first[name], second[name]) for name in first)
    if isinstance(first, tuple) and isinstance(second, tuple):
        return len(first) == len(second) and all(map(same, first, second))
    if is_dataclass(first) and type(first) is type(second):
        return all(same(getattr(first, f.name), getattr(second, f.name)) for f in fields(first))
    return first == second


def insert_all(connection: Connection, table: Table, rows: list[dict[str, Any]]) -> None:
    """Insert rows in one statement; none is fine."""
    if rows:
        connection.execute(table.insert(), rows)
