"""Maximum likelihood against published estimates, to the printed digits."""

import numpy as np
import pytest

from analysis.counts import count_responses
from analysis.maximum import Estimate, _design, _surface, maximum_a_posteriori, maximum_likelihood
from analysis.model import Model
from data.errors import ElbowroomError

DAVIDSON = {
    "Barcelona": (0.6129, 0.0752),
    "London": (1.8228, 0.0831),
    "Milano": (0.4420, 0.0760),
    "Paris": (1.0325, 0.0776),
    "St.Gallen": (0.5983, 0.0752),
}
RAO_KUPPER = {
    "Barcelona": (0.5307, 0.0659),
    "London": (1.6299, 0.0726),
    "Milano": (0.3883, 0.0665),
    "Paris": (0.9125, 0.0683),
    "St.Gallen": (0.5156, 0.0662),
}
BASEBALL = {
    "Boston": (1.1077, 0.3339),
    "Cleveland": (0.6839, 0.3319),
    "Detroit": (1.4364, 0.3396),
    "Milwaukee": (1.5814, 0.3433),
    "New York": (1.2476, 0.3359),
    "Toronto": (1.2945, 0.3367),
}


def against(estimate: Estimate, reference: str) -> dict[str, tuple[float, float]]:
    """Contrasts with one mode, and their standard errors."""
    r, c = estimate.modes.index(reference), estimate.ability_covariance
    return {
        mode: (
            float(estimate.ability[k] - estimate.ability[r]),
            float(np.sqrt(c[k, k] + c[r, r] - 2 * c[k, r])),
        )
        for k, mode in enumerate(estimate.modes)
        if k != r
    }


def assert_published(
    found: dict[str, tuple[float, float]], published: dict[str, tuple[float, float]]
) -> None:
    assert found.keys() == published.keys()
    for mode, (ability, error) in published.items():
        assert found[mode][0] == pytest.approx(ability, abs=6e-5)
        # Standard errors from another program's curvature: to a unit of the last printed digit.
        assert found[mode][1] == pytest.approx(error, abs=1e-4)


@pytest.mark.parametrize(
    ("link", "published", "name", "shape", "log_likelihood"),
    [
        ("adjacent", DAVIDSON, "log_nu", (-1.3172, 0.0485), -3964.378),
        ("cumulative", RAO_KUPPER, "log_gap_1", (-1.3826, 0.0431), -3960.742),
    ],
)
def test_business_schools_have_the_published_abilities(cems, link, published, name, shape, log_likelihood):
    counts = count_responses(cems, cems.questions[0])
    estimate = maximum_likelihood(counts, Model(3, link, False, False, 1.0))
    assert_published(against(estimate, "Stockholm"), published)
    assert estimate.parameters[name] == pytest.approx(shape[0], abs=6e-5)
    assert estimate.parameter_sd[name] == pytest.approx(shape[1], abs=6e-5)
    assert estimate.log_likelihood == pytest.approx(log_likelihood, abs=6e-4)


def deviance(counts, estimate: Estimate) -> float:
    """Twice the distance to the model that fits every cell."""
    answers = counts.pooled().responses
    share = answers / answers.sum(axis=1, keepdims=True)
    saturated = np.where(answers > 0, answers * np.log(np.where(share > 0, share, 1.0)), 0.0).sum()
    return float(2 * (saturated - estimate.log_likelihood))


def test_baseball_has_the_published_abilities_and_deviance(baseball):
    counts = count_responses(baseball, baseball.questions[0])
    without_home = maximum_likelihood(counts, Model(2, "cumulative", False, False, 1.0))
    assert_published(against(without_home, "Baltimore"), BASEBALL)
    with_home = maximum_likelihood(counts, Model(2, "cumulative", False, True, 1.0))
    assert with_home.parameters["side_effect"] == pytest.approx(0.3023, abs=6e-5)
    assert with_home.parameter_sd["side_effect"] == pytest.approx(0.1309, abs=6e-5)
    assert deviance(counts, without_home) == pytest.approx(44.053, abs=6e-4)
    assert deviance(counts, with_home) == pytest.approx(38.643, abs=6e-4)


def test_three_modes_have_the_known_maximum(wins_table):
    table = wins_table([[0, 10, 5], [4, 0, 3], [9, 11, 0]])
    counts = count_responses(table, table.questions[0])
    ability = maximum_likelihood(counts, Model(2, "cumulative", False, False, 1.0)).ability
    worth = np.exp(ability) / np.exp(ability).sum()
    np.testing.assert_allclose(worth, [0.31997, 0.13658, 0.54345], atol=6e-6)


@pytest.mark.parametrize(("levels", "link"), [*((n, "cumulative") for n in range(2, 10)), (3, "adjacent")])
@pytest.mark.parametrize("has_priors", [True, False])
def test_slopes_and_curvature_are_those_of_finite_differences(simulated, levels, link, has_priors):
    table = simulated(levels)
    cells = count_responses(table, table.questions[0]).pooled()
    model = Model(levels, link, False, True, 1.0)
    design = _design(cells, model)
    x = np.random.default_rng(1).normal(size=2 + len(model.parameter_names(("M1", "M2", "M3"))))

    def at(shift):
        return _surface(x + shift, cells, model, design, has_priors)

    step = 1e-5
    _, gradient, curvature = at(0.0)
    np.testing.assert_allclose(
        gradient, [(at(step * e)[0] - at(-step * e)[0]) / (2 * step) for e in np.eye(len(x))], atol=1e-6
    )
    np.testing.assert_allclose(
        curvature, [(at(step * e)[1] - at(-step * e)[1]) / (2 * step) for e in np.eye(len(x))], atol=1e-6
    )


def test_a_mode_that_always_wins_has_no_maximum_but_a_most_probable_place(wins_table):
    table = wins_table([[0, 5, 5], [0, 0, 3], [0, 2, 0]])
    counts = count_responses(table, table.questions[0])
    model = Model(2, "cumulative", False, False, 1.0)
    with pytest.raises(ElbowroomError, match="no most likely ranking"):
        maximum_likelihood(counts, model)
    assert maximum_a_posteriori(counts, model).ability[0] > 1.0
