"""The paper's checkable claims, each beside what came out here."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from sim_trials.reproductions.beaudoin2022.robot import ARM, START, B, link_state
from sim_trials.reproductions.beaudoin2022.shell import SHELLS, translation_matrix
from sim_trials.reproductions.beaudoin2022.strategies import (
    DAMPED,
    STRATEGIES,
    TRANSPOSE,
    VARIABLE,
    inverse_of,
)
from sim_trials.reproductions.beaudoin2022.trajectory import HARMONICS
from sim_trials.reproductions.chain import posture
from sim_trials.reproductions.solvers import damped_least_squares, jacobian_transpose, variable_damping
from sim_trials.reproductions.verdict import Judgement, Verdict, judge, percent

CONFIGURATIONS = 50
CLOSE_DEG = 2.0
"""How near a figure read off a curve ("about") must be."""
FEW_DEG = 5.0
PUBLISHED_LARGEST_DEG = {DAMPED: 13.0, VARIABLE: 13.0, TRANSPOSE: 25.0}
LEVERS_M = tuple(share * B[2] for share in (0.25, 0.5, 0.75, 1.0))
"""Places of the shell along link 3: the paper gives none."""
Angles = pd.DataFrame


def verdicts_of(angles: pd.DataFrame, readings: list[str]) -> tuple[Verdict, ...]:
    """Judge every claim; ``angles`` as `experiment.angle_table` makes it."""
    return (*_of_the_geometry(), *_of_the_equations(), *_of_the_curves(angles, readings))


def turned(phi: float) -> np.ndarray:
    """Joint angles with joint 2 turned by ``phi`` [rad] from the start, towards the shell's motion."""
    q = START.copy()
    q[1] -= phi
    return q


def angle_deg(strategy: str, phi: float, damping_squared: float = 0.1, lever_m: float = LEVERS_M[1]) -> float:
    """psi of one strategy for a velocity in the optimal direction, joint 2 turned by ``phi`` [rad]."""
    J = link_state(turned(phi), 3, lever_m).jacobian
    rates = inverse_of(strategy, damping_squared)(translation_matrix(SHELLS[0], J), np.array([0.0, 1.0]))
    v = J[3:, :2] @ rates
    return float(np.degrees(np.arctan2(np.hypot(v[0], v[2]), v[1])))


def _fall_share(strategy: str, turn: float, damping_squared: float) -> float:
    """How far psi falls from its peak by the time joint 2 has turned by ``turn`` [rad], as a share."""
    psi = [angle_deg(strategy, phi, damping_squared) for phi in np.linspace(0.0, turn, 61)]
    return float(1.0 - psi[-1] / max(psi))


