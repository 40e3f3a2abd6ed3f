"""How a file was read, in lines for the terminal: each column, what was left out and why, how many."""

from collections import Counter
from dataclasses import dataclass, field

from data.convert.items import Item
from data.convert.map import ConversionMap
from data.convert.rankings import ResolvedRanking
from data.convert.reading_answers import NoAnswer, Preference
from data.convert.rows import Reason
from data.convert.table import MOST_SHOWN, Row, Table, counted, listed
from data.labels import plain_or_quoted


@dataclass
class _Tally:
    rows: int = 0
    answers: int = 0
    column: str = ""
    values: dict[str, None] = field(default_factory=dict)
    per_column: str = ""
    per: set[str] = field(default_factory=set)
    places: list[str] = field(default_factory=list)

    @property
    def condition(self) -> str:
        """The column and its values that say why."""
        return f" ({self.column} = {listed(self.values)})" if self.column else ""

    @property
    def lines(self) -> str:
        """The lines in the file."""
        return f"{'line' if len(self.places) == 1 else 'lines'} {listed(self.places)}"


class Account:
    """Counts while a file is read."""

    def __init__(
        self,
        table: Table,
        mapping: ConversionMap,
        items: tuple[Item, ...],
        rankings: tuple[ResolvedRanking, ...],
        own_words: frozenset[str],
    ) -> None:
        """Start at nothing; ``own_words`` are the form's own, which need not occur."""
        self._table, self._mapping = table, mapping
        self._items, self._rankings, self._own_words = items, rankings, own_words
        self._rows: dict[str, _Tally] = {}
        self._answers: dict[str, _Tally] = {}
        self._taken: dict[str, _Tally] = {}
        self._notes: list[str] = list(table.notes)

    def row_left_out(self, reason: Reason, row: Row, answers: int, who: str = "") -> None:
        """Count a row that does not count, with the answers in it."""
        self._add(self._rows, reason, row, answers, who)

    def taken(self, reason: Reason, row: Row, answers: int) -> None:
        """Count answers that are taken although something speaks against them."""
        self._add(self._taken, reason, row, answers)

    def no_answer(self, outcome: NoAnswer, row: Row, who: str) -> None:
        """Count an answer that is none, in a row that counts."""
        column = f" in {plain_or_quoted(outcome.column)}" if outcome.column else ""
        self._add(self._answers, Reason(f"{column}: {outcome.reason}"), row, 1, who)

    def _add(self, tallies: dict[str, _Tally], reason: Reason, row: Row, answers: int, who: str = "") -> None:
        tally = tallies.setdefault(reason.text, _Tally(column=reason.column, per_column=reason.per_column))
        tally.rows += 1
        tally.answers += answers
        tally.values[reason.value] = None
        if reason.per_value is not None:
            tally.per.add(reason.per_value)
        inside = row.path.removeprefix(f"{self._table.path}/")
        place = f"{row.line}" if row.path == self._table.path else f"{inside}:{row.line}"
        tally.places.append(f"{place}{who}")

    def note(self, text: str) -> None:
        """Add a line of its own."""
        self._notes.append(text)

    def left_out_lines(self) -> list[str]:
        """A line a reason, rows first."""
        lines = []
        for reason, tally in self._rows.items():
            rows = counted(tally.rows, "row") + (
                f" of {len(tally.per)} {tally.per_column}" if tally.per else ""
            )
            answers = f" with {counted(tally.answers, 'answer')}" if tally.answers else ""
            lines.append(f"left out: {rows}{answers}: {reason}{tally.condition}; {tally.lines}")
        for reason, tally in self._answers.items():
            lines.append(f"no answer: {tally.answers}{reason}; {tally.lines}")
        for reason, tally in self._taken.items():
            answers = counted(tally.answers, "answer")
            lines.append(f"taken all the same: {answers}: {reason}{tally.condition}; {tally.lines}")
        return lines

    def lines(self, preferences: list[Preference]) -> list[str]:
        """All lines about a conversion."""
        return [
            *self._column_lines(preferences),
            *self.left_out_lines(),
            _mode_line(preferences),
            *_tie_lines(preferences),
            *self._unused_lines(preferences),
            *self._side_lines(preferences),
            *self._notes,
        ]

    def _column_lines(self, preferences: list[Preference]) -> list[str]:
        mapping = self._mapping
        lines = [
            f"{mapping.participant}: participant" if mapping.participant else "participant: nobody is named"
        ]
        words: dict[str, Counter[tuple[str, str]]] = {}
        questions: dict[str, dict[str, None]] = {}
        for preference in preferences:
            words.setdefault(preference.column, Counter())[preference.word, preference.response] += 1
            questions.setdefault(preference.column, {})[preference.question] = None
        for item in self._items:
            name = item.source.name
            meanings = words.get(name, Counter()).most_common(MOST_SHOWN)
            read = ", ".join(f"{_meaning(item, *both)} ({n})" for both, n in sorted(meanings))
            how = self._item(item, tuple(questions.get(name, ())))
            lines.append(f"{plain_or_quoted(name)}: {how}; {read or 'no response'}")
        for ranking in self._rankings:
            columns = listed(column.name for column in ranking.columns)
            modes = listed(ranking.modes)
            lines.append(f"{columns}: ranking of {modes}, as question {ranking.spec.question}")
        for role, name in (("count", mapping.count), ("comparison", mapping.comparison)):
            if name:
                lines.append(f"{name}: {role}")
        used = {column.place for item in self._items for column in item.used}
        used |= {column.place for ranking in self._rankings for column in ranking.columns}
        names = {mapping.participant, mapping.count, mapping.comparison, *mapping.keep}
        names |= {rule.column for rule in mapping.rows}
        rest = [
            name
            for place, name in enumerate(self._table.names)
            if place not in used and name and name not in names and not name.startswith("@")
        ]
        if rest:
            lines.append(f"not used: {listed(rest)}")
        return lines

    def _item(self, item: Item, questions: tuple[str, ...]) -> str:
        """How an item is read: its question or those that its cells name, and its sides."""
        question = listed(questions or (item.spec.question,))
        if item.question:
            question = f"the question in column {plain_or_quoted(item.question.name)}"
        if item.left and item.right:
            sides = f"left in {plain_or_quoted(item.left.name)}, right in {plain_or_quoted(item.right.name)}"
        elif item.pair:
            sides = f"left and right by {item.pair.name}"
        else:
            assert item.modes is not None
            left, right = item.modes
            sides = f"left {left}, right {right}"
        order = f", exchanged by {item.order.name}" if item.order else ""
        return f"answer to {question}, {sides}{order}"

    def _unused_lines(self, preferences: list[Preference]) -> list[str]:
        """Words and pairs that do not occur: perhaps a misspelling."""
        meanings = self._mapping.words.items()
        words = {word for word, meaning in meanings if not meaning.startswith("none")}
        words -= {preference.word for preference in preferences} | self._own_words
        pairs = set(self._mapping.pairs)
        for item in self._items:
            columns = [item.pair] if item.pair else []
            pairs -= {text for column in columns for row in self._table.rows if (text := column.text(row))}
            pairs -= set(item.keys) if item.modes else set()
        return [
            f"not in the responses: {what} {listed(sorted(names))}"
            for what, names in (("words", words), ("pairs", pairs))
            if names
        ]

    def _side_lines(self, preferences: list[Preference]) -> list[str]:
        lines = []
        unknown = sum(not preference.is_side_known for preference in preferences)
        if unknown:
            lines.append(
                f"sides unknown: {unknown} of {counted(len(preferences), 'response')}: the file does not say "
                "what was shown as A; report them with --no-side-effect"
            )
        if self._rankings:
            lines.append("pairs of one ranking are not independent: intervals from them are too narrow")
        scale = self._mapping.scale
        if scale:
            lines.append(f"a scale of {scale.levels} levels: report it with --levels {scale.levels}")
        return lines


def _meaning(item: Item, word: str, answer: str) -> str:
    """A word of the file and what it means; the columns alone say it where there is no word."""
    if item.spec.always is not None:
        return answer
    return f"{plain_or_quoted(word)} = {answer}"


def _mode_line(preferences: list[Preference]) -> str:
    """The modes, each with its number of responses."""
    modes = Counter(mode for one in preferences for mode in (one.mode_a, one.mode_b))
    shown = [f"{listed([mode])} ({n})" for mode, n in sorted(modes.items())]
    rest = f" and {len(shown) - MOST_SHOWN} more" if len(shown) > MOST_SHOWN else ""
    return f"modes: {', '.join(shown[:MOST_SHOWN])}{rest}"


def _tie_lines(preferences: list[Preference]) -> list[str]:
    """Ties by word, where several words are ties."""
    ties = Counter(preference.word for preference in preferences if preference.response == "A=B")
    if len(ties) < 2:
        return []
    words = ", ".join(f"{n} {plain_or_quoted(word)}" for word, n in ties.items())
    return [f"ties: {ties.total()}, of which {words}"]
