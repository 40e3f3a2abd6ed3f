"""The likelihood family and its priors, written once.

With ``eta = ability_A - ability_B + side_effect + subject_sd (z[s, A] - z[s, B])`` an answer Y, counted
from B much (0) to A much, has ``P(Y <= k) = logistic(theta_k - eta)`` with symmetric cut-points
``theta = (-c2, -c1, c1, c2)`` (cumulative link), or the odds ``e^(eta/2) : nu : e^(-eta/2)`` (adjacent link).

References
----------
Bradley & Terry 1952 (two levels); Rao & Kupper 1967 (three levels, their theta = e^c1); Agresti 1992 (five
levels: cumulative and adjacent logits for paired comparisons); Davidson 1970 (adjacent).
"""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.counts import Counts
from analysis.results import FitSettings, Link
from data.errors import InputError

SIDE_EFFECT_SD = 0.5
"""Scale of Normal(0, .) on the side effect [logit]: being shown as A is worth little against a mode."""
SUBJECT_SD_SCALE = 1.0
"""Scale of HalfNormal(.) on the spread of participants [logit]: as wide as the modes' own."""
CUT_GAP_SCALE = 1.0
"""Scale of HalfNormal(.) on the gaps between cut-points [logit]."""
LOG_NU_SD = 1.0
"""Scale of Normal(0, .) on Davidson's log nu; at nu = 1 equals tie in a third of the answers."""

_GAPS = {2: 0, 3: 1, 5: 2}


@dataclass(frozen=True)
class Model:
    """Which model a question is fitted with.

    Attributes
    ----------
    levels : int
        2, 3 or 5.
    hierarchical : bool
        True if participants have deviations of their own.
    """

    levels: int
    link: Link
    hierarchical: bool
    side_effect: bool
    prior_sd: float

    @property
    def n_gaps(self) -> int:
        """Gaps between cut-points that are estimated: (c1, c2 - c1)."""
        return _GAPS[self.levels] if self.link == "cumulative" else 0

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """The parameters beside the abilities, in the order of the report."""
        names = ["side_effect"] if self.side_effect else []
        names += [f"cut_{k + 1}" for k in range(self.n_gaps)]
        names += ["log_nu"] if self.link == "adjacent" else []
        names += ["subject_sd"] if self.hierarchical else []
        return tuple(names)


@dataclass(frozen=True)
class Problem:
    """One question's counts with the model they are fitted with: what an engine takes."""

    counts: Counts
    model: Model

    @property
    def n_global(self) -> int:
        """Free parameters that are not a participant's own."""
        return len(self.counts.modes) - 1 + len(self.model.parameter_names)

    @property
    def n_dim(self) -> int:
        """Free parameters in all."""
        own = len(self.counts.participants) * (len(self.counts.modes) - 1) if self.model.hierarchical else 0
        return self.n_global + own


def model_of(settings: FitSettings, levels: int, has_participants: bool) -> Model:
    """The model that the settings ask for on a scale of so many levels.

    Raises
    ------
    InputError
        If the adjacent link is asked for on a scale that has not three levels.
    """
    if settings.link == "adjacent" and levels != 3:
        raise InputError(
            f"link: adjacent needs a scale of 3 levels, not {levels}; valid for {levels} levels: cumulative"
        )
    hierarchical = has_participants and not settings.pooled
    return Model(levels, settings.link, hierarchical, settings.side_effect, settings.prior_sd)


def model_behind(
    parameters: Collection[str], settings: FitSettings, levels: int, has_participants: bool
) -> Model:
    """The model that draws of these parameters come from: a fit leaves out a side effect that the answers
    make unknown."""
    model = model_of(settings, levels, has_participants)
    return replace(model, side_effect="side_effect" in parameters)


