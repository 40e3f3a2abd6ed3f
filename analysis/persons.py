"""Each participant's own preferences: what the hierarchical model knows of every person.

The samplers keep the group's parameters alone. Given those, people are independent of each other, so a
person's own deviations follow from that person's answers: nodes from their prior, weighted by the likelihood
of the answers (importance sampling, draw by draw).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.answer_shares import answer_probabilities, thinned
from analysis.counts import Counts, count_responses
from analysis.diagnostics import hdi
from analysis.results import HDI_PROBABILITY, Draws, Fit, QuestionFit
from analysis.softmax import worth_of
from analysis.zero_sum import zero_sum_basis
from data.responses import ResponseTable

FloatArray = NDArray[np.float64]

MOST_MODES = 8
"""With more modes than these, nodes from the prior cannot cover a person's deviations."""
MOST_PEOPLE = 60
"""With more people than these, persons are summed up and not listed."""
FEWEST_NODES = 8.0
"""Effective nodes a draw below which a person's worths would rest on too few of them. Untuned."""
_DRAWS, _NODES = 200, 128


@dataclass(frozen=True)
class PersonWorth:
    """One mode in one participant's own order.

    Attributes
    ----------
    worth_mean, worth_hdi_low, worth_hdi_high : float
        Of the person's own worth, 94 % HDI.
    p_first : float
        Posterior probability that the mode is the person's own first.
    """

    participant: str
    mode: str
    worth_mean: float
    worth_hdi_low: float
    worth_hdi_high: float
    p_first: float


@dataclass(frozen=True)
class Agreement:
    """How many people's own first mode is the group's first, on one question.

    Attributes
    ----------
    first : str
        The mode that most often ranks first for the group.
    share_mean, share_hdi_low, share_hdi_high : float
        Share of these participants whose own first it is; 94 % HDI.
    new_person : float
        Probability that it is the own first of someone who has not taken part.
    people : tuple of PersonWorth
        Participant by participant, mode by mode.
    reason : str
        Why nothing is said of single participants, where nothing is; their shares are NaN then, and all else
        too if the model knows no differences between people.
    """

    question: str
    first: str
    share_mean: float
    share_hdi_low: float
    share_hdi_high: float
    new_person: float
    people: tuple[PersonWorth, ...]
    reason: str = ""


def agreements(table: ResponseTable, fit: Fit, seed: int = 2017) -> tuple[Agreement, ...]:
    """One agreement a question, in the order of the fit."""
    return tuple(_agreement(table, fit, question, seed) for question in fit.questions)


def prior_nodes(n_modes: int, n: int = _NODES) -> FloatArray:
    """Points spread as a person's deviations are before any answer: ZeroSumNormal(1) over the modes.

    Returns
    -------
    ndarray, shape (n, mode)
        Scrambled Sobol points (Owen 1998) put through the normal quantile; ``n`` a power of two.
    """
    from scipy.special import ndtri
    from scipy.stats import qmc

    sobol = qmc.Sobol(n_modes - 1, rng=np.random.default_rng(1998))
    return np.asarray(ndtri(sobol.random(n)) @ zero_sum_basis(n_modes).T)


def log_likelihoods(
    counts: Counts, ability: FloatArray, parameters: Mapping[str, FloatArray], nodes: FloatArray
) -> FloatArray:
    """Log-likelihood of every participant's answers, were their deviations each of the nodes.

    Parameters
    ----------
    ability : ndarray, shape (draw, mode)
        In the order of ``counts.modes``.
    parameters : mapping of str to ndarray, shape (draw,)
    nodes : ndarray, shape (node, mode)

    Returns
    -------
    ndarray, shape (participant, draw, node)
    """
    own = own_abilities(ability, parameters, nodes)
    columns = {name: values[:, None] for name, values in parameters.items()}
    side = columns.get("side_effect", np.zeros((len(ability), 1)))
    total = np.zeros((len(counts.participants), *own.shape[:2]))
    pairs = counts.mode_a * len(counts.modes) + counts.mode_b
    for pair in np.unique(pairs):
        a, b = divmod(int(pair), len(counts.modes))
        chances = answer_probabilities(own[..., a] - own[..., b] + side, columns, counts.levels)
        logs = np.log(np.maximum(chances, 1e-300))
        for cell in np.flatnonzero(pairs == pair):
            total[counts.participant[cell]] += logs @ counts.responses[cell]
    return total


