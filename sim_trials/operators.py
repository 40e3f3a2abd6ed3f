"""Simulated people: a hand on the handle that guides the nozzle around the maze.

An operator has in view a point that moves along the line (the carrot), wants the cursor there, and pulls
as if a spring ran from the handle to where the handle would have to be. What stays behind is pulled
harder for. If the cursor hardly gets on for longer than the operator is patient, some go back a little
once, and all then lean the nozzle the way they pull; after a while of good progress they straighten it.

An operator knows the maze, where the cursor was and how the nozzle leant a visual delay ago, where its
own hand is, and the force it feels. It knows nothing of the robot: no mode, no damping, no singular
value, no joint angle. `hand_wrench` shows by its arguments that nothing else gets in.

Where the numbers come from: arm stiffness and signal-dependent noise have the order of magnitude of the
literature below; all distributions are untuned for real people, and were chosen so that simulated
operators complete most laps of the default maze and paint it mostly solid.

References
----------
Mussa-Ivaldi, Hogan, Bizzi (1985), "Neural, mechanical, and geometric factors subserving arm posture in
humans" (stiffness of the hand).
Jones, Hamilton, Wolpert (2002), "Sources of signal-dependent noise during isometric force production".
"""

import math
from dataclasses import dataclass

import numpy as np

from sim_trials.compiled import compiled
from sim_trials.maze import (
    Wall,
    along_edge,
    edge_length,
    edge_start,
    phase,
    point_at,
    reaches_corner,
)
from sim_trials.spring import spring_force, spring_moment

NOISE_CORRELATION_S = 0.05
"""Correlation time of tremor and force noise [s]."""
TREMOR_LEVER_M = 0.05
"""Tremor of the moment per tremor of the force [m]: half the distance between two fists, untuned."""
FORCE_SENSE_S = 0.25
"""Time constant with which the felt force settles into a direction [s], untuned."""
PROGRESS_SENSE_S = 0.4
"""Time constant with which progress is judged [s], untuned."""
POOR_PROGRESS = 0.3
"""Below this share of the wanted speed, an operator thinks it isn't getting on."""
NEAR_LINE_M = 0.06
"""Progress counts only this near the line [m]: sliding past the corner isn't progress."""
RETREAT_M = 0.06
"""How far one goes back for a second try [m], untuned."""
RETREAT_S = 0.8
"""How long that takes [s], untuned."""
SETTLE_S = 0.4
"""From gripping the handle to pressing the blasting trigger [s], untuned."""
START_S = 0.8
"""Time to get up to speed at the start [s], untuned."""
ESCALATION_FADE_S = 4.0
"""Time constant with which extra pull fades once the cursor is where it should be [s], untuned."""


@dataclass(frozen=True)
class Operator:
    """One simulated person.

    Attributes
    ----------
    stiffness_n_m, rotation_stiffness_nm_rad : float
        Of the hand against translation and rotation of the handle.
    force_cap_n, torque_cap_nm : float
        The most this person pulls and twists.
    pace_m_s, look_ahead_m : float
        Speed of the carrot, and how far it may run ahead of the cursor.
    escalation_n_m_s : float
        Growth of the extra pull, per metre that the cursor is off the carrot.
    noise_share, tremor_n : float
        Standard deviation of the force: share of the force itself, and a constant part.
    visual_delay_s : float
        Age of what is seen.
    patience_s, calm_s : float
        Time of poor progress before a reaction, and of good progress before the nozzle is straightened.
    goes_back : bool
        Whether the first reaction is to go back a little and try again.
    tilt_rate_rad_s, tilt_limit_rad : float
        How fast the nozzle is leant, and the most it is leant on purpose.
    habit_tilt_rad, learning : float
        The lean expected to be needed at the right edge, and the share of what is still missing of it
        that one more lap teaches.
    """

    stiffness_n_m: float
    rotation_stiffness_nm_rad: float
    force_cap_n: float
    torque_cap_nm: float
    pace_m_s: float
    look_ahead_m: float
    escalation_n_m_s: float
    noise_share: float
    tremor_n: float
    visual_delay_s: float
    patience_s: float
    calm_s: float
    goes_back: bool
    tilt_rate_rad_s: float
    tilt_limit_rad: float
    habit_tilt_rad: float
    learning: float

    def anticipated_tilt_rad(self, lap: int) -> float:
        """Lean to the right with which this person meets the right edge on a lap, from 1: 0 on the first."""
        return self.habit_tilt_rad * (1.0 - (1.0 - self.learning) ** (lap - 1))


