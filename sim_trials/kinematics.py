"""Where the handle of the UR10 is and how its joints move it: pose, Jacobian, smallest singular value.

Frames follow the standard (distal) Denavit-Hartenberg convention. The base frame has z up; the tool
frame is the flange's frame, its z along the nozzle; the handle centre lies on that axis. Every
function is compiled, allocates nothing that outlives it and writes into arrays of the caller.

References
----------
Universal Robots, "DH Parameters for calculations of kinematics and dynamics", table UR10 (CB3).
Siciliano, Sciavicco, Villani, Oriolo (2009), "Robotics", sections 2.8 (convention), 3.1 (Jacobian).
"""

import math

import numpy as np

from sim_trials.compiled import compiled
from sim_trials.singular_value import smallest_singular_value

__all__ = [
    "DH_ALPHA_RAD",
    "DH_A_M",
    "DH_D_M",
    "HANDLE_OFFSET_M",
    "JOINT_SPEED_LIMITS_RAD_S",
    "NOZZLE_LENGTH_M",
    "SENSOR_OFFSET_M",
    "handle_jacobian",
    "handle_pose",
    "rotation_matrix",
    "rotation_vector",
    "smallest_singular_value",
    "tilt",
]

DH_A_M = (0.0, -0.612, -0.5723, 0.0, 0.0, 0.0)
"""Link lengths a_i [m], as Universal Robots publishes them for the UR10 (CB3)."""

DH_D_M = (0.1273, 0.0, 0.0, 0.163941, 0.1157, 0.0922)
"""Link offsets d_i [m], same table. One controller manual prints d1 = 0.118, a2 = -0.6127, a3 = -0.5716."""

DH_ALPHA_RAD = (math.pi / 2, 0.0, 0.0, math.pi / 2, -math.pi / 2, 0.0)
"""Link twists alpha_i [rad], same table."""

JOINT_SPEED_LIMITS_RAD_S = tuple(math.radians(v) for v in (120.0, 120.0, 180.0, 180.0, 180.0, 180.0))
"""Maximum joint speeds [rad/s] of the UR10's data sheet: 120 deg/s base and shoulder, 180 deg/s others."""

SENSOR_OFFSET_M = 0.05
"""From the flange to the force-torque sensor's origin along tool z [m]; untuned, the paper gives none."""

HANDLE_OFFSET_M = 0.15
"""From the flange to the handle centre along tool z [m]; untuned, the paper gives none."""

NOZZLE_LENGTH_M = 0.35
"""From the flange to the nozzle's tip along tool z [m]; untuned, the paper gives none."""

_A2, _A3 = DH_A_M[1], DH_A_M[2]
_D1, _D4, _D5 = DH_D_M[0], DH_D_M[3], DH_D_M[4]
_D6_HANDLE = DH_D_M[5] + HANDLE_OFFSET_M


@compiled("void(float64[::1], float64[:, ::1])")
def handle_pose(q: np.ndarray, T: np.ndarray) -> None:
    """Write the pose of the handle: tool axes in the base frame, origin at the handle centre.

    Joints 2-4 turn about one direction, so the arm is worked out in its vertical plane: x1 points
    outwards, y1 up, z1 along the shoulder's axis.

    Parameters
    ----------
    q : ndarray, shape (6,)
        Joint angles [rad].
    T : ndarray, shape (4, 4), written
        Homogeneous transform from the handle frame to the base frame [m].
    """
    c1, s1 = math.cos(q[0]), math.sin(q[0])
    q23 = q[1] + q[2]
    q234 = q23 + q[3]
    c234, s234 = math.cos(q234), math.sin(q234)
    c5, s5 = math.cos(q[4]), math.sin(q[4])
    c6, s6 = math.cos(q[5]), math.sin(q[5])

    # Frame 5 in the arm's plane; x5 = c5 x4 + s5 z1, y5 = -z4, z5 = -s5 x4 + c5 z1.
    x6x = c6 * c5 * c234 - s6 * s234
    x6y = c6 * c5 * s234 + s6 * c234
    x6z = c6 * s5
    y6x = -s6 * c5 * c234 - c6 * s234
    y6y = -s6 * c5 * s234 + c6 * c234
    y6z = -s6 * s5
    z6x, z6y, z6z = -s5 * c234, -s5 * s234, c5

    hx = _A2 * math.cos(q[1]) + _A3 * math.cos(q23) + _D5 * s234 + _D6_HANDLE * z6x
    hy = _A2 * math.sin(q[1]) + _A3 * math.sin(q23) - _D5 * c234 + _D6_HANDLE * z6y
    hz = _D4 + _D6_HANDLE * z6z

    T[0, 0], T[1, 0], T[2, 0] = c1 * x6x + s1 * x6z, s1 * x6x - c1 * x6z, x6y
    T[0, 1], T[1, 1], T[2, 1] = c1 * y6x + s1 * y6z, s1 * y6x - c1 * y6z, y6y
    T[0, 2], T[1, 2], T[2, 2] = c1 * z6x + s1 * z6z, s1 * z6x - c1 * z6z, z6y
    T[0, 3], T[1, 3], T[2, 3] = c1 * hx + s1 * hz, s1 * hx - c1 * hz, _D1 + hy
    T[3, 0], T[3, 1], T[3, 2], T[3, 3] = 0.0, 0.0, 0.0, 1.0


