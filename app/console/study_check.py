"""Checking a study file before it is served: nothing is stored, and what is wrong is said in one line."""

from dataclasses import dataclass
from typing import Literal

from app.studies import cautions, check_can_be_run, resolved_modes
from data.errors import InputError
from data.store import StoredStudy
from data.study import Study
from data.study_file import parse_study

Standing = Literal["wrong", "same", "next revision", "another study"]


@dataclass(frozen=True)
class StudyCheck:
    """What is to be said of a candidate file.

    Attributes
    ----------
    sentence : str
        One line: what is wrong, or how the file relates to the study that is served.
    study : Study or None
        What it defines; None if it is wrong.
    changes : tuple of (place, served, candidate)
        Where it differs from the study that is served.
    cautions : tuple of str
        What a researcher must know of its modes though it is valid.
    """

    standing: Standing
    sentence: str
    study: Study | None
    changes: tuple[tuple[str, str, str], ...] = ()
    cautions: tuple[str, ...] = ()


def check_study(content: bytes, name: str, served: StoredStudy) -> StudyCheck:
    """Check a candidate file as ``elbowroom serve`` would, and compare it with the study that is served."""
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        return _wrong(f"{name}: not UTF-8 text (byte {error.start})")
    try:
        study = parse_study(text, where=name)
        modes = () if study.protocol.trial_source == "external" else resolved_modes(study, name)
        check_can_be_run(study, name)
        told = cautions(study, modes)
    except InputError as error:
        return _wrong(str(error))
    if study.sha256 == served.sha256:
        return StudyCheck("same", f"Valid, and the same study as {served.label}.", study, (), told)
    if study.name != served.name:
        words = f"Valid, and a study of its own: {study.name!r}, not {served.name!r}."
        return StudyCheck("another study", words, study, (), told)
    changes = _changes(served.study, study)
    words = f"Valid, and differs from {served.label}: served, it is stored as the next revision."
    return StudyCheck("next revision", words, study, changes, told)


def _wrong(sentence: str) -> StudyCheck:
    return StudyCheck("wrong", sentence, None)


def _changes(served: Study, candidate: Study) -> tuple[tuple[str, str, str], ...]:
    before, after = _leaves(served.model_dump(mode="json")), _leaves(candidate.model_dump(mode="json"))
    return tuple(
        (place, before.get(place, "absent"), after.get(place, "absent"))
        for place in dict.fromkeys([*before, *after])
        if before.get(place) != after.get(place)
    )


def _leaves(part: object, place: str = "") -> dict[str, str]:
    """Every value of nested tables and lists, by its place: ``modes[2].parameters.lambda0``."""
    found: dict[str, str] = {}
    if isinstance(part, dict):
        for key, value in part.items():
            found |= _leaves(value, f"{place}.{key}" if place else str(key))
    elif isinstance(part, list):
        for number, value in enumerate(part, start=1):
            found |= _leaves(value, f"{place}[{number}]")
    else:
        found[place] = str(part)
    return found
