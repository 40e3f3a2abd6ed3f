"""Converted responses as a response CSV."""

import csv
import io
from pathlib import Path

from data.convert.engine import Conversion
from data.errors import InputError

_OWN = (
    "participant",
    "comparison",
    "question",
    "mode_a",
    "mode_b",
    "response",
    "count",
    "sides",
    "file",
    "line",
)


def response_csv(conversion: Conversion) -> str:
    """The text of the response CSV.

    ``sides`` is there where the sides of some responses are unknown; ``line`` is the row's line in its file,
    and ``file`` is there where several were converted.
    """
    responses = conversion.responses
    kept = tuple(conversion.map.keep)
    for name in kept:
        if name in _OWN:
            raise InputError(f"--keep: {name!r} is a column of the response CSV itself")
    has = {
        "participant": bool(conversion.map.participant),
        "comparison": any(response.preference.comparison for response in responses),
        "count": bool(conversion.map.count),
        "sides": not all(response.preference.is_side_known for response in responses),
        "file": len({response.row.path for response in responses}) > 1,
    }
    names = [name for name in _OWN if has.get(name, True)]
    files = {path: _file(conversion, path) for path in {response.row.path for response in responses}}
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*names, *kept])
    for response in responses:
        preference = response.preference
        cells = {
            "participant": response.participant,
            "comparison": preference.comparison,
            "question": preference.question,
            "mode_a": preference.mode_a,
            "mode_b": preference.mode_b,
            "response": preference.response,
            "count": response.count,
            "sides": "known" if preference.is_side_known else "unknown",
            "file": files[response.row.path],
            "line": str(response.row.line),
        }
        writer.writerow([*(cells[name] for name in names), *response.kept])
    return text.getvalue()


def _file(conversion: Conversion, path: str) -> str:
    """A file's name, or its place in an archive."""
    inside = path.removeprefix(f"{conversion.table.path}/")
    return inside if inside != path else Path(path).name
