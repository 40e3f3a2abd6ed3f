"""The response CSV: answers collected anywhere, one row a response or a group of equal ones.

``mode_a, mode_b, response`` are required, ``participant, question, count, comparison, repetition,
source, check`` optional, and further columns are kept. ``mode_a`` is what was shown as A.
"""

import re
from collections.abc import Callable
from pathlib import Path
from typing import get_args

import numpy as np
import pandas as pd

from data.answers import ANSWERS, SCALES, inferred_levels
from data.csv_file import Column, CsvFile, read_csv_file
from data.errors import InputError, one_of
from data.labels import folded, listed_names, quoted, without_the_invisible
from data.records import Source
from data.response_keys import check_keys
from data.response_names import check_names
from data.responses import QuestionScale, ResponseTable
from data.study import Question, Study

REQUIRED = ("mode_a", "mode_b", "response")
OPTIONAL = ("participant", "question", "count", "comparison", "repetition", "source", "check")
ONLY_QUESTION = "preference"
"""The question's name where a file has no column for it."""

LARGEST_COUNT = 2**53
"""Counts are summed as double-precision numbers, which are exact up to here."""

_WHOLE = re.compile(r"[0-9]{1,25}")
_TRUTH = {"true": True, "false": False, "1": True, "0": False, "": False}
Problem = Callable[[str], str | None]


def read_response_csv(path: Path, study: Study | None = None, *, levels: int | None = None) -> ResponseTable:
    """Read a response CSV, every cell of it validated.

    Parameters
    ----------
    path : Path
    study : Study, optional
        Says which modes, questions and levels there are; without it they come from the data.
    levels : int, optional
        Levels of every question's scale where there is no study; without it they are inferred.

    Returns
    -------
    ResponseTable
        The questions are those that were asked, in the study's order if there is one.

    Raises
    ------
    InputError
        One line: the file, the line, the column and the valid values.
    """
    file = read_csv_file(Path(path), REQUIRED, "responses", OPTIONAL)
    questions = _questions(file, study)
    _check_cells(file, study, questions)
    notes = list(file.notes) + check_names(file, study)
    check = _truths(file)
    _check_pairs(file, check)
    _check_scales(file, questions)
    if study is None and levels is not None:
        _check_levels(file, levels)
    counts = _numbers(file, "count", 1)
    keyed = check_keys(file, counts, check, _numbers(file, "repetition", 0))
    every_row = _rows(file, check, study)
    counted = keyed.kept & (counts > 0)
    rows = every_row if counted.all() else every_row[counted].reset_index(drop=True)
    asked = rows.loc[~rows["check"]]
    if asked.empty:
        why = "all rows are attention checks" if counts.any() else "every count is 0"
        raise InputError(f"{path}: {why}: there are no responses to rank")
    modes = study.mode_names if study else _modes_as_they_appear(file, ~check & (counts > 0))
    return ResponseTable(
        rows=rows,
        modes=modes,
        questions=_scales(every_row, asked, modes, study, levels),
        has_participants="participant" in file.columns,
        is_simulated=bool((rows["source"] == "simulated").any()),
        sha256=file.sha256,
        title=study.title if study else Path(path).stem,
        notes=(*notes, *keyed.notes, *_about_zeros(every_row, asked, modes, study)),
    )


def _questions(file: CsvFile, study: Study | None) -> dict[str, Question] | None:
    """The study's questions by name; None without a study."""
    if study is None:
        return None
    questions = {question.name: question for question in study.questions}
    if "question" not in file.columns and len(questions) > 1 and ONLY_QUESTION not in questions:
        raise InputError(
            f"{file.path}: line 1: the column question is missing, "
            f"and the study has {len(questions)} questions: {', '.join(questions)}"
        )
    return questions


