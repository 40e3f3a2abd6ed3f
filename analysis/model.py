"""The likelihood family and its priors, written once.

With ``eta = ability_A - ability_B + side_effect + subject_sd (z[s, A] - z[s, B])`` an answer Y, counted
from B much (0) to A much, has ``P(Y <= k) = logistic(theta_k - eta)`` with symmetric cut-points
``theta = (-c2, -c1, c1, c2)`` (cumulative link; an even number of levels has a cut-point at 0 in the middle),
or the odds ``e^(eta/2) : nu : e^(-eta/2)`` (adjacent link).

Four options extend it, each by a flag of ``FitSettings``:

- ``lapse``: an answer is careless with this chance, and then every level is as likely.
- ``person_side``: ``eta`` has ``side_sd s[person]`` more, ``s ~ Normal(0, 1)``.
- ``person_scale``: a person's cut-points are ``theta e^(scale_sd w[person])`` (adjacent link: their nu is
  ``nu e^(scale_sd w[person])``), ``w ~ Normal(0, 1)``.
- ``position``: ``eta`` has ``side_drift t + learning_A x_A - learning_B x_B`` more, with the place ``t`` of
  the comparison and how often its modes came before, ``x``, as ``analysis.order`` scales them.

References
----------
Bradley & Terry 1952 (two levels); Rao & Kupper 1967 (three levels, their theta = e^c1); Agresti 1992 (more
levels: cumulative and adjacent logits for paired comparisons); Davidson 1970 (adjacent); Wichmann & Hill 2001
(lapses); Johnson 2003 (cut-points of each person's own width).
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.counts import Counts
from analysis.results import FitSettings, Link
from data.answers import FEWEST_LEVELS
from data.errors import InputError

SIDE_EFFECT_SD = 0.5
"""Scale of Normal(0, .) on the side effect [logit]: being shown as A is worth little against a mode."""
SUBJECT_SD_SCALE = 1.0
"""Scale of HalfNormal(.) on the spread of participants [logit]: as wide as the modes' own."""
CUT_GAP_SCALE = 1.0
"""Scale of HalfNormal(.) on the gaps between cut-points [logit]."""
LOG_NU_SD = 1.0
"""Scale of Normal(0, .) on Davidson's log nu; at nu = 1 equals tie in a third of the answers."""
LAPSE_BETA = 9.0
"""Beta(1, .) on the share of careless answers: 10 % in the mean, as surveys find of careless people (Meade &
Craig 2012), most likely none, and above a half with a chance of 1 in 500."""
SIDE_SD_SCALE = 0.5
"""Scale of HalfNormal(.) on the spread of people's own side effects [logit]: as wide as the common one."""
SCALE_SD_SCALE = 0.5
"""Scale of HalfNormal(.) on the spread of the log of people's widths of scale: at 0.5 someone uses cut-points
more than 2.7 times as wide as another, once in six pairs. Untuned."""
SIDE_DRIFT_SD = 0.5
"""Scale of Normal(0, .) on the change of the side effect from first to last [logit]: as wide as itself."""
LEARNING_SD = 0.5
"""Scale of ZeroSumNormal(.) on what a mode gains from its first to its last use [logit]. Untuned."""

LEARNING = "learning_"
"""What the name of a mode's learning begins with; the mode's name follows."""


@dataclass(frozen=True)
class Model:
    """Which model a question is fitted with.

    Attributes
    ----------
    levels : int
        2 to 9.
    hierarchical : bool
        True if participants have deviations of their own.
    lapse, person_side, person_scale, position : bool
        The options.
    """

    levels: int
    link: Link
    hierarchical: bool
    side_effect: bool
    prior_sd: float
    lapse: bool = False
    person_side: bool = False
    person_scale: bool = False
    position: bool = False

    @property
    def n_gaps(self) -> int:
        """Gaps between cut-points that are estimated: (c1, c2 - c1, ...)."""
        return (self.levels - 1) // 2 if self.link == "cumulative" else 0

    @property
    def n_own(self) -> int:
        """Coordinates of a participant's own beside their deviations from the abilities."""
        return self.person_side + self.person_scale

    def parameter_names(self, modes: Sequence[str]) -> tuple[str, ...]:
        """The parameters beside the abilities, in the order of the report and of the sampler's position."""
        names = ["side_effect"] if self.side_effect else []
        names += [f"cut_{k + 1}" for k in range(self.n_gaps)]
        names += ["log_nu"] if self.link == "adjacent" else []
        names += ["lapse"] if self.lapse else []
        if self.position:
            names += ["side_drift", *(LEARNING + mode for mode in modes)]
        names += ["subject_sd"] if self.hierarchical else []
        names += ["side_sd"] if self.person_side else []
        names += ["scale_sd"] if self.person_scale else []
        return tuple(names)

    @property
    def plain(self) -> "Model":
        """The same model without the options."""
        return replace(self, lapse=False, person_side=False, person_scale=False, position=False)

    @property
    def alike(self) -> "Model":
        """The same model of people who do not differ."""
        return replace(self, hierarchical=False, person_side=False, person_scale=False)


