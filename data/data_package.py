"""An export's folder as a Frictionless Data Package: each file's size and hash, each table's schema.

Only the CSV files are tables in it. Whatever else there is (recordings, JSON lines, the study file) is a
plain file: a validator then compares its bytes and does not try to read it as a table.

References
----------
Data Package and Table Schema, version 1: specs.frictionlessdata.io.
"""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from data.codebook import Field, Sheet

_DIALECT = {
    "delimiter": ",",
    "quoteChar": '"',
    "doubleQuote": True,
    "lineTerminator": "\n",
    "skipInitialSpace": False,
    "header": True,
}
"""Said, so that no reader has to guess it from the first rows."""


def data_package(
    folder: Path, sheets: Sequence[Sheet], about: Mapping[str, object], elbowroom: Mapping[str, object]
) -> dict[str, object]:
    """The folder's description.

    Parameters
    ----------
    folder : Path
        With all its files; whatever is in it is listed.
    about : mapping
        The package's ``name``, ``title``, ``description`` and ``version``.
    elbowroom : mapping
        What only Elbowroom reads.
    """
    by_file = {sheet.file: sheet for sheet in sheets}
    paths = {p.relative_to(folder).as_posix(): p for p in sorted(folder.rglob("*")) if p.is_file()}
    names = _resource_names([*by_file, *(path for path in paths if path not in by_file)])
    resources = []
    for path, file in paths.items():
        content = file.read_bytes()
        resource: dict[str, object] = {
            "name": names[path],
            "path": path,
            "type": "table" if path in by_file else "file",
            "format": file.suffix[1:],
            "bytes": len(content),
            "hash": f"sha256:{hashlib.sha256(content).hexdigest()}",
        }
        if path in by_file:
            resource |= {
                "profile": "tabular-data-resource",
                "mediatype": "text/csv",
                "encoding": "utf-8",
                "dialect": _DIALECT,
                "schema": _schema(by_file[path], names),
            }
        resources.append(resource)
    return {"profile": "data-package", **about, "elbowroom": dict(elbowroom), "resources": resources}


def _resource_names(paths: Sequence[str]) -> dict[str, str]:
    """A name of its own for each path: in small letters, as the standard wants names."""
    names: dict[str, str] = {}
    used: set[str] = set()
    for path in paths:
        name = path.lower().replace("/", "-")
        again = 1
        while name in used:
            again += 1
            name = f"{path.lower().replace('/', '-')}-{again}"
        used.add(name)
        names[path] = name
    return names


def _schema(sheet: Sheet, names: Mapping[str, str]) -> dict[str, object]:
    schema: dict[str, object] = {
        "fields": [_field(field) for field in sheet.fields],
        "primaryKey": list(sheet.keys),
        "missingValues": [""],
    }
    if sheet.references:
        schema["foreignKeys"] = [
            {"fields": column, "reference": {"resource": names[f"{table}.csv"], "fields": target}}
            for column, (table, target) in sheet.references.items()
        ]
    return schema


def _field(field: Field) -> dict[str, object]:
    described: dict[str, object] = {"name": field.name, "type": field.type, "description": field.meaning}
    if field.unit:
        described["unit"] = field.unit
    constraints: dict[str, object] = {"required": True} if field.is_required else {}
    if field.valid:
        constraints["enum"] = list(field.valid)
    if constraints:
        described["constraints"] = constraints
    return described
