"""What is behind the convergence gate: draws that are good in all but one thing must not pass."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.diagnostics import (
    ESS_ABOVE,
    RHAT_BELOW,
    Convergence,
    convergence,
    ess_in_words,
    rhat_in_words,
    shown_ess,
    shown_rhat,
)
from analysis.engines import fast
from analysis.fit import fit
from analysis.gate import MOST_PAIRS, Gate, reported_convergence, watched_pairs
from analysis.results import Draws, FitSettings
from analysis.softmax import worth_of

SHAPE = (4, 1000)
BY_CHAIN = np.array([-1.0, -1.0, 1.0, 1.0])[:, None]


def draws_of(ability: np.ndarray, **parameters: np.ndarray) -> Draws:
    centred = ability - ability.mean(axis=-1, keepdims=True)
    return Draws(centred, worth_of(centred), parameters, np.zeros(SHAPE, dtype=bool))


def normal(*shape: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(*SHAPE, *shape))


def gate(draws: Draws) -> Gate:
    return reported_convergence(draws, [f"M{k + 1}" for k in range(draws.ability.shape[-1])])


def of_modes(by_mode: np.ndarray) -> Convergence:
    return convergence(np.moveaxis(by_mode, -1, 0))


def two_close_modes(lead: np.ndarray) -> Draws:
    """Three modes of which the first leads the second by little, while both move much and together."""
    both = 0.3 * normal()
    return draws_of(np.stack([both + lead / 2, both - lead / 2, -2 * both], axis=-1))


def test_good_draws_pass():
    state = gate(draws_of(normal(4), subject_sd=np.exp(normal(seed=2))))
    assert state.passed
    assert state.rhat.shape == (4 + 4 + 4 + 1 + 6,)


@pytest.mark.parametrize("name", ["side_effect", "cut_1", "cut_2", "log_nu", "subject_sd"])
def test_a_parameter_whose_chains_disagree_does_not_pass(name):
    assert not gate(draws_of(normal(3), **{name: normal(seed=2) + 0.5 * BY_CHAIN})).passed


def test_chains_that_disagree_only_on_who_leads_a_close_pair_do_not_pass():
    draws = two_close_modes(0.01 * (BY_CHAIN + 0.5 * normal(seed=2)))
    assert of_modes(draws.ability).passed
    assert of_modes(draws.worth).passed
    assert not gate(draws).passed


def test_chains_that_disagree_only_on_how_far_a_close_pair_is_apart_do_not_pass():
    # The first leads the second in every draw: no rank tells.
    draws = two_close_modes(0.01 * np.exp(0.5 * BY_CHAIN + 0.1 * normal(seed=2)))
    assert of_modes(draws.ability).passed
    assert of_modes(draws.worth).passed
    assert not gate(draws).passed


def test_chains_that_disagree_only_on_a_rank_do_not_pass():
    # Two chains lead in half, two in 0.7 of their draws, by less: mean and spread of the lead are the same.
    size, sign = np.abs(normal()), np.random.default_rng(2).uniform(size=SHAPE)
    even = np.where(sign < 0.5, size, -size)
    often = np.where(sign < 0.7, 0.8 * size, -1.5 * size)
    draws = draws_of(np.stack([np.where(BY_CHAIN < 0, even, often), np.zeros(SHAPE)], axis=-1))
    assert convergence((draws.ability[..., 0] - draws.ability[..., 1])[None]).passed
    assert of_modes(draws.worth).passed
    assert not gate(draws).passed


def test_a_slow_pair_is_found_by_its_effective_sample_size():
    lead = normal(seed=2)
    for t in range(1, SHAPE[1]):
        lead[:, t] += 0.95 * lead[:, t - 1]
    state = gate(two_close_modes(0.01 * lead))
    assert state.ess_min < ESS_ABOVE


def test_ranks_that_never_or_hardly_ever_change_pass():
    ability = 0.1 * normal(3) + np.array([4.0, 0.0, -4.0])
    assert gate(draws_of(ability)).passed
    ability[2, 17] = ability[2, 17, [1, 0, 2]]
    assert gate(draws_of(ability)).passed
    ability[1, 600] = ability[1, 600, [2, 1, 0]]
    assert gate(draws_of(ability)).passed


def test_an_infinite_or_missing_draw_does_not_pass():
    for wrong in (np.nan, np.inf):
        draws = draws_of(normal(3), cut_1=normal(seed=2))
        draws.parameters["cut_1"][3, 500] = wrong
        assert not gate(draws).passed


def test_a_refusal_names_the_worst_quantity_and_counts_those_that_fail():
    spread = np.exp(normal(seed=2) + 0.5 * BY_CHAIN)
    assert "1 of 13 quantities fails. The worst is the spread between participants: R-hat 1.1" in (
        gate(draws_of(normal(3), subject_sd=spread)).refusal
    )
    said = gate(two_close_modes(0.01 * (BY_CHAIN + 0.5 * normal(seed=2)))).refusal
    # The ranks of both and their difference.
    assert "3 of 12 quantities fail. The worst is the difference of M2 and M1: R-hat 1.7" in said
    both = np.stack([normal(), normal(seed=2) + 2 * BY_CHAIN, normal(seed=3)], axis=-1)
    assert "of M2" in gate(draws_of(both)).refusal
    assert gate(draws_of(normal(3))).refusal == ""


@pytest.mark.parametrize("rhat", [1.0096, 1.01, 1.01001, 1.0104, 1.2])
@pytest.mark.parametrize("ess", [399.7, 400.0, 400.3, 4000.0])
def test_printed_values_are_rounded_as_usual_and_words_say_on_which_side_of_the_limit_they_are(rhat, ess):
    state = Gate(np.array([rhat]), np.array([ess]), np.array([5000.0]), ("the worth of M1",))
    assert float(shown_rhat(rhat)) == round(rhat, 3)
    assert float(shown_ess(ess).replace(",", "")) == round(ess)
    passes = float(shown_rhat(rhat)) < RHAT_BELOW or "just below" in rhat_in_words(rhat)
    assert passes == (rhat < RHAT_BELOW)
    passes = round(ess) > ESS_ABOVE or "just above" in ess_in_words(ess)
    assert passes == (ess > ESS_ABOVE)
    assert state.passed == (rhat < RHAT_BELOW and ess > ESS_ABOVE)
    assert state.passed == (state.refusal == "")


def test_the_order_of_the_modes_does_not_matter_to_the_gate():
    draws = draws_of(np.cumsum(normal(5), axis=1) / 30 + normal(5, seed=2))
    other = replace(draws, ability=draws.ability[..., ::-1], worth=draws.worth[..., ::-1])
    one, two = gate(draws), gate(other)
    assert one.rhat_max == pytest.approx(two.rhat_max, rel=1e-12)
    assert one.ess_min == pytest.approx(two.ess_min, rel=1e-12)


@pytest.mark.parametrize(("modes", "apart"), [(2, 1), (3, 2), (100, 99), (200, 26), (1000, 5)])
def test_every_pair_is_watched_or_of_many_modes_the_neighbours_in_rank(modes, apart):
    place = np.random.default_rng(1).permutation(modes)
    ability = -place + np.zeros((2, 4, modes))
    pairs = watched_pairs(ability)
    assert len(pairs) <= max(MOST_PAIRS, modes)
    found = {(place[one], place[other]) for one, other in pairs}
    assert found == {(k, k + d) for d in range(1, apart + 1) for k in range(modes - d)}


def test_a_pair_that_does_not_converge_leaves_the_question_unranked_and_says_so(simulated, monkeypatch):
    sample = fast.sample

    def sticky_pair(problems, settings, done=lambda k: None):
        drawn = sample(problems, settings, done)
        n = settings.draws
        both = np.random.default_rng(1).normal(size=(4, n))
        lead = 0.01 * (BY_CHAIN + 0.5 * np.random.default_rng(2).normal(size=(4, n)))
        ability = np.stack([both + lead / 2, both - lead / 2, -2 * both], axis=-1)
        return [replace(d, ability=ability, worth=worth_of(ability)) for d in drawn]

    monkeypatch.setattr(fast, "sample", sticky_pair)
    question = fit(simulated(3), FitSettings(seed=7)).questions[0]
    assert not question.ranked
    assert question.rhat_max >= RHAT_BELOW
    assert "did not converge" in question.reason
    assert question.modes == ()
    assert all(np.isnan(pair.p_i_above_j) for pair in question.pairs)
