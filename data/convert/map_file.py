"""Maps as TOML files: read with an error that lists what is valid, written so that they can be used again."""

import difflib
import json
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import get_args

import tomli_w
from pydantic import BaseModel, ValidationError

from data.convert.map import ConversionMap
from data.errors import InputError


def read_map(path: Path) -> dict[str, object]:
    """The keys of a map file, checked.

    Raises
    ------
    InputError
        One line: the file, the key and what is valid.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        raise InputError(f"{path}: cannot be read: {reason}") from None
    except ValueError as error:
        raise InputError(f"{path}: not valid TOML: {error}") from None
    checked_map(content, str(path))
    return content


def checked_map(content: dict[str, object], where: str) -> ConversionMap:
    """A map from its keys; ``where`` names their source in an error."""
    try:
        # As JSON, because strict types do not take a list for a tuple otherwise.
        return ConversionMap.model_validate_json(json.dumps(content, default=str))
    except ValidationError as error:
        first = min(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
        *parents, key = first["loc"] or ("",)
        place = ".".join(str(part + 1) if isinstance(part, int) else part for part in first["loc"])
        if first["type"] == "extra_forbidden":
            valid = sorted(_part_at(parents).model_fields)
            near = difflib.get_close_matches(str(key), valid, n=1)
            hint = f" (did you mean {near[0]}?)" if near else ""
            message = f"unknown key{hint}; valid keys: {', '.join(valid)}"
        elif first["type"] == "value_error":
            message = str(first["ctx"]["error"])
        else:
            message = first["msg"][0].lower() + first["msg"][1:]
        raise InputError(f"{where}: {place}: {' '.join(message.split())}") from None


def merged(defaults: ConversionMap, content: dict[str, object], where: str) -> ConversionMap:
    """The defaults of a form with what a map says instead."""
    checked_map(content, where)
    return checked_map({**defaults.model_dump(mode="json", exclude_none=True), **content}, where)


def map_text(complete: ConversionMap, defaults: ConversionMap) -> str:
    """A map as TOML: all that a conversion needs, also where it only repeats the form's own defaults."""
    content = complete.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    every = complete.model_dump(mode="json", exclude_none=True)
    for name in defaults.model_dump(mode="json", exclude_none=True, exclude_defaults=True):
        if name in every:
            content.setdefault(name, every[name])
    ordered = {name: content[name] for name in ConversionMap.model_fields if name in content}
    return (
        "# How `elbowroom convert` reads a file. To use it again:\n"
        "# elbowroom convert FILE --map THIS_FILE --out responses.csv\n" + tomli_w.dumps(ordered)
    )


def _part_at(place: Sequence[int | str]) -> type[BaseModel]:
    """The model that a place in the map belongs to."""
    part: type[BaseModel] = ConversionMap
    for key in place:
        if isinstance(key, str) and key in part.model_fields:
            annotation = part.model_fields[key].annotation
            candidates = [annotation, *get_args(annotation)]
            part = next((c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)), part)
    return part
