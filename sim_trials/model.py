"""The UR10 in MuJoCo: the model loaded, its state as named arrays, its physics step for compiled loops."""

import ctypes
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

import mujoco
import numpy as np
from numba.core import types

from data.errors import ElbowroomError
from data.private_parts import require

PHYSICS_STEP_S = 0.002
"""Time step of the model [s]."""

require("numba", types, "FunctionType", "WrapperAddressProtocol")

STEP_SIGNATURE = types.void(types.intp, types.intp)
"""``mj_step`` as a compiled loop sees it: address of the model, address of the data."""

STEP_TYPE = types.FunctionType(STEP_SIGNATURE)
"""Type of the physics step as an argument of a compiled function."""


class PhysicsStep(types.WrapperAddressProtocol):
    """A C function of two pointers that a compiled loop takes as an argument.

    As an argument, its address is no part of the machine code, so that the loop can be cached.
    """

    def __init__(self, address: int) -> None:
        self._address = address

    def __wrapper_address__(self) -> int:
        return self._address

    def signature(self) -> types.Type:
        return STEP_SIGNATURE


@cache
def _library() -> ctypes.CDLL:
    """MuJoCo's C library, found in its package under whatever name the platform gives it.

    An upgrade in place may leave an older library beside it, whose structures are laid out otherwise: the one
    that says the version of the Python bindings is taken.
    """
    folder = Path(mujoco.__file__).parent
    paths = [
        p for pattern in ("libmujoco.so*", "libmujoco*.dylib", "mujoco.dll") for p in folder.glob(pattern)
    ]
    for path in sorted(paths, key=lambda path: (mujoco.__version__ not in path.name, path.name)):
        library = ctypes.CDLL(str(path))
        if library.mj_version() == mujoco.mj_version():
            return library
    names = ", ".join(sorted(path.name for path in paths)) or "no library"
    raise ElbowroomError(
        f"MuJoCo {mujoco.__version__} has {names} in {folder}, none of this version: "
        "pip install --force-reinstall mujoco"
    )


@cache
def physics_step() -> PhysicsStep:
    """``mj_step`` of the installed MuJoCo."""
    address = ctypes.cast(_library().mj_step, ctypes.c_void_p).value
    assert address is not None
    return PhysicsStep(address)


@cache
def ur10_model() -> mujoco.MjModel:
    """The compiled model, one for the whole process: it is never changed."""
    xml = resources.files("sim_trials.models").joinpath("ur10.xml").read_text(encoding="utf-8")
    model = mujoco.MjModel.from_xml_string(xml)
    if model.opt.timestep != PHYSICS_STEP_S:
        raise ElbowroomError(f"ur10.xml: timestep is {model.opt.timestep}, not {PHYSICS_STEP_S}")
    return model


@dataclass(frozen=True)
class Robot:
    """One simulated UR10. The arrays are views: what is written into them is what MuJoCo reads.

    Attributes
    ----------
    q, qdot : ndarray, shape (6,)
        Joint angles [rad] and velocities [rad/s].
    target : ndarray, shape (6,)
        Position references of the servos [rad].
    hand : ndarray, shape (6,)
        Force and moment on the handle centre, base frame [N, N m].
    model_address, data_address : int
        What ``physics_step()`` takes; valid as long as this object lives.
    """

    model: mujoco.MjModel
    data: mujoco.MjData
    q: np.ndarray
    qdot: np.ndarray
    target: np.ndarray
    hand: np.ndarray
    model_address: int
    data_address: int

    def place(self, q: np.ndarray) -> None:
        """Put the robot at rest at joint angles ``q`` [rad], held there by its servos, nobody touching it."""
        mujoco.mj_resetData(self.model, self.data)
        self.q[:] = q
        self.target[:] = q
        mujoco.mj_forward(self.model, self.data)

    def step(self) -> None:
        """Advance the physics by ``PHYSICS_STEP_S``."""
        mujoco.mj_step(self.model, self.data)


def new_robot(q: np.ndarray) -> Robot:
    """A robot of its own, at rest at joint angles ``q`` [rad]."""
    model = ur10_model()
    data = mujoco.MjData(model)
    require("mujoco", model, "_address")
    require("mujoco", data, "_address")
    robot = Robot(
        model=model,
        data=data,
        q=data.qpos,
        qdot=data.qvel,
        target=data.ctrl,
        hand=data.xfrc_applied[model.body("tool").id],
        model_address=model._address,
        data_address=data._address,
    )
    robot.place(q)
    return robot
