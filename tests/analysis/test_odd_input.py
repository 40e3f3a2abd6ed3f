"""Odd but valid answers go from the file to the report unharmed, and nothing in them is ever executed."""

import csv
import json
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.counts import count_responses
from analysis.fit import fit
from analysis.report import write_report
from analysis.results import FitSettings
from data.errors import InputError
from data.response_csv import read_response_csv

SETTINGS = FitSettings(draws=500, tune=300)
ODD_NAMES = (
    'comma, and "quotes"',
    "two\nlines",
    "שיטה א",
    "=HYPERLINK(1)",
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "$\\frac{a}{$",
    "{{ 7 * 7 }}",
    "x" * 300,
)


def write_rows(path: Path, rows: list[dict[str, object]]) -> Path:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return path


def round_robin(names: tuple[str, ...], seed: int = 1) -> list[dict[str, object]]:
    """Every pair of names by four people, answers at random."""
    rng = np.random.default_rng(seed)
    pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 1 :]]
    return [
        {
            "participant": person,
            "mode_a": pair[side],
            "mode_b": pair[1 - side],
            "response": rng.choice(["A>B", "A=B", "B>A"]),
        }
        for person in ("p, 1", "<b>p2</b>", "=3+4", "p\n4")
        for pair in pairs
        for side in (0, 1)
    ]


class Elements(HTMLParser):
    """What a browser would run: scripts, and attributes that are event handlers or script addresses."""

    def __init__(self) -> None:
        super().__init__()
        self.active: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in {"script", "iframe", "object", "embed", "link"}:
            self.active.append(tag)
        for name, value in attrs:
            if name.startswith("on") or (value or "").strip().lower().startswith("javascript:"):
                self.active.append(f"{tag} {name}")

    handle_startendtag = handle_starttag


def test_odd_names_come_through_and_nothing_in_them_runs(tmp_path):
    path = write_rows(tmp_path / "odd.csv", round_robin(ODD_NAMES))
    table = read_response_csv(path)
    assert set(table.modes) == set(ODD_NAMES)
    write_report(table, fit(table, SETTINGS), tmp_path / "report")
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    found = Elements()
    found.feed(page)
    assert found.active == []
    assert "{{ 7 * 7 }}" in page
    assert "&lt;script&gt;" in page
    worth = pd.read_csv(tmp_path / "report" / "worth.csv", keep_default_na=False)
    assert len(worth) == len(ODD_NAMES)
    assert worth["worth_mean"].sum() == pytest.approx(1)
    for picture in (tmp_path / "report" / "figures").glob("*.svg"):
        drawing = Elements()
        drawing.feed(picture.read_text(encoding="utf-8"))
        assert drawing.active == [], picture.name


def test_a_file_full_of_duplicates_counts_them_all(tmp_path):
    rows = round_robin(("M1", "M2", "M3"))
    once = read_response_csv(write_rows(tmp_path / "once.csv", rows))
    twice = read_response_csv(write_rows(tmp_path / "twice.csv", rows * 2))
    a, b = (count_responses(t, t.questions[0]) for t in (once, twice))
    assert np.array_equal(2 * a.responses, b.responses)
    assert b.n == 2 * len(rows)


def test_a_participant_with_one_answer_is_a_participant(tmp_path):
    rows = [*round_robin(("M1", "M2", "M3")), {"participant": "once", "mode_a": "M1", "mode_b": "M2"}]
    rows[-1]["response"] = "A>B"
    table = read_response_csv(write_rows(tmp_path / "one.csv", rows))
    found = fit(table, SETTINGS).questions[0]
    assert (found.n_participants, found.ranked) == (5, True)


def test_one_answer_in_all_is_ranked_with_a_warning_and_a_report(tmp_path):
    rows = [{"participant": "p", "mode_a": "M1", "mode_b": "M2", "response": "A>B"}]
    table = read_response_csv(write_rows(tmp_path / "least.csv", rows))
    found = fit(table)
    said = " ".join(found.questions[0].warnings)
    assert "one participant's" in said
    assert "Few data" in said
    write_report(table, found, tmp_path / "report")
    assert json.loads((tmp_path / "report" / "summary.json").read_text())["ranked"] is found.ranked


@pytest.mark.parametrize("pooled", [True, False])
def test_a_billion_answers_in_a_row_are_ranked_or_openly_not(tmp_path, pooled, monkeypatch):
    monkeypatch.setattr("analysis.fit.LONGER", ())
    rows = [
        {"participant": person, "mode_a": a, "mode_b": b, "response": answer, "count": count}
        for person in ("p", "q")
        for a, b in (("M1", "M2"), ("M2", "M3"), ("M1", "M3"))
        for answer, count in (("A>B", 10**9), ("A=B", 5 * 10**8), ("B>A", 5 * 10**8))
    ]
    table = read_response_csv(write_rows(tmp_path / "many.csv", rows))
    found = fit(table, replace(SETTINGS, pooled=pooled, side_effect=False)).questions[0]
    assert found.n == 12 * 10**9
    assert np.isfinite(found.draws.ability).all()
    # The chains either agree, and then closely, or the question is openly not ranked.
    if found.ranked:
        assert [m.mode for m in sorted(found.modes, key=lambda m: m.rank_mean)] == ["M1", "M2", "M3"]
        assert pooled is False or max(m.ability_sd for m in found.modes) < 1e-3
    else:
        assert "did not converge" in found.reason


def test_ten_thousand_modes_of_one_comparison_each_are_refused_in_a_line(tmp_path):
    rows = [{"mode_a": f"a{k}", "mode_b": f"b{k}", "response": "A>B"} for k in range(5000)]
    table = read_response_csv(write_rows(tmp_path / "wide.csv", rows))
    with pytest.raises(InputError, match="10000 modes are more than a report can rank") as caught:
        fit(table)
    assert "\n" not in str(caught.value)


def test_a_hundred_modes_of_one_comparison_each_are_not_ranked_and_the_report_says_why(tmp_path):
    rows = [{"mode_a": f"a{k}", "mode_b": f"b{k}", "response": "A>B"} for k in range(50)]
    table = read_response_csv(write_rows(tmp_path / "pairs.csv", rows))
    found = fit(table)
    assert not found.ranked
    assert "50 groups never compared with each other" in found.questions[0].reason
    write_report(table, found, tmp_path / "report")
    assert json.loads((tmp_path / "report" / "summary.json").read_text())["ranked"] is False
