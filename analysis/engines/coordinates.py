"""A sampler's global coordinates as the model's quantities, and back: the order is that of ``density.py``."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, logit

from analysis.model import LEARNING, Model
from analysis.zero_sum import zero_sum_basis

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Quantities:
    """The abilities, shape (..., mode), and each parameter beside them, shape (...,)."""

    ability: Floats
    parameters: Mapping[str, Floats]


def quantities_of(position: Floats, model: Model, modes: Sequence[str]) -> Quantities:
    """The model's quantities at global coordinates of shape (..., n_global)."""
    basis = zero_sum_basis(len(modes))
    free = basis.shape[1]
    ability = position[..., :free] @ basis.T
    rest = position[..., free:]
    learning: Floats | None = None
    parameters: dict[str, Floats] = {}
    cut, at = np.zeros(()), 0
    for name in model.parameter_names(modes):
        if name.startswith(LEARNING):
            if learning is None:
                learning = rest[..., at : at + free] @ basis.T
                at += free
            value = learning[..., modes.index(name.removeprefix(LEARNING))]
        else:
            value = rest[..., at]
            at += 1
            if name.startswith("cut_"):
                cut = cut + np.exp(value)
                value = cut
            elif name.endswith("_sd"):
                value = np.exp(value)
            elif name == "lapse":
                value = expit(value)
        parameters[name] = np.ascontiguousarray(value)
    return Quantities(ability, parameters)


def position_of(quantities: Quantities, model: Model, modes: Sequence[str]) -> Floats:
    """The global coordinates of the model's quantities, shape (..., n_global)."""
    columns = [quantities.ability @ zero_sum_basis(len(modes))]
    columns += list(_columns(quantities.parameters, model, modes))
    return np.ascontiguousarray(np.concatenate(columns, axis=-1))


def _columns(parameters: Mapping[str, Floats], model: Model, modes: Sequence[str]) -> Iterator[Floats]:
    cut = np.zeros(())
    names = model.parameter_names(modes)
    for k, name in enumerate(names):
        value = parameters[name]
        if name.startswith(LEARNING):
            if not names[k - 1].startswith(LEARNING):
                learning = np.stack([parameters[LEARNING + mode] for mode in modes], axis=-1)
                yield learning @ zero_sum_basis(len(modes))
            continue
        if name.startswith("cut_"):
            value, cut = np.log(value - cut), value
        elif name.endswith("_sd"):
            value = np.log(value)
        elif name == "lapse":
            value = logit(value)
        yield value[..., None]