def _of_the_geometry() -> tuple[Verdict, ...]:
    start, end = (
        max(angle_deg(s, phi, lever_m=lever) for s in STRATEGIES for lever in LEVERS_M)
        for phi in (0.0, np.pi / 2)
    )
    still, turning = (
        max(_moment_off_axis(lever, turns_joint_3) for lever in LEVERS_M) for turns_joint_3 in (False, True)
    )
    first = max(_motion_off_direction(lever) for lever in LEVERS_M)
    peaks = [
        {s: max(range(91), key=lambda k: angle_deg(s, np.radians(k), lever_m=lever)) for s in STRATEGIES}
        for lever in LEVERS_M
    ]
    ratio = [(h.speed_m_s, h.acceleration_m_s2) for h in HARMONICS]
    factors = [v / r for h in ratio[1:] for v, r in zip(h, ratio[0], strict=True)]
    return (
        _said("psi in the initial configuration (6.3)", "0 deg", f"{start:.1e} deg", start < 1e-6),
        Verdict(
            "A force in the optimal direction turns link 3 about joint 2 alone, in any configuration (6.3)",
            "no other moment about joint 2's centre",
            f"share off the axis in {CONFIGURATIONS} random configurations at most {still:.0e} with joint 3 "
            f"as at the start, {turning:.2f} with joint 3 turned, which turns the direction with the link",
            "joint 3 stays where it is at the start, as it does in the trajectories",
            judge([still < 1e-9, turning < 1e-9], "joint 3"),
        ),
        _said(
            "... and about joint 1 alone in the initial configuration (6.3)",
            "no other moment",
            "joint 1 moves the shell's point along the force and no other way: sine of the angle "
            f"{first:.1e}",
            first < 1e-9,
        ),
        _said("psi when joint 2 has turned by 90 deg (6.3)", "0 deg", f"{end:.1e} deg", end < 1e-6),
        _said(
            "psi of the transpose peaks at a larger angle of joint 2 than the others' (6.3, which prints "
            "theta_1)",
            "later",
            "shell at 1/4, 1/2, 3/4 and the end of link 3: "
            + ", ".join(f"{s} {'/'.join(str(p[s]) for p in peaks)} deg" for s in STRATEGIES),
            all(p[TRANSPOSE] > max(p[DAMPED], p[VARIABLE]) for p in peaks),
        ),
        _said(
            "Speed and acceleration of trajectories 2 and 3 against trajectory 1 (6.3)",
            "x5, x5; x3, x9",
            "; ".join(f"x{a:.3g}, x{b:.3g}" for a, b in zip(factors[::2], factors[1::2], strict=True)),
            np.allclose(factors, [5, 5, 3, 9]),
        ),
    )


def _of_the_equations() -> tuple[Verdict, ...]:
    rng = np.random.default_rng(2022)
    gap = left = 0.0
    for _ in range(200):
        J, t = rng.standard_normal((2, 2)), rng.standard_normal(2)
        one = damped_least_squares.step(J, t, np.sqrt(0.1))
        gap = max(gap, float(np.abs(one - damped_least_squares.spectral_step(J, t, np.sqrt(0.1))).max()))
        moved = J @ jacobian_transpose.step(J, t)
        left = max(left, abs(float(moved @ (t - moved))))
    printed = float(variable_damping.printed_damping_squared(np.zeros(1), np.sqrt(0.1))[0])
    return (
        _said(
            "Eqs. (9) and (19) give the same joint velocities (6)",
            "equal",
            f"differ by {gap:.0e}",
            gap < 1e-12,
        ),
        _said(
            "Eq. (13) is the length of the transpose step that leaves the least error (3.4)",
            "smallest residual",
            f"residual orthogonal to the motion to {left:.0e}",
            left < 1e-10,
        ),
        _said(
            "Eq. (29) as printed: lambda is the largest damping, met at a singular value of 0",
            "lambda_i^2 = +0.1 at sigma_i = 0",
            f"lambda_i^2 = {printed:+.1f}: negative for every sigma_i < 1",
            printed > 0,
        ),
    )


