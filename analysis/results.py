"""What a fit returns: frozen results that the report, the console and the CSV files read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import takewhile
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from data.responses import QuestionScale

if TYPE_CHECKING:
    import xarray as xr

Engine = Literal["fast", "pymc", "gibbs"]
Link = Literal["cumulative", "adjacent"]
OPTIONS = ("lapse", "person_side", "person_scale", "position")
"""Options of the model, as the settings name them."""
HDI_PROBABILITY = 0.94
"""Mass of every interval that is not named otherwise."""

FEW_DIMENSIONS, MANY_DIMENSIONS = 100, 10_000
"""Free coordinates: of 30 people and three modes, and of 1000 people and 11 modes."""
ACCEPTANCE_IN_SOME, ACCEPTANCE_IN_MANY = 0.8 / 0.9, 0.65 / 0.9
"""By how much the acceptance rate is lowered with more coordinates than few, and with many."""


@dataclass(frozen=True)
class FitSettings:
    """How the responses are modelled and sampled.

    Attributes
    ----------
    engine : {"fast", "pymc", "gibbs"}
    pooled : bool
        True leaves out the participants' own deviations.
    side_effect : bool
        False leaves out the preference for whatever is shown as A.
    prior_sd : float
        Scale of the ability prior alone [logit].
    link : {"cumulative", "adjacent"}
        ``adjacent`` (Davidson's ties) needs three levels.
    lapse, person_side, person_scale, position : bool
        Options of the model, see ``analysis.model``: careless answers; each person's own side effect and own
        width of the scale; the place of a comparison and learning.
    seed : int
    draws, tune, chains : int
        Kept and warm-up draws a chain, and chains.
    target_accept : float
        Acceptance rate that NUTS adapts its step size to with few free coordinates; see ``acceptance``.
    """

    engine: Engine = "fast"
    pooled: bool = False
    side_effect: bool = True
    prior_sd: float = 1.0
    link: Link = "cumulative"
    lapse: bool = False
    person_side: bool = False
    person_scale: bool = False
    position: bool = False
    seed: int = 2017
    draws: int = 1000
    tune: int = 500
    chains: int = 4
    target_accept: float = 0.9

    @property
    def options(self) -> tuple[str, ...]:
        """Names of the options that are switched on."""
        return tuple(name for name in OPTIONS if getattr(self, name))

    def acceptance(self, n_dim: int) -> float:
        """Acceptance rate to adapt to in so many dimensions: ``target_accept`` in few, lower in more.

        In few, cautious steps cost little, and a spread near zero, where a few people leave it, needs them.
        In many, bold ones are worth more.

        References
        ----------
        Beskos, Pillai, Roberts, Sanz-Serna, Stuart 2013, "Optimal tuning of the hybrid Monte Carlo
        algorithm" (0.651 as the dimension grows).
        """
        if n_dim <= FEW_DIMENSIONS:
            return self.target_accept
        return self.target_accept * (ACCEPTANCE_IN_SOME if n_dim < MANY_DIMENSIONS else ACCEPTANCE_IN_MANY)


@dataclass(frozen=True)
class Draws:
    """Posterior draws of one question.

    Attributes
    ----------
    ability : ndarray, shape (chain, draw, mode)
        Sums to 0 over the modes of a draw [logit]; modes in the order of ``QuestionFit.mode_names``.
    worth : ndarray, shape (chain, draw, mode)
        ``softmax(ability)``: sums to 1 over the modes of a draw.
    parameters : mapping of str to ndarray, shape (chain, draw)
        ``side_effect``, ``cut_1``, ``cut_2`` and so on, ``log_nu``, ``lapse``, ``side_drift``,
        ``learning_MODE``, ``subject_sd``, ``side_sd``, ``scale_sd``: those the model has.
    diverging : ndarray of bool, shape (chain, draw)
    """

    ability: NDArray[np.float64]
    worth: NDArray[np.float64]
    parameters: Mapping[str, NDArray[np.float64]]
    diverging: NDArray[np.bool_]


@dataclass(frozen=True)
class Quantity:
    """Posterior summary of one parameter; the interval is a 94 % HDI."""

    name: str
    mean: float
    sd: float
    hdi_low: float
    hdi_high: float


@dataclass(frozen=True)
class PairResult:
    """Two modes against each other.

    Attributes
    ----------
    p_i_above_j : float
        Posterior probability that mode i's ability is above mode j's; nan if the question is not ranked.
    n : int
        Responses to this pair, whatever the sides: ``wins_i + ties + wins_j``.
    """

    mode_i: str
    mode_j: str
    p_i_above_j: float
    n: int
    wins_i: int
    ties: int
    wins_j: int


@dataclass(frozen=True)
class ModeResult:
    """Posterior summary of one mode on one question.

    Attributes
    ----------
    worth_hdi_low, worth_hdi_high : float
        94 % highest-density interval of the worth.
    worth_50_low, worth_50_high : float
        50 % highest-density interval of the worth.
    p_best : float
        Posterior probability of being highest on the question as asked.
    rank_mean : float
        Posterior mean of the rank; 1 is highest.
    rank_probabilities : tuple of float
        Probability of rank 1, 2, ..., number of modes.
    """

    mode: str
    ability_mean: float
    ability_sd: float
    worth_mean: float
    worth_sd: float
    worth_hdi_low: float
    worth_hdi_high: float
    worth_50_low: float
    worth_50_high: float
    p_best: float
    rank_mean: float
    rank_probabilities: tuple[float, ...]


@dataclass(frozen=True)
class QuestionFit:
    """What is known about one question.

    Attributes
    ----------
    ranked : bool
        False if the data or the sampling do not allow a ranking.
    reason : str
        Why it is not ranked, as a sentence; empty if it is.
    modes : tuple of ModeResult
        In the order of the response table; empty if not ranked.
    pairs : tuple of PairResult
        Every pair of the question's modes, asked or not, in the order of the response table.
    parameters : tuple of Quantity
        Empty if not ranked.
    draws : Draws or None
        None if nothing was sampled. Draws of a question that did not converge are kept for inspection.
    rhat_max, ess_min : float
        Over every reported quantity; ESS is the smaller of bulk and tail. nan if nothing was sampled.
    warnings : tuple of str
        Sentences for the reader; they do not stop the ranking.
    n, n_participants : int
        Responses in the model (checks are out) and the people who gave them (0 if unknown).
    missing_pairs : tuple of (str, str)
        Comparisons that were never made and would be needed to connect the modes.
    hierarchical : bool
        True if participants have deviations of their own in this fit.
    is_side_told_apart : bool
        True if some pair was shown with its sides exchanged, so that a side effect differs from the modes.
    """

    question: QuestionScale
    ranked: bool
    reason: str
    modes: tuple[ModeResult, ...]
    pairs: tuple[PairResult, ...]
    parameters: tuple[Quantity, ...]
    draws: Draws | None
    rhat_max: float
    ess_min: float
    divergences: int
    warnings: tuple[str, ...]
    n: int
    n_participants: int
    missing_pairs: tuple[tuple[str, str], ...] = ()
    hierarchical: bool = False
    is_side_told_apart: bool = True

    @property
    def mode_names(self) -> tuple[str, ...]:
        """The modes that the question is about, ranked or not, in the order of the response table; the last
        axis of the draws.
        """
        if self.modes or not self.pairs:
            return tuple(mode.mode for mode in self.modes)
        first = self.pairs[0].mode_i
        return first, *(pair.mode_j for pair in takewhile(lambda pair: pair.mode_i == first, self.pairs))


@dataclass(frozen=True)
class Fit:
    """All questions of a response table, fitted.

    Attributes
    ----------
    modes : tuple of str
        All modes in the order of the response table; a question may be about some of them alone.
    model : str
        The likelihood in a sentence.
    priors : mapping of str to str
        Prior by parameter, as written in the model.
    rhat_max, ess_min : float
        Worst over the questions; nan if nothing was sampled.
    converged : bool
        True if every question that was sampled passed the convergence gate.
    ranked : bool
        True only if every question is ranked.
    warnings : tuple of str
        Sentences about the fit as a whole; those about one question stand with the question.
    """

    questions: tuple[QuestionFit, ...]
    settings: FitSettings
    modes: tuple[str, ...]
    model: str
    priors: Mapping[str, str] = field(default_factory=dict)
    rhat_max: float = float("nan")
    ess_min: float = float("nan")
    divergences: int = 0
    converged: bool = True
    ranked: bool = True
    warnings: tuple[str, ...] = ()

    @property
    def posterior(self) -> xr.DataTree:
        """The draws with named dimensions; ``arviz.from_netcdf`` opens what its ``to_netcdf`` writes."""
        from analysis.posterior import posterior_tree

        return posterior_tree(self)