def thresholds(cuts: NDArray[np.float64], levels: int) -> NDArray[np.float64]:
    """All cut-points theta, from B much to A much.

    Parameters
    ----------
    cuts : ndarray, shape (..., 0 | 1 | 2)
        ``()``, ``(c1,)`` or ``(c1, c2)`` for 2, 3 or 5 levels [logit].

    Returns
    -------
    ndarray, shape (..., levels - 1)
    """
    if levels == 2:
        return np.zeros((*cuts.shape[:-1], 1))
    return np.concatenate([-cuts[..., ::-1], cuts], axis=-1)


def log_sigmoid(t: NDArray[np.float64]) -> NDArray[np.float64]:
    """``log(1 / (1 + exp(-t)))`` without overflow, elementwise."""
    return np.minimum(t, 0.0) - np.log1p(np.exp(-np.abs(t)))


def cumulative_log_probabilities(
    eta: NDArray[np.float64], cuts: NDArray[np.float64], levels: int
) -> NDArray[np.float64]:
    """Log-probability of every answer under the cumulative link, from A much to B much.

    An inner interval is ``logistic(u) - logistic(l) = logistic(u) logistic(-l) (1 - exp(l - u))``, which
    loses no digits however far ``eta`` lies from the cut-points.

    Parameters
    ----------
    eta : ndarray, shape (...,)
        Lead of A over B [logit].
    cuts : ndarray, shape (..., 0 | 1 | 2)
        Broadcasts against ``eta``.

    Returns
    -------
    ndarray, shape (..., levels)
    """
    theta = thresholds(cuts, levels)
    above = log_sigmoid(eta[..., None] - theta)
    below = log_sigmoid(theta - eta[..., None])
    inner = below[..., 1:] + above[..., :-1] + np.log(-np.expm1(-np.diff(theta, axis=-1)))
    return np.concatenate([above[..., -1:], inner[..., ::-1], below[..., :1]], axis=-1)


def adjacent_log_probabilities(eta: NDArray[np.float64], log_nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """Log-probability of A>B, A=B, B>A under Davidson's model.

    Returns
    -------
    ndarray, shape (..., 3)
    """
    odds = np.stack(np.broadcast_arrays(eta / 2, log_nu, -eta / 2), axis=-1)
    return odds - np.logaddexp.reduce(odds, axis=-1, keepdims=True)


def describe(settings: FitSettings, hierarchical: bool) -> str:
    """The likelihood in a sentence for the report."""
    if settings.engine == "gibbs":
        return "Bradley-Terry with Rao-Kupper ties, pooled, without a side effect (Caron & Doucet 2012)"
    likelihood = (
        "Cumulative logit with symmetric cut-points (two levels: Bradley-Terry, three: Rao-Kupper)"
        if settings.link == "cumulative"
        else "Adjacent-category logit (Davidson's Bradley-Terry model with ties)"
    )
    subjects = "with deviations of each participant" if hierarchical else "pooled over participants"
    side = "with a side effect" if settings.side_effect else "without a side effect"
    return f"{likelihood}, {subjects}, {side}"


def priors(settings: FitSettings, levels: set[int], hierarchical: bool) -> dict[str, str]:
    """Prior by parameter, as the report prints it."""
    if settings.engine == "gibbs":
        return {"worth": "Dirichlet(1)"} | ({"theta": "flat above 1"} if levels - {2} else {})
    stated = {"ability": f"ZeroSumNormal({settings.prior_sd:g})"}
    if settings.side_effect:
        stated["side_effect"] = f"Normal(0, {SIDE_EFFECT_SD:g})"
    if settings.link == "adjacent":
        stated["log_nu"] = f"Normal(0, {LOG_NU_SD:g})"
    elif levels - {2}:
        stated["cut_1"] = f"HalfNormal({CUT_GAP_SCALE:g})"
        if 5 in levels:
            stated["cut_2"] = f"cut_1 + HalfNormal({CUT_GAP_SCALE:g})"
    if hierarchical:
        stated["subject_sd"] = f"HalfNormal({SUBJECT_SD_SCALE:g})"
        stated["z"] = "ZeroSumNormal(1) over the modes, per participant"
    return stated
