"""The page as a whole: a list of contents, figures counted without a gap, none of them blank."""

import html
import io
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from analysis.figures.persons import MOST_MODES
from analysis.figures.ranks import draw_ranks
from analysis.fit import fit
from analysis.persons import agreements
from analysis.report.people import agreement_section
from analysis.softmax import worth_of
from analysis.summaries import mode_results


def page_of(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8").replace("\u00a0", " ")


def text_of(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]+>", " ", page[page.index("<main>") :]).split()))


def dark_share(png: bytes, below: int = 245) -> float:
    """Share of the pixels that are not nearly white."""
    return float((np.asarray(Image.open(io.BytesIO(png)).convert("L")) < below).mean())


@pytest.fixture(scope="module")
def unranked_report(study_case, write_case, tmp_path_factory) -> Path:
    """Report of a fit in which no question converged."""
    questions = tuple(
        replace(q, ranked=False, reason="It did not converge.", modes=(), parameters=())
        for q in study_case.fit.questions
    )
    case = replace(
        study_case, fit=replace(study_case.fit, questions=questions, converged=False, ranked=False)
    )
    return write_case(case, tmp_path_factory.mktemp("unranked"))


@pytest.fixture(scope="module")
def one_person(study_case):
    """One participant's answers, fitted."""
    rows = study_case.table.rows
    own = rows[rows["participant"] == "p0"].reset_index(drop=True)
    table = replace(study_case.table, rows=own)
    return replace(study_case, table=table, fit=fit(table), stuck=None)


def test_the_contents_list_names_every_section_and_leads_there(study_report):
    page = page_of(study_report)
    contents = page[page.index("<nav") : page.index("</nav>")]
    links = dict(re.findall(r'<a href="#([^"]+)">([^<]+)</a>', contents))
    headings = re.findall(r'<section[^>]* id="([^"]+)">\s*<h2>([^<]+)</h2>', page)
    assert dict(headings) == links
    assert len(headings) == len(links) >= 15


@pytest.mark.parametrize("report", ["study_report", "simulated_report", "refused_report", "unranked_report"])
def test_figures_are_counted_from_one_without_a_gap_and_none_is_blank(report, request):
    folder = request.getfixturevalue(report)
    page = page_of(folder)
    numbers = [int(n) for n in re.findall(r"<b>Figure (\d+)\.</b>", page)]
    assert numbers == list(range(1, len(numbers) + 1))
    files = sorted((folder / "figures").glob("*.png"))
    assert {int(re.match(r"figure_(\d+)_", f.name)[1]) for f in files} == set(numbers)
    assert all(dark_share(f.read_bytes()) > 0.01 for f in files), [
        (f.name, dark_share(f.read_bytes())) for f in files
    ]


def test_without_any_ranking_no_empty_axes_are_drawn(unranked_report):
    names = {f.name.partition("_")[2].partition("_")[2] for f in (unranked_report / "figures").glob("*.svg")}
    assert not names & {"worth.svg", "pairwise.svg", "ranks.svg"}
    assert "answers.svg" in names
    assert "No question is ranked, so there are no worths to draw" in text_of(page_of(unranked_report))


def test_a_question_that_nobody_answered_stands_among_the_others(study_report):
    page = page_of(study_report)
    settled = text_of("<main>" + page[page.index('class="settled"') : page.index('class="cap">First is')])
    assert "Q1 smoothest no answers" in settled
    assert "Q1 smoothest is not ranked. Nobody answered this question." in text_of(page)


def test_one_participant_is_not_spoken_of_as_a_share_of_participants(one_person, write_case, tmp_path):
    said = text_of(page_of(write_case(one_person, tmp_path)))
    assert "What does one participant prefer?" in said
    assert "% of the participants" not in said
    assert "of these 1 participants" not in said
    assert "this participant's own first" in said
    section = agreement_section_of(one_person)
    assert "94 % interval" not in section.table.columns


def agreement_section_of(case):
    from analysis.closer_look import closer_look

    return agreement_section(closer_look(case.table, case.fit), case.fit, "")


def test_of_many_modes_those_with_the_highest_worth_are_drawn_for_each_participant(many_case):
    section = agreement_section_of(many_case)
    (drawing,) = section.drawings
    texts = re.findall(r">([^<>]+)</text>", drawing.svg)
    by_worth = sorted(many_case.fit.questions[0].modes, key=lambda m: -m.worth_mean)
    assert {m.mode for m in by_worth[:MOST_MODES]} <= set(texts)
    assert not {m.mode for m in by_worth[MOST_MODES:]} & set(texts)
    assert f"the {MOST_MODES} with the highest worth are drawn" in section.caption


def test_with_too_many_modes_a_new_persons_first_is_still_told(many_case, monkeypatch):
    monkeypatch.setattr("analysis.persons.MOST_MODES", 9)
    (agreement,) = agreements(many_case.table, many_case.fit)
    assert not agreement.people
    assert "at most 9 modes" in agreement.reason
    assert agreement.first == max(many_case.fit.questions[0].modes, key=lambda m: m.p_best).mode
    assert 0 < agreement.new_person < 1


def test_ranks_of_forty_modes_are_drawn_to_be_seen(study_case):
    rng = np.random.default_rng(1)
    ability = rng.normal(size=(2, 500, 40)) * 0.5 + np.linspace(1.5, -1.5, 40)
    names = tuple(f"m{k}" for k in range(40))
    question = study_case.fit.questions[0]
    draws = replace(question.draws, ability=ability, worth=worth_of(ability))
    many = replace(question, draws=draws, modes=mode_results(draws, names))
    (drawing,) = draw_ranks((many,), names)
    assert dark_share(drawing.png, below=230) > 0.12
    texts = re.findall(r">([^<>]+)</text>", drawing.svg)
    assert "chance" in texts
    assert {"1", "5", "40"} <= set(texts)
    assert "13" not in texts


def test_no_report_speaks_of_significance_or_of_what_a_metric_does(study_report, simulated_report):
    for folder in (study_report, simulated_report):
        said = text_of(page_of(folder)).lower()
        for word in ("significant", "causes", "because of the metric", "leads to", "due to"):
            assert word not in said
        assert "credible interval" in said
