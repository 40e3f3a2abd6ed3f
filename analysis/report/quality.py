"""The report's sections on the quality of the data: input delay, and attention checks."""

from collections.abc import Sequence
from math import isnan

from analysis.checks import CheckShare
from analysis.figures.labels import isolated, one_line, percent
from analysis.lag import LagExclusion, ModeDelay
from analysis.report.cautions import unequal_delays
from analysis.report.changes import changes_table
from analysis.report.findings import listed
from analysis.report.page import Section, Table

FEW_SAME = 0.5
"""Below this share of "about the same" a participant's checks are pointed out. Untuned."""


def delay_section(delays: Sequence[ModeDelay]) -> Section | None:
    """Input delay of every mode."""
    if not delays:
        return None
    laps, measured = sum(d.laps for d in delays), sum(d.measured for d in delays)
    words = [
        "The delay from a movement of the hand to the picture of what came of it, as the participants' "
        "browsers measured it; medians over laps. A mode whose laps are delayed more feels worse than it is."
    ]
    words += unequal_delays(delays)
    if measured < laps:
        words.append(f"Of {laps - measured:,} of {laps:,} guided laps the delay isn't known.")
    rows = tuple(
        (
            one_line(d.mode),
            f"{d.laps:,}",
            _number(d.latency_median_ms, 0, " ms"),
            _number(d.latency_p95_ms, 0, " ms"),
            _number(d.frame_rate_hz, 0, " Hz"),
            _number(d.skipped_percent, 2, " %"),
        )
        for d in delays
    )
    columns = ("Mode", "Guided laps", "Delay, median", "Delay, 95th percentile", "Frames", "Ticks skipped")
    table = Table(columns, (False, *([True] * 5)), rows, "delay.csv")
    return Section("Input delay", (), "", "", table, words=tuple(words))


def exclusion_section(excluded: LagExclusion | None) -> Section | None:
    """What leaving out the laggy comparisons changed."""
    if excluded is None:
        return None
    left, total = len(excluded.comparisons), excluded.total
    words = [
        f"Comparisons with a guided lap that has {excluded.limits.sentence}, under either mode, are left out "
        f"of the answers and of the stuck rates: {left:,} of {total:,}."
    ]
    if excluded.unmeasured:
        words.append(f"Of {excluded.unmeasured:,} of them nothing was measured; these stay.")
    if left:
        words.append("Worth and chance to rank first, with them and without:")
    table = changes_table(excluded.changes, "lag.csv") if left else None
    return Section("Without the laggy comparisons", (), "", "", table, words=tuple(words))


def checks_section(shares: Sequence[CheckShare]) -> Section | None:
    """Who said "about the same" of a mode and itself."""
    if not shares:
        return None
    answers, same = sum(s.answers for s in shares), sum(s.same for s in shares)
    words = [
        "In an attention check A and B are one mode, so “about the same” is the answer to expect; small "
        f"differences from lap to lap may be felt nevertheless. {same:,} of {answers:,} answers "
        f"({percent(same / answers)} %) said so."
    ]
    few = [s for s in shares if s.participant and s.share < FEW_SAME]
    if few:
        names = listed([isolated(s.participant) for s in few[:6]])
        more = f" and {len(few) - 6} more" if len(few) > 6 else ""
        words.append(f"Fewer than half of theirs: {names}{more}. Nobody is left out for it.")
    rows = tuple(
        (one_line(s.participant) or "unknown", f"{s.answers:,}", f"{s.same:,}", f"{percent(s.share)} %")
        for s in shares
    )
    columns = ("Participant", "Answers to checks", "About the same", "Share")
    table = Table(columns, (False, True, True, True), rows, "checks.csv")
    return Section("Attention checks", (), "", "", table, words=tuple(words))


def _number(value: float, digits: int, unit: str) -> str:
    return "" if isnan(value) else f"{value:.{digits}f}{unit}"
