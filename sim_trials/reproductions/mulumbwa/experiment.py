"""The thesis's experiments in one go, as tables: sections 4.1 and 4.2."""

from itertools import product

import numpy as np
import pandas as pd

from sim_trials.reproductions.chain import Convention
from sim_trials.reproductions.mulumbwa import euler, humanoid, joint_limits, planar, potential_field
from sim_trials.reproductions.mulumbwa.arms import HUMANOID_TARGETS, PLANAR_TARGETS
from sim_trials.reproductions.mulumbwa.arms import humanoid as humanoid_arm
from sim_trials.reproductions.mulumbwa.claims import verdicts_of
from sim_trials.reproductions.verdict import Progress, Reproduction

STARTS = ((0.0, 0.0, 0.0), (0.1, 0.1, 0.1), (0.5, 0.5, 0.5), (np.pi / 4, -0.5, 0.3))
"""Start angles of the planar arm [rad]: the thesis gives none."""
GAMMAS = (np.pi / 4, np.pi)
"""Largest joint steps of the SDLS tried on the 7-DOF arm [rad]."""
SECONDARY = {
    "none": None,
    "gradient projection": joint_limits.gradient_projection,
    "kinematic optimisation": joint_limits.kinematic_optimisation,
}
OBSTACLE = np.array([0.0, 0.3])
WAYS = (
    ((-0.5, 0.0), (0.1, 0.02)),
    ((-0.4, 0.3), (0.25, 0.3)),
    ((-0.5, 0.1), (0.0, 0.07)),
    ((-0.3, 0.5), (0.23, 0.3)),
    ((-0.2, 0.0), (0.05, 0.55)),
)
"""Starts and goals [m] around one obstacle, goals close to it; the thesis gives no positions."""


def reproduce(progress: Progress | None = None) -> Reproduction:
    """Run everything and judge the thesis's claims; ``progress`` counts the runs of the 7-DOF arm."""
    tables = {
        "iterations": iteration_table(),
        "planar": planar_table(),
        "angle_sets": angle_set_table(),
        "humanoid": humanoid_table(progress),
        "humanoid_angles": humanoid_angle_table(),
        "obstacle": obstacle_table(),
        "obstacle_paths": obstacle_path_table(),
    }
    return Reproduction(
        "mulumbwa",
        "Mulumbwa, Humanoid Arm Geometric Model (thesis)",
        tables,
        verdicts_of(tables),
    )


def iteration_table() -> pd.DataFrame:
    """Table 3, under each start and both schedules; an empty cell: not reached."""
    rows = []
    for start, method, is_scheduled in product(STARTS, planar.METHODS, (True, False)):
        if method == planar.SVF_SDLS and is_scheduled:
            continue
        done = planar.solve(method, PLANAR_TARGETS["inside"], np.array(start), is_scheduled=is_scheduled)
        published = planar.PUBLISHED_ITERATIONS[method]
        for norm, number in zip(planar.NORMS, published, strict=True):
            rows.append((_angles(start), method, is_scheduled, norm, number, done.needed(norm)))
    columns = ["start_rad", "method", "is_scheduled", "error_norm", "published", "needed"]
    return pd.DataFrame(rows, columns=columns).astype({"needed": "Int64"})


