"""What the README files say is there."""

import re
from pathlib import Path

import pytest
from typer.main import get_command

from app.cli.main import cli

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    "README.md",
    "analysis/README.md",
    "app/README.md",
    "app/server/README.md",
    "data/README.md",
    "data/convert/README.md",
    "sim_trials/README.md",
]
LARGEST_PICTURE = 120_000
"""Of a picture [bytes]: the page stays quick."""


def text_of(page: str) -> str:
    return (ROOT / page).read_text(encoding="utf-8")


def anchors_of(page: Path) -> set[str]:
    """The headings of a page as they are linked to."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES)
def test_every_link_to_a_file_of_ours_leads_somewhere(page: str) -> None:
    links = re.findall(r"\]\(([^)\s]+)\)", text_of(page))
    for link in (link for link in links if "://" not in link):
        path, _, anchor = link.partition("#")
        target = (ROOT / page).parent / path if path else ROOT / page
        assert target.exists(), link
        assert not anchor or anchor in anchors_of(target), link


def test_every_picture_is_shown_described_and_small() -> None:
    pattern = r"!\[([^\]]*)\]\((?:\.\./)?\.pictures/([a-z0-9-]+\.png)\)"
    shown = [found for page in PAGES for found in re.findall(pattern, text_of(page))]
    pictures = {picture.name: picture for picture in (ROOT / ".pictures").iterdir()}
    assert {name for _, name in shown} == set(pictures)
    assert all(alt for alt, _ in shown)
    for picture in pictures.values():
        assert picture.stat().st_size < LARGEST_PICTURE, picture.name


def test_every_command_is_in_the_table() -> None:
    rows = re.findall(r"^\| (`[^|]+) \|", text_of("README.md").partition("## Commands")[2], re.MULTILINE)
    named = {name.split()[0] for row in rows for name in re.findall(r"`([^`]+)`", row)}
    commands = set(get_command(cli).commands)
    assert named - {"show", "check"} >= commands
    assert named <= commands | {"show", "check", "elbowroom"}


def test_the_options_of_serve_are_explained() -> None:
    serve = get_command(cli).commands["serve"]
    options = {name for parameter in serve.params for name in parameter.opts if name.startswith("--")}
    page = text_of("app/server/README.md")
    assert [name for name in options - {"--help"} if f"`{name}" not in page] == []


@pytest.mark.parametrize("page", ["app/README.md", "app/server/README.md"])
def test_the_tour_names_only_files_that_exist(page: str) -> None:
    there = {path.name for folder in ("app", "tests") for path in (ROOT / folder).rglob("*.py")}
    named = re.findall(r"`(?:\w+/)*(\w+\.py)`", text_of(page))
    assert named
    assert [name for name in named if name not in there] == []
