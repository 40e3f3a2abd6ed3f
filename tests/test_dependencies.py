"""What the packages import is what pyproject.toml declares, and what it declares is used."""

import ast
import re
import sys
import tomllib
from importlib import metadata
from pathlib import Path

from analysis.engines.nuts import NUTPIE

HOUSE = Path(__file__).resolve().parents[1]
PACKAGES = ("analysis", "app", "data", "sim_trials")
UNNAMED = {
    "h5netcdf": "xarray writes posterior.nc by it, as its engine",
    "h5py": "h5netcdf writes posterior.nc by it",
}
"""Declared and used, but imported by another package."""


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def declared(part: str = "") -> dict[str, str]:
    """The distributions that pyproject.toml asks for, with each whole requirement."""
    project = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = project["optional-dependencies"][part] if part else project["dependencies"]
    return {normal(re.split(r"[<>=!~\[; ]", line)[0]): line for line in lines}


def imported(folder: Path) -> dict[str, str]:
    """Top-level modules that the files of a folder import, each with one of the places."""
    places = {}
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                names = [node.module]
            for name in names:
                places.setdefault(name.partition(".")[0], f"{path.relative_to(HOUSE)}:{node.lineno}")
    return places


def foreign(folder: Path) -> dict[str, str]:
    own = {*PACKAGES, "tests", *sys.stdlib_module_names}
    return {name: place for name, place in imported(folder).items() if name not in own}


def test_every_import_is_declared() -> None:
    owners = metadata.packages_distributions()
    asked = set(declared()) | set(declared("dask"))
    undeclared = {}
    used = set()
    for package in PACKAGES:
        for module, place in foreign(HOUSE / package).items():
            distributions = {normal(name) for name in owners.get(module, [module])}
            used |= distributions & asked
            if not distributions & asked:
                undeclared[module] = place
    assert undeclared == {}, "imported, but not declared in pyproject.toml"
    assert set(declared()) - used - set(UNNAMED) == set(), "declared, but imported nowhere"


def test_every_import_of_the_tests_is_declared() -> None:
    owners = metadata.packages_distributions()
    asked = set(declared()) | set(declared("dev")) | set(declared("bench")) | set(declared("dask"))
    undeclared = {
        module: place
        for module, place in foreign(HOUSE / "tests").items()
        # Benchmarks against other software say themselves what they need.
        if not place.startswith("tests/benchmarks")
        and not {normal(name) for name in owners.get(module, [module])} & asked
    }
    assert undeclared == {}


def test_nutpie_is_capped_below_the_versions_with_another_core() -> None:
    assert declared()["nutpie"] == NUTPIE
    pinned = dict(
        line.split("==") for line in (HOUSE / ".ci" / "constraints.txt").read_text().split() if "==" in line
    )
    assert tuple(map(int, pinned["nutpie"].split("."))) < (0, 16, 9)


def test_every_declared_package_is_pinned() -> None:
    pinned = {normal(line.split("==")[0]) for line in (HOUSE / ".ci" / "constraints.txt").read_text().split()}
    assert set(declared()) | set(declared("dev")) - {"setuptools"} <= pinned
