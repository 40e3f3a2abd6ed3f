"""What a file's columns mean: the model of a map, TOML on disk."""

import re
from typing import Annotated, Literal, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from data.answers import ANSWERS, FEWEST_LEVELS, MOST_LEVELS, Answer
from data.response_csv import ONLY_QUESTION

SIDES: dict[str, Answer] = {"A": "A>B", "B": "B>A", "equal": "A=B"}
"""Short names of answers."""
CHOSEN = "chosen"
"""A word that means: the mode that the column ``chosen`` names is preferred."""
_NONE = re.compile(r"none(: *(?P<reason>.+))?")
LeaveOut = Literal["contradictions", "off-scale", "repeated", "same-mode"]
LEAVE_OUT: tuple[str, ...] = get_args(LeaveOut)
"""Kinds of rows that are refused unless they are asked to be left out; or lines: ``7``, ``FILE:7``."""


def reason_of_none(word: str) -> str | None:
    """Why a word is not an answer: ``none``, or ``none: the reason``; None if it is an answer."""
    match = _NONE.fullmatch(word)
    return None if match is None else match["reason"] or "not an answer"


def known_word(text: str) -> str:
    """What a word may mean, or a ValueError with all that it may."""
    if text in SIDES or text in ANSWERS or text == CHOSEN or reason_of_none(text) is not None:
        return text
    raise ValueError(f"{text!r} is not one of: {', '.join([*SIDES, 'none', CHOSEN, *ANSWERS])}")


def _left_out(text: str) -> str:
    if text in LEAVE_OUT or re.fullmatch(r"(.+:)?\d+", text):
        return text
    raise ValueError(f"{text!r} is neither a line nor one of: {', '.join(LEAVE_OUT)}")


Word = Annotated[str, AfterValidator(known_word)]
LeftOut = Annotated[str, AfterValidator(_left_out)]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class RowRule(_Part):
    """Which rows count, by one column. Upper and lower case are the same; ``response_*`` is a beginning."""

    column: str
    only: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    reason: str = ""
    optional: bool = False
    per: str = ""
    """Column whose values are counted beside the rows."""
    taken: bool = False
    """Such rows are counted and said, but taken."""


class Order(_Part):
    """A column that says whether left and right were exchanged."""

    column: str
    as_named: tuple[str, ...]
    exchanged: tuple[str, ...]


class AnswerColumn(_Part):
    """One answer of a row; a ``*`` in ``column`` stands for a whole number and makes several.

    A ``*`` in the other keys is what the one in ``column`` stands for, or the column's name if it has none.
    """

    column: str = ""
    question: str = ONLY_QUESTION
    question_column: str = ""
    left: str = ""
    right: str = ""
    pair: str = ""
    """Column whose value is looked up in ``pairs``."""
    chosen: str = ""
    """Column that names the preferred mode."""
    always: Word | None = None
    """The answer of every row, where the columns themselves say who won."""
    one_of: dict[str, Word] = {}
    """Columns of which exactly one holds 1, with what each means."""
    order: Order | None = None
    answer_is: Literal["button", "item", ""] = ""
    """Whether an answer means the button or the item behind it; needed where ``order`` may exchange them."""
    sides: Literal["known", "unknown"] = "known"
    renamed: tuple[Literal["left", "right"], ...] = ()
    """Sides whose cells do not name a mode unless ``modes`` says which."""
    other: str = ""
    """Column with free text instead of an answer."""
    words: dict[str, Word] = {}
    """Words of this column alone."""


class Ranking(_Part):
    """Modes in order of preference."""

    columns: tuple[str, ...]
    cells: Literal["modes", "ranks"]
    """Columns in the order of places with a mode in each; or a column a mode with its rank, 1 the best."""
    question: str = "ranking"
    unranked: tuple[str, ...] = ("N/A",)


class Scale(_Part):
    """Numbers around 0 as answers."""

    levels: Annotated[int, Field(ge=FEWEST_LEVELS, le=MOST_LEVELS)]
    positive: Literal["A", "B", ""] = ""
    """Which side a number above 0 prefers; it has to be told."""


class ConversionMap(_Part):
    """How a file of one form becomes responses."""

    form: str = ""
    sheet: str = ""
    participant: str | None = None
    """Column that names the person; "" if the file names nobody."""
    fill_down: tuple[str, ...] = ()
    """Columns in which an empty cell means the one above."""
    comparison: str = ""
    """Column that says which answers of a person belong together."""
    count: str = ""
    answers: tuple[AnswerColumn, ...] = ()
    rankings: tuple[Ranking, ...] = ()
    words: dict[str, Word] = {}
    modes: dict[str, str] = {}
    """Other names of modes."""
    pairs: dict[str, Annotated[tuple[str, str], Field(strict=False)]] = {}
    scale: Scale | None = None
    rows: tuple[RowRule, ...] = ()
    winner: Literal["rows", "columns", ""] = ""
    """Of a matrix of counts: who was preferred in a cell."""
    each_pair_once: bool = False
    """Whether a pair stands twice, mirrored, and must say the same."""
    empty: str = "left empty"
    """What an answer is called that is not there."""
    unquoted_is_not_asked: bool = False
    """Whether nothing between two separators means not asked, and "" left empty."""
    keep: tuple[str, ...] = ()
    """Further columns to keep."""
    leave_out: tuple[LeftOut, ...] = ()
