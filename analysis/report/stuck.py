"""The report's sections on how often the robot got stuck: rates, and modes against each other."""

from collections.abc import Sequence
from math import isnan

from analysis.figures.labels import isolated, one_line, percent, percent_in_words
from analysis.figures.stuck import draw_stuck
from analysis.report.page import Section, Table
from analysis.results import Quantity
from analysis.stuck import StuckRate
from analysis.stuck_contrasts import StuckContrast

_MOST_SAID = 3


def stuck_section(rates: Sequence[StuckRate], contrasts: Sequence[StuckContrast], tag: str) -> Section | None:
    """Rates per comparison and per minute, with independent comparisons and over people."""
    if not rates:
        return None
    timed = any(not isnan(rate.per_minute_mean) for rate in rates)
    caption = (
        "Share of a mode's comparisons in which the robot got stuck at least once under that mode"
        + (", and comparisons stuck per minute of exposure to the mode" if timed else "")
        + ", with 94 % credible intervals. Marked: comparisons taken as independent. Pale below it: over "
        "people, each with a rate of their own, as events cluster in people. On the right: comparisons "
        "stuck, of how many. Rates hold for this task and no other."
    )
    words = [_said(rates)]
    if contrasts and any(rate.stuck for rate in rates):
        words += _surest(contrasts, {rate.mode: rate for rate in rates})
    return Section(
        "How often the robot got stuck",
        (draw_stuck(rates, tag),),
        "",
        caption,
        stuck_table(rates),
        "here",
        tuple(words),
    )


def _said(rates: Sequence[StuckRate]) -> str:
    some = sorted((r for r in rates if r.stuck), key=lambda r: -r.stuck / r.comparisons)
    if not some:
        alone, over_people = (
            percent_in_words(max(highs))
            for highs in ([r.rate_hdi_high for r in rates], [r.between.hdi_high for r in rates])
        )
        return (
            "The robot never got stuck under any mode. That does not make a rate 0: with so many comparisons "
            f"rates of up to {alone} of the comparisons go with it, and of up to {over_people} if people "
            "have rates of their own."
        )
    said = []
    for r in some[:_MOST_SAID]:
        per_minute = ""
        if r.per_minute_between is not None:
            per_minute = f", or {_rate(r.per_minute_between)} a minute of exposure"
        said.append(
            f"{isolated(r.mode)}: stuck in {r.stuck:,} of {r.comparisons:,} comparisons; over people that is "
            f"{_share(r.between)} of the comparisons{per_minute}"
        )
    left = len(some) - _MOST_SAID
    more = f" {left} more {'mode' if left == 1 else 'modes'} had no higher rate." if left > 0 else ""
    return f"{'. '.join(said)}. In brackets stand 94 % credible intervals.{more}"


def _surest(contrasts: Sequence[StuckContrast], rates: dict[str, StuckRate]) -> list[str]:
    """The two contrasts that are surest, of modes of which at least one got stuck."""
    told = [c for c in contrasts if rates[c.mode_i].stuck or rates[c.mode_j].stuck]
    said = []
    for contrast in sorted(told, key=lambda c: -abs(c.p_i_above_j - 0.5))[:2]:
        high, low, chance = contrast.mode_i, contrast.mode_j, contrast.p_i_above_j
        if chance < 0.5:
            high, low, chance = low, high, 1 - chance
        said.append(f"{isolated(high)}'s rate is above {isolated(low)}'s: {percent_in_words(chance)}")
    return [f"The chance that {'; that '.join(said)}."] if said else []


def stuck_table(rates: Sequence[StuckRate]) -> Table:
    """Stuck rates with their counts; per minute where the time of exposure is known."""
    timed = any(not isnan(rate.per_minute_mean) for rate in rates)
    rows = tuple(
        (
            one_line(r.mode),
            f"{r.stuck:,} of {r.comparisons:,}",
            f"{100 * r.rate_mean:.1f} % ({100 * r.rate_hdi_low:.1f} to {100 * r.rate_hdi_high:.1f})",
            f"{100 * r.between.mean:.1f} % ({100 * r.between.hdi_low:.1f} to {100 * r.between.hdi_high:.1f})",
            *(_per_minute(r) if timed else ()),
        )
        for r in rates
    )
    columns = ["Mode", "Stuck", "Rate (94 %)", "Over people"]
    columns += ["Minutes", "Per minute", "Per minute over people"] if timed else []
    return Table(
        tuple(columns), (False, *([True] * (len(columns) - 1))), rows, "stuck.csv and parameters.csv"
    )


def contrasts_section(contrasts: Sequence[StuckContrast], rates: Sequence[StuckRate]) -> Section | None:
    """Stuck rates against each other, where there are any: posterior, and exact tests beside it."""
    if not contrasts or not any(rate.stuck for rate in rates):
        return None
    words = (
        "The chance that the rate of mode i is higher is posterior. Beside it stand two-sided exact tests of "
        "equal rates: Fisher's takes comparisons as independent; the one within people asks how often each "
        "person got stuck in all, so that a few people who are stuck in everything cannot make a difference "
        "between modes. No correction is made for several pairs.",
    )
    rows = tuple(
        (
            one_line(c.mode_i),
            one_line(c.mode_j),
            f"{percent(c.p_i_above_j)} %",
            _p_value(c.p_fisher),
            _p_value(c.p_within_people),
        )
        for c in contrasts
    )
    columns = ("Mode i", "Mode j", "i higher", "p, Fisher", "p, within people")
    table = Table(columns, (False, False, True, True, True), rows, "stuck_contrasts.csv")
    return Section("Do the stuck rates differ?", (), "", "", table, words=words)


def _p_value(p: float) -> str:
    return "<0.0001" if p < 0.0001 else f"{p:.2g}"


def _share(q: Quantity) -> str:
    return f"{percent_in_words(q.mean)} ({percent(q.hdi_low)} to {percent(q.hdi_high)} %)"


def _rate(q: Quantity) -> str:
    return f"{q.mean:.2f} ({q.hdi_low:.2f} to {q.hdi_high:.2f})"


def _per_minute(r: StuckRate) -> tuple[str, str, str]:
    if isnan(r.per_minute_mean):
        return "", "", ""
    return (
        f"{r.exposure_min:.1f}",
        f"{r.per_minute_mean:.2f} ({r.per_minute_hdi_low:.2f} to {r.per_minute_hdi_high:.2f})",
        "" if r.per_minute_between is None else _rate(r.per_minute_between),
    )
