"""Which rows of a table count, and which are left out for what reason."""

from collections.abc import Iterable
from dataclasses import dataclass

from data.convert.form import Form
from data.convert.map import ConversionMap, RowRule
from data.convert.table import Column, Row, Table, listed
from data.errors import InputError
from data.labels import plain_or_quoted


@dataclass(frozen=True)
class Reason:
    """Why rows are left out: in words, and the value that says so; ``per`` counts what they belong to."""

    text: str
    column: str = ""
    value: str = ""
    per_column: str = ""
    per_value: str | None = None


@dataclass(frozen=True)
class ResolvedRule:
    """A rule with its column in the file."""

    rule: RowRule
    column: Column
    only: tuple[str, ...]
    without: tuple[str, ...]
    per: Column | None = None

    def fires(self, row: Row) -> bool:
        """Whether the rule leaves a row out, or counts it."""
        value = (self.column.text(row) or "").casefold()
        if self.only and not _is_among(value, self.only):
            return True
        return bool(self.without) and _is_among(value, self.without)

    def reason(self, row: Row) -> Reason:
        """Why a row is left out or counted; rows of one rule of a form have one reason."""
        value = self.column.text(row) or "(empty)"
        per = self.per.text(row) if self.per else None
        if self.rule.reason:
            return Reason(self.rule.reason, self.column.name, value, self.rule.per, per)
        return Reason(
            f"{self.column.name} = {plain_or_quoted(value)}", per_column=self.rule.per, per_value=per
        )


def resolve_rules(table: Table, mapping: ConversionMap) -> list[ResolvedRule]:
    """The rules of a map in their order; optional ones only where the file has the column.

    Raises
    ------
    InputError
        If a column is missing, or no row has a value that a rule keeps.
    """
    rules = []
    for rule in mapping.rows:
        if rule.optional and table.find(rule.column) is None:
            continue
        column = table.column(rule.column)
        only = tuple(value.casefold() for value in rule.only)
        without = tuple(value.casefold() for value in rule.without)
        per = table.find(rule.per) if rule.per else None
        resolved = ResolvedRule(rule, column, only, without, per)
        if only and not rule.optional and all(resolved.fires(row) for row in table.rows):
            seen = _values(table.rows, column)
            raise InputError(
                f"{table.path}: {column.name}: no row is {listed(rule.only)}; values: {listed(seen)}"
            )
        rules.append(resolved)
    return rules


def check_rows_are_chosen(table: Table, kept: Iterable[Row], form: Form, mapping: ConversionMap) -> None:
    """Refuse a file in which a column marks several kinds of rows and nothing says which count."""
    if {rule.column for rule in mapping.rows} & set(form.choose_rows):
        return
    for name in form.choose_rows:
        column = table.find(name)
        if column is None:
            continue
        seen = _values(kept, column)
        if len(seen) > 1:
            values = listed(value or "(empty)" for value in seen)
            raise InputError(
                f"{table.path}: {name}: {values}: nothing says which of these rows count; "
                f"tell it by --only {name}=VALUE"
            )
        return


def filled_down(table: Table, mapping: ConversionMap) -> Table:
    """The table with empty cells of some columns filled by what stands above."""
    places = [table.column(name).place for name in mapping.fill_down]
    if not places:
        return table
    above: dict[int, str | None] = {}
    rows = []
    for row in table.rows:
        cells = list(row.cells)
        for place in places:
            cells[place] = above[place] = cells[place] or above.get(place)
        rows.append(Row(row.path, row.line, tuple(cells)))
    return Table(table.path, table.names, tuple(rows), table.notes)


def _values(rows: Iterable[Row], column: Column) -> list[str]:
    return sorted({column.text(row) or "" for row in rows})


def _is_among(value: str, texts: tuple[str, ...]) -> bool:
    """Whether a value is one of some texts; a ``*`` at a text's end stands for anything."""
    return value in texts or any(text.endswith("*") and value.startswith(text[:-1]) for text in texts)
