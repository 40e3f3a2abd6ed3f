"""What one answer column says in one row."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from data.answers import MIRRORED, SCALES, Answer
from data.convert.items import Item
from data.convert.map import CHOSEN, SIDES, ConversionMap, reason_of_none
from data.convert.table import Cell, Column, Row, json_text, parse_json
from data.errors import InputError
from data.labels import plain_or_quoted, quoted

_NUMBER = re.compile(r"[-+−]?\d+([.,]\d+)?")
_WHOLE = re.compile(r"[-+−]?\d+([.,]0+)?")
_THOUSANDS = re.compile(r"[-+−]?\d{1,3}(,\d{3})+")


@dataclass(frozen=True)
class Preference:
    """An answer to a question about two modes.

    Attributes
    ----------
    word : str
        The answer as the file has it.
    """

    column: str
    question: str
    mode_a: str
    mode_b: str
    response: Answer
    comparison: str
    is_side_known: bool
    word: str


@dataclass(frozen=True)
class NoAnswer:
    """No answer, and why; an empty reason: the question was not asked."""

    column: str
    reason: str
    is_empty: bool = False


class RowProblem(InputError):
    """A row that cannot be read; rows of some kinds may be left out if asked."""

    def __init__(self, message: str, kind: str = "") -> None:
        super().__init__(message)
        self.kind = kind


class MissingMeaningError(Exception):
    """A value that nothing gives a meaning to."""

    def __init__(self, what: str, column: str, value: str) -> None:
        super().__init__(what, column, value)
        self.what, self.column, self.value = what, column, value


def is_number(text: str) -> bool:
    """Whether a text is a number, with a point or a comma before its decimals."""
    return _NUMBER.fullmatch(text) is not None


def read_item(item: Item, row: Row, mapping: ConversionMap) -> Iterator[Preference | NoAnswer]:
    """The answers of one item in one row: one, or one a question where the cell is a JSON object.

    Raises
    ------
    RowProblem
        If the row contradicts the map.
    MissingMeaningError
        If the map has no meaning for a word, a pair or a mode.
    """
    for question, word in _words(item, row):
        column = item.source.name
        if not word:
            yield _empty(item, row, word, mapping)
            continue
        meaning = _meaning(item, row, word, mapping)
        reason = reason_of_none(meaning)
        if reason is not None:
            yield NoAnswer(column, reason)
            continue
        left, right = _modes(item, row, mapping)
        if left == right:
            raise RowProblem(f"{row.where}, {column}: {quoted(left)} against itself", "same-mode")
        answer: Answer
        if meaning == CHOSEN:
            chosen = _chosen(item, row, left, right, mapping)
            if chosen is None:
                yield _empty(item, row, None, mapping)
                continue
            answer = chosen
        else:
            answer = SIDES.get(meaning) or meaning  # type: ignore[assignment]
        is_item = meaning == CHOSEN or item.spec.always is not None or item.spec.answer_is == "item"
        left, right, answer, is_side_known = _ordered(item, row, left, right, answer, is_item)
        yield Preference(column, question, left, right, answer, item.comparison, is_side_known, word)


def _words(item: Item, row: Row) -> list[tuple[str, Cell]]:
    """The question and the word of each answer in the row."""
    question = item.spec.question
    if item.question is not None:
        named = item.question.text(row)
        if not named:
            raise RowProblem(f"{row.where}, {item.question.name}: empty, but a question is needed")
        question = named
    if item.one_of:
        return [(question, _ticked(item, row))]
    if item.spec.always is not None:
        return [(question, item.spec.always)]
    source = item.answer or item.chosen
    assert source is not None
    text = source.text(row)
    if text and text.startswith("{"):
        try:
            value = parse_json(text, row.where)
        except InputError:
            return [(question, text)]
        if isinstance(value, dict):
            return [(key, json_text(answer)) for key, answer in value.items()]
    return [(question, text)]


def _ticked(item: Item, row: Row) -> str:
    """The column of which alone the cell is 1."""
    cells = {column.name: column.text(row) for column, _ in item.one_of}
    ones = [name for name, text in cells.items() if text == "1"]
    if len(ones) != 1 or any(text not in ("0", "1") for text in cells.values()):
        seen = ", ".join(f"{name} = {text}" for name, text in cells.items())
        raise RowProblem(f"{row.where}: one of these columns must be 1 and the others 0: {seen}")
    return ones[0]


def _empty(item: Item, row: Row, word: Cell, mapping: ConversionMap) -> NoAnswer:
    if item.other is not None and item.other.text(row):
        return NoAnswer(item.source.name, f'"other": a text in {plain_or_quoted(item.other.name)}')
    if word is None and mapping.unquoted_is_not_asked:
        return NoAnswer(item.source.name, "", is_empty=True)
    return NoAnswer(item.source.name, mapping.empty, is_empty=True)


def _meaning(item: Item, row: Row, word: str, mapping: ConversionMap) -> str:
    """What a word means: an answer, a side, ``none`` or ``chosen``."""
    for meaning in (item.spec.words.get(word), mapping.words.get(word)):
        if meaning is not None:
            return meaning
    if item.one_of:
        return next(meaning for column, meaning in item.one_of if column.name == word)
    if item.spec.always is not None:
        return item.spec.always
    if mapping.scale is not None and is_number(word):
        return _level(item.source, row, word, mapping)
    if item.answer is None:
        return CHOSEN
    raise MissingMeaningError("word", item.source.name, word)


def _level(column: Column, row: Row, word: str, mapping: ConversionMap) -> Answer:
    """The answer of a number on a scale around 0; a comma is a decimal one."""
    assert mapping.scale is not None
    levels = mapping.scale.levels
    if not mapping.scale.positive:
        raise MissingMeaningError("sign", column.name, word)
    if _WHOLE.fullmatch(word) and not _THOUSANDS.fullmatch(word):
        number = int(word.replace("−", "-").replace(",", ".").partition(".")[0])
        towards_a = number if mapping.scale.positive == "A" else -number
        for answer in SCALES[levels]:
            if _signed_arrows(answer) == towards_a:
                return answer
    half = levels // 2
    zero = "" if levels % 2 else " without 0"
    raise RowProblem(
        f"{row.where}, {column.name}: {word!r} is not one of the {levels} levels -{half} to {half}{zero}",
        "off-scale",
    )


def _signed_arrows(answer: Answer) -> int:
    return answer.count(">") * (1 if answer.startswith("A") else -1)


def _modes(item: Item, row: Row, mapping: ConversionMap) -> tuple[str, str]:
    """The modes that are named as left and as right."""
    if item.left is not None and item.right is not None:
        left = _mode(item.left, row, mapping, "left" in item.spec.renamed)
        return left, _mode(item.right, row, mapping, "right" in item.spec.renamed)
    if item.pair is not None:
        key = item.pair.text(row)
        if not key:
            raise RowProblem(f"{row.where}, {item.pair.name}: empty, but it says which pair was shown")
        if key not in mapping.pairs:
            raise MissingMeaningError("pair", item.pair.name, key)
        return mapping.pairs[key]
    assert item.modes is not None
    return item.modes


def _mode(column: Column, row: Row, mapping: ConversionMap, must_be_renamed: bool) -> str:
    text = column.text(row)
    if not text:
        raise RowProblem(f"{row.where}, {column.name}: empty, but a mode is needed beside an answer")
    if must_be_renamed and text not in mapping.modes:
        raise MissingMeaningError("mode", column.name, text)
    return mapping.modes.get(text, text)


def _chosen(item: Item, row: Row, left: str, right: str, mapping: ConversionMap) -> Answer | None:
    """The answer where a column names the preferred mode."""
    if item.chosen is None:
        raise RowProblem(
            f"{row.where}: an answer means {CHOSEN!r}, and no column `chosen` is named in the map"
        )
    text = item.chosen.text(row)
    if not text:
        return None
    mode = mapping.modes.get(text, text)
    if mode not in (left, right):
        raise RowProblem(f"{row.where}, {item.chosen.name}: {quoted(text)} is neither {left!r} nor {right!r}")
    return "A>B" if mode == left else "B>A"


def _ordered(
    item: Item, row: Row, left: str, right: str, answer: Answer, is_item: bool
) -> tuple[str, str, Answer, bool]:
    """Modes and answer as shown, and whether that is known; ``is_item``: the answer names a mode."""
    order = item.spec.order
    if order is None or item.order is None:
        return left, right, answer, item.spec.sides == "known"
    if not item.spec.answer_is and not is_item:
        raise MissingMeaningError("answer_is", item.source.name, item.source.text(row) or "")
    text = item.order.text(row) or ""
    if text in order.as_named:
        return left, right, answer, True
    if text in order.exchanged:
        return right, left, MIRRORED[answer] if is_item else answer, True
    if is_item:
        return left, right, answer, False
    raise RowProblem(
        f"{row.where}, {item.order.name}: {quoted(text)} is not one of: "
        f"{', '.join((*order.as_named, *order.exchanged))}"
    )