@dataclass(frozen=True)
class Problem:
    """One question's counts with the model they are fitted with: what an engine takes."""

    counts: Counts
    model: Model

    @property
    def n_global(self) -> int:
        """Free parameters that are not a participant's own."""
        free = len(self.counts.modes) - 1
        # What modes gain by use adds up to 0, as the abilities do.
        return free + len(self.model.parameter_names(self.counts.modes)) - self.model.position

    @property
    def n_own(self) -> int:
        """Free parameters of each participant's own."""
        return (len(self.counts.modes) - 1 if self.model.hierarchical else 0) + self.model.n_own

    @property
    def n_dim(self) -> int:
        """Free parameters in all."""
        return self.n_global + len(self.counts.participants) * self.n_own


def model_of(settings: FitSettings, levels: int, has_participants: bool) -> Model:
    """The model that the settings ask for on a scale of so many levels.

    Raises
    ------
    InputError
        If the adjacent link is asked for on a scale that has not three levels, or an option needs to know
        participants where none are known or all are pooled.
    """
    if settings.link == "adjacent" and levels != 3:
        raise InputError(
            f"link: adjacent needs a scale of 3 levels, not {levels}; valid for {levels} levels: cumulative"
        )
    hierarchical = has_participants and not settings.pooled
    for option in ("person_side", "person_scale"):
        if getattr(settings, option) and not hierarchical:
            why = "they are pooled" if has_participants else "the answers name none"
            raise InputError(f"{option}: this option needs participants, and {why}")
    if settings.position and not has_participants:
        raise InputError("position: this option needs participants, and the answers name none")
    return Model(
        levels,
        settings.link,
        hierarchical,
        settings.side_effect,
        settings.prior_sd,
        lapse=settings.lapse,
        person_side=settings.person_side,
        # With one cut-point, at 0, a wider scale is the same scale.
        person_scale=settings.person_scale and levels > FEWEST_LEVELS,
        position=settings.position,
    )


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
    cuts : ndarray, shape (..., (levels - 1) // 2)
        ``(c1, c2, ...)``, the cut-points above 0 [logit].

    Returns
    -------
    ndarray, shape (..., levels - 1)
    """
    middle = np.zeros((*cuts.shape[:-1], 1 - levels % 2))
    return np.concatenate([-cuts[..., ::-1], middle, cuts], axis=-1)


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
    cuts : ndarray, shape (..., (levels - 1) // 2)
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


_OPTIONS = {
    "lapse": "careless answers (lapse)",
    "person_side": "each participant's own side effect",
    "person_scale": "each participant's own width of the scale",
    "position": "the place of a comparison and learning (position)",
}


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
    options = [f", with {text}" for option, text in _OPTIONS.items() if getattr(settings, option)]
    return f"{likelihood}, {subjects}, {side}{''.join(options)}"


def priors(settings: FitSettings, levels: set[int], hierarchical: bool) -> dict[str, str]:
    """Prior by parameter, as the report prints it."""
    if settings.engine == "gibbs":
        return {"worth": "Dirichlet(1)"} | ({"theta": "flat above 1"} if levels - {2} else {})
    stated = {"ability": f"ZeroSumNormal({settings.prior_sd:g})"}
    if settings.side_effect:
        stated["side_effect"] = f"Normal(0, {SIDE_EFFECT_SD:g})"
    if settings.link == "adjacent":
        stated["log_nu"] = f"Normal(0, {LOG_NU_SD:g})"
    else:
        for k in range((max(levels) - 1) // 2):
            stated[f"cut_{k + 1}"] = f"{f'cut_{k} + ' if k else ''}HalfNormal({CUT_GAP_SCALE:g})"
    if settings.lapse:
        stated["lapse"] = f"Beta(1, {LAPSE_BETA:g})"
    if settings.position:
        stated["side_drift"] = f"Normal(0, {SIDE_DRIFT_SD:g})"
        stated["learning"] = f"ZeroSumNormal({LEARNING_SD:g})"
    if hierarchical:
        stated["subject_sd"] = f"HalfNormal({SUBJECT_SD_SCALE:g})"
        stated["z"] = "ZeroSumNormal(1) over the modes, per participant"
    if settings.person_side:
        stated["side_sd"] = f"HalfNormal({SIDE_SD_SCALE:g})"
        stated["s"] = "Normal(0, 1), per participant"
    if settings.person_scale and levels - {FEWEST_LEVELS}:
        stated["scale_sd"] = f"HalfNormal({SCALE_SD_SCALE:g})"
        stated["w"] = "Normal(0, 1), per participant"
    return stated
