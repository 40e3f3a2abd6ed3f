"""The rule for keys in a response CSV: one comparison, one answer to a question.

A key is (participant, comparison, question). Everything about a comparison is one: what was shown as A and
as B, whether it was an attention check, which repetition it was. A row that says a key's answer again is
counted once, and said; one that contradicts an earlier row is refused.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from data.csv_file import CsvFile
from data.labels import quoted

_LINES_NAMED = 3
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Keyed:
    """Which rows count once repeated ones are out.

    Attributes
    ----------
    kept : ndarray of bool, shape (rows,)
    notes : tuple of str
        What was left out, a sentence each.
    """

    kept: NDArray[np.bool_]
    notes: tuple[str, ...]


def check_keys(
    file: CsvFile,
    counts: IntArray,
    check: NDArray[np.bool_],
    repetition: IntArray,
) -> Keyed:
    """Find repeated rows, and refuse those that contradict each other.

    Rows without a comparison have no key: each is answers of its own. Rows with the count 0 say nothing.

    Parameters
    ----------
    file : CsvFile
    counts : ndarray of int64, shape (rows,)
    check : ndarray of bool, shape (rows,)
    repetition : ndarray of int64, shape (rows,)

    Raises
    ------
    InputError
        For the first row that contradicts an earlier one, with the lines of both.
    """
    kept = np.ones(file.rows, bool)
    _check_sources(file)
    column = file.columns.get("comparison")
    if column is None:
        return Keyed(kept, ())
    is_named = np.array([text != "" for text in column.values])[column.codes]
    rows = np.flatnonzero(is_named & (counts > 0))
    if not rows.size:
        return Keyed(kept, ())
    several = rows[counts[rows] > 1]
    if several.size:
        row = int(several[0])
        raise file.error(
            row,
            "count",
            f"{_comparison(file, row)} has one answer to a question, not {counts[row]}: leave the column "
            "comparison out where a row stands for several comparisons",
        )
    # Where no participants are named, people's comparisons and simulated ones are still apart.
    by = (_codes(file, "participant"), _sources(file), _codes(file, "comparison"))
    comparison = _joined(*(codes[rows] for codes in by))
    _check_comparisons(file, rows, comparison, check, repetition)
    first = _first_rows(rows, _joined(comparison, _codes(file, "question")[rows]))
    response = file.columns["response"].codes
    _refuse_second(file, rows, response[rows] != response[first], first, "response")
    again = rows[rows != first]
    kept[again] = False
    return Keyed(kept, _about(file, again))


def _check_sources(file: CsvFile) -> None:
    """A participant's answers all come from people or all from a simulation."""
    if "participant" not in file.columns or "source" not in file.columns:
        return
    rows = np.arange(file.rows)
    source = _sources(file)
    first = _first_rows(rows, file.columns["participant"].codes.astype(np.int64))
    wrong = np.flatnonzero(source != source[first])
    if wrong.size:
        row = int(wrong[0])
        who = quoted(file.text(row, "participant"))
        raise file.error(
            row,
            "source",
            f"participant {who} is both human and simulated (line {file.line(int(first[row]))})",
        )


def _check_comparisons(
    file: CsvFile, rows: IntArray, comparison: IntArray, check: NDArray[np.bool_], repetition: IntArray
) -> None:
    """Everything about a comparison is the same in all its rows."""
    first = _first_rows(rows, comparison)
    for name in ("mode_a", "mode_b"):
        codes = file.columns[name].codes
        _refuse_second(file, rows, codes[rows] != codes[first], first, name)
    _refuse_second(file, rows, check[rows] != check[first], first, "check")
    _refuse_second(file, rows, repetition[rows] != repetition[first], first, "repetition")


def _refuse_second(
    file: CsvFile, rows: IntArray, differs: NDArray[np.bool_], first: IntArray, column: str
) -> None:
    if not differs.any():
        return
    place = int(np.argmax(differs))
    row, earlier = int(rows[place]), int(first[place])
    which = _comparison(file, row)
    if column == "response" and "question" in file.columns:
        which += f", question {quoted(file.text(row, 'question'))},"
    had, has = (quoted(file.text(r, column)) for r in (earlier, row))
    hint = "" if "participant" in file.columns else "; a column participant tells people's comparisons apart"
    raise file.error(row, column, f"{which} has {had} in line {file.line(earlier)}, but {has} here{hint}")


def _comparison(file: CsvFile, row: int) -> str:
    who = f" of participant {quoted(file.text(row, 'participant'))}" if "participant" in file.columns else ""
    return f"comparison {quoted(file.text(row, 'comparison'))}{who}"


def _about(file: CsvFile, again: IntArray) -> tuple[str, ...]:
    n = len(again)
    if n == 0:
        return ()
    named = ", ".join(str(line) for line in file.lines([int(row) for row in again[:_LINES_NAMED]]))
    more = f" and {n - _LINES_NAMED} more" if n > _LINES_NAMED else ""
    rows, are = (
        (f"row (line {named}) repeats", "is") if n == 1 else (f"rows (lines {named}{more}) repeat", "are")
    )
    return (
        f"{n} {rows} an earlier row's answer of the same participant in the same comparison to the same "
        f"question, and {are} counted once.",
    )


def _codes(file: CsvFile, name: str) -> IntArray:
    column = file.columns.get(name)
    return np.zeros(file.rows, np.int64) if column is None else column.codes.astype(np.int64)


def _sources(file: CsvFile) -> IntArray:
    """1 where a row says that it is simulated; nothing is as good as ``human``."""
    column = file.columns.get("source")
    if column is None:
        return np.zeros(file.rows, np.int64)
    return np.array([int(text not in ("", "human")) for text in column.values], np.int64)[column.codes]


def _joined(*keys: IntArray) -> IntArray:
    """One number from 0 for each combination, all arrays of one shape."""
    joined = np.zeros(len(keys[0]), np.int64)
    for key in keys:
        joined = np.unique(joined * (key.max(initial=0) + 1) + key, return_inverse=True)[1]
    return joined


def _first_rows(rows: IntArray, keys: IntArray) -> IntArray:
    """For each row the first row with the same key, both in the file's numbering."""
    _, first, group = np.unique(keys, return_index=True, return_inverse=True)
    return rows[first[group]]