def _check_cells(file: CsvFile, study: Study | None, questions: dict[str, Question] | None) -> None:
    modes = study.mode_names if study else None
    asked = tuple(questions) if questions else None
    checks: dict[str, Problem] = {
        "mode_a": lambda text: _is_one_of(text, modes),
        "mode_b": lambda text: _is_one_of(text, modes),
        "response": lambda text: _is_one_of(text, ANSWERS),
        "participant": lambda text: _is_one_of(text, None),
        "question": lambda text: _is_one_of(text, asked),
        "count": _count_problem,
        "comparison": lambda text: (
            f"{quoted(text)} has nothing to see in it" if text and not without_the_invisible(text) else None
        ),
        "repetition": _repetition_problem,
        "source": lambda text: _is_one_of(text, get_args(Source)) if text else None,
        "check": lambda text: (
            None if text.lower() in _TRUTH else f"{quoted(text)} is not one of: true, false"
        ),
    }
    for column, problem in checks.items():
        if column in file.columns:
            file.check_each(column, problem)
    if "count" in file.columns:
        counts = file.columns["count"]
        total = sum(int(v) * int(n) for v, n in zip(counts.values, np.bincount(counts.codes), strict=True))
        if total > LARGEST_COUNT:
            raise InputError(f"{file.path}: count: {total} in all is more than {LARGEST_COUNT}")


def _is_one_of(text: str, valid: tuple[str, ...] | None) -> str | None:
    listed = f"; valid: {', '.join(valid)}" if valid else ""
    if not without_the_invisible(text):
        return f"empty, but a value is needed{listed}"
    if not valid or text in valid:
        return None
    alike = next((name for name in valid if folded(name) == folded(text)), None)
    hint = f" (it looks like {quoted(alike)} and is spelled otherwise)" if alike is not None else ""
    return f"{quoted(text)} is not one of: {', '.join(valid)}{hint}"


def _count_problem(text: str) -> str | None:
    if not _WHOLE.fullmatch(text):
        return (
            f"{quoted(text)} is not a whole number of at least 0" if text else "empty, but a count is needed"
        )
    return f"{text[:60]} is more than {LARGEST_COUNT}" if int(text) > LARGEST_COUNT else None


def _repetition_problem(text: str) -> str | None:
    if text and (not _WHOLE.fullmatch(text) or int(text) >= 2**31):
        return f"{quoted(text)} is not a whole number from 0"
    return None


def _truths(file: CsvFile) -> np.ndarray:
    """Which rows are attention checks, shape (rows,)."""
    if "check" not in file.columns:
        return np.zeros(file.rows, bool)
    column = file.columns["check"]
    return np.array([_TRUTH[text.lower()] for text in column.values])[column.codes]


def _check_pairs(file: CsvFile, check: np.ndarray) -> None:
    """A mode against itself says nothing, unless it is an attention check."""
    a, b = file.columns["mode_a"], file.columns["mode_b"]
    as_b = {text: value for value, text in enumerate(b.values)}
    same = np.array([as_b.get(text, -1) for text in a.values])[a.codes] == b.codes
    wrong = np.flatnonzero(same & ~check)
    if wrong.size:
        row = int(wrong[0])
        mode = a.values[a.codes[row]]
        raise file.error(
            row, "mode_b", f"{quoted(mode)} against itself, and the row is no check (check = true)"
        )


def _check_scales(file: CsvFile, questions: dict[str, Question] | None) -> None:
    """Every answer is on its question's scale."""
    if questions is None:
        return
    response = file.columns["response"]
    question = file.columns.get("question")
    if question is None:
        question = Column((_only_question(questions),), np.zeros(file.rows, np.int32))
    fits = np.array(
        [[answer in questions[name].scale for answer in response.values] for name in question.values]
    )
    wrong = np.flatnonzero(~fits[question.codes, response.codes])
    if wrong.size:
        row = int(wrong[0])
        name, answer = question.values[question.codes[row]], response.values[response.codes[row]]
        scale = questions[name].scale
        valid = ", ".join(scale)
        raise file.error(
            row, "response", f"{answer!r} is not on the scale of {name} ({len(scale)} levels): {valid}"
        )


def _check_levels(file: CsvFile, levels: int) -> None:
    """Every answer is on the scale of so many levels."""
    if levels not in SCALES:
        raise one_of("levels", levels, tuple(str(n) for n in SCALES))
    response = file.columns["response"]
    fits = np.array([answer in SCALES[levels] for answer in response.values])
    wrong = np.flatnonzero(~fits[response.codes])
    if wrong.size:
        row = int(wrong[0])
        answer, valid = response.values[response.codes[row]], ", ".join(SCALES[levels])
        raise file.error(row, "response", f"{answer!r} is not on a scale of {levels} levels: {valid}")


def _only_question(questions: dict[str, Question]) -> str:
    return next(iter(questions)) if len(questions) == 1 else ONLY_QUESTION


