"""Three drawings of a calibration: rank histograms, ECDF differences and coverages, each with its bands."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import binom

from analysis.calibration.uniformity import (
    DRAWS_RANKED,
    FALSE_ALARM,
    LEVELS,
    Coverage,
    ecdf,
    ecdf_band,
    ecdf_limit,
)
from analysis.figures.style import (
    DATA,
    DATA_2,
    INK,
    INK_3,
    LINE,
    LINE_STRONG,
    SUNKEN,
    SURFACE,
    WIDTH_PX,
    Drawing,
    finish,
    house_style,
    new_figure,
    place_axes,
    write_text,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from analysis.calibration import Calibration

_BINS = 20
_COLUMNS = 4
_TITLE_PX, _GAP_PX, _FOOT_PX = 60.0, 22.0, 24.0
_PANEL_PX = 84.0
_TAG = "simulated for calibration"
ALARM = "#A23B2A"
"""What lies outside: red, and marked by shape or word too."""


def draw_calibration(result: "Calibration") -> tuple[Drawing, ...]:
    """Rank histograms, ECDF differences and coverages, in this order."""
    return draw_rank_histograms(result), draw_ecdf_differences(result), draw_coverage(result)


def draw_rank_histograms(result: "Calibration") -> Drawing:
    """A histogram of 20 bins a quantity: flat if calibrated."""
    n = len(result.converged)
    tail = FALSE_ALARM / 2 / _BINS
    low, high = binom.ppf(tail, n, 1 / _BINS), binom.isf(tail, n, 1 / _BINS)
    bins = {
        name: np.bincount(r * _BINS // (DRAWS_RANKED + 1), minlength=_BINS)
        for name, r in result.ranks.items()
    }
    top = 1.2 * max(high, *(float(b.max()) for b in bins.values()))

    def panel(axes: "Axes", name: str) -> None:
        axes.set_xlim(0, _BINS)
        axes.set_ylim(0, top)
        axes.axhspan(low, high, color=SUNKEN, linewidth=0, zorder=0)
        axes.axhline(n / _BINS, color=LINE_STRONG, linewidth=0.9, zorder=1)
        axes.bar(np.arange(_BINS) + 0.5, bins[name], width=0.86, color=DATA_2, zorder=2)
        axes.set_xticks([0, _BINS], ["0", str(DRAWS_RANKED)])
        axes.set_yticks([0, n / _BINS], ["0", f"{n / _BINS:.3g}"])

    return _panels(
        result,
        "rank_histograms",
        f"Rank of the true value among {DRAWS_RANKED} posterior draws",
        f"{n} replicates; the grey band holds all 20 bars of a calibrated quantity in 99 % of cases",
        panel,
    )


def draw_ecdf_differences(result: "Calibration") -> Drawing:
    """ECDF of the ranks less that of uniform ranks, in its simultaneous band."""
    n, limit = len(result.converged), ecdf_limit(len(result.uniformities))
    band = ecdf_band(n, limit)
    outside = {check.parameter for check in result.uniformities if not check.inside}
    differences = {name: ecdf(ranks) - band.at for name, ranks in result.ranks.items()}
    reach = 1.1 * max(
        float((band.high - band.at).max()), *(float(np.abs(d).max()) for d in differences.values())
    )

    def panel(axes: "Axes", name: str) -> None:
        axes.set_xlim(0, 1)
        axes.set_ylim(-reach, reach)
        axes.fill_between(
            band.at, band.low - band.at, band.high - band.at, color=SUNKEN, edgecolor=LINE_STRONG,
            linewidth=0.6, zorder=0,
        )  # fmt: skip
        axes.axhline(0, color=LINE_STRONG, linewidth=0.9, zorder=1)
        colour = ALARM if name in outside else DATA
        at, difference = np.r_[0.0, band.at, 1.0], np.r_[0.0, differences[name], 0.0]
        axes.plot(at, difference, color=colour, linewidth=1.3, zorder=2)
        tick = _tick(reach)
        axes.set_xticks([0, 1], ["0", "1"])
        axes.set_yticks([-tick, 0, tick], [f"−{tick:g}", "0", f"{tick:g}"])

    return _panels(
        result,
        "ecdf_differences",
        "ECDF of the ranks less the uniform one",
        f"{n} replicates; a calibrated engine leaves one of the {len(result.uniformities)} bands with a "
        f"chance of {100 * FALSE_ALARM / 2:g} %",
        panel,
        marked=outside,
    )


def draw_coverage(result: "Calibration") -> Drawing:
    """Coverage of each level by quantity, as the difference from what is said, in its band."""
    n, names = len(result.converged), list(result.ranks)
    by_name = {(c.parameter, c.level): c for c in result.coverages}
    reach = 1.1 * max(
        *(
            max(c.band_high - c.level, c.level - c.band_low, abs(c.coverage - c.level))
            for c in result.coverages
        ),
        0.01,
    )
    left, row = 116.0, 21.0
    width = (WIDTH_PX - left - _GAP_PX * (len(LEVELS) - 1) - 8) / len(LEVELS)
    height = row * len(names)
    with house_style():
        figure = new_figure(_TITLE_PX + 22 + height + 46)
        write_text(figure, 0, 16, "How often central intervals hold the true value", color=INK, weight="bold")
        write_text(
            figure, 0, 35,
            f"{n} replicates; difference in percentage points; a calibrated engine leaves one of the "
            f"{len(result.coverages)} bands with a chance of at most {100 * FALSE_ALARM / 2:g} %",
            fontsize=8.2,
        )  # fmt: skip
        for k, name in enumerate(names):
            write_text(figure, 0, _TITLE_PX + 22 + row * (k + 0.5) + 3.5, name, color=INK)
        for column, level in enumerate(LEVELS):
            x = left + column * (width + _GAP_PX)
            write_text(
                figure,
                x + width / 2,
                _TITLE_PX + 12,
                f"{100 * level:.0f} %",
                ha="center",
                color=INK,
                weight="bold",
            )
            axes = place_axes(figure, x, _TITLE_PX + 22, width, height)
            axes.set_xlim(-reach, reach)
            axes.set_ylim(len(names), 0)
            tick = _tick(reach)
            axes.set_yticks([])
            axes.set_xticks([-tick, 0, tick], [f"−{100 * tick:g}", "0", f"+{100 * tick:g}"])
            axes.axvline(0, color=LINE_STRONG, linewidth=0.9, zorder=1)
            for k, name in enumerate(names):
                _draw_coverage(axes, k + 0.5, by_name[name, level])
        said = ", ".join(
            f"{name} {'/'.join(f'{100 * by_name[name, level].coverage:.0f}' for level in LEVELS)}"
            for name in names
        )
        levels = "/".join(f"{100 * level:.0f}" for level in LEVELS)
        return finish(figure, "coverage", f"Coverage of {levels} % intervals in per cent: {said}.", _TAG)


def _draw_coverage(axes: "Axes", y: float, check: Coverage) -> None:
    low, high = check.band_low - check.level, check.band_high - check.level
    axes.barh(
        [y], [high - low], left=[low], height=0.62, color=SUNKEN, edgecolor=LINE, linewidth=0.6, zorder=0
    )
    axes.plot(
        [check.coverage - check.level], [y], linestyle="none", marker="o" if check.inside else "X",
        markersize=5.6 if check.inside else 7.5, markeredgewidth=1.4, zorder=3,
        markerfacecolor=SURFACE if check.inside else ALARM, color=DATA if check.inside else ALARM,
    )  # fmt: skip


def _panels(
    result: "Calibration",
    name: str,
    title: str,
    subtitle: str,
    panel: Callable[["Axes", str], None],
    marked: set[str] | frozenset[str] = frozenset(),
) -> Drawing:
    """A panel a quantity, four in a row."""
    names = list(result.ranks)
    rows = math.ceil(len(names) / _COLUMNS)
    left, head = 36.0, 20.0
    pitch_x = (WIDTH_PX + 2) / _COLUMNS
    pitch_y = head + _PANEL_PX + _FOOT_PX + 8
    with house_style():
        figure = new_figure(_TITLE_PX + rows * pitch_y + 8)
        write_text(figure, 0, 16, title, color=INK, weight="bold")
        write_text(figure, 0, 35, subtitle, fontsize=8.2)
        for k, quantity in enumerate(names):
            x = (k % _COLUMNS) * pitch_x
            y = _TITLE_PX + (k // _COLUMNS) * pitch_y
            is_marked = quantity in marked
            write_text(
                figure, x + left, y + 12, f"{quantity}: outside" if is_marked else quantity,
                color=ALARM if is_marked else INK,
            )  # fmt: skip
            axes = place_axes(figure, x + left, y + head, pitch_x - left - 12, _PANEL_PX)
            axes.tick_params(labelsize=7.6, labelcolor=INK_3)
            panel(axes, quantity)
        shapes = "; ".join(f"{u.parameter} p {u.p_value:.2g}" for u in result.uniformities)
        return finish(figure, name, f"{title}. Chance of so uneven an ECDF: {shapes}.", _TAG)


def _tick(reach: float) -> float:
    """A round number a little inside an axis of this half-width."""
    return max(t for t in (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8) if t < reach)
