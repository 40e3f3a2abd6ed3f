"""The surface of stuck rates: exact for every dwell time, and lower for a longer one."""

from pathlib import Path

import pandas as pd
import pytest

from data.errors import InputError
from data.study import Study
from sim_trials.batch import condition_jobs
from sim_trials.operators import draw_operator
from sim_trials.sweep import SweepResult, _with, sweep, write_sweep

EDGES, DWELLS = (-1.03, -1.05), (3.0, 4.5, 6.0)


@pytest.fixture(scope="module")
def result(study: Study) -> SweepResult:
    short = study.model_copy(update={"protocol": study.protocol.model_copy(update={"laps_per_condition": 1})})
    return sweep(short, EDGES, DWELLS, participants=4, seed=3, modes=["M1"])


def test_rates_fall_with_the_dwell_time_and_rise_with_the_reach(result: SweepResult) -> None:
    rates = result.table.pivot(index="dwell_s", columns="right_y_m", values="rate")
    assert (rates.diff().dropna() <= 0).all().all()
    assert (rates[-1.05] >= rates[-1.03]).all()
    assert rates.loc[3.0, -1.05] > rates.loc[6.0, -1.05]
    assert list(result.table.columns) == ["mode", "right_y_m", "dwell_s", "participants", "stuck", "rate"]
    assert len(result.table) == len(EDGES) * len(DWELLS)


def test_each_dwell_time_has_the_rate_of_laps_that_really_halt_then(
    study: Study, result: SweepResult
) -> None:
    for dwell in DWELLS[:2]:
        halting = _with(study, -1.05, dwell)
        outcomes = [
            condition_jobs(halting, "M1", draw_operator(seed), seed)[0].run().outcome for seed in range(3, 7)
        ]
        rows = result.table.query("right_y_m == -1.05 and dwell_s == @dwell")
        assert rows["stuck"].item() == outcomes.count("stuck")


def test_sweep_writes_table_and_figures(result: SweepResult, tmp_path: Path) -> None:
    paths = write_sweep(result, tmp_path / "out")
    assert [path.name for path in paths] == ["stuck_surface.csv", "stuck_surface.png", "stuck_surface.svg"]
    pd.testing.assert_frame_equal(pd.read_csv(paths[0]), result.table)
    assert paths[1].read_bytes().startswith(b"\x89PNG")
    again = write_sweep(result, tmp_path / "again")
    assert [p.read_bytes() for p in paths] == [p.read_bytes() for p in again]


@pytest.mark.parametrize(
    ("edges", "dwells", "message"),
    [
        ((), (5.0,), "at least one edge"),
        ((0.5,), (5.0,), "right_y_m must be smaller than left_y_m"),
        ((-1.0,), (0.0,), "greater than 0"),
    ],
)
def test_what_cannot_be_swept_is_refused_in_one_line(
    study: Study, edges: tuple[float, ...], dwells: tuple[float, ...], message: str
) -> None:
    with pytest.raises(InputError, match=message) as caught:
        sweep(study, edges, dwells, participants=1)
    assert "\n" not in str(caught.value)
    assert "[type=" not in str(caught.value)
