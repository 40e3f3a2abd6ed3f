"""What Frictionless says of an export.

Its reader of CSV files lifts ``csv.field_size_limit`` for the whole process, which decides what this
project's own readers refuse: the limit is put back.
"""

import csv
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import frictionless


@contextmanager
def _own_limit() -> Iterator[None]:
    limit = csv.field_size_limit()
    try:
        yield
    finally:
        csv.field_size_limit(limit)


def validated(folder: Path) -> frictionless.Report:
    """The report on the data package in a folder."""
    with _own_limit():
        return frictionless.validate(str(folder / "datapackage.json"))


def typed_rows(folder: Path, resource: str) -> list[dict[str, object]]:
    """A table's rows as the schema types them."""
    with _own_limit():
        package = frictionless.Package(str(folder / "datapackage.json"))
        return [row.to_dict() for row in package.get_resource(resource).read_rows()]
