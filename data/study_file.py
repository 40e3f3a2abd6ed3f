"""Reading study files: TOML in, a validated Study out, or one line that says what is wrong."""

import difflib
import json
import re
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from data.errors import InputError
from data.study import Study

_BUILT_IN = resources.files("data") / "studies"


def built_in_studies() -> tuple[str, ...]:
    """Names of the studies that ship with Elbowroom."""
    return tuple(sorted(f.name[:-5] for f in _BUILT_IN.iterdir() if f.name.endswith(".toml")))


def study_text(source: str | Path) -> str:
    """The TOML text of a study, by the name of a built-in one or by a file's path.

    Raises
    ------
    InputError
        If there is neither such a name nor such a file, or it is no UTF-8 text.
    """
    if str(source) in built_in_studies():
        return (_BUILT_IN / f"{source}.toml").read_text(encoding="utf-8")
    path = Path(source)
    if not path.is_file():
        names = ", ".join(built_in_studies())
        raise InputError(f"study {str(source)!r}: no such file, and no built-in study (built in: {names})")
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start})") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None


def read_study(source: str | Path) -> Study:
    """A validated study, by the name of a built-in one or by a file's path.

    Raises
    ------
    InputError
        One line: the file, the key, what was found and what is valid.
    """
    return parse_study(study_text(source), where=str(source))


def parse_study(text: str, where: str) -> Study:
    """A validated study from TOML text; ``where`` names the text in an error."""
    try:
        # As JSON, because strict types take no list for a tuple otherwise: `repetitions = true` is no number.
        content = json.dumps(tomllib.loads(text), default=str)
    except RecursionError:
        raise InputError(f"{where}: not valid TOML: nested too deeply") from None
    except ValueError as error:
        raise InputError(f"{where}: not valid TOML: {error}") from None
    try:
        return Study.model_validate_json(content, strict=True)
    except ValidationError as error:
        # A misspelt key is the likelier cause than the key that is missing in its place.
        first = min(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
        raise InputError(f"{where}: {' '.join(_in_one_line(first).split())}") from None


def with_trial_source(text: str) -> str:
    """A study's text as it was meant when laps could only be observed: now it says so where it said nothing.

    For texts from stores and exports of that time alone: today a file that says nothing means guided trials.
    """
    meant = tomllib.loads(text)
    if "trial_source" in meant.get("protocol", {}):
        return text
    meant["protocol"] = {"trial_source": "observed", **meant.get("protocol", {})}
    said = 'trial_source = "observed"'
    ways = (
        re.sub(r"(?m)^(\s*\[\s*protocol\s*\][^\r\n]*)", rf"\1\n{said}", text, count=1),
        re.sub(r"(?m)^(\s*protocol\s*=\s*\{)", rf"\1 {said},", text, count=1),
        f"protocol.{said}\n{text}",
    )
    for way in ways:
        try:
            if tomllib.loads(way) == meant:
                return way
        except tomllib.TOMLDecodeError:
            continue
    return text


def _in_one_line(error: ErrorDetails) -> str:
    place = ".".join(str(part + 1) if isinstance(part, int) else part for part in error["loc"])
    given = error["input"]
    if place.startswith("protocol.pairs"):
        return 'protocol.pairs: is neither \'all\' nor a list of pairs of modes, such as [["M1", "M2"]]'
    match error["type"]:
        case "extra_forbidden":
            *parents, key = error["loc"]
            valid = sorted(_part_at(parents).model_fields)
            near = difflib.get_close_matches(str(key), valid, n=1)
            hint = f" (did you mean {near[0]}?)" if near else ""
            return f"{place}: unknown key{hint}; valid keys: {', '.join(valid)}"
        case "missing":
            return f"{place}: missing"
        case "literal_error":
            return f"{place}: {given!r} is not one of: {error['ctx']['expected'].replace(' or ', ', ')}"
        case "string_pattern_mismatch" if place == "protocol.finish_url":
            return f"{place}: {given!r} is no web address: https://... , or empty"
        case "string_pattern_mismatch":
            return f"{place}: {given!r} is no name: a letter, then up to 39 letters, digits, '_', '.', '-'"
        case "value_error":
            said = str(error["ctx"]["error"])
            return f"{place}: {said}" if place else said
        case _:
            said = error["msg"][0].lower() + error["msg"][1:]
            shown = f", not {given!r}" if isinstance(given, str | int | float | bool) else ""
            return f"{place}: {said}{shown}"


def _part_at(place: list[Any]) -> type[BaseModel]:
    """The model that a place in the file belongs to."""
    part: type[BaseModel] = Study
    for key in place:
        if isinstance(key, str) and key in part.model_fields:
            annotation = part.model_fields[key].annotation
            candidates = [annotation, *get_args(annotation)]
            part = next((c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)), part)
    return part
