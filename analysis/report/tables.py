"""The CSV files of a report folder: full precision, and the same bytes for the same results."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import fields
from decimal import Decimal
from pathlib import Path

from analysis.checks import CheckShare
from analysis.closer_look import CloserLook
from analysis.lag import LagChange, ModeDelay
from analysis.refits import Refits
from analysis.results import Fit, Quantity, QuestionFit
from analysis.straight_lining import StraightLining
from analysis.stuck import StuckRate
from analysis.stuck_contrasts import StuckContrast

_FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")
Cell = str | int | float


def neutralised(name: str) -> str:
    """A name that no spreadsheet runs as a formula: a leading ``= + - @`` gets a ``'`` before it."""
    return f"'{name}" if name.startswith(_FORMULA_STARTS) else name


def neutralised_names(fit: Fit) -> tuple[str, ...]:
    """The names of modes and questions that the CSV files write differently."""
    names = [*fit.modes, *(q.question.name for q in fit.questions)]
    return tuple(name for name in dict.fromkeys(names) if neutralised(name) != name)


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write rows as UTF-8 CSV, quoted as in RFC 4180; floats as `repr`, nan as an empty cell."""
    lines = [",".join(header), *(",".join(_cell(value) for value in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="")


def _cell(value: Cell) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(float(value))
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    text = neutralised(value)
    if any(c in text for c in ',"\r\n') or text != text.strip():
        return '"' + text.replace('"', '""') + '"'
    return text


def write_tables(
    fit: Fit, stuck: Sequence[StuckRate], more: Sequence[tuple[str, Quantity]], folder: Path
) -> None:
    """Write ``worth.csv``, ``pairwise.csv``, ``parameters.csv`` and, if rates are known, ``stuck.csv``.

    A question that is not ranked has no row in ``worth.csv``, and no chances in ``pairwise.csv``.
    Pairs stand in both directions. ``more`` are further rows of ``parameters.csv``, each with what stands
    for its question.
    """
    write_csv(
        folder / "worth.csv",
        (
            "question",
            "mode",
            "ability_mean",
            "ability_sd",
            "worth_mean",
            "worth_sd",
            "worth_hdi_low",
            "worth_hdi_high",
            "p_best",
            "rank_mean",
        ),
        (
            (
                q.question.name,
                m.mode,
                m.ability_mean,
                m.ability_sd,
                m.worth_mean,
                m.worth_sd,
                m.worth_hdi_low,
                m.worth_hdi_high,
                m.p_best,
                m.rank_mean,
            )
            for q in fit.questions
            if q.ranked
            for m in q.modes
        ),
    )
    write_csv(
        folder / "pairwise.csv",
        ("question", "mode_i", "mode_j", "p_i_above_j", "n", "wins_i", "ties", "wins_j"),
        (row for q in fit.questions for row in _both_ways(fit, q)),
    )
    write_csv(
        folder / "parameters.csv",
        ("question", "name", "mean", "sd", "hdi_low", "hdi_high"),
        (
            (question, p.name, p.mean, p.sd, p.hdi_low, p.hdi_high)
            for question, p in [*((q.question.name, p) for q in fit.questions for p in q.parameters), *more]
        ),
    )
    if stuck:
        write_csv(
            folder / "stuck.csv",
            ("mode", "comparisons", "stuck", "rate_mean", "rate_hdi_low", "rate_hdi_high"),
            ((r.mode, r.comparisons, r.stuck, r.rate_mean, r.rate_hdi_low, r.rate_hdi_high) for r in stuck),
        )


def write_quality(
    delays: Sequence[ModeDelay], changes: Sequence[LagChange], checks: Sequence[CheckShare], folder: Path
) -> None:
    """Write ``delay.csv``, ``lag.csv`` and ``checks.csv``, each if there is anything to write."""
    for name, rows in (("delay", delays), ("lag", changes)):
        if rows:
            header = [field.name for field in fields(rows[0])]
            write_csv(folder / f"{name}.csv", header, ([getattr(r, h) for h in header] for r in rows))
    if checks:
        header = ["participant", "answers", "same", "share"]
        write_csv(
            folder / "checks.csv", header, ((s.participant, s.answers, s.same, s.share) for s in checks)
        )


def write_closer_look(look: CloserLook, contrasts: Sequence[StuckContrast], folder: Path) -> None:
    """Write what goes beyond the ranking, each file if there is anything to write."""
    known = [a for a in look.agreements if a.first]
    if known:
        header = ["question", "first", "share_mean", "share_hdi_low", "share_hdi_high", "new_person"]
        write_csv(folder / "agreement.csv", header, ([getattr(a, h) for h in header] for a in known))
    people = [(a.question, p) for a in known for p in a.people]
    if people:
        header = [field.name for field in fields(people[0][1])]
        rows = ([question, *(getattr(p, h) for h in header)] for question, p in people)
        write_csv(folder / "people.csv", ["question", *header], rows)
    for name, found in (
        ("equivalence", look.equivalences),
        ("strength", look.strengths),
        ("consistency", look.consistencies),
        ("predictive", look.checks.checks),
        ("monte_carlo", look.errors),
        ("measures", look.measures),
        ("association", look.associations),
        ("stuck_contrasts", contrasts),
    ):
        _write_results(folder / f"{name}.csv", found)


def write_straight_lines(found: StraightLining, folder: Path) -> None:
    """Write who answers in a line, and what the ranking is without them, if anybody does."""
    _write_results(folder / "careless.csv", found.lines)
    _write_results(folder / "careless_left_out.csv", found.changes)


def write_refits(refitted: Refits, folder: Path) -> None:
    """Write what refits tell, each file if there is anything to write."""
    for name, found in (
        ("models", refitted.scores),
        ("priors", refitted.shifts),
        ("covariates", refitted.effects),
        ("groups", refitted.moderation.differences),
        ("lag", refitted.lag.changes if refitted.lag is not None else ()),
    ):
        _write_results(folder / f"{name}.csv", found)


def _write_results(path: Path, results: Sequence[object]) -> None:
    """A row a result, a column a field."""
    if results:
        header = [field.name for field in fields(results[0])]  # type: ignore[arg-type]
        write_csv(path, header, ([getattr(r, h) for h in header] for r in results))


def _complement(probability: float) -> float:
    """``1 - probability`` in as few digits as the probability itself has."""
    return probability if math.isnan(probability) else float(1 - Decimal(repr(probability)))


def _both_ways(fit: Fit, question: QuestionFit) -> list[Sequence[Cell]]:
    """Every ordered pair, in the order of the modes."""
    name, place = question.question.name, {mode: k for k, mode in enumerate(fit.modes)}
    rows: dict[tuple[int, int], Sequence[Cell]] = {}
    for p in question.pairs:
        i, j = place[p.mode_i], place[p.mode_j]
        rows[i, j] = (name, p.mode_i, p.mode_j, p.p_i_above_j, p.n, p.wins_i, p.ties, p.wins_j)
        rows[j, i] = (name, p.mode_j, p.mode_i, _complement(p.p_i_above_j), p.n, p.wins_j, p.ties, p.wins_i)
    return [rows[key] for key in sorted(rows)]