def own_abilities(ability: FloatArray, parameters: Mapping[str, FloatArray], nodes: FloatArray) -> FloatArray:
    """The group's abilities with a person's deviations: ndarray, shape (draw, node, mode)."""
    spread = parameters.get("subject_sd", np.zeros(len(ability)))
    return ability[:, None, :] + spread[:, None, None] * nodes


def _agreement(table: ResponseTable, fit: Fit, question: QuestionFit, seed: int) -> Agreement:
    name, nan = question.question.name, float("nan")

    def nothing(reason: str, first: str = "", new_person: float = nan) -> Agreement:
        return Agreement(name, first, nan, nan, nan, new_person, (), reason)

    draws = question.draws
    if draws is None or not question.ranked:
        return nothing("The question is not ranked.")
    if "subject_sd" not in draws.parameters:
        why = (
            "Participants are pooled in this fit"
            if table.has_participants
            else "The answers name no participants"
        )
        return nothing(f"{why}, so nothing is known of single people's own order.")
    first = max(range(len(fit.modes)), key=lambda k: question.modes[k].p_best)
    kept = thinned(draws, _DRAWS)
    prior = own_abilities(kept.ability, kept.parameters, prior_nodes(len(fit.modes)))
    new_person = float((prior.argmax(axis=-1) == first).mean())
    if len(fit.modes) > MOST_MODES:
        reason = f"Each participant's own worths are worked out for at most {MOST_MODES} modes."
        return nothing(reason, fit.modes[first], new_person)
    counts = count_responses(table, question.question)
    own, effective = _own_draws(draws, fit.modes, counts, seed)
    if effective < FEWEST_NODES:
        reason = "There are so many answers a person that each participant's own worths would be too rough."
        return nothing(reason, fit.modes[first], new_person)
    is_first = own.argmax(axis=-1) == first
    shares = is_first.mean(axis=0)
    low, high = hdi(shares, HDI_PROBABILITY)
    return Agreement(
        name,
        fit.modes[first],
        float(shares.mean()),
        float(low),
        float(high),
        new_person,
        _person_worths(counts, fit.modes, own),
    )


def _own_draws(draws: Draws, modes: tuple[str, ...], counts: Counts, seed: int) -> tuple[FloatArray, float]:
    """Draws of every person's abilities, (person, draw, mode), and the median effective nodes a draw."""
    kept = thinned(draws, _DRAWS)
    nodes = prior_nodes(len(modes))
    sorted_order = [modes.index(mode) for mode in counts.modes]
    logs = log_likelihoods(counts, kept.ability[:, sorted_order], kept.parameters, nodes[:, sorted_order])
    weights = np.exp(logs - logs.max(axis=-1, keepdims=True))
    weights /= weights.sum(axis=-1, keepdims=True)
    effective = float(np.median(1.0 / (weights**2).sum(axis=-1)))
    at = np.random.default_rng(seed).random((*weights.shape[:2], 1))
    chosen = (np.cumsum(weights, axis=-1) < at).sum(axis=-1).clip(max=len(nodes) - 1)
    spread = kept.parameters["subject_sd"][None, :, None]
    return kept.ability[None] + spread * nodes[chosen], effective


def _person_worths(counts: Counts, modes: tuple[str, ...], own: FloatArray) -> tuple[PersonWorth, ...]:
    worth = worth_of(own)
    mean, (low, high) = worth.mean(axis=1), hdi(np.swapaxes(worth, 0, 1), HDI_PROBABILITY)
    first = (own.argmax(axis=-1)[..., None] == np.arange(len(modes))).mean(axis=1)
    return tuple(
        PersonWorth(person, mode, float(mean[s, k]), float(low[s, k]), float(high[s, k]), float(first[s, k]))
        for s, person in enumerate(counts.participants)
        for k, mode in enumerate(modes)
    )
