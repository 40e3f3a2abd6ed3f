"""A simulated cohort: what is refused beforehand, and what an interruption leaves behind."""

from pathlib import Path

import pytest

from app.cli.main import run
from app.cohort import simulate_cohort
from app.studies import open_study
from data.store import Store
from data.study_file import study_text

TEXT = study_text("carmichael2017")


@pytest.mark.parametrize(
    ("old", "new"),
    [("[maze]", "[maze]\nwall_x_m = 1.9"), ("gain_exit = 0.8", "no_such_metric = 0.8")],
    ids=["a maze out of reach", "a metric that trials don't have"],
)
def test_a_study_that_cannot_be_simulated_is_refused_before_a_store_is_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str
) -> None:
    study = tmp_path / "study.toml"
    study.write_text(TEXT.replace(old, new, 1))
    store = tmp_path / "study.sqlite"
    assert run(["simulate", "--study", str(study), "--store", str(store), "--participants", "1"]) == 2
    assert run(["study", "check", str(study)]) == 2
    refusals = capsys.readouterr().err.splitlines()
    assert len(refusals) == 2
    assert all(line.startswith(f"elbowroom: {study}: ") for line in refusals)
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_an_interrupted_cohort_leaves_the_recordings_that_another_process_stored(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    short = TEXT.replace("laps_per_condition = 3", "laps_per_condition = 1")
    study.write_text(short.replace("repetitions = 2", "repetitions = 1"))
    opened = open_study(study)

    with Store.open(tmp_path / "study.sqlite") as store:

        def other_process(*_: object) -> None:
            with Store.open(tmp_path / "study.sqlite") as other:
                simulate_cohort(opened, other, 1, seed=1, n_jobs=1)
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            simulate_cohort(opened, store, 1, seed=1, n_jobs=1, progress=other_process)
        trials = store.trials()
        assert len(trials) == 6
        for trial in trials:
            assert store.recording_path(trial).is_file()
