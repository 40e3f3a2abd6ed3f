"""How many people it takes to show that modes are equal, against fits of whole studies."""

from dataclasses import replace

import pytest

from analysis.equality_reach import equality_reach, reach_of
from analysis.fit import fit
from analysis.observed_design import ObservedDesign, observed_design
from analysis.power.scenario import Scenario
from analysis.results import FitSettings

DESIGN = ObservedDesign(((0, 1), (0, 2), (1, 2)), 2, Scenario((1, 1, 1), 3, (0.5,), 0.7, 0.1), 7.0)


@pytest.mark.parametrize(
    ("people", "low", "high"), [(20, 0.0, 0.0), (60, 0.0, 0.05), (120, 0.3, 0.6), (240, 0.7, 1.0)]
)
def test_equality_is_found_as_often_as_fits_of_whole_studies_find_it(people, low, high) -> None:
    """An audit's fits found it in 0 of 24 studies of 20 people, 0 of 15 of 60, 6 of 12 of 120, 9 of 9 of
    240."""
    assert low <= equality_reach(replace(DESIGN, people=float(people))).share <= high


def test_the_sentence_says_how_many_are_needed_and_falls_silent_where_there_are_enough() -> None:
    small = equality_reach(DESIGN)
    assert small.enough == pytest.approx(255, abs=5)
    assert "no study of this size" in small.sentence
    assert "it takes about 250 participants" in small.sentence or "about 260 participants" in small.sentence
    assert "“Open” does not mean equal" in small.about_open
    large = equality_reach(replace(DESIGN, people=240.0))
    assert (large.sentence, large.about_open) == ("", "")


def test_people_who_differ_more_take_more_people() -> None:
    wide = replace(DESIGN, scenario=replace(DESIGN.scenario, subject_sd=1.4))
    assert equality_reach(wide).enough > 2 * equality_reach(DESIGN).enough


def test_the_design_is_read_from_the_fit(simulated) -> None:
    fitted = fit(simulated(5, participants=9))
    design = observed_design(fitted)
    means = {p.name: p.mean for p in fitted.questions[0].parameters}
    assert (design.pairs, design.repetitions, design.people) == (((0, 1), (0, 2), (1, 2)), 2, 9.0)
    assert design.scenario.cuts == (means["cut_1"], means["cut_2"])
    assert design.scenario.subject_sd == means["subject_sd"]
    assert not design.is_pooled
    pooled = fit(simulated(5, participants=9), FitSettings(pooled=True))
    assert observed_design(pooled).is_pooled
    assert reach_of(pooled) is None
