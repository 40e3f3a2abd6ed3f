"""A file of a known form as responses: which rows count, and who answered what about which modes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from data.answers import MIRRORED
from data.convert.account import Account
from data.convert.form import Form
from data.convert.items import Item, resolve_items
from data.convert.json_records import ARRAY
from data.convert.map import LEAVE_OUT, ConversionMap
from data.convert.missing import MissingMeanings
from data.convert.rankings import ResolvedRanking, read_ranking, resolve_rankings
from data.convert.reading import FILE, read_tables
from data.convert.reading_answers import MissingMeaningError, NoAnswer, Preference, RowProblem, read_item
from data.convert.rows import Reason, check_rows_are_chosen, filled_down, resolve_rules
from data.convert.table import Column, Row, Table, counted, listed
from data.errors import InputError
from data.labels import plain_or_quoted


@dataclass(frozen=True)
class ConvertedResponse:
    """One row of the response CSV."""

    participant: str | None
    preference: Preference
    count: str | None
    kept: tuple[str, ...]
    row: Row


@dataclass(frozen=True)
class Conversion:
    """All responses of one conversion, and how they were read."""

    responses: tuple[ConvertedResponse, ...]
    table: Table
    account: Account
    map: ConversionMap


def convert_files(paths: Sequence[Path], form: Form, mapping: ConversionMap) -> Conversion:
    """Convert files of one form.

    Parameters
    ----------
    paths : sequence of Path
    form : Form
    mapping : ConversionMap
        The form's defaults with what the user said.

    Raises
    ------
    InputError
        One line: what is wrong with the file, or what has to be told: the column, the values seen in it and
        the option.
    """
    table = filled_down(form.prepare(read_tables(paths, form.layout, mapping.sheet), mapping), mapping)
    if form.refusal:
        raise InputError(f"{table.path}: {form.refusal}")
    if not mapping.answers and not mapping.rankings:
        raise InputError(
            f"{table.path}: nothing says which column holds the answers; "
            f"tell it by --answer COLUMN{_or_ranking(form)}; columns: {table.labels}"
        )
    return _Reader(table, form, mapping).conversion()


def _or_ranking(form: Form) -> str:
    return ", or a ranking's by --ranking COLUMNS" if form.ranking_cells else ""


@dataclass
class _Reader:
    """Goes through the rows of a table once."""

    table: Table
    form: Form
    mapping: ConversionMap
    missing: MissingMeanings = field(init=False)

    def __post_init__(self) -> None:
        self.rules = resolve_rules(self.table, self.mapping)
        self.items: list[Item] = resolve_items(self.table, self.mapping)
        self.rankings: list[ResolvedRanking] = resolve_rankings(self.table, self.mapping)
        self.parts: tuple[Item | ResolvedRanking, ...] = (*self.items, *self.rankings)
        own_words = frozenset(self.form.defaults.words)
        self.account = Account(self.table, self.mapping, tuple(self.items), tuple(self.rankings), own_words)
        left_out = [rule for rule in self.rules if not rule.rule.taken]
        kept = [row for row in self.table.rows if not any(rule.fires(row) for rule in left_out)]
        check_rows_are_chosen(self.table, kept, self.form, self.mapping)
        self.participant = self._participant()
        self.count = self.table.column(self.mapping.count) if self.mapping.count else None
        self.comparison = self.table.column(self.mapping.comparison) if self.mapping.comparison else None
        self.kept_columns = [self.table.column(name) for name in self.mapping.keep]
        self.missing = MissingMeanings(self.table, kept, self.items)
        self._is_one_file = len({row.path for row in self.table.rows}) <= 1
        self._file_place = self.table.names.index(FILE) if FILE in self.table.names else -1
        self._asked_away: set[str] = set()
        self._rows: dict[tuple[str | None, ...], Row] = {}
        self._keys: dict[tuple[str | None, str, str], Row] = {}

    def _participant(self) -> Column | None:
        if self.mapping.participant is None:
            raise InputError(
                f"{self.table.path}: nothing says which column names the person who answered; "
                f"tell it by --participant COLUMN, or --participant none; columns: {self.table.labels}"
            )
        return self.table.column(self.mapping.participant) if self.mapping.participant else None

    def conversion(self) -> Conversion:
        """Read every row.

        What has to be told is said before any other fault, and all of it that is of one kind at once.
        """
        responses: list[ConvertedResponse] = []
        problem: InputError | None = None
        for row in self.table.rows:
            rule = next((rule for rule in self.rules if rule.fires(row) and not rule.rule.taken), None)
            if rule is not None:
                self._leave_out(row, rule.reason(row))
            elif self._is_asked_away(row):
                self._leave_out(row, Reason("asked to be left out"))
            else:
                try:
                    responses += self._responses(row)
                except InputError as error:
                    problem = problem or error
        self.missing.check()
        self._check_lines_to_leave_out()
        if problem is not None:
            raise problem
        if self.mapping.each_pair_once:
            responses = self._each_pair_once(responses)
        self._count_arrays(responses)
        if self.participant and len(responses) > 1 and len({r.participant for r in responses}) == 1:
            self.account.note(f"one participant alone: {self.participant.name} is {responses[0].participant}")
        if not responses:
            raise InputError(f"{self.table.path}: no row counts: {'; '.join(self.account.left_out_lines())}")
        return Conversion(tuple(responses), self.table, self.account, self.mapping)

    def _read(self, part: Item | ResolvedRanking, row: Row) -> Iterator[Preference | NoAnswer]:
        if isinstance(part, Item):
            return read_item(part, row, self.mapping)
        return read_ranking(part, row, self.mapping)

    def _leave_out(self, row: Row, reason: Reason) -> None:
        answers = 0
        for part in self.parts:
            try:
                preferences = sum(isinstance(outcome, Preference) for outcome in self._read(part, row))
            except (InputError, MissingMeaningError):
                continue
            answers += preferences if isinstance(part, Item) else min(preferences, 1)
        self.account.row_left_out(reason, row, answers)

    def _is_asked_away(self, row: Row) -> bool:
        if not self.mapping.leave_out:
            return False
        inside = row.path.removeprefix(f"{self.table.path}/")
        places = {f"{path}:{row.line}" for path in (row.path, inside, Path(row.path).name)}
        if self._is_one_file:
            places.add(str(row.line))
        asked = places.intersection(self.mapping.leave_out)
        self._asked_away |= asked
        return bool(asked)

    def _check_lines_to_leave_out(self) -> None:
        """Refuse a bare line number among several files, and say which lines are not there."""
        asked = [place for place in self.mapping.leave_out if place not in LEAVE_OUT]
        numbers = [place for place in asked if place.isdigit()]
        if numbers and not self._is_one_file:
            raise InputError(
                f"{self.table.path}: --leave-out {numbers[0]}: nothing says in which of the files; "
                f"write --leave-out FILE:{numbers[0]}"
            )
        absent = [place for place in asked if place not in self._asked_away]
        if absent:
            self.account.note(f"not in the rows that count: --leave-out {listed(absent)}")

    def _responses(self, row: Row) -> list[ConvertedResponse]:
        preferences: list[Preference] = []
        missing: list[NoAnswer] = []
        for part in self.parts:
            try:
                for outcome in self._read(part, row):
                    (preferences if isinstance(outcome, Preference) else missing).append(outcome)  # type: ignore[arg-type]
            except MissingMeaningError as error:
                self.missing.add(error)
            except RowProblem as problem:
                if not problem.kind:
                    raise
                if problem.kind not in self.mapping.leave_out:
                    raise InputError(
                        f"{problem}: leave such rows out by --leave-out {problem.kind}, or this one by "
                        f"--leave-out {self._place(row)}"
                    ) from None
                missing.append(NoAnswer("", f"{problem.kind}, asked to be left out"))
        person = self.participant.text(row) if self.participant else None
        who = f" ({person})" if person else ""
        if not preferences and len(missing) > 1 and all(outcome.is_empty for outcome in missing):
            self.account.row_left_out(Reason("without any answer"), row, 0, who)
        else:
            for outcome in missing:
                if outcome.reason:
                    self.account.no_answer(outcome, row, who)
        if not preferences:
            return []
        if self.participant and not person:
            raise self.participant.error(row, "empty, but the person who answered is needed")
        for rule in self.rules:
            if rule.rule.taken and rule.fires(row):
                self.account.taken(rule.reason(row), row, len(preferences))
        if self._repeats_another_file(row):
            self.account.row_left_out(Reason("repeated, asked to be left out"), row, len(preferences), who)
            return []
        return [self._response(row, person, preference) for preference in preferences]

    def _repeats_another_file(self, row: Row) -> bool:
        """Whether a row is to be left out because another file has it, cell by cell."""
        if self._is_one_file:
            return False
        cells = tuple(cell for place, cell in enumerate(row.cells) if place != self._file_place)
        first = self._rows.setdefault(cells, row)
        if first.path == row.path:
            return False
        if "repeated" not in self.mapping.leave_out:
            raise InputError(
                f"{row.where}: repeats {first.where}, cell by cell: leave such rows out by --leave-out "
                "repeated; or, if they are other answers, convert the files one by one"
            )
        return True

    def _response(self, row: Row, person: str | None, preference: Preference) -> ConvertedResponse:
        comparison = preference.comparison or (self.comparison and self.comparison.text(row)) or ""
        preference = Preference(**{**vars(preference), "comparison": comparison})
        if comparison and person is not None:
            key = (person, comparison, preference.question)
            first = self._keys.setdefault(key, row)
            if first is not row:
                raise InputError(
                    f"{row.where}: {plain_or_quoted(person)} answered {preference.question} of {comparison} "
                    f"already in {first.where}: leave one out, such as --leave-out {self._place(row)}"
                )
        kept = tuple(column.text(row) or "" for column in self.kept_columns)
        count = self.count.text(row) if self.count else None
        return ConvertedResponse(person, preference, count, kept, row)

    def _place(self, row: Row) -> str:
        """A row's place as ``--leave-out`` takes it."""
        return str(row.line) if self._is_one_file else f"{Path(row.path).name}:{row.line}"

    def _each_pair_once(self, responses: list[ConvertedResponse]) -> list[ConvertedResponse]:
        """One response a pair where a pair stands twice, mirrored; both must say the same."""
        first: dict[tuple[str | None, str, frozenset[str]], ConvertedResponse] = {}
        contradicted: set[tuple[str | None, str, frozenset[str]]] = set()
        for response in responses:
            one = response.preference
            key = (response.participant, one.question, frozenset((one.mode_a, one.mode_b)))
            other = first.setdefault(key, response)
            same_order = other.preference.mode_a == one.mode_a
            if other.preference.response == (one.response if same_order else MIRRORED[one.response]):
                continue
            if "contradictions" not in self.mapping.leave_out:
                who = f"participant {response.participant}" if response.participant else "the file"
                raise InputError(
                    f"{response.row.where}: {who} says {one.response} for {one.mode_a} and {one.mode_b}, "
                    f"against line {other.row.line}: leave such pairs out by --leave-out contradictions"
                )
            if key not in contradicted:
                contradicted.add(key)
                reason = "contradicts its mirrored cell, asked to be left out"
                who = f" ({response.participant})" if response.participant else ""
                self.account.no_answer(NoAnswer("", reason), response.row, who)
        return [response for key, response in first.items() if key not in contradicted]

    def _count_arrays(self, responses: list[ConvertedResponse]) -> None:
        column = self.table.find(ARRAY)
        if column is None:
            return
        every = {(row.path, column.text(row)) for row in self.table.rows if column.text(row)}
        used = {(response.row.path, column.text(response.row)) for response in responses}
        if len(every) > 1 and (without := len(every - used)):
            self.account.note(f"{counted(without, 'array')} of {len(every)} without a response")
