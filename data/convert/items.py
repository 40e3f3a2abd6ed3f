"""The answer columns of a map as they are in a file."""

from dataclasses import dataclass

from data.convert.map import AnswerColumn, ConversionMap
from data.convert.table import Column, Table, listed, plain
from data.errors import InputError
from data.labels import plain_or_quoted


@dataclass(frozen=True)
class Item:
    """One answer of a row: the columns that say it.

    Attributes
    ----------
    source : Column
        The column that an answer is read from, for messages.
    modes : tuple of str, optional
        The pair where it is the same in all rows.
    keys : tuple of str
        Under which the item's pair may stand in the map, the first that is there.
    comparison : str
        Which of a person's comparisons the item belongs to; empty if a row is one.
    """

    spec: AnswerColumn
    source: Column
    answer: Column | None
    left: Column | None
    right: Column | None
    pair: Column | None
    chosen: Column | None
    question: Column | None
    order: Column | None
    other: Column | None
    one_of: tuple[tuple[Column, str], ...]
    keys: tuple[str, ...]
    comparison: str = ""
    modes: tuple[str, str] | None = None

    @property
    def used(self) -> list[Column]:
        """All its columns."""
        columns = (self.answer, self.left, self.right, self.pair, self.chosen, self.question, self.order)
        return [column for column in (*columns, self.other, *(c for c, _ in self.one_of)) if column]


def resolve_items(table: Table, mapping: ConversionMap) -> list[Item]:
    """The items of a map in the order of their columns in the file.

    Raises
    ------
    InputError
        If a column is missing or nothing says what was on the two sides.
    """
    items = [item for spec in mapping.answers for item in _expanded(table, spec, mapping)]
    if len({(spec.left, spec.right, spec.pair) for spec in mapping.answers}) > 1:
        items = [_named(item) for item in items]
    for item in items:
        _check_sides(table, item)
    _check_columns_count_once(table, items)
    return sorted(items, key=lambda item: item.source.place)


def _check_columns_count_once(table: Table, items: list[Item]) -> None:
    """Refuse two items that read the same answer to the same question."""
    seen: set[tuple[object, ...]] = set()
    for item in items:
        sides = (item.left, item.right, item.pair, item.modes)
        key = (item.source.place, item.source.keys, item.spec.question, item.question, sides)
        if key in seen:
            raise InputError(
                f"{table.path}: {plain_or_quoted(item.source.name)}: is told twice as a column of answers to "
                f"{plain_or_quoted(item.spec.question)}: each answer would count twice"
            )
        seen.add(key)


def _named(item: Item) -> Item:
    """The item with its own column as its comparison: its number may mean something else in another."""
    return Item(**{**vars(item), "comparison": item.source.name if item.comparison else ""})


def _expanded(table: Table, spec: AnswerColumn, mapping: ConversionMap) -> list[Item]:
    pattern = spec.column or next((name for name in (spec.chosen, spec.left) if "*" in name), "")
    if "*" not in pattern or table.find(pattern):
        is_one_of_several = bool(spec.column) and not spec.pair and "*" in spec.left
        return [
            _item(table, spec, mapping, spec.column, (plain(spec.column), spec.question), is_one_of_several)
        ]
    numbers = table.matches(pattern)
    if not numbers:
        raise InputError(
            f"{table.path}: no column is named {plain_or_quoted(pattern)} with a whole number for *; "
            f"columns: {table.labels}"
        )
    items = []
    for number in numbers:
        column = plain(pattern).replace("*", number)
        keys = (number, column, plain(pattern))
        items.append(_item(table, spec, mapping, number, keys, is_one_of_several=True))
    return items


def _item(
    table: Table,
    spec: AnswerColumn,
    mapping: ConversionMap,
    star: str,
    keys: tuple[str, ...],
    is_one_of_several: bool,
) -> Item:
    def column(reference: str) -> Column | None:
        return table.column(reference.replace("*", star)) if reference else None

    answer, chosen, left = column(spec.column), column(spec.chosen), column(spec.left)
    one_of = tuple((table.column(name.replace("*", star)), word) for name, word in spec.one_of.items())
    pair = column(spec.pair)
    source = one_of[0][0] if one_of else answer or chosen or left or pair
    if source is None:
        raise InputError(f"{table.path}: an entry of answers in the map names no column")
    return Item(
        spec=spec,
        source=source,
        answer=answer,
        left=left,
        right=column(spec.right),
        pair=pair,
        chosen=chosen,
        question=column(spec.question_column),
        order=column(spec.order.column) if spec.order else None,
        other=column(spec.other),
        one_of=one_of,
        keys=keys,
        comparison=star if is_one_of_several else "",
        modes=next((mapping.pairs[key] for key in keys if key in mapping.pairs), None),
    )


def _check_sides(table: Table, item: Item) -> None:
    if (item.left and item.right) or item.pair or item.modes:
        return
    name = item.source.name
    seen = dict.fromkeys(text for row in table.rows if (text := item.source.text(row)))
    values = listed(seen)
    by_pair = f", or by --pair {plain_or_quoted(item.keys[0])}=LEFT,RIGHT" if item.keys[0] else ""
    raise InputError(
        f"{table.path}: {plain_or_quoted(name)} ({values}): nothing says which two modes were compared; "
        f"tell it by --left COLUMN and --right COLUMN{by_pair}; columns: {table.labels}"
    )
