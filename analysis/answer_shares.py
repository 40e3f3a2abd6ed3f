"""The answers people gave to each pair of modes, and the shares the fitted model expects."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.counts import Counts, count_responses
from analysis.diagnostics import hdi
from analysis.model import LEARNING, adjacent_log_probabilities, cumulative_log_probabilities
from analysis.results import HDI_PROBABILITY, Draws, Fit, QuestionFit
from data.responses import ResponseTable

FloatArray = NDArray[np.float64]

DRAWS_USED = 400
"""Thinned to about this many: the error of a mean share is then far below what a drawing shows."""
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(15)


@dataclass(frozen=True)
class PairShares:
    """The answers to one pair of modes, turned so that the first mode stands as A.

    Attributes
    ----------
    counts : tuple of int
        From much more the first (or more, on a shorter scale) to much more the second.
    expected : tuple of float
        Posterior mean share of each answer among new people who see the pair in the same
        orders; empty where the model has none.
    expected_low, expected_high : tuple of float
        94 % HDI of these shares.
    much_i, much_j : tuple of float
        Posterior mean and 94 % HDI of the share of all answers for a mode that are stronger than the weakest
        preference, among new people; empty where the model has none or the scale has no such answer.
    """

    mode_i: str
    mode_j: str
    counts: tuple[int, ...]
    expected: tuple[float, ...] = ()
    expected_low: tuple[float, ...] = ()
    expected_high: tuple[float, ...] = ()
    much_i: tuple[float, ...] = ()
    much_j: tuple[float, ...] = ()

    @property
    def n(self) -> int:
        """Answers to this pair."""
        return sum(self.counts)


@dataclass(frozen=True)
class ThinnedDraws:
    """Evenly chosen draws, chains laid end to end: ``ability`` (draw, mode), each parameter (draw,)."""

    ability: FloatArray
    parameters: dict[str, FloatArray]


def thinned(draws: Draws, number: int = DRAWS_USED) -> ThinnedDraws:
    """About so many of the draws, evenly chosen."""
    ability = draws.ability.reshape(-1, draws.ability.shape[-1])
    every = max(1, len(ability) // number)
    return ThinnedDraws(
        ability[::every], {name: values.reshape(-1)[::every] for name, values in draws.parameters.items()}
    )


def answer_shares(table: ResponseTable, fit: Fit) -> tuple[tuple[PairShares, ...], ...]:
    """Per question of the fit, the pairs that were asked, in the order of the modes."""
    return tuple(_pairs(table, fit, question) for question in fit.questions)


def _pairs(table: ResponseTable, fit: Fit, question: QuestionFit) -> tuple[PairShares, ...]:
    counts = count_responses(table, question.question, in_order=fit.settings.position)
    modes, levels = question.mode_names, question.question.levels
    place = np.array([modes.index(mode) for mode in counts.modes])
    first, second = place[counts.mode_a], place[counts.mode_b]
    draws = question.draws if question.ranked else None
    if draws is not None and not knows_scale(draws.parameters, levels):
        draws = None
    shown = np.zeros((len(modes), len(modes), levels), dtype=np.int64)
    np.add.at(shown, (first, second), counts.responses)
    pairs = []
    for i in range(len(modes)):
        for j in range(i + 1, len(modes)):
            as_ij, as_ji = shown[i, j], shown[j, i]
            if not as_ij.any() and not as_ji.any():
                continue
            answers = tuple(int(n) for n in as_ij + as_ji[::-1])
            if draws is None:
                pairs.append(PairShares(modes[i], modes[j], answers))
                continue
            ways = [
                _Shown(int(as_ij.sum()), _orders(counts, (first == i) & (second == j))),
                _Shown(int(as_ji.sum()), _orders(counts, (first == j) & (second == i))),
            ]
            expected = _expected(draws, levels, modes, i, j, ways)
            pairs.append(_with_expected(PairShares(modes[i], modes[j], answers), expected))
    return tuple(pairs)


@dataclass(frozen=True)
class _Shown:
    """How often a pair was shown with one side first, and, where it matters, when.

    Attributes
    ----------
    order : _Orders or None
    """

    n: int
    order: "_Orders | None"


@dataclass(frozen=True)
class _Orders:
    """Different orders as in ``Counts.order``, (order, 3), and how many answers were given in each."""

    at: FloatArray
    n: NDArray[np.int64]


def _orders(counts: Counts, cells: NDArray[np.bool_]) -> _Orders | None:
    if counts.order is None:
        return None
    at, which = np.unique(counts.order[cells], axis=0, return_inverse=True)
    n = np.bincount(which.ravel(), counts.responses[cells].sum(axis=1), minlength=len(at))
    return _Orders(at, n.astype(np.int64))


def _with_expected(pair: PairShares, expected: FloatArray) -> PairShares:
    levels = expected.shape[1]
    half = levels // 2
    stronger = [expected[:, : half - 1], expected[:, levels - half + 1 :]] if half > 1 else []
    shares = np.concatenate([expected, *(s.sum(axis=1, keepdims=True) for s in stronger)], axis=1)
    low, high = hdi(shares, HDI_PROBABILITY)
    found = [(float(m), float(a), float(b)) for m, a, b in zip(shares.mean(axis=0), low, high, strict=True)]
    mean, least, most = zip(*found[:levels], strict=True)
    much_i, much_j = found[levels:] or ((), ())
    return replace(
        pair,
        expected=mean,
        expected_low=least,
        expected_high=most,
        much_i=much_i,
        much_j=much_j,
    )


def _expected(
    draws: Draws, levels: int, modes: tuple[str, ...], i: int, j: int, ways: list[_Shown]
) -> FloatArray:
    """Draws of the shares, (draw, level), over people and over the ways in which the pair was shown.

    The deviations z of a person are ZeroSumNormal(1) over the modes, so z_i - z_j has variance 2 whatever the
    number of modes, and a person's own side adds its own variance; the integrals over these and over a
    person's own width are Gauss-Hermite quadratures.
    """
    kept = thinned(draws)
    parameters = {name: values[:, None] for name, values in kept.parameters.items()}
    lead = (kept.ability[:, i] - kept.ability[:, j])[:, None]
    zero = np.zeros_like(lead)
    side = parameters.get("side_effect", zero)
    people = np.sqrt(2.0) * parameters.get("subject_sd", zero) * _NODES
    if "side_sd" in parameters:
        variance = 2.0 * parameters.get("subject_sd", zero) ** 2 + parameters["side_sd"] ** 2
        people = np.sqrt(variance) * _NODES
    total = zero[..., None]
    for is_turned, way in enumerate(ways):
        about = -lead if is_turned else lead
        a, b = (modes[j], modes[i]) if is_turned else (modes[i], modes[j])
        shares = zero[..., None]
        for eta, n in _leads(about + side, a, b, parameters, way):
            shares = shares + n * _over_widths(eta + people, parameters, levels)
        total = total + (shares[..., ::-1] if is_turned else shares)
    both = total / sum(way.n for way in ways)
    return np.asarray(np.einsum("m,dml->dl", _WEIGHTS / _WEIGHTS.sum(), both))


def _leads(
    lead: FloatArray, a: str, b: str, parameters: Mapping[str, FloatArray], way: _Shown
) -> Iterator[tuple[FloatArray, int]]:
    """The lead of A at every order in which a pair was shown, and how often it was."""
    if way.order is None:
        yield lead, way.n
        return
    gained = parameters[LEARNING + a], parameters[LEARNING + b]
    for (place, before_a, before_b), n in zip(way.order.at, way.order.n, strict=True):
        yield lead + parameters["side_drift"] * place + gained[0] * before_a - gained[1] * before_b, int(n)


def _over_widths(eta: FloatArray, parameters: Mapping[str, FloatArray], levels: int) -> FloatArray:
    """Shares of answers at leads of shape (draw, node), over people's own widths: (draw, node, level)."""
    if "scale_sd" not in parameters:
        return answer_probabilities(eta, parameters, levels)
    widths = [
        weight * answer_probabilities(eta, parameters, levels, parameters["scale_sd"] * node)
        for node, weight in zip(_NODES, _WEIGHTS / _WEIGHTS.sum(), strict=True)
    ]
    return np.asarray(np.sum(widths, axis=0))


