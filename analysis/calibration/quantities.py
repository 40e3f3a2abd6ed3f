"""What is ranked: every quantity a report shows, and one that sees whether the data were used at all."""

import numpy as np
from numpy.typing import NDArray

from analysis.answer_shares import answer_log_probabilities, group_lead
from analysis.calibration.world import Design, Truth
from analysis.counts import Counts
from analysis.model import Model
from analysis.results import Draws
from analysis.softmax import worth_of

LOG_LIKELIHOOD = "log_likelihood"
"""Log-likelihood of the answers if nobody differed from the common abilities.

Ranks of parameters alone are uniform for an engine that ignores the data and returns its prior; those of a
function of parameters and data are not (Modrák et al. 2025).
"""

FloatArray = NDArray[np.float64]


def quantities(draws: Draws, counts: Counts, model: Model, design: Design) -> dict[str, FloatArray]:
    """Every quantity of a posterior by name, each of shape (draw,): chains laid end to end.

    Parameters
    ----------
    draws : Draws
        Modes in the order of the design.
    counts : Counts
        The answers the draws were made from.
    """
    ability, worth = (x.reshape(-1, design.n_modes) for x in (draws.ability, draws.worth))
    # A fit that leaves out the side effect, since all answers are for one side, says that it is 0.
    none = np.zeros_like(draws.ability[..., 0])
    names = model.parameter_names(design.modes)
    parameters = {name: draws.parameters.get(name, none).ravel() for name in names}
    return _named(ability, worth, parameters, counts, model, design)


def true_quantities(truth: Truth, counts: Counts, model: Model, design: Design) -> dict[str, float]:
    """The same quantities of the truth."""
    ability = truth.ability[None]
    parameters = {name: np.array([value]) for name, value in truth.parameters.items()}
    found = _named(ability, worth_of(ability), parameters, counts, model, design)
    return {name: float(value[0]) for name, value in found.items()}


def _named(
    ability: FloatArray,
    worth: FloatArray,
    parameters: dict[str, FloatArray],
    counts: Counts,
    model: Model,
    design: Design,
) -> dict[str, FloatArray]:
    modes = design.modes
    named = {f"ability {mode}": ability[:, k] for k, mode in enumerate(modes)}
    named |= {f"worth {mode}": worth[:, k] for k, mode in enumerate(modes)}
    named |= {f"{modes[i]} - {modes[j]}": ability[:, i] - ability[:, j] for i, j in design.pairs}
    named |= parameters
    return named | {LOG_LIKELIHOOD: _log_likelihood(ability, parameters, counts, model)}


def _log_likelihood(
    ability: FloatArray, parameters: dict[str, FloatArray], counts: Counts, model: Model
) -> FloatArray:
    cells = counts.pooled()
    columns = {name: values[:, None] for name, values in parameters.items()}
    lead = group_lead(cells, ability, columns)
    log_p = answer_log_probabilities(lead, columns, model.levels)
    return (cells.responses * log_p).sum(axis=(1, 2))
