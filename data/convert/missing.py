"""What a file cannot say by itself: collected while reading, and asked for in one line."""

from collections.abc import Sequence

from data.convert.items import Item
from data.convert.reading_answers import MissingMeaningError, is_number
from data.convert.table import Row, Table, listed
from data.errors import InputError
from data.labels import plain_or_quoted

_ASKS = {
    "word": "nothing says what these mean; tell each by --word {first}=ANSWER: A (left preferred), B, "
    "equal, none, or an answer such as A>>B",
    "sign": "nothing says which side a number above 0 prefers; tell it by --positive A or --positive B",
    "pair": "nothing says which two modes these compared; tell each by --pair {first}=LEFT,RIGHT",
    "mode": "nothing says which modes these are; tell each by --mode {first}=NAME",
    "answer_is": "nothing says whether these name the button or the item under it, and the two were "
    "exchanged for some; tell it by --answer-is button or --answer-is item",
}
_OR_NUMBERS = "; or all numbers around 0 by --levels N --positive A or B"


class MissingMeanings:
    """Values without a meaning, by what is missing and by column."""

    def __init__(self, table: Table, kept: Sequence[Row], items: Sequence[Item]) -> None:
        self._table, self._kept, self._items = table, kept, items
        self._missing: dict[str, dict[str, dict[str, None]]] = {}

    def add(self, error: MissingMeaningError) -> None:
        """Remember one value."""
        self._missing.setdefault(error.what, {}).setdefault(error.column, {})[error.value] = None

    def check(self) -> None:
        """Raise for what is missing first, with all its values and the others in the same columns."""
        for what, columns in self._missing.items():
            values = sorted({value for column in columns.values() for value in column})
            ask = _ASKS[what].format(first=plain_or_quoted(values[0]))
            if what == "word" and all(is_number(value) for value in values):
                ask += _OR_NUMBERS
            others = [value for value in self._seen(set(columns)) if value not in values]
            beside = f" (other values there: {listed(others)})" if others else ""
            names = listed(columns)
            raise InputError(f"{self._table.path}: {names}: {listed(values)}{beside}: {ask}")

    def _seen(self, names: set[str]) -> list[str]:
        """All values of some columns in the rows that count; JSON in a cell is not a value."""
        used = {column.name: column for item in self._items for column in item.used}
        columns = [column for name, column in used.items() if name in names]
        texts = {text for column in columns for row in self._kept if (text := column.text(row))}
        return sorted(text for text in texts if not text.startswith("{"))
