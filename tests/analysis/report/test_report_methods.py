"""The methods paragraphs and the references: what the code does, and every source named and listed."""

import re
from dataclasses import replace

import pytest

from analysis.closer_look import closer_look
from analysis.report.methods import methods
from analysis.report.references import SOURCES, cited
from analysis.results import FitSettings
from analysis.stuck import stuck_rates
from data.study_file import read_study

YEAR = re.compile(r"[A-Z][A-Za-z&. -]+?,? \(?((?:19|20)\d\d)\b")


def text_of(fit, **more):
    return " ".join(str(paragraph.text) for paragraph in methods(fit, **more))


def with_settings(case, levels=None, **settings):
    """The case's fit as if it had been made with other settings."""
    questions = case.fit.questions
    if levels is not None:
        questions = tuple(replace(q, question=replace(q.question, levels=levels)) for q in questions)
    if settings.get("engine") == "gibbs" or settings.get("pooled"):
        questions = tuple(replace(q, hierarchical=False) for q in questions)
    return replace(case.fit, questions=questions, settings=replace(FitSettings(), **settings))


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"engine": "pymc"},
        {"engine": "gibbs"},
        {"link": "adjacent", "levels": 3},
        {"levels": 2, "side_effect": False, "pooled": True},
    ],
)
def test_every_year_in_the_methods_stands_in_the_references(study_case, settings):
    look = closer_look(study_case.table, study_case.fit)
    fit = with_settings(study_case, **settings)
    rates = stuck_rates(study_case.stuck)
    text = text_of(fit, look=look, rates=rates, study=read_study("carmichael2017"))
    listed = cited(text)
    assert {int(year) for year in YEAR.findall(text)} - {FitSettings.seed} == (
        {s.year for s in listed} - {FitSettings.seed}
    )
    assert len(listed) == len(set(listed)) >= 8


def test_references_stand_in_the_order_of_their_first_authors():
    assert [s.text for s in SOURCES] == sorted((s.text for s in SOURCES), key=str.lower)
    assert all(f"({s.year})" in s.text for s in SOURCES)


def test_the_methods_state_the_model_that_was_fitted(study_case):
    full = text_of(study_case.fit)
    assert "<i>τ</i> (<i>z</i><sub>A</sub>" in full
    assert "b is a side effect" in full
    assert "Rao & Kupper (1967)" in full
    assert "τ ~ HalfNormal(1)" in full
    bare = text_of(with_settings(study_case, side_effect=False, pooled=True))
    assert "<i>τ</i>" not in bare
    assert "no side effect" in bare
    assert "(pooled)" in bare
    assert "Davidson (1970)" in text_of(with_settings(study_case, levels=3, link="adjacent"))
    gibbs = text_of(with_settings(study_case, engine="gibbs"))
    assert "Caron & Doucet (2012)" in gibbs
    assert "No-U-Turn" not in gibbs
    assert "Every stronger answer was taken as the weakest preference." in gibbs


def test_the_papers_figure_is_named_for_its_own_study_alone(study_case):
    assert "Carmichael" in text_of(study_case.fit, study=read_study("carmichael2017"))
    assert "Carmichael" not in text_of(study_case.fit)


def test_the_gate_that_is_stated_is_the_gate_that_holds(study_case):
    from analysis.diagnostics import ESS_ABOVE, RHAT_BELOW
    from analysis.fit import LONGER

    text = text_of(study_case.fit)
    assert f"R-hat below {RHAT_BELOW} " in text
    assert f"above {ESS_ABOVE:.0f} " in text
    assert f"up to {max(LONGER)} times as many draws" in text
