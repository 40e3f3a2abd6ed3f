"""The chance that coin tosses agree as much: published tables, counting all tosses, and large numbers."""

from itertools import product

import numpy as np
import pytest

from analysis import agreement_chance as module
from analysis.agreement_chance import agreement_chance


@pytest.mark.parametrize(
    ("agreements", "lead", "published"),
    [
        (6, (0, 0, 0), 1.000),
        (7, (2, 0, 0), 0.947),
        (8, (2, 2, 0), 0.736),
        (9, (2, 2, 2), 0.455),
        (10, (4, 0, 0), 0.330),
        (11, (4, 2, 0), 0.277),
        (12, (4, 2, 2), 0.137),
        (14, (4, 4, 0), 0.043),
        (15, (4, 4, 2), 0.025),
        (18, (4, 4, 4), 0.0020),
    ],
)
def test_four_people_and_three_modes_have_the_published_chances(agreements, lead, published) -> None:
    """Kendall & Babington Smith 1940, table of the agreements of m = 4 people about n = 3 objects."""
    assert sum(((4 + s) / 2) ** 2 + ((4 - s) / 2) ** 2 - 4 for s in lead) / 2 == agreements
    chance = agreement_chance(np.array(lead), np.array([4, 4, 4]))
    assert chance == pytest.approx(published, abs=0.0006)


def test_with_ties_the_chance_is_that_of_counting_every_set_of_tosses() -> None:
    decided, lead = np.array([5, 2, 3]), np.array([3, -2, 1])
    sums = [
        sum(sum(tosses[start : start + d]) ** 2 for start, d in ((0, 5), (5, 2), (7, 3)))
        for tosses in product((-1, 1), repeat=10)
    ]
    counted = np.mean(np.array(sums) >= (lead**2).sum())
    assert 0 < counted < 1
    assert agreement_chance(lead, decided) == counted


def test_where_nobody_decided_there_is_no_chance() -> None:
    assert np.isnan(agreement_chance(np.array([0, 0, 0]), np.array([0, 0, 0])))


@pytest.mark.parametrize("lead", [(60, 50, 40), (30, 20, 10), (20, -20, 44)])
def test_beyond_what_is_convolved_three_moments_come_near(lead, monkeypatch) -> None:
    decided = np.array([300, 280, 290])
    exact = agreement_chance(np.array(lead), decided)
    monkeypatch.setattr(module, "MOST_STEPS", 0)
    assert agreement_chance(np.array(lead), decided) == pytest.approx(exact, rel=0.05)