@compiled("void(float64[::1], float64[:, ::1])")
def handle_jacobian(q: np.ndarray, J: np.ndarray) -> None:
    """Write the geometric Jacobian at the handle centre, in the base frame.

    The handle centre lies on the last joint's axis, so q6 has no effect on J.

    Parameters
    ----------
    q : ndarray, shape (6,)
        Joint angles [rad].
    J : ndarray, shape (6, 6), written
        Rows: linear velocity [m/rad], then angular velocity [rad/rad]; a column for each joint.
    """
    c1, s1 = math.cos(q[0]), math.sin(q[0])
    q23 = q[1] + q[2]
    q234 = q23 + q[3]
    c234, s234 = math.cos(q234), math.sin(q234)
    c5, s5 = math.cos(q[4]), math.sin(q[4])

    # From the axes of joints 4, 3 and 2 to the handle centre, in the arm's plane.
    r4x = _D5 * s234 - _D6_HANDLE * s5 * c234
    r4y = -_D5 * c234 - _D6_HANDLE * s5 * s234
    r3x, r3y = r4x + _A3 * math.cos(q23), r4y + _A3 * math.sin(q23)
    r2x, r2y = r3x + _A2 * math.cos(q[1]), r3y + _A2 * math.sin(q[1])
    hz = _D4 + _D6_HANDLE * c5

    J[0, 0], J[1, 0], J[2, 0] = c1 * hz - s1 * r2x, c1 * r2x + s1 * hz, 0.0
    J[3, 0], J[4, 0], J[5, 0] = 0.0, 0.0, 1.0
    J[0, 1], J[1, 1], J[2, 1] = -r2y * c1, -r2y * s1, r2x
    J[0, 2], J[1, 2], J[2, 2] = -r3y * c1, -r3y * s1, r3x
    J[0, 3], J[1, 3], J[2, 3] = -r4y * c1, -r4y * s1, r4x
    for joint in range(1, 4):
        J[3, joint], J[4, joint], J[5, joint] = s1, -c1, 0.0

    # Joint 5 turns about z4, and z4 x z5 = -s5 z1 - c5 x4.
    J[0, 4] = _D6_HANDLE * (-s5 * s1 - c5 * c234 * c1)
    J[1, 4] = _D6_HANDLE * (s5 * c1 - c5 * c234 * s1)
    J[2, 4] = _D6_HANDLE * (-c5 * s234)
    J[3, 4], J[4, 4], J[5, 4] = s234 * c1, s234 * s1, -c234
    J[0, 5], J[1, 5], J[2, 5] = 0.0, 0.0, 0.0
    J[3, 5] = -s5 * c234 * c1 + c5 * s1
    J[4, 5] = -s5 * c234 * s1 - c5 * c1
    J[5, 5] = -s5 * s234


@compiled("float64(float64[:, ::1])")
def tilt(T: np.ndarray) -> float:
    """Angle between the nozzle (tool z) and the wall's normal (base x) [rad]; 0 is perpendicular."""
    return math.atan2(math.hypot(T[1, 2], T[2, 2]), T[0, 2])


