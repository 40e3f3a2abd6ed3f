"""The words that participants read (``texts.toml``)."""

import tomllib
from functools import cache
from pathlib import Path

Words = dict[str, str]
Parts = dict[str, str | Words]


@cache
def texts() -> dict[str, Words]:
    """All texts by page and name; a nested table is a page of its own, ``watch.unlock``."""
    content = tomllib.loads(Path(__file__).with_name("texts.toml").read_text(encoding="utf-8"))
    pages: dict[str, Words] = {}
    for page, entries in content.items():
        pages[page] = {name: text for name, text in entries.items() if isinstance(text, str)}
        for name, nested in entries.items():
            if isinstance(nested, dict):
                pages[f"{page}.{name}"] = nested
    return pages


def texts_with_parts(page: str) -> Parts:
    """The texts of a page together with its nested tables by their names, ``unlock`` for ``guide.unlock``."""
    parts: Parts = {**texts()[page]}
    for name, words in texts().items():
        if name.startswith(f"{page}."):
            parts[name.removeprefix(f"{page}.")] = words
    return parts


def filled(words: Words, **values: object) -> Words:
    """Texts with some of their {names} filled in; the others are left to the browser."""

    def fill(text: str) -> str:
        for name, value in values.items():
            text = text.replace(f"{{{name}}}", str(value))
        return text

    return {name: fill(text) for name, text in words.items()}
