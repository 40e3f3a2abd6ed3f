"""Draws to results: abilities, worths, ranks, pairs and parameters, vectorised over modes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from analysis.counts import Counts
from analysis.diagnostics import hdi
from analysis.results import HDI_PROBABILITY, Draws, ModeResult, PairResult, Quantity

FloatArray = NDArray[np.float64]


def draws_in_order(draws: Draws, order: list[int]) -> Draws:
    """The same draws with the modes in another order."""
    return Draws(draws.ability[..., order], draws.worth[..., order], draws.parameters, draws.diverging)


def every_draw(draws: Draws, step: int) -> Draws:
    """Each ``step``-th draw of every chain."""
    return Draws(
        draws.ability[:, ::step],
        draws.worth[:, ::step],
        {name: values[:, ::step] for name, values in draws.parameters.items()},
        draws.diverging[:, ::step],
    )


def mode_results(draws: Draws, modes: tuple[str, ...]) -> tuple[ModeResult, ...]:
    """Posterior summary of every mode, in the order of the draws' last axis."""
    ability, worth = _flat(draws.ability), _flat(draws.worth)
    wide, narrow = hdi(worth, HDI_PROBABILITY), hdi(worth, 0.5)
    probabilities, rank_mean = rank_probabilities(ability), ranks(ability).mean(axis=0)
    return tuple(
        ModeResult(
            mode=mode,
            ability_mean=float(ability[:, k].mean()),
            ability_sd=float(ability[:, k].std(ddof=1)),
            worth_mean=float(worth[:, k].mean()),
            worth_sd=float(worth[:, k].std(ddof=1)),
            worth_hdi_low=float(wide[0, k]),
            worth_hdi_high=float(wide[1, k]),
            worth_50_low=float(narrow[0, k]),
            worth_50_high=float(narrow[1, k]),
            p_best=float(probabilities[k, 0]),
            rank_mean=float(rank_mean[k]),
            rank_probabilities=tuple(float(p) for p in probabilities[k]),
        )
        for k, mode in enumerate(modes)
    )


def ranks(ability: FloatArray) -> FloatArray:
    """Rank of each mode in each draw, 1 for the highest ability; same shape as ``ability``, (..., mode)."""
    by_rank = np.argsort(-ability, axis=-1, kind="stable")
    found = np.empty(ability.shape)
    places = np.broadcast_to(np.arange(1.0, ability.shape[-1] + 1), ability.shape)
    np.put_along_axis(found, by_rank, places, axis=-1)
    return found


def rank_probabilities(ability: FloatArray) -> FloatArray:
    """Share of the draws in which each mode has each rank.

    Parameters
    ----------
    ability : ndarray, shape (draw, mode)

    Returns
    -------
    ndarray, shape (mode, rank)
        Rank 1, the highest ability, first; rows and columns sum to 1.
    """
    n_draws, n_modes = ability.shape
    held = ranks(ability).astype(np.intp) - 1
    return np.stack([np.bincount(column, minlength=n_modes) for column in held.T]) / n_draws


def pair_results(counts: Counts, modes: tuple[str, ...], draws: Draws | None) -> tuple[PairResult, ...]:
    """Every pair of modes with its answers, and who is above whom if there are draws.

    Parameters
    ----------
    modes : tuple of str
        The order of the pairs, and of the draws' last axis.
    """
    place = [counts.modes.index(mode) for mode in modes]
    wins, ties = counts.wins()[np.ix_(place, place)], counts.ties()[np.ix_(place, place)]
    above = np.full((len(modes), len(modes)), np.nan)
    if draws is not None:
        ability = _flat(draws.ability)
        for i in range(len(modes)):
            above[i] = (ability[:, i : i + 1] > ability).mean(axis=0)
    return tuple(
        PairResult(
            mode_i=modes[i],
            mode_j=modes[j],
            p_i_above_j=float(above[i, j]),
            n=int(wins[i, j] + ties[i, j] + wins[j, i]),
            wins_i=int(wins[i, j]),
            ties=int(ties[i, j]),
            wins_j=int(wins[j, i]),
        )
        for i in range(len(modes))
        for j in range(i + 1, len(modes))
    )


def parameter_results(draws: Draws, names: Sequence[str]) -> tuple[Quantity, ...]:
    """Posterior summary of every parameter beside the abilities; ``names`` says in which order."""
    return tuple(quantity(name, draws.parameters[name].ravel()) for name in names)


def quantity(name: str, draws: FloatArray) -> Quantity:
    """Mean, sd and 94 % HDI of one quantity; ``draws`` has shape (draw,)."""
    low, high = hdi(draws, HDI_PROBABILITY)
    return Quantity(name, float(draws.mean()), float(draws.std(ddof=1)), float(low), float(high))


def _flat(draws: FloatArray) -> FloatArray:
    """Chains laid end to end: (chain, draw, mode) to (draw, mode)."""
    return draws.reshape(-1, draws.shape[-1])