@compiled("void(float64[::1], float64[:, ::1])")
def rotation_matrix(vector: np.ndarray, R: np.ndarray) -> None:
    """Write the rotation by ``|vector|`` [rad] about the direction of ``vector`` (Rodrigues).

    Parameters
    ----------
    vector : ndarray, shape (3,)
        Rotation vector [rad].
    R : ndarray, shape (3, 3) or larger, written
        Only the upper left 3 x 3 block is written, so that a 4 x 4 pose can be given.
    """
    x, y, z = vector[0], vector[1], vector[2]
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-4:
        # Series: the closed form loses all digits of 1 - cos near zero.
        a, b = 1.0 - angle * angle / 6.0, 0.5 - angle * angle / 24.0
    else:
        a, b = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    R[0, 0], R[0, 1], R[0, 2] = 1.0 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    R[1, 0], R[1, 1], R[1, 2] = b * x * y + a * z, 1.0 - b * (x * x + z * z), b * y * z - a * x
    R[2, 0], R[2, 1], R[2, 2] = b * x * z - a * y, b * y * z + a * x, 1.0 - b * (x * x + y * y)


@compiled("void(float64[:, ::1], float64[:, ::1], float64[::1])")
def rotation_vector(R: np.ndarray, R_target: np.ndarray, vector: np.ndarray) -> None:
    """Write the rotation that takes R to R_target, in the base frame: R_target = rot(vector) R.

    Through the unit quaternion, so that it is exact from 0 to pi.

    Parameters
    ----------
    R, R_target : ndarray, shape (3, 3) or larger
        Rotations to the base frame; only the upper left 3 x 3 blocks are read.
    vector : ndarray, shape (3,), written
        Rotation vector [rad], its length in [0, pi].
    """
    e00 = R_target[0, 0] * R[0, 0] + R_target[0, 1] * R[0, 1] + R_target[0, 2] * R[0, 2]
    e01 = R_target[0, 0] * R[1, 0] + R_target[0, 1] * R[1, 1] + R_target[0, 2] * R[1, 2]
    e02 = R_target[0, 0] * R[2, 0] + R_target[0, 1] * R[2, 1] + R_target[0, 2] * R[2, 2]
    e10 = R_target[1, 0] * R[0, 0] + R_target[1, 1] * R[0, 1] + R_target[1, 2] * R[0, 2]
    e11 = R_target[1, 0] * R[1, 0] + R_target[1, 1] * R[1, 1] + R_target[1, 2] * R[1, 2]
    e12 = R_target[1, 0] * R[2, 0] + R_target[1, 1] * R[2, 1] + R_target[1, 2] * R[2, 2]
    e20 = R_target[2, 0] * R[0, 0] + R_target[2, 1] * R[0, 1] + R_target[2, 2] * R[0, 2]
    e21 = R_target[2, 0] * R[1, 0] + R_target[2, 1] * R[1, 1] + R_target[2, 2] * R[1, 2]
    e22 = R_target[2, 0] * R[2, 0] + R_target[2, 1] * R[2, 1] + R_target[2, 2] * R[2, 2]
    # Shepperd's choice: divide by the largest of the four quaternion components.
    trace = e00 + e11 + e22
    if trace >= e00 and trace >= e11 and trace >= e22:
        w, x, y, z = 1.0 + trace, e21 - e12, e02 - e20, e10 - e01
    elif e00 >= e11 and e00 >= e22:
        w, x, y, z = e21 - e12, 1.0 + e00 - e11 - e22, e01 + e10, e02 + e20
    elif e11 >= e22:
        w, x, y, z = e02 - e20, e01 + e10, 1.0 + e11 - e00 - e22, e12 + e21
    else:
        w, x, y, z = e10 - e01, e02 + e20, e12 + e21, 1.0 + e22 - e00 - e11
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    norm = math.sqrt(x * x + y * y + z * z)
    scale = 2.0 * math.atan2(norm, w) / norm if norm > 0.0 else 0.0
    vector[0], vector[1], vector[2] = scale * x, scale * y, scale * z
