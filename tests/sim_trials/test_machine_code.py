"""The cache of machine code: it has to notice a change in anything a compiled function calls."""

from pathlib import Path

import pytest

from sim_trials import compiled


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "arm.py").write_text("LENGTH = 1.0\n")
    (tmp_path / "loop.py").write_text("from sim_trials.middle import step\n")
    (tmp_path / "middle.py").write_text("import math\nfrom sim_trials.arm import LENGTH\n")
    (tmp_path / "apart.py").write_text("X = 1\n")
    monkeypatch.setattr(compiled, "_PACKAGE", tmp_path)
    monkeypatch.setattr(compiled.numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    compiled._cache_root.cache_clear()
    compiled._cache_folder.cache_clear()
    yield tmp_path
    compiled._cache_root.cache_clear()
    compiled._cache_folder.cache_clear()


def folder_of(path: Path) -> str | None:
    compiled._cache_folder.cache_clear()
    return compiled._cache_folder(str(path))


def test_a_change_in_an_imported_file_gives_another_folder(package: Path) -> None:
    before = folder_of(package / "loop.py")
    assert before is not None
    assert folder_of(package / "loop.py") == before
    (package / "arm.py").write_text("LENGTH = 2.0\n")
    assert folder_of(package / "loop.py") != before


def test_a_change_elsewhere_keeps_the_machine_code(package: Path) -> None:
    before = folder_of(package / "loop.py")
    (package / "apart.py").write_text("X = 2\n")
    assert folder_of(package / "loop.py") == before


def test_machine_code_goes_to_numba_cache_dir_where_set(package: Path) -> None:
    assert str(folder_of(package / "loop.py")).startswith(str(package / "cache"))


def test_without_a_writable_folder_functions_still_compile(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package / "blocked").write_text("a file where a folder is wanted")
    monkeypatch.setattr(compiled.numba.config, "CACHE_DIR", str(package / "blocked"))
    compiled._cache_root.cache_clear()
    assert folder_of(package / "loop.py") is None

    @compiled.compiled("float64(float64)")
    def doubled(x: float) -> float:
        return 2.0 * x

    assert doubled(1.5) == 3.0