def knows_scale(parameters: Mapping[str, FloatArray], levels: int) -> bool:
    """False where the model was fitted to a shorter scale than the answers have (the gibbs engine)."""
    if "log_nu" in parameters:
        return levels == 3
    return sum(name.startswith("cut_") for name in parameters) == (levels - 1) // 2


def group_lead(counts: Counts, ability: FloatArray, parameters: Mapping[str, FloatArray]) -> FloatArray:
    """Lead of A over B of someone like the group, in every cell, shape (draw, cell).

    Parameters
    ----------
    ability : ndarray, shape (draw, mode)
        In the order of ``counts.modes``.
    parameters : mapping of str to ndarray, shape (draw, 1)
    """
    lead = ability[:, counts.mode_a] - ability[:, counts.mode_b] + parameters.get("side_effect", 0.0)
    if "side_drift" in parameters:
        assert counts.order is not None, "the model was fitted to answers in their order"
        place, before_a, before_b = counts.order.T
        learning = np.concatenate([parameters[LEARNING + mode] for mode in counts.modes], axis=1)
        lead = lead + parameters["side_drift"] * place
        lead = lead + learning[:, counts.mode_a] * before_a - learning[:, counts.mode_b] * before_b
    return np.asarray(lead)


def answer_probabilities(
    eta: FloatArray,
    parameters: Mapping[str, FloatArray],
    levels: int,
    width: FloatArray | float = 0.0,
) -> FloatArray:
    """Chance of each answer, from A much to B much, as the fitted model has it, careless answers included.

    Parameters
    ----------
    eta : ndarray, shape (draw, ...)
        Lead of A over B [logit].
    parameters : mapping of str to ndarray
        The draws' parameters, each of a shape that broadcasts against ``eta``.
    width : float or ndarray, optional
        Log of what the person's cut-points are multiplied by; broadcasts against ``eta``.

    Returns
    -------
    ndarray, shape (draw, ..., level)
    """
    return np.exp(answer_log_probabilities(eta, parameters, levels, width))


def answer_log_probabilities(
    eta: FloatArray,
    parameters: Mapping[str, FloatArray],
    levels: int,
    width: FloatArray | float = 0.0,
) -> FloatArray:
    """The logarithm of ``answer_probabilities``, exact however unlikely an answer is."""
    log_p = _careful_log_probabilities(eta, parameters, levels, width)
    if "lapse" not in parameters:
        return log_p
    lapse = parameters["lapse"][..., None]
    return np.asarray(np.logaddexp(np.log1p(-lapse) + log_p, np.log(lapse / levels)))


def _careful_log_probabilities(
    eta: FloatArray, parameters: Mapping[str, FloatArray], levels: int, width: FloatArray | float
) -> FloatArray:
    """Log chance of each answer of someone who takes care."""
    if "log_nu" in parameters:
        return adjacent_log_probabilities(eta, parameters["log_nu"] + width)
    cuts = [parameters[f"cut_{k + 1}"] * np.exp(width) for k in range((levels - 1) // 2)]
    stacked = np.stack(cuts, axis=-1) if cuts else np.empty((*([1] * eta.ndim), 0))
    return cumulative_log_probabilities(eta, stacked, levels)
