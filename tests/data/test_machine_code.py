"""The cache of machine code: it has to notice a change in anything a compiled function calls."""

from collections.abc import Iterator
from pathlib import Path

import numba
import pytest

from data import machine_code
from sim_trials.compiled import compiled


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    (tmp_path / "sim_trials").mkdir()
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "lengths.py").write_text("UNIT = 1.0\n")
    for name, text in {
        "arm": "from data.lengths import UNIT\nLENGTH = 1.0\n",
        "loop": "from sim_trials.middle import step\n",
        "middle": "import math\nfrom sim_trials.arm import LENGTH\n",
        "apart": "X = 1\n",
    }.items():
        (tmp_path / "sim_trials" / f"{name}.py").write_text(text)
    monkeypatch.setattr(machine_code, "_HOUSE", tmp_path)
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    machine_code._root.cache_clear()
    machine_code.folder_of.cache_clear()
    yield tmp_path
    machine_code._root.cache_clear()
    machine_code.folder_of.cache_clear()


def folder_of(path: Path) -> str | None:
    machine_code.folder_of.cache_clear()
    return machine_code.folder_of(str(path))


def test_a_change_in_an_imported_file_gives_another_folder(package: Path) -> None:
    before = folder_of(package / "sim_trials" / "loop.py")
    assert before is not None
    assert folder_of(package / "sim_trials" / "loop.py") == before
    (package / "sim_trials" / "arm.py").write_text("from data.lengths import UNIT\nLENGTH = 2.0\n")
    after = folder_of(package / "sim_trials" / "loop.py")
    assert after != before
    (package / "data" / "lengths.py").write_text("UNIT = 2.0\n")
    assert folder_of(package / "sim_trials" / "loop.py") not in (before, after)


def test_a_change_elsewhere_keeps_the_machine_code(package: Path) -> None:
    before = folder_of(package / "sim_trials" / "loop.py")
    (package / "sim_trials" / "apart.py").write_text("X = 2\n")
    assert folder_of(package / "sim_trials" / "loop.py") == before


def test_machine_code_goes_to_numba_cache_dir_where_set(package: Path) -> None:
    assert str(folder_of(package / "sim_trials" / "loop.py")).startswith(str(package / "cache"))


def test_without_a_writable_folder_functions_still_compile(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package / "blocked").write_text("a file where a folder is wanted")
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(package / "blocked"))
    machine_code._root.cache_clear()
    assert folder_of(package / "sim_trials" / "loop.py") is None

    @compiled("float64(float64)")
    def doubled(x: float) -> float:
        return 2.0 * x

    assert doubled(1.5) == 3.0
