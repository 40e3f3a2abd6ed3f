"""Where a lap begins."""

import numpy as np
import pytest

from data.errors import InputError
from data.study import Maze
from sim_trials.kinematics import handle_pose, tilt
from sim_trials.start import start_angles


@pytest.mark.parametrize(
    "changes", [{}, {"left_y_m": 0.2, "top_z_m": 0.5}, {"standoff_m": 0.2, "wall_x_m": 1.2}]
)
def test_lap_starts_perpendicular_before_the_top_left_corner(changes: dict[str, float]) -> None:
    maze = Maze(**changes)
    q, T = np.array(start_angles(maze)), np.empty((4, 4))
    handle_pose(q, T)
    nozzle = T[:3, 3] + 0.20 * T[:3, 2]
    np.testing.assert_allclose(
        nozzle, (maze.wall_x_m - maze.standoff_m, maze.left_y_m, maze.top_z_m), atol=1e-10
    )
    assert tilt(T) < 1e-10
    assert abs(T[2, 0]) < 1e-10
    assert 0.3 < q[2] < np.pi


def test_a_corner_out_of_reach_is_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="does not reach the top left corner") as caught:
        start_angles(Maze(left_y_m=1.0, wall_x_m=1.9))
    assert "\n" not in str(caught.value)
