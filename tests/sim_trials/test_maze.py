"""The maze: lap, progress, phases, cursor, tilt, paint."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from data.study import Feedback, Maze
from sim_trials import maze as m
from sim_trials.record import record_of

MAZE, FEEDBACK = Maze(), Feedback()


@pytest.fixture(scope="module")
def wall() -> np.void:
    return record_of(m.wall_of(MAZE, FEEDBACK))


def walk(wall: np.void, step: float) -> Iterator[tuple[int, float, float]]:
    for edge in range(m.EDGES):
        for along in np.arange(0.0, m.edge_length(wall, edge), step):
            yield edge, *m.point_at(wall, edge, along)


def pose(x: float, y: float, z: float, lean_y: float, lean_z: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    T[:3, 2] = math.sqrt(1.0 - lean_y**2 - lean_z**2), lean_y, lean_z
    return T


def test_lap_runs_clockwise_from_the_top_left_corner(wall: np.void) -> None:
    found = np.array([m.corner(wall, edge) for edge in range(m.EDGES)])
    np.testing.assert_array_equal(found, m.corners(MAZE))
    y, z = found.T
    # Somebody facing the wall has -y to the right: clockwise there is a negative area in (-y, z).
    right = -y
    area = 0.5 * np.sum(right * np.roll(z, -1) - np.roll(right, -1) * z)
    assert area == pytest.approx(-(0.35 + 1.045) * 0.40)
    assert m.corner(wall, 4) == m.corner(wall, 0) == (0.35, 0.45)


def test_progress_is_the_arc_length_all_the_way_round(wall: np.void) -> None:
    places = np.array([m.progress(wall, edge, y, z) for edge, y, z in walk(wall, 0.01)])
    assert places[0] == 0.0
    assert np.all(np.diff(places) > 0.0)
    assert np.diff(places).max() == pytest.approx(0.01)
    assert m.edge_start(wall, 4) == pytest.approx(m.lap_length_m(MAZE)) == pytest.approx(3.59)


def test_points_beside_the_line_have_the_progress_of_the_line(wall: np.void) -> None:
    assert m.along_edge(wall, 0, 0.15, 0.47) == pytest.approx((0.20, -0.02))
    assert m.along_edge(wall, 1, -1.065, 0.25) == pytest.approx((0.20, -0.02))
    assert m.progress(wall, 1, -1.2, 0.25) == pytest.approx(1.395 + 0.20)
    assert m.progress(wall, 0, 0.9, 0.45) == 0.0


def test_corner_counts_as_reached_within_the_tolerance_and_not_beyond(wall: np.void) -> None:
    for edge in range(m.EDGES):
        y, z = m.corner(wall, edge + 1)
        assert m.reaches_corner(wall, edge, y + 0.0299, z)
        assert not m.reaches_corner(wall, edge, y, z - 0.0301)


def test_edge_phase_is_the_right_edge_with_its_corners(wall: np.void) -> None:
    names = [m.PHASES[m.phase(wall, m.progress(wall, edge, y, z))] for edge, y, z in walk(wall, 0.005)]
    in_order = [name for k, name in enumerate(names) if k == 0 or names[k - 1] != name]
    assert in_order == ["free", "approach", "edge", "exit", "free"]
    top_right = 0.35 + 1.045
    assert m.PHASES[m.phase(wall, top_right - 0.0299)] == "edge"
    assert m.PHASES[m.phase(wall, top_right - 0.0301)] == "approach"
    assert m.PHASES[m.phase(wall, top_right + 0.4 + 0.0301)] == "exit"
    assert m.PHASES[m.phase(wall, top_right + 0.4 + 0.3301)] == "free"


def test_cursor_is_where_the_axis_of_a_leaning_nozzle_hits_the_wall(wall: np.void) -> None:
    assert m.cursor(wall, pose(0.8, -0.3, 0.2, 0.0, 0.0)) == pytest.approx((-0.3, 0.2))
    lean = math.radians(10.0)
    expected = (-0.3 - 0.5 * math.tan(lean), 0.2)
    assert m.cursor(wall, pose(0.8, -0.3, 0.2, -math.sin(lean), 0.0)) == pytest.approx(expected)


def test_tilt_direction_is_that_of_somebody_facing_the_wall() -> None:
    for lean_y, lean_z, angle in ((-0.1, 0.0, 0.0), (0.0, 0.1, 90.0), (0.1, 0.0, 180.0), (0.0, -0.1, -90.0)):
        assert math.degrees(m.tilt_direction(pose(0.8, 0.0, 0.0, lean_y, lean_z))) == pytest.approx(angle)


def test_paint_is_solid_up_to_the_limit_and_faint_from_twice_the_limit_on() -> None:
    speeds = np.linspace(0.0, 0.5, 501)
    opacity = m.paint_opacities(MAZE, FEEDBACK, speeds)
    assert np.all(opacity[speeds <= 0.15] == 1.0)
    assert np.all(opacity[speeds >= 0.3001] == pytest.approx(m.FAINT_OPACITY))
    assert np.all(np.diff(opacity) <= 0.0)
    assert m.paint_opacities(MAZE, FEEDBACK, np.array([0.225]))[0] == pytest.approx(0.6)
    assert m.paint_opacities(MAZE, FEEDBACK, np.zeros((2, 3))).shape == (2, 3)