def _of_the_curves(angles: Angles, readings: list[str]) -> tuple[Verdict, ...]:
    cells = angles.set_index(["reading", "trajectory", "strategy"])
    psi = cells["psi_max_deg"]
    numbers = range(len(readings))

    def each(holds: Callable[[int], bool]) -> list[bool]:
        return [holds(r) for r in numbers]

    def apart(r: int) -> float:
        return max(float(abs(psi[r, t, DAMPED] - psi[r, t, VARIABLE])) for t in (1, 2, 3))

    def gap(r: int, t: int) -> float:
        return float(psi[r, t, TRANSPOSE] - max(psi[r, t, DAMPED], psi[r, t, VARIABLE]))

    def ratio(r: int) -> float:
        return float(psi[r, 2, TRANSPOSE] / max(psi[r, 2, DAMPED], psi[r, 2, VARIABLE]))

    def met(r: int, t: int, limit: str) -> list[bool]:
        return [bool(cells.loc[(r, t, s), limit]) for s in STRATEGIES]

    def within(r: int) -> bool:
        return not any(met(r, 1, "reaches_speed_limit") + met(r, 1, "reaches_shell_limit"))

    def beyond(r: int) -> bool:
        robot = ("reaches_speed_limit", "reaches_acceleration_limit")
        return all(
            any(any(met(r, t, limit)) for limit in robot) and any(met(r, t, "reaches_shell_limit"))
            for t in (2, 3)
        )

    fall, joint_2 = cells["fall_share"], cells["joint_2_largest_deg"]

    def steadier(r: int) -> bool:
        others = min(fall[r, 2, DAMPED], fall[r, 2, VARIABLE])
        return bool(others > 0.1 and fall[r, 2, TRANSPOSE] < 0.5 * others)

    limited = [i for i in numbers if "no limits" not in readings[i]]
    turn = np.radians(60.0)
    still = {d: [_fall_share(s, turn, d) for s in STRATEGIES] for d in (0.01, 0.1)}
    turning = [f"link 3 turns back at 60 deg, lambda^2 = {d:g}, no limits, shell mid-link" for d in still]
    largest = ", ".join(f"{s} {psi[0, 2, s]:.1f} deg" for s in STRATEGIES)
    letter = ", ".join(f"{s} {psi[2, 2, s]:.1f} deg" for s in STRATEGIES)
    return (
        _over(
            "Fig. 6 (trajectory 2): largest psi about 13 deg, slightly over 25 deg for the transpose",
            "13, 13, 25 deg",
            f"{largest}; as printed (lambda^2 = 0.1, limits on): {letter}",
            each(lambda r: all(abs(psi[r, 2, s] - p) <= CLOSE_DEG for s, p in PUBLISHED_LARGEST_DEG.items())),
            readings,
        ),
        _over(
            "Damped pseudo-inverse and variable damping differ by a few degrees at most (figs. 5-7)",
            f"a few degrees (taken as {FEW_DEG:g})",
            f"largest difference {apart(0):.1f} deg",
            each(lambda r: apart(r) <= FEW_DEG),
            readings,
        ),
        _over(
            "The transpose has the largest psi in all three trajectories (figs. 5-7)",
            "larger",
            "larger by " + ", ".join(f"{gap(0, t):.1f}" for t in (1, 2, 3)) + " deg",
            each(lambda r: all(gap(r, t) > 0 for t in (1, 2, 3))),
            readings,
        ),
        _over(
            "... by only a few degrees in trajectories 1 and 3 (figs. 5, 7)",
            f"a few degrees (taken as {FEW_DEG:g})",
            f"{gap(0, 1):.1f} and {gap(0, 3):.1f} deg",
            each(lambda r: all(0 < gap(r, t) <= FEW_DEG for t in (1, 3))),
            readings,
        ),
        _over(
            "... about double in trajectory 2 (fig. 6)",
            "x2",
            f"x{ratio(0):.2f}; as printed x{ratio(2):.2f}",
            each(lambda r: 1.6 <= ratio(r) <= 2.4),
            readings,
        ),
        _over(
            "Trajectories 1 and 3 look alike (figs. 5, 7)",
            "similar angles",
            "largest psi "
            + ", ".join(f"{psi[0, 1, s]:.1f}/{psi[0, 3, s]:.1f}" for s in STRATEGIES)
            + " deg without limits; as printed "
            + ", ".join(f"{psi[2, 1, s]:.1f}/{psi[2, 3, s]:.1f}" for s in STRATEGIES),
            each(lambda r: all(abs(psi[r, 1, s] - psi[r, 3, s]) <= CLOSE_DEG for s in STRATEGIES)),
            readings,
        ),
        _over(
            "psi oscillates near the change of direction, much less so for the transpose (fig. 6)",
            "falls back for two strategies, much less for the transpose",
            "falls from its peak up to the first change of direction, were it at 60 deg: "
            + ", ".join(f"{s} {percent(f)}" for s, f in zip(STRATEGIES, still[0.01], strict=True))
            + "; in the run as printed: "
            + ", ".join(f"{s} {percent(fall[2, 2, s])}" for s in STRATEGIES),
            [*(min(f[:2]) > 0.1 and f[2] < 0.5 * min(f[:2]) for f in still.values()), *each(steadier)],
            [*turning, *readings],
        ),
        _over(
            "Joint 2 turns by less than 90 deg in trajectory 2 (6.3)",
            "below 90 deg",
            f"{joint_2.loc[0, 2].max():.0f} deg; as printed {joint_2.loc[2, 2].max():.0f} deg",
            each(lambda r: bool(joint_2.loc[r, 2].max() < 90.0)),
            readings,
        ),
        _over(
            "Trajectory 1 stays within the limits of joints and shell (6.3)",
            "no limit met",
            f"no limit met under {sum(within(i) for i in limited)} of {len(limited)} readings with limits",
            [within(i) for i in limited],
            [readings[i] for i in limited],
        ),
        _over(
            "Trajectories 2 and 3 reach limits of the robot (speed or acceleration) and of the shell (6.3)",
            "both met",
            f"both met under {sum(beyond(i) for i in limited)} of {len(limited)} readings with limits",
            [beyond(i) for i in limited],
            [readings[i] for i in limited],
        ),
        Verdict(
            "A user would feel the difference of 12 deg (6.3, future work)",
            "left open",
            "no simulation can tell",
            "",
            Judgement.NOT_DETERMINABLE,
        ),
    )


