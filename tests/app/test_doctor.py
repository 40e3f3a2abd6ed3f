"""`elbowroom doctor` does what it checks, and says in one line each what is broken."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import app.cli.doctor as doctor
from app.cli.main import run
from data.errors import ElbowroomError

HOUSE = Path(__file__).resolve().parents[2]
ANSWERS = HOUSE / "tests" / "reference" / "cems.csv"
BROKEN_MUJOCO = """raise ImportError(
    "The 'mujoco' package is installed, but its core bindings are missing.\\n"
    "Repair your environment with:\\n  pip install --force-reinstall mujoco"
)
"""
"""As an upgrade in place from 3.x can leave it."""
NEWER_NUTPIE = """class _Part:
    def __init__(self, signature):
        self.__text_signature__ = signature


LogpFunc = _Part("(ptr, user_data_ptr, keep_alive)")
ExpandFunc = _Part("(dim, expanded_dim, ptr, user_data_ptr, keep_alive)")
PyMcModel = _Part("(density, expand, variables, dim, dim_sizes, coords, init_func, transform_adapter)")
PyNutsSettings = type("PyNutsSettings", (), {"Diag": _Part("(seed=None)")})
ProgressType = type("ProgressType", (), {"none": _Part("()")})
PyStorage = type("PyStorage", (), {"arrow": _Part("()")})
PyVariable = type(
    "PyVariable", (), {"new_variables": _Part("($cls, names, item_types, shapes, dim_sizes, dims)")}
)
PySampler = type("PySampler", (), {"from_pymc": _Part(
    "(settings, cores, model, progress_type, extra_callback, extra_callback_rate, store)"
)})
"""
"""The signatures of 0.16.9 to 0.16.11."""


def shadowed(folder: Path, package: str, files: dict[str, str]) -> dict[str, str]:
    """An environment in which a package of that name stands before the installed one."""
    (folder / package).mkdir()
    for name, content in files.items():
        (folder / package / name).write_text(content)
    return os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), str(HOUSE)])}


def elbowroom(environment: dict[str, str], *arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-m", "app.cli", *arguments], env=environment, capture_output=True, text=True
    )


def test_a_lap_a_fit_and_a_store_are_tried_for_real(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["doctor"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any("steps a lap of the UR10: completed after" in line and line.startswith("ok") for line in lines)
    assert any("samples a fit of four answers: M1 ranks first" in line for line in lines)
    assert any("default store in" in line for line in lines)


def test_a_broken_mujoco_is_one_line_and_everything_else_is_still_checked(tmp_path: Path) -> None:
    environment = shadowed(tmp_path, "mujoco", {"__init__.py": BROKEN_MUJOCO})
    result = elbowroom(environment, "doctor")
    assert result.returncode == 1
    assert "Traceback" not in result.stdout + result.stderr
    failed = [line for line in result.stdout.splitlines() if line.startswith("FAIL")]
    assert len(failed) == 1
    assert (
        "core bindings are missing. Repair your environment with: pip install --force-reinstall" in failed[0]
    )
    assert "M1 ranks first" in result.stdout
    assert len(result.stdout.splitlines()) == len(doctor.CHECKS)
    lap = elbowroom(environment, "trial", "--mode", "M3")
    assert lap.returncode == 1
    assert lap.stderr.count("\n") == 1
    assert lap.stderr.startswith("elbowroom: mujoco ")


def test_another_nutpie_is_one_line_that_says_which_to_install(tmp_path: Path) -> None:
    environment = shadowed(tmp_path, "nutpie", {"__init__.py": "", "_lib.py": NEWER_NUTPIE})
    result = elbowroom(environment, "doctor")
    assert result.returncode == 1
    assert "Traceback" not in result.stdout + result.stderr
    (failed,) = (line for line in result.stdout.splitlines() if line.startswith("FAIL"))
    assert "its core has PySampler.from_pymc(settings, cores, model, progress_type, extra_callback," in failed
    assert failed.endswith("pip install 'nutpie>=0.16,<0.16.9'")
    out = tmp_path / "report"
    report = elbowroom(environment, "report", "--responses", str(ANSWERS), "--out", str(out))
    assert report.returncode == 1
    assert report.stderr.splitlines()[-1].endswith("pip install 'nutpie>=0.16,<0.16.9'")
    assert "Traceback" not in report.stderr
    assert not out.exists()


def test_whatever_a_check_raises_is_a_line_and_the_next_one_is_made(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def torn() -> doctor.Finding:
        raise RuntimeError("torn\n in two")

    def said() -> doctor.Finding:
        raise ElbowroomError("said in a line")

    good = doctor.Finding(True, "good")
    monkeypatch.setattr(doctor, "CHECKS", {"one": torn, "two": said, "three": lambda: good})
    assert run(["doctor"]) == 1
    out = capsys.readouterr().out
    assert (
        out
        == "FAIL  one: RuntimeError: torn in two\nFAIL  two: said in a line\nok    three: good\n".replace(
            "three: good", "good"
        )
    )


def test_an_import_that_fails_inside_elbowroom_is_a_fault_and_not_blamed_on_a_package() -> None:
    with pytest.raises(ImportError):
        from data import no_such_module  # noqa: F401
    source = "import app.cli.main as m, app.cli.doctor as d\nm.sys.exit(m.run(['doctor']))"
    broken = source.replace(
        "m.sys", "d.CHECKS.clear()\nm.cli = lambda **k: __import__('data.nowhere')\nm.sys"
    )
    result = subprocess.run([sys.executable, "-c", broken], cwd=HOUSE, capture_output=True, text=True)
    assert "ModuleNotFoundError: No module named 'data.nowhere'" in result.stderr
    assert "Traceback" in result.stderr
