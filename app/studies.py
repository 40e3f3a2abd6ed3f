"""Opening a study whole: its file, and its modes against the registry of methods."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from data.errors import InputError
from data.study import Mode, Study
from data.study_file import parse_study, study_text

if TYPE_CHECKING:
    from sim_trials.modes.method import ResolvedMode


@dataclass(frozen=True)
class OpenedStudy:
    """A study that can be run: validated, with the text it came from and its modes resolved.

    Attributes
    ----------
    modes : tuple of ResolvedMode
        Empty for a study of a robot in the lab, whose modes are known to that robot alone.
    """

    study: Study
    text: str
    modes: "tuple[ResolvedMode, ...]"


def open_study(source: str | Path) -> OpenedStudy:
    """A study by file or built-in name, with every mode's method and parameters checked.

    Raises
    ------
    InputError
        One line: the file, the key or mode, and what is valid.
    """
    text = study_text(source)
    study = parse_study(text, where=str(source))
    modes = () if study.protocol.trial_source == "external" else resolved_modes(study, str(source))
    return OpenedStudy(study, text, modes)


def resolved_modes(study: Study, where: str) -> "tuple[ResolvedMode, ...]":
    """The modes as the simulated robot runs them.

    Parameters
    ----------
    study : Study
    where : str
        What the error calls the study, e.g. its file.

    Raises
    ------
    InputError
        If a mode has no method, or one that does not exist, or parameters that the method does not take.
    """
    # A study of a robot in the lab needs no simulator, which is slow to import.
    from sim_trials.modes.registry import method_names, resolve

    for number, mode in enumerate(study.modes, start=1):
        if _has_no_method(mode):
            raise InputError(
                f"{where}: modes.{number}.method: missing; mode {mode.name} needs one of: "
                f"{', '.join(method_names())}"
            )
    try:
        return tuple(resolve(mode) for mode in study.modes)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def cautions(study: Study, modes: "Sequence[ResolvedMode]") -> tuple[str, ...]:
    """What a researcher must know of a study's modes though the study is valid: a sentence each.

    Parameters
    ----------
    study : Study
    modes : sequence of ResolvedMode
        Empty for a study of a robot in the lab.
    """
    if not modes:
        return ()
    from sim_trials.standstill import caution

    said = {f"mode {mode.name} ({mode.method.name})": caution(mode, study.maze) for mode in modes}
    return tuple(f"{who} {what}" for who, what in said.items() if what)


def check_can_be_simulated(study: Study, where: str) -> None:
    """Find out before anything is written whether simulated people can do a study.

    Parameters
    ----------
    study : Study
    where : str
        What the error calls the study, e.g. its file.

    Raises
    ------
    InputError
        If a mode has no method, a question weighs a trial metric that does not exist, or the robot does not
        reach the maze.
    """
    from sim_trials.metrics import metric_names
    from sim_trials.raters import check_rehearsal
    from sim_trials.start import start_angles

    if study.protocol.trial_source == "external":
        nameless = [mode.name for mode in study.modes if _has_no_method(mode)]
        if nameless:
            raise InputError(
                f"{where}: cannot be simulated: its trials are external, and no method is named for the "
                f"modes {', '.join(nameless)}"
            )
        resolved_modes(study, where)
    try:
        check_rehearsal(study, metric_names())
        start_angles(study.maze)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def check_can_be_run(study: Study, where: str) -> None:
    """Find out before anybody is invited whether people can do a study.

    A study of a robot in the lab asks nothing of the simulator. Else the robot must reach the maze's start,
    and every corner of the rectangle for practice; and simulated people must be able to rehearse the study.

    Parameters
    ----------
    study : Study
        As `open_study` gives it.
    where : str
        What the error calls the study, e.g. its file.

    Raises
    ------
    InputError
        One line that says what stands against it.
    """
    if study.protocol.trial_source == "external":
        return
    check_can_be_simulated(study, where)
    if study.has_practice:
        _check_practice_is_in_reach(study, where)


def _check_practice_is_in_reach(study: Study, where: str) -> None:
    """Whoever practises must meet no corner that the arm reaches stretched out, or not at all."""
    from sim_trials.start import start_angles

    maze = study.practice_study.maze
    for y in (maze.left_y_m, maze.right_y_m):
        for z in (maze.top_z_m, maze.bottom_z_m):
            try:
                start_angles(maze.model_copy(update={"left_y_m": y, "top_z_m": z}))
            except InputError:
                raise InputError(
                    f"{where}: practice.right_y_m: the robot does not reach the corner y = {y:g}, "
                    f"z = {z:g} m of the rectangle for practice; a larger right_y_m makes it narrower"
                ) from None


def _has_no_method(mode: Mode) -> bool:
    return "method" not in mode.model_fields_set
