"""Rankings as preferences: each pair of ranked modes once."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

from data.answers import Answer
from data.convert.map import ConversionMap, Ranking
from data.convert.reading_answers import NoAnswer, Preference, RowProblem
from data.convert.table import Column, Row, Table, listed, plain
from data.errors import InputError
from data.labels import plain_or_quoted, quoted

_RANK = re.compile(r"\d+([.,]0+)?")


@dataclass(frozen=True)
class ResolvedRanking:
    """A ranking's columns in a file, and every mode that it ranks."""

    spec: Ranking
    columns: tuple[Column, ...]
    modes: tuple[str, ...]

    @property
    def name(self) -> str:
        """What messages call it."""
        return self.columns[0].name


def resolve_rankings(table: Table, mapping: ConversionMap) -> list[ResolvedRanking]:
    """The rankings of a map as they are in the file."""
    rankings = [_resolved(table, ranking, mapping) for ranking in mapping.rankings]
    seen: set[tuple[str, frozenset[int]]] = set()
    for ranking in rankings:
        key = (ranking.spec.question, frozenset(column.place for column in ranking.columns))
        if key in seen:
            raise InputError(f"{table.path}: {listed(ranking.spec.columns)}: this ranking is told twice")
        seen.add(key)
    return rankings


def _resolved(table: Table, ranking: Ranking, mapping: ConversionMap) -> ResolvedRanking:
    columns = [column for name in ranking.columns for column in _columns(table, name)]
    if len(columns) < 2:
        raise InputError(f"{table.path}: {listed(ranking.columns)}: a ranking needs two columns at least")
    if ranking.cells == "ranks":
        modes = [mapping.modes.get(name, name) for name in (_option(table, column) for column in columns)]
    else:
        cells = (column.text(row) for row in table.rows for column in columns)
        texts = sorted({text for text in cells if text and text not in ranking.unranked})
        modes = [mapping.modes.get(text, text) for text in texts]
    return ResolvedRanking(ranking, tuple(columns), tuple(modes))


def _columns(table: Table, reference: str) -> list[Column]:
    """The columns of a reference; the beginning of a name and ``...`` may mean several."""
    name = plain(reference)
    if "*" in name and not table.find(name):
        return [table.column(name.replace("*", number)) for number in table.matches(name)]
    if name.endswith("...") and name not in table.names:
        places = [place for place, other in enumerate(table.names) if other.startswith(name[:-3])]
        if places:
            return [Column(table.names[place], place) for place in places]
    return [table.column(name)]


def _option(table: Table, column: Column) -> str:
    """The mode that a column ranks: the option behind its question, or its name."""
    return table.names[column.place].rpartition(" | ")[2]


def read_ranking(
    ranking: ResolvedRanking, row: Row, mapping: ConversionMap
) -> Iterator[Preference | NoAnswer]:
    """The pairs of one ranking, the better mode first; equal ranks are a tie."""
    texts = [column.text(row) for column in ranking.columns]
    if not any(texts):
        yield NoAnswer(ranking.name, "without a ranking", is_empty=True)
        return
    places = (
        _ranks(ranking, row, texts)
        if ranking.spec.cells == "ranks"
        else _places(ranking, row, texts, mapping)
    )
    for mode in ranking.modes:
        if mode not in places:
            yield NoAnswer(ranking.name, f"{plain_or_quoted(mode)} has no rank and is in no pair")
    for better, worse in combinations(sorted(places, key=lambda mode: places[mode]), 2):
        answer: Answer = "A>B" if places[better] < places[worse] else "A=B"
        word = f"{better} before {worse}" if answer == "A>B" else f"{better} and {worse} equal"
        yield Preference(ranking.name, ranking.spec.question, better, worse, answer, "", False, word)


def _ranks(ranking: ResolvedRanking, row: Row, texts: list[str | None]) -> dict[str, float]:
    ranks = {}
    for column, mode, text in zip(ranking.columns, ranking.modes, texts, strict=True):
        if not text or text in ranking.spec.unranked:
            continue
        if not _RANK.fullmatch(text):
            raise RowProblem(
                f"{row.where}, {plain_or_quoted(column.name)}: {quoted(text)} is not a rank (1, 2, ...)"
            )
        ranks[mode] = float(text.replace(",", "."))
    return ranks


def _places(
    ranking: ResolvedRanking, row: Row, texts: list[str | None], mapping: ConversionMap
) -> dict[str, float]:
    places: dict[str, float] = {}
    for place, (column, text) in enumerate(zip(ranking.columns, texts, strict=True)):
        if not text or text in ranking.spec.unranked:
            continue
        mode = mapping.modes.get(text, text)
        if mode in places:
            raise RowProblem(f"{row.where}, {plain_or_quoted(column.name)}: {quoted(mode)} is ranked twice")
        places[mode] = place
    return places