@dataclass
class Mind:
    """What an operator carries from one control tick to the next (compiled code works on its record).

    Attributes
    ----------
    edge, along_m : int, float
        Where the carrot is.
    pull_y_n, pull_z_n : float
        Extra pull built up so far.
    lean_y, lean_z : float
        Lean on purpose, as components of the nozzle's unit vector along the wall.
    felt_y_n, felt_z_n : float
        The force felt, low-passed.
    rate_m_s, seen_m : float
        Progress as judged, and the place on the edge it was last judged at.
    """

    edge: int = 0
    along_m: float = 0.0
    pull_y_n: float = 0.0
    pull_z_n: float = 0.0
    lean_y: float = 0.0
    lean_z: float = 0.0
    felt_y_n: float = 0.0
    felt_z_n: float = 0.0
    rate_m_s: float = 0.0
    seen_m: float = 0.0
    poor_s: float = 0.0
    good_s: float = 0.0
    retreat_s: float = 0.0
    has_gone_back: bool = False
    time_s: float = 0.0
    force_share: float = 0.0


def draw_operator(seed: int) -> Operator:
    """A person at random: the same seed gives the same person."""
    rng = np.random.default_rng([seed, 0x0B])

    def between(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    def around(median: float, spread: float, low: float, high: float) -> float:
        return float(np.clip(median * np.exp(spread * rng.standard_normal()), low, high))

    return Operator(
        stiffness_n_m=between(200.0, 400.0),
        rotation_stiffness_nm_rad=between(10.0, 20.0),
        force_cap_n=around(45.0, 0.35, 20.0, 110.0),
        torque_cap_nm=between(5.0, 10.0),
        pace_m_s=between(0.07, 0.12),
        look_ahead_m=between(0.06, 0.10),
        escalation_n_m_s=between(70.0, 210.0),
        noise_share=between(0.03, 0.08),
        tremor_n=between(0.3, 1.0),
        visual_delay_s=between(0.15, 0.20),
        patience_s=around(1.2, 0.35, 0.4, 4.0),
        calm_s=1.5,
        goes_back=bool(rng.random() < 0.5),
        tilt_rate_rad_s=math.radians(between(4.0, 10.0)),
        tilt_limit_rad=math.radians(between(12.0, 20.0)),
        habit_tilt_rad=math.radians(between(1.0, 4.0)),
        learning=between(0.1, 0.5),
    )


@compiled(None)
def _correlate(noise: np.ndarray, keep: float) -> None:
    """Turn white noise of unit variance into an Ornstein-Uhlenbeck series of unit variance, in place."""
    fresh = math.sqrt(1.0 - keep * keep)
    for k in range(1, noise.shape[0]):
        for i in range(noise.shape[1]):
            noise[k, i] = keep * noise[k - 1, i] + fresh * noise[k, i]


def hand_noise(seed: int, lap: int, ticks: int, dt: float) -> np.ndarray:
    """Unsteadiness of the hand in one lap, without unit, shape (ticks, 6), unit variance per channel.

    It depends on nothing but the arguments, so that modes are compared on the same hand.
    """
    noise = np.random.default_rng([seed, lap, 0x0C]).standard_normal((ticks, 6))
    _correlate(noise, math.exp(-dt / NOISE_CORRELATION_S))
    return noise


@compiled(None)
def _move_carrot(
    operator: Operator, mind: Mind, wall: Wall, cursor_y: float, cursor_z: float, dt: float
) -> None:
    """Move the carrot on; it waits at a corner until the cursor is seen there, and never runs far ahead."""
    length = edge_length(wall, mind.edge)
    if mind.along_m >= length and mind.edge < 3 and reaches_corner(wall, mind.edge, cursor_y, cursor_z):
        mind.edge += 1
        mind.along_m = 0.0
        mind.seen_m = 0.0
        mind.poor_s = 0.0
        length = edge_length(wall, mind.edge)
    along, aside = along_edge(wall, mind.edge, cursor_y, cursor_z)
    pace = operator.pace_m_s * min(1.0, mind.time_s / START_S)
    if mind.retreat_s > 0.0:
        mind.retreat_s -= dt
        mind.along_m = max(mind.along_m - RETREAT_M * dt / RETREAT_S, 0.0)
    else:
        ahead = min(mind.along_m + pace * dt, along + operator.look_ahead_m)
        mind.along_m = min(max(ahead, mind.along_m), length)

    step = along - mind.seen_m if abs(aside) < NEAR_LINE_M else 0.0
    mind.seen_m = along
    mind.rate_m_s += dt / PROGRESS_SENSE_S * (step / dt - mind.rate_m_s)


@compiled(None)
def _react(operator: Operator, mind: Mind, seen_tilt: float, dt: float) -> None:
    """Judge the progress; go back, lean the nozzle along the felt force, or straighten it."""
    if mind.retreat_s > 0.0 or mind.time_s < 2.0 * START_S:
        return
    if mind.rate_m_s < POOR_PROGRESS * operator.pace_m_s:
        mind.poor_s += dt
        mind.good_s = 0.0
    else:
        mind.poor_s = 0.0
        mind.good_s += dt

    turn = operator.tilt_rate_rad_s * dt
    if mind.poor_s > operator.patience_s:
        if operator.goes_back and not mind.has_gone_back:
            mind.has_gone_back = True
            mind.retreat_s = RETREAT_S
            mind.poor_s = 0.0
            mind.pull_y_n = 0.0
            mind.pull_z_n = 0.0
            return
        force = math.hypot(mind.felt_y_n, mind.felt_z_n)
        if force > 0.0 and seen_tilt < operator.tilt_limit_rad:
            mind.lean_y += turn * mind.felt_y_n / force
            mind.lean_z += turn * mind.felt_z_n / force
            lean = math.hypot(mind.lean_y, mind.lean_z)
            if lean > operator.tilt_limit_rad:
                mind.lean_y *= operator.tilt_limit_rad / lean
                mind.lean_z *= operator.tilt_limit_rad / lean
    elif mind.good_s > operator.calm_s:
        lean = math.hypot(mind.lean_y, mind.lean_z)
        keep = max(lean - turn, 0.0) / lean if lean > 0.0 else 0.0
        mind.lean_y *= keep
        mind.lean_z *= keep


@compiled(None)
def hand_wrench(
    operator: Operator,
    mind: Mind,
    wall: Wall,
    anticipated: float,
    cursor_y: float,
    cursor_z: float,
    seen_tilt: float,
    hand: np.ndarray,
    noise: np.ndarray,
    dt: float,
    wrench: np.ndarray,
) -> bool:
    """One control tick of an operator: write what its hand does to the handle.

    Parameters
    ----------
    operator, mind : records of Operator and Mind
        ``mind`` is changed.
    wall : record of Wall
    anticipated : float
        Lean with which the right edge is met [rad], ``Operator.anticipated_tilt_rad``.
    cursor_y, cursor_z : float
        Where the cursor was a visual delay ago [m].
    seen_tilt : float
        The nozzle's tilt a visual delay ago [rad].
    hand : ndarray, shape (4, 4)
        Pose of the operator's own hand, which holds the handle.
    noise : ndarray, shape (6,)
        This tick's unsteadiness, of unit variance.
    dt : float
        Control period [s].
    wrench : ndarray, shape (6,), written
        Force and moment of the hand on the handle, about its centre, base frame [N, N m].

    Returns
    -------
    bool
        Whether the blasting trigger is pressed.
    """
    mind.time_s += dt
    _move_carrot(operator, mind, wall, cursor_y, cursor_z, dt)
    _react(operator, mind, seen_tilt, dt)
    aim_y, aim_z = point_at(wall, mind.edge, mind.along_m)

    # Lean: on purpose, plus what earlier laps have taught about the right edge.
    lean_y, lean_z = mind.lean_y, mind.lean_z
    near = phase(wall, edge_start(wall, mind.edge) + mind.along_m)
    if near == 1 or near == 2:
        lean_y -= anticipated
    lean = math.hypot(lean_y, lean_z)
    if lean > operator.tilt_limit_rad:
        lean_y *= operator.tilt_limit_rad / lean
        lean_z *= operator.tilt_limit_rad / lean

    # Extra pull for what stays behind; it stops growing when the arm has no more to give.
    if mind.force_share < 1.0 and mind.retreat_s <= 0.0:
        mind.pull_y_n += operator.escalation_n_m_s * (aim_y - cursor_y) * dt
        mind.pull_z_n += operator.escalation_n_m_s * (aim_z - cursor_z) * dt
    mind.pull_y_n -= mind.pull_y_n * dt / ESCALATION_FADE_S
    mind.pull_z_n -= mind.pull_z_n * dt / ESCALATION_FADE_S

    fx, fy, fz = spring_force(operator.stiffness_n_m, wall, aim_y, aim_z, lean_y, lean_z, hand)
    fy += mind.pull_y_n
    fz += mind.pull_z_n
    force = math.sqrt(fx * fx + fy * fy + fz * fz)
    mind.force_share = force / operator.force_cap_n
    if mind.force_share > 1.0:
        fx, fy, fz = fx / mind.force_share, fy / mind.force_share, fz / mind.force_share
        force, mind.force_share = operator.force_cap_n, 1.0
    mind.felt_y_n += dt / FORCE_SENSE_S * (fy - mind.felt_y_n)
    mind.felt_z_n += dt / FORCE_SENSE_S * (fz - mind.felt_z_n)

    mx, my, mz, moment = spring_moment(
        operator.rotation_stiffness_nm_rad, operator.torque_cap_nm, lean_y, lean_z, hand
    )
    spread = math.hypot(operator.noise_share * force, operator.tremor_n)
    spread_m = math.hypot(operator.noise_share * moment, TREMOR_LEVER_M * operator.tremor_n)
    wrench[0], wrench[1], wrench[2] = fx + spread * noise[0], fy + spread * noise[1], fz + spread * noise[2]
    wrench[3], wrench[4], wrench[5] = (
        mx + spread_m * noise[3],
        my + spread_m * noise[4],
        mz + spread_m * noise[5],
    )
    return mind.time_s > SETTLE_S and mind.retreat_s <= 0.0
