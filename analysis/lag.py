"""Input delay: how promptly the robot followed the hand, and what laggy comparisons change."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from analysis.results import Fit
from data.errors import InputError
from data.responses import LagTable, ResponseTable, StuckTable


@dataclass(frozen=True)
class ModeDelay:
    """Input delay in the guided laps of one mode; medians over laps, NaN where nothing was measured.

    Attributes
    ----------
    laps, measured : int
        Guided laps, and those whose delay is known.
    latency_median_ms, latency_p95_ms : float
        Of the laps' medians, and of their 95th percentiles [ms].
    frame_rate_hz : float
        Of the page [Hz].
    skipped_percent : float
        Control ticks that were skipped, of all ticks.
    """

    mode: str
    laps: int
    measured: int
    latency_median_ms: float
    latency_p95_ms: float
    frame_rate_hz: float
    skipped_percent: float


@dataclass(frozen=True)
class LagLimits:
    """When a guided lap is laggy; None sets no limit.

    Attributes
    ----------
    latency_ms : float or None
        Most that its ``latency_p95_ms`` may be.
    skipped_percent : float or None
        Most of its ticks that may be skipped.
    """

    latency_ms: float | None = None
    skipped_percent: float | None = None

    @property
    def is_set(self) -> bool:
        """Whether there is any limit."""
        return self.latency_ms is not None or self.skipped_percent is not None

    @property
    def sentence(self) -> str:
        """What makes a lap laggy, in words."""
        said = []
        if self.latency_ms is not None:
            said.append(f"a 95th percentile of the input delay above {self.latency_ms:g} ms")
        if self.skipped_percent is not None:
            said.append(f"more than {self.skipped_percent:g} % of its ticks skipped")
        return " or ".join(said)


@dataclass(frozen=True)
class LagChange:
    """One mode on one question, with some answers and without; NaN where there is no ranking."""

    question: str
    mode: str
    worth_with: float
    worth_without: float
    p_best_with: float
    p_best_without: float


@dataclass(frozen=True)
class LagExclusion:
    """The comparisons that a report leaves out because of lag, and what that changes.

    Attributes
    ----------
    comparisons : tuple of str
        Those with answers that are left out.
    total : int
        Comparisons with answers, in all.
    unmeasured : int
        Comparisons that stay although nothing is known of their lag.
    changes : tuple of LagChange
        Question by question, mode by mode.
    """

    limits: LagLimits
    comparisons: tuple[str, ...]
    total: int
    unmeasured: int
    changes: tuple[LagChange, ...] = ()


@dataclass(frozen=True)
class PromptEvidence:
    """Responses and stuck comparisons without the laggy ones."""

    table: ResponseTable
    stuck: StuckTable | None
    excluded: LagExclusion


def mode_delays(table: LagTable, modes: Sequence[str]) -> tuple[ModeDelay, ...]:
    """Input delay of every mode that was guided, in the order of ``modes``."""
    by_mode = {mode: table.rows[table.rows["mode"] == mode] for mode in modes}
    return tuple(_delay(mode, rows) for mode, rows in by_mode.items() if len(rows))


def _delay(mode: str, rows: pd.DataFrame) -> ModeDelay:
    known = rows.dropna(subset=["ticks", "skipped_ticks"])
    ticks = float(known["ticks"].sum())
    return ModeDelay(
        mode,
        laps=len(rows),
        measured=int(rows["latency_p95_ms"].notna().sum()),
        latency_median_ms=float(rows["latency_median_ms"].median()),
        latency_p95_ms=float(rows["latency_p95_ms"].median()),
        frame_rate_hz=float(rows["frame_rate_hz"].median()),
        skipped_percent=100.0 * float(known["skipped_ticks"].sum()) / ticks if ticks else math.nan,
    )


def without_laggy(
    table: ResponseTable, stuck: StuckTable | None, lag: LagTable, limits: LagLimits
) -> PromptEvidence:
    """Leave out every comparison with a laggy lap, under either of its modes.

    What was not measured is not laggy.

    Raises
    ------
    InputError
        If no answer would be left.
    """
    answered = list(dict.fromkeys(table.rows.loc[~table.rows["check"].astype(bool), "comparison"]))
    laggy = set(_laggy(lag.rows, limits))
    out = tuple(name for name in answered if name in laggy)
    if answered and len(out) == len(answered):
        raise InputError(f"all {len(answered)} comparisons have a lap with {limits.sentence}: none is left")
    known = set(lag.rows.loc[_is_measured(lag.rows, limits), "comparison"])
    excluded = LagExclusion(limits, out, len(answered), sum(name not in known for name in answered))
    return PromptEvidence(table.without(laggy), None if stuck is None else stuck.without(laggy), excluded)


def _laggy(rows: pd.DataFrame, limits: LagLimits) -> "pd.Series[str]":
    """The comparisons of laps beyond a limit; comparing with NaN is False."""
    is_laggy = pd.Series(False, index=rows.index)
    if limits.latency_ms is not None:
        is_laggy |= rows["latency_p95_ms"] > limits.latency_ms
    if limits.skipped_percent is not None:
        is_laggy |= 100.0 * rows["skipped_ticks"] > limits.skipped_percent * rows["ticks"]
    return rows.loc[is_laggy, "comparison"]


def _is_measured(rows: pd.DataFrame, limits: LagLimits) -> "pd.Series[bool]":
    """Laps of which everything is known that a limit is about."""
    is_known = pd.Series(True, index=rows.index)
    if limits.latency_ms is not None:
        is_known &= rows["latency_p95_ms"].notna()
    if limits.skipped_percent is not None:
        is_known &= rows["skipped_ticks"].notna() & rows["ticks"].notna()
    return is_known


def lag_changes(everything: Fit, prompt: Fit) -> tuple[LagChange, ...]:
    """Worth and chance to rank first, in a fit of all answers and in one without some of them."""
    changes = []
    for with_them, without in zip(everything.questions, prompt.questions, strict=True):
        before = {m.mode: m for m in with_them.modes}
        after = {m.mode: m for m in without.modes}
        for mode in everything.modes:
            old, new = before.get(mode), after.get(mode)
            changes.append(
                LagChange(
                    with_them.question.name,
                    mode,
                    old.worth_mean if old else math.nan,
                    new.worth_mean if new else math.nan,
                    old.p_best if old else math.nan,
                    new.p_best if new else math.nan,
                )
            )
    return tuple(changes)