def _said(claim: str, published: str, ours: str, holds: bool) -> Verdict:
    return Verdict(claim, published, ours, "", judge(bool(holds)))


def _over(claim: str, published: str, ours: str, holds: list[bool], readings: list[str]) -> Verdict:
    """Judge by the readings that keep to the text; those against it are named where they alone fit."""
    kept = [(held, words) for held, words in zip(holds, readings, strict=True) if _keeps_to_the_text(words)]
    against = [
        words for held, words in zip(holds, readings, strict=True) if held and not _keeps_to_the_text(words)
    ]
    fitting = [words for held, words in kept if held]
    said = f"holds under {len(fitting)} of {len(kept)} readings that keep to the text"
    if fitting and len(fitting) < len(kept):
        said += f", first: {fitting[0]}"
    if not fitting and against:
        said += f"; against it (lambda^2 = 0.1, limits on) it holds with: {against[0]}"
    said += f". {_IN_ALL}"
    return Verdict(claim, published, ours, said, judge([held for held, _ in kept], said))


_IN_ALL = "Assumed in all: p_max = 50 mm, 500 steps a second, no angle while the shell or the link turns back"


def _keeps_to_the_text(reading: str) -> bool:
    """The paper says lambda^2 = 0.1 and limits on; what it leaves open may be anything."""
    return "lambda^2 = 0.1," in reading and "no limits" not in reading


def _moment_off_axis(lever_m: float, turns_joint_3: bool) -> float:
    """How much of the moment of a force in the optimal direction about joint 2's centre is off its axis.

    The largest share in random configurations.
    """
    rng = np.random.default_rng(22)
    shares = []
    for _ in range(CONFIGURATIONS):
        q = rng.uniform(-np.pi, np.pi, 5)
        if not turns_joint_3:
            q[2] = START[2]
        state, axis = link_state(q, 3, lever_m), posture(ARM, q).axes[1]
        moment = np.cross(lever_m * state.rotation[:, 2], state.rotation[:, 1])
        shares.append(np.linalg.norm(np.cross(moment, axis)) / np.linalg.norm(moment))
    return float(max(shares))


def _motion_off_direction(lever_m: float) -> float:
    """How much of the velocity that joint 1 gives the shell's point at the start is off the direction."""
    v = link_state(START, 3, lever_m).jacobian[3:, 0]
    return float(np.hypot(v[0], v[2]) / np.linalg.norm(v))