def planar_table() -> pd.DataFrame:
    """Condition number, manipulability and joint angles by iteration: figs. 8 to 13."""
    parts = []
    for start, (where, target), method in product(STARTS, PLANAR_TARGETS.items(), planar.METHODS):
        done = planar.solve(method, target, np.array(start), is_scheduled=True)
        parts.append(
            pd.DataFrame(
                {
                    "start_rad": _angles(start),
                    "target": where,
                    "method": method,
                    "iteration": np.arange(done.error.size),
                    "error_m": done.error,
                    "condition_number": [planar.condition_number(method, s) for s in done.sigma],
                    "manipulability": [planar.manipulability(method, s) for s in done.sigma],
                    "arm_manipulability": done.sigma.prod(axis=1),
                    "q1_rad": done.q[:, 0],
                    "q2_rad": done.q[:, 1],
                    "q3_rad": done.q[:, 2],
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def angle_set_table() -> pd.DataFrame:
    """Table 2, and the sets that are free of gimbal lock wherever one is locked, found by search."""
    rows = []
    for order in euler.SETS:
        free = [o for o in euler.SETS if o != order and euler.never_locks_with(order, o)]
        rows.append((_code(order), _codes(euler.PUBLISHED_ALTERNATIVES[order]), _codes(free)))
    return pd.DataFrame(rows, columns=["singular_set", "published_free", "found_free"])


def humanoid_table(progress: Progress | None = None) -> pd.DataFrame:
    """SVF+SDLS on the 7-DOF arm: every reading of the arm and the angle set, with and without switching."""
    rows: list[tuple[object, ...]] = []
    plain = list(product(Convention, HUMANOID_TARGETS.items(), GAMMAS, euler.SETS, (False, True)))
    limited = [
        (target, task)
        for target, task in product(HUMANOID_TARGETS.items(), SECONDARY.items())
        if task[1] is not None
    ]

    def tell(what: str) -> None:
        if progress is not None:
            progress(len(rows), len(plain) + len(limited), what)

    for convention, (where, target), gamma_max, order, switches in plain:
        run = humanoid.solve(
            humanoid_arm(convention), target, order=order, switches_sets=switches, gamma_max=gamma_max
        )
        rows.append((convention.value, where, gamma_max, _code(order), switches, "none", *_ends(run)))
        tell(f"7-DOF arm, set {_code(order)}")
    for (where, target), (name, secondary) in limited:
        run = humanoid.solve(
            humanoid_arm(Convention.MODIFIED), target, switches_sets=True, secondary=secondary
        )
        rows.append(("modified", where, GAMMAS[0], _code(humanoid.MAIN_SET), True, name, *_ends(run)))
        tell(f"7-DOF arm, {name}")
    columns = [
        "convention",
        "target",
        "gamma_max_rad",
        "angle_set",
        "switches_sets",
        "secondary_task",
        "position_error_m",
    ]
    columns += ["attitude_error_rad", "jumps", "travel_rad", "joints_out_of_range", "switched_iterations"]
    return pd.DataFrame(rows, columns=columns)


def humanoid_angle_table() -> pd.DataFrame:
    """Joint angles by iteration for the target outside: figs. 14 (fixed set), 15 (switched), 16 (limits)."""
    parts = []
    for figure, switches, name in (
        ("fixed set", False, "none"),
        ("switched sets", True, "none"),
        ("joint limits", True, "kinematic optimisation"),
    ):
        run = humanoid.solve(
            humanoid_arm(Convention.MODIFIED),
            HUMANOID_TARGETS["outside"],
            switches_sets=switches,
            secondary=SECONDARY[name],
        )
        part = pd.DataFrame(run.q, columns=[f"q{j}_rad" for j in range(1, 8)])
        part.insert(0, "iteration", np.arange(len(part)))
        part.insert(0, "run", figure)
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def obstacle_table() -> pd.DataFrame:
    """How near to the obstacle each way comes, with the gradient of eq. (43) and with eq. (44) as printed."""
    rows = []
    for (number, (start, goal)), as_printed in product(enumerate(WAYS, start=1), (False, True)):
        path = potential_field.descend(np.array(start), np.array(goal), OBSTACLE, as_printed=as_printed)
        rows.append((number, as_printed, *goal, path.clearance_m, path.has_arrived))
    columns = ["way", "as_printed", "goal_x_m", "goal_y_m", "clearance_m", "has_arrived"]
    return pd.DataFrame(rows, columns=columns)


def obstacle_path_table() -> pd.DataFrame:
    """The ways themselves, every tenth point: fig. 17."""
    parts = []
    for number, (start, goal) in enumerate(WAYS, start=1):
        path = potential_field.descend(np.array(start), np.array(goal), OBSTACLE)
        points = path.points[::10]
        parts.append(pd.DataFrame({"way": number, "x_m": points[:, 0], "y_m": points[:, 1]}))
    return pd.concat(parts, ignore_index=True)


def _angles(start: tuple[float, ...]) -> str:
    return " ".join(f"{angle:.3g}" for angle in start)


def _ends(run: humanoid.HumanoidRun) -> tuple[float, float, int, float, int, int]:
    return (
        float(run.position_error_m[-1]),
        float(run.attitude_error[-1]),
        run.jumps,
        run.travel,
        run.violated,
        run.switches,
    )


def _code(order: euler.AngleSet) -> str:
    return "".join(map(str, order))


def _codes(orders: list[euler.AngleSet] | tuple[euler.AngleSet, ...]) -> str:
    return " ".join(sorted(map(_code, orders)))