def _rows(file: CsvFile, check: np.ndarray, study: Study | None) -> pd.DataFrame:
    """All rows in the columns and types of a ResponseTable, further columns behind them."""
    fallback = ONLY_QUESTION
    if study is not None:
        fallback = _only_question({question.name: question for question in study.questions})
    columns: dict[str, pd.Series | np.ndarray] = {
        "participant": _texts(file, "participant", ""),
        "question": _texts(file, "question", fallback),
        "mode_a": _texts(file, "mode_a", ""),
        "mode_b": _texts(file, "mode_b", ""),
        "response": _texts(file, "response", ""),
        "count": _numbers(file, "count", 1),
        "comparison": _texts(file, "comparison", ""),
        "repetition": _numbers(file, "repetition", 0),
        "source": _texts(file, "source", "human"),
        "check": check,
    }
    for name in file.names:
        if name not in columns:
            columns[name] = _texts(file, name, "")
    return pd.DataFrame(columns)


def _texts(file: CsvFile, name: str, empty: str) -> pd.Series:
    if name not in file.columns:
        return pd.Series([empty], dtype="str").repeat(file.rows).reset_index(drop=True)
    column = file.columns[name]
    values = pd.Series([text or empty for text in column.values], dtype="str")
    return values.take(column.codes).reset_index(drop=True)


def _numbers(file: CsvFile, name: str, empty: int) -> np.ndarray:
    if name not in file.columns:
        return np.full(file.rows, empty, np.int64)
    column = file.columns[name]
    return np.array([int(text) if text else empty for text in column.values], np.int64)[column.codes]


def _modes_as_they_appear(file: CsvFile, counted: np.ndarray) -> tuple[str, ...]:
    """The modes of the counted rows, by the first row and there by side, A before B."""
    appears: dict[str, tuple[int, int]] = {}
    for side, name in enumerate(("mode_a", "mode_b")):
        column = file.columns[name]
        rows = np.flatnonzero(counted)
        values, first = np.unique(column.codes[rows], return_index=True)
        for value, place in zip(values, rows[first], strict=True):
            here = (int(place), side)
            text = column.values[value]
            appears[text] = min(appears.get(text, here), here)
    return tuple(sorted(appears, key=lambda mode: appears[mode]))


def _scales(
    every_row: pd.DataFrame,
    asked: pd.DataFrame,
    modes: tuple[str, ...],
    study: Study | None,
    levels: int | None,
) -> tuple[QuestionScale, ...]:
    """The questions that were asked; without a study each has the modes of its own rows."""
    names = set(asked["question"].unique())
    if study is not None:
        return tuple(
            QuestionScale(q.name, q.short, q.wording, q.levels, q.polarity)
            for q in study.questions
            if q.name in names
        )
    # A row with the count 0 says nothing of the modes, but that its answer could have been given.
    answers = (
        every_row[["question", "response"]].drop_duplicates().groupby("question", sort=False)["response"]
    )
    shown = asked[["question", "mode_a", "mode_b"]].drop_duplicates().groupby("question", sort=False)
    scales = []
    for name, possible in answers:
        if name in names:
            pairs = shown.get_group(name)
            own = {*pairs["mode_a"], *pairs["mode_b"]}
            of_its_own = tuple(mode for mode in modes if mode in own) if len(own) < len(modes) else ()
            scales.append(
                QuestionScale(
                    str(name),
                    str(name),
                    str(name),
                    levels or inferred_levels(set(possible)),
                    levels_inferred=levels is None,
                    modes=of_its_own,
                )
            )
    return tuple(scales)


def _about_zeros(
    every_row: pd.DataFrame, asked: pd.DataFrame, modes: tuple[str, ...], study: Study | None
) -> list[str]:
    """What only rows with the count 0 name: nothing is known of it."""
    if study is not None or every_row["count"].all():
        return []
    notes = []
    rows = every_row[~every_row["check"]]
    for what, names, counted in (
        ("mode", pd.unique(rows[["mode_a", "mode_b"]].to_numpy().ravel()), set(modes)),
        ("question", rows["question"].unique(), set(asked["question"])),
    ):
        silent = [name for name in names if name not in counted]
        if silent:
            kind = what if len(silent) == 1 else f"{what}s"
            is_left = "is" if len(silent) == 1 else "are"
            notes.append(
                f"The {kind} {listed_names(silent)} {is_left} named only in rows with the count 0, "
                f"and {is_left} left out."
            )
    return notes
