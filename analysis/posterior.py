"""The draws of a fit with named dimensions, written as ArviZ reads them, without ArviZ."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from analysis.model import LEARNING
from analysis.results import Fit, QuestionFit

if TYPE_CHECKING:
    import xarray as xr


def posterior_tree(fit: Fit) -> xr.DataTree:
    """Groups ``posterior``, ``sample_stats`` and ``observed_data``; questions are a dimension.

    A parameter that only some questions have (``cut_2``) has a question dimension of its own,
    ``question_<parameter>``, so that there is no padding that a diagnostic would trip over. Abilities and
    worths of modes that a question is not about are NaN.
    """
    import xarray as xr

    sampled = [q for q in fit.questions if q.draws is not None]
    groups = {"/": xr.Dataset(attrs=_attributes(fit)), "/observed_data": _observed(fit)}
    if sampled:
        groups["/posterior"] = _posterior(fit, sampled)
        diverging = np.stack([q.draws.diverging for q in sampled if q.draws is not None], axis=-1)
        groups["/sample_stats"] = xr.Dataset(
            {
                "diverging": (("chain", "draw"), diverging.any(axis=-1)),
                "diverging_by_question": (("chain", "draw", "question"), diverging),
            },
            _coordinates(diverging.shape[:2], sampled),
        )
    return xr.DataTree.from_dict(groups)


def write_posterior(fit: Fit, path: Path) -> None:
    """Write ``posterior.nc``; ``arviz.from_netcdf`` opens it."""
    posterior_tree(fit).to_netcdf(path, engine="h5netcdf")


def _posterior(fit: Fit, sampled: list[QuestionFit]) -> xr.Dataset:
    import xarray as xr

    draws = {q.question.name: q.draws for q in sampled if q.draws is not None}
    ability, worth = (
        np.stack([_over_all(values, q, fit.modes) for q, values in zip(sampled, drawn, strict=True)], axis=2)
        for drawn in ([d.ability for d in draws.values()], [d.worth for d in draws.values()])
    )
    axes = ("chain", "draw", "question", "mode")
    coordinates = _coordinates(ability.shape[:2], sampled) | {"mode": list(fit.modes)}
    dataset = xr.Dataset({"ability": (axes, ability), "worth": (axes, worth)}, coordinates)
    if fit.settings.position:
        # What modes gain by use has an axis for them, as abilities do: modes may be named in any way.
        learning = np.stack([_over_all(_learning(q), q, fit.modes) for q in sampled], axis=2)
        dataset["learning"] = (axes, learning)
    names = dict.fromkeys(name for d in draws.values() for name in d.parameters)
    for name in (name for name in names if not name.startswith(LEARNING)):
        having = [question for question, d in draws.items() if name in d.parameters]
        axis = "question" if len(having) == len(draws) else f"question_{name}"
        values = np.stack([draws[question].parameters[name] for question in having], axis=-1)
        dataset = dataset.assign_coords({axis: having})
        dataset[name] = (("chain", "draw", axis), values)
    return dataset


def _learning(question: QuestionFit) -> NDArray[np.float64]:
    assert question.draws is not None
    return np.stack([question.draws.parameters[LEARNING + mode] for mode in question.mode_names], axis=-1)


def _over_all(
    values: NDArray[np.float64], question: QuestionFit, modes: tuple[str, ...]
) -> NDArray[np.float64]:
    """Draws of a question with an axis for all modes: NaN for those that the question is not about."""
    own = question.mode_names
    if own == modes:
        return values
    spread = np.full((*values.shape[:2], len(modes)), np.nan)
    spread[..., [modes.index(mode) for mode in own]] = values
    return spread


def _observed(fit: Fit) -> xr.Dataset:
    """Answers by question and pair: ``wins`` (row over column) and ``ties``."""
    import xarray as xr

    shape = (len(fit.questions), len(fit.modes), len(fit.modes))
    wins, ties = np.zeros(shape, dtype=np.int64), np.zeros(shape, dtype=np.int64)
    place = {mode: k for k, mode in enumerate(fit.modes)}
    for k, question in enumerate(fit.questions):
        for pair in question.pairs:
            i, j = place[pair.mode_i], place[pair.mode_j]
            wins[k, i, j], wins[k, j, i] = pair.wins_i, pair.wins_j
            ties[k, i, j] = ties[k, j, i] = pair.ties
    axes = ("question", "mode", "other_mode")
    names = [q.question.name for q in fit.questions]
    return xr.Dataset(
        {"wins": (axes, wins), "ties": (axes, ties)},
        {"question": names, "mode": list(fit.modes), "other_mode": list(fit.modes)},
    )


def _coordinates(chains_and_draws: tuple[int, ...], sampled: list[QuestionFit]) -> dict[str, object]:
    n_chains, n_draws = chains_and_draws
    return {
        "chain": np.arange(n_chains),
        "draw": np.arange(n_draws),
        "question": [q.question.name for q in sampled],
    }


def _attributes(fit: Fit) -> dict[str, str]:
    return {
        "model": fit.model,
        "priors": json.dumps(dict(fit.priors)),
        "settings": json.dumps(asdict(fit.settings)),
    }
