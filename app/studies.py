"""Opening a study whole: its file, and its modes against the registry of methods."""

from dataclasses import dataclass
from pathlib import Path

from data.errors import InputError
from data.study import Study
from data.study_file import parse_study, study_text
from sim_trials.modes.method import ResolvedMode
from sim_trials.modes.registry import resolve


@dataclass(frozen=True)
class OpenedStudy:
    """A study that can be run: validated, with the text it came from and its modes resolved."""

    study: Study
    text: str
    modes: tuple[ResolvedMode, ...]


def open_study(source: str | Path) -> OpenedStudy:
    """A study by file or built-in name, with every mode's method and parameters checked.

    Raises
    ------
    InputError
        One line: the file, the key or mode, and what is valid.
    """
    text = study_text(source)
    study = parse_study(text, where=str(source))
    try:
        modes = tuple(resolve(mode) for mode in study.modes)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    return OpenedStudy(study, text, modes)
