"""The atlas in words and numbers: the same cells for its page, the console and the terminal."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from sim_trials.mode_atlas import Curve, ModeCurves
    from sim_trials.mode_laps import ModeLaps
    from sim_trials.modes.method import Method, ResolvedMode

SHOWN_SIGMA = (0.2, 0.1, 0.02)
"""Where the curves are read off: a little within the usual threshold, halfway, and next to the lock."""
CURVES_SAY = (
    "The arm is stretched step by step from the start of the lap. Each mode is asked for 0.1 m/s along the"
    " one direction that the elbow-lock takes away: into the lock (in) and out of it (out). Its gain is what"
    " it gives of that. Every gain is also said as the damping \u03bb of damped least squares that would give"
    " the same, so that filters and limits can be compared with dampings. \u03c3 is the smallest singular"
    " value, in m and rad."
)
LAPS_SAY = (
    "Simulated people, not real ones: first laps of {n} simulated operators, the same for each mode, and one"
    " lap that a scripted hand guides live. Joint speed is the fastest joint's highest, as a share of its"
    " limit; the robot stops itself at 0.98. Edge force is the hand's pull on the edge that leads to the"
    " lock; exit gain is what the robot gives of the way out. Chatter counts jumps of the command to and fro"
    " that the robot cannot follow. {n} laps tell endings apart, not small differences."
)


@dataclass(frozen=True)
class Cells:
    """A table: its head, its rows, and which columns are numbers."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: tuple[int, ...]


def curves_table(curves: "Sequence[ModeCurves]") -> Cells:
    """Two rows a mode, into the lock and out of it, and what a call costs."""
    head = (
        "Mode",
        "Way",
        *(f"Gain at \u03c3 {sigma:g}" for sigma in SHOWN_SIGMA),
        *(f"\u03bb at \u03c3 {sigma:g}" for sigma in SHOWN_SIGMA),
        "Fastest joint",
        "A call",
    )
    rows = []
    for mode in curves:
        at = [int(np.argmin(np.abs(mode.sigma - sigma))) for sigma in SHOWN_SIGMA]
        name, cost = mode.mode.name, f"{mode.cost_ns / 1000:.1f} \u00b5s"
        rows.append((name, "in", *_row(mode.towards, at), cost))
        rows.append((name, "out", *_row(mode.away, at), ""))
    return Cells(head, tuple(rows), tuple(range(2, len(head))))


def _row(curve: "Curve", at: Sequence[int]) -> tuple[str, ...]:
    dampings = [float(curve.damping[k]) for k in at]
    return (
        *(f"{curve.gain[k]:.3f}" for k in at),
        *("\u221e" if np.isinf(value) else f"{value:.2f}" for value in dampings),
        f"{100 * curve.joint_speed.max():.0f} %",
    )


def laps_table(laps: "Sequence[ModeLaps]") -> Cells:
    """A row a mode: how its laps ended and what they were like."""
    head = (
        "Mode",
        "Done",
        "Stuck",
        "Ended otherwise",
        "Joint speed",
        "Edge force [N]",
        "Exit gain",
        "Chatter [1/s]",
        "Live lap",
    )
    rows = tuple(
        (
            lap.name,
            _count(lap, "completed"),
            _count(lap, "stuck"),
            _count(lap, "failed", "abandoned"),
            f"{lap.peak_joint_speed:.2f}",
            _number(lap.mean("force_edge_n"), 1),
            _number(lap.mean("gain_exit"), 2),
            _number(lap.mean("chatter_hz"), 2),
            f"{_ENDINGS[lap.live_outcome]} {lap.live_duration_s:.0f}\u00a0s",
        )
        for lap in laps
    )
    return Cells(head, rows, tuple(range(1, 8)))


_ENDINGS = {
    "completed": "done in",
    "stuck": "stuck after",
    "abandoned": "given up after",
    "failed": "stopped after",
}


def verdicts(laps: "Sequence[ModeLaps]") -> tuple[str, ...]:
    """Whether laps can be done, a sentence each for those modes of which there is something to say."""
    done = [lap.name for lap in laps if lap.can_be_done]
    said = [f"{lap.name}: {lap.verdict}." for lap in laps if lap.name not in done]
    return (*said, f"Laps are done under {', '.join(done)}.") if done else tuple(said)


def _count(laps: "ModeLaps", *outcomes: str) -> str:
    return f"{sum(lap.outcome in outcomes for lap in laps.laps)} of {len(laps.laps)}"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if value == value else "\u2013"


def by_method(modes: "Sequence[ResolvedMode]") -> "tuple[tuple[ResolvedMode, ...], ...]":
    """Modes that share a method together, in the order of their first ones."""
    found: dict[str, list[ResolvedMode]] = {}
    for mode in modes:
        found.setdefault(mode.method.name, []).append(mode)
    return tuple(tuple(alike) for alike in found.values())


def names(modes: "Sequence[ResolvedMode]") -> str:
    """What modes of one method are called, where that says more than the method's name."""
    return ", ".join(mode.name for mode in modes if mode.name != mode.method.name)


def parameters_table(modes: "Sequence[ResolvedMode]") -> Cells:
    """A row a parameter: its value in each of the modes of one method, its range and what it means."""
    rows = tuple(
        (
            parameter.name,
            *(f"{mode.values[k]:g} {parameter.unit}".strip() for mode in modes),
            f"{parameter.low:g} to {parameter.high:g} {parameter.unit}".strip(),
            parameter.meaning,
        )
        for k, parameter in enumerate(modes[0].method.parameters)
    )
    head = ("Parameter", *(mode.name for mode in modes), "Range", "Meaning")
    return Cells(head, rows, tuple(range(1, len(modes) + 2)))


def claims(method: "Method") -> str:
    """What the method says of itself and the tests hold it to, in a line."""
    return ", ".join(sorted(str(claim).replace("_", " ") for claim in method.properties)) or "none"
