"""A person's hand: the pointer on the screen made into a force on the handle.

The pointer says where on the wall the cursor is wanted, and how the nozzle shall lean. The hand pulls as
a spring would that runs from the handle to where it would have to be for that, up to the force that a
person can keep up, and turns the nozzle with a limited moment. Along the wall and across it the force is
limited on its own: whoever pulls with all strength to the right still keeps the distance.

With no lean wanted the hand holds the nozzle perpendicular, but no stronger than it can: the tilt that
the damping imposes shows. A hand that takes hold, however far from the nozzle its pointer is, grows to its
strength within `Hand.grip_s` instead of tearing at the handle, and begins with the lean it finds. A hand
that lets go pulls with nothing, and the enable trigger is released with it.
"""

import math
from dataclasses import dataclass

import numpy as np

from sim_trials.compiled import compiled
from sim_trials.kinematics import tilt
from sim_trials.maze import Wall
from sim_trials.spring import spring_force, spring_moment


@dataclass(frozen=True)
class Hand:
    """The hand that a pointer moves; the same for everybody, so that strength is no advantage.

    Attributes
    ----------
    stiffness_n_m, rotation_stiffness_nm_rad : float
        Against translation and rotation of the handle; middle of the range of ``operators.draw_operator``.
    force_cap_n : float
        The most it pulls along the wall.
    standoff_cap_n : float
        The most it pushes or pulls across the wall.
    torque_cap_nm : float
        The most it twists.
    lean_limit_rad, lean_rate_rad_s : float
        The most it leans the nozzle on purpose, and how fast.
    grip_s : float
        From taking hold to full strength.
    """

    stiffness_n_m: float
    rotation_stiffness_nm_rad: float
    force_cap_n: float
    standoff_cap_n: float
    torque_cap_nm: float
    lean_limit_rad: float
    lean_rate_rad_s: float
    grip_s: float


HAND = Hand(
    stiffness_n_m=300.0,
    rotation_stiffness_nm_rad=15.0,
    force_cap_n=60.0,
    standoff_cap_n=60.0,
    torque_cap_nm=8.0,
    lean_limit_rad=math.radians(25.0),
    lean_rate_rad_s=math.radians(40.0),
    grip_s=0.15,
)


@dataclass
class Grip:
    """What a hand carries from one control tick to the next (compiled code works on its record).

    Attributes
    ----------
    strength : float
        Share of its strength, 0 released to 1.
    lean_y_rad, lean_z_rad : float
        The lean it holds: the angle, as components along base y and z.
    pull : float
        Force along the wall over the most it pulls.
    """

    strength: float = 0.0
    lean_y_rad: float = 0.0
    lean_z_rad: float = 0.0
    pull: float = 0.0


@compiled(None)
def lean_of(T: np.ndarray) -> tuple[float, float]:
    """The nozzle's tilt as components along base y and z [rad], by the handle's pose T (4, 4)."""
    across = math.hypot(T[1, 2], T[2, 2])
    share = tilt(T) / across if across > 0.0 else 0.0
    return share * T[1, 2], share * T[2, 2]


@compiled(None)
def _limited(y: float, z: float, limit: float) -> tuple[float, float]:
    """A vector in its direction, no longer than the limit."""
    length = math.hypot(y, z)
    share = limit / length if length > limit else 1.0
    return share * y, share * z


@compiled(None)
def guided_wrench(
    hand: Hand,
    grip: Grip,
    wall: Wall,
    is_held: bool,
    aim_y: float,
    aim_z: float,
    tilt_y: float,
    tilt_z: float,
    T: np.ndarray,
    dt: float,
    wrench: np.ndarray,
) -> None:
    """One control tick of a person's hand: write what it does to the handle.

    Parameters
    ----------
    hand, grip, wall : records of Hand, Grip and Wall
        ``grip`` is changed.
    is_held : bool
        Whether the hand holds the handle.
    aim_y, aim_z : float
        Where on the wall the cursor is wanted [m].
    tilt_y, tilt_z : float
        Wanted lean: the angle, as components along base y and z [rad].
    T : ndarray, shape (4, 4)
        Pose of the handle.
    dt : float
        Control period [s].
    wrench : ndarray, shape (6,), written
        Force and moment of the hand on the handle, about its centre, base frame [N, N m].
    """
    if not is_held:
        found_y, found_z = lean_of(T)
        grip.lean_y_rad, grip.lean_z_rad = _limited(found_y, found_z, hand.lean_limit_rad)
        grip.strength = 0.0
        grip.pull = 0.0
        wrench[:] = 0.0
        return
    grip.strength = min(grip.strength + dt / hand.grip_s, 1.0)

    wanted_y, wanted_z = _limited(tilt_y, tilt_z, hand.lean_limit_rad)
    turn_y, turn_z = _limited(
        wanted_y - grip.lean_y_rad, wanted_z - grip.lean_z_rad, hand.lean_rate_rad_s * dt
    )
    grip.lean_y_rad += turn_y
    grip.lean_z_rad += turn_z
    lean = math.hypot(grip.lean_y_rad, grip.lean_z_rad)
    share = math.sin(lean) / lean if lean > 0.0 else 0.0
    lean_y, lean_z = share * grip.lean_y_rad, share * grip.lean_z_rad

    fx, fy, fz = spring_force(hand.stiffness_n_m, wall, aim_y, aim_z, lean_y, lean_z, T)
    fx = min(max(fx, -hand.standoff_cap_n), hand.standoff_cap_n)
    fy, fz = _limited(fy, fz, hand.force_cap_n)
    mx, my, mz, _ = spring_moment(hand.rotation_stiffness_nm_rad, hand.torque_cap_nm, lean_y, lean_z, T)
    wrench[0], wrench[1], wrench[2] = grip.strength * fx, grip.strength * fy, grip.strength * fz
    wrench[3], wrench[4], wrench[5] = grip.strength * mx, grip.strength * my, grip.strength * mz
    grip.pull = math.hypot(wrench[1], wrench[2]) / hand.force_cap_n
