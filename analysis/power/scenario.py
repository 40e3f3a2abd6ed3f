"""What is assumed of the people and the question, and what a study shall conclude about it."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import expit, ndtr

from analysis.equivalence import EQUIVALENT_BELOW
from analysis.figures.labels import LIKELY
from analysis.results import QuestionFit
from data.answers import SCALES
from data.errors import InputError

Kind = Literal["best", "order", "pair", "equal", "equal pair"]
Verdict = Literal["right", "wrong", "open", "unranked"]

LEVELS = 3
_FIRST_CUT = 0.5
"""Half of the width of "about the same", or where there are no ties that of the weakest preference [logit].
Untuned."""
_GAP = 1.0
"""From one cut-point to the next [logit]. Untuned."""
CUTS: dict[int, tuple[float, ...]] = {
    levels: tuple(_FIRST_CUT + _GAP * k for k in range((levels - 1) // 2)) for levels in SCALES
}
"""Cut-points that are assumed where none are given [logit]."""
SUBJECT_SD = 0.7
"""How much people are assumed to differ where nothing is said [logit]. Untuned."""
SIDE_EFFECT = 0.1
"""Assumed preference for what is shown as A [logit]. Untuned."""
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(61)
_WIDEST_CUT = 60.0


@dataclass(frozen=True)
class Scenario:
    """What is assumed of the people and the question.

    Attributes
    ----------
    worth : tuple of float
        Planted worth of each mode of the study, in its order; any positive numbers, their ratios count.
    levels : int
        Levels of the question's scale: 2 to 9.
    cuts : tuple of float
        Cut-points of the cumulative model above 0 [logit], increasing.
    subject_sd : float
        Spread of the participants' own abilities [logit].
    side_effect : float
        Preference for what is shown as A [logit].
    """

    worth: tuple[float, ...]
    levels: int = LEVELS
    cuts: tuple[float, ...] = CUTS[LEVELS]
    subject_sd: float = SUBJECT_SD
    side_effect: float = SIDE_EFFECT

    @property
    def ability(self) -> NDArray[np.float64]:
        """The abilities that have these worths, shape (modes,); they sum to 0 [logit]."""
        logs = np.log(np.array(self.worth))
        return logs - logs.mean()

    @property
    def best(self) -> int | None:
        """Place of the mode with the highest worth; None if several share it."""
        highest = max(self.worth)
        return self.worth.index(highest) if self.worth.count(highest) == 1 else None

    @property
    def followers(self) -> tuple[int, float] | None:
        """Place of the second best mode, and the share of people who themselves prefer the best to it."""
        if self.best is None:
            return None
        second = int(np.argsort(-self.ability)[1])
        lead = float(self.ability[self.best] - self.ability[second])
        return second, float(ndtr(lead / (np.sqrt(2.0) * self.subject_sd))) if self.subject_sd else 1.0

    @property
    def sentence(self) -> str:
        """The assumptions in a line."""
        worth = " : ".join(f"{w:g}" for w in self.worth)
        cuts = f" with cut-points {', '.join(f'{c:.3g}' for c in self.cuts)}" if self.cuts else ""
        if len(self.cuts) == 2:
            cuts = cuts.replace(",", " and")
        return (
            f"worths {worth}, {self.levels} levels{cuts}, people differ with sd {self.subject_sd:g}, "
            f"side effect {self.side_effect:g}"
        )


def tie_share(pairs: Sequence[tuple[int, int]], scenario: Scenario) -> float:
    """Share of answers "about the same" over these pairs of modes, each side first equally often.

    A person's own lead of one mode over another has the variance ``2 subject_sd^2`` about that of the group.
    """
    return _share_within(pairs, scenario, scenario.cuts[0]) if scenario.levels % 2 else 0.0


def cuts_for_ties(pairs: Sequence[tuple[int, int]], scenario: Scenario, share: float) -> tuple[float, ...]:
    """The cut-points with which these people say "about the same" in this share of their answers.

    Stronger answers begin 1 logit beyond, and another logit beyond that.

    Raises
    ------
    InputError
        If the scale has no such answer, or the share is not above 0 and below 1.
    """
    if scenario.levels % 2 == 0:
        raise InputError(
            f"ties: a scale of {scenario.levels} levels has none; valid with 3, 5, 7 or 9 levels"
        )
    if not 0.0 < share < 0.99:
        raise InputError(f"ties: {share:g} is no share above 0 and below 0.99")
    cut = float(brentq(lambda c: _share_within(pairs, scenario, c) - share, 0.0, _WIDEST_CUT))
    return tuple(cut + _GAP * k for k in range((scenario.levels - 1) // 2))


def _share_within(pairs: Sequence[tuple[int, int]], scenario: Scenario, cut: float) -> float:
    ability = scenario.ability
    lead = np.array([s * (ability[a] - ability[b]) for a, b in pairs for s in (1, -1)]) + scenario.side_effect
    felt = lead[:, None] + np.sqrt(2.0) * scenario.subject_sd * _NODES
    within = expit(cut - felt) - expit(-cut - felt)
    return float((within @ _WEIGHTS / _WEIGHTS.sum()).mean())


@dataclass(frozen=True)
class Conclusion:
    """What a study shall conclude, and how sure it must be.

    Attributes
    ----------
    kind : {"best", "order", "pair", "equal", "equal pair"}
        Which mode is best, the whole order of the modes, which of two is better; that all modes, or two, are
        equal in practice.
    confidence : float
        Posterior probability above which it counts as concluded.
    pair : tuple of two int
        Places of the two modes, for ``pair`` and ``equal pair`` alone.
    """

    kind: Kind = "best"
    confidence: float = 0.95
    pair: tuple[int, int] = (0, 1)

    @property
    def is_equality(self) -> bool:
        """Whether it says that modes are equal in practice, and not which is better."""
        return self.kind in ("equal", "equal pair")

    def equal_pairs(self, n_modes: int) -> tuple[tuple[int, int], ...]:
        """The pairs that it says are equal in practice."""
        return (self.pair,) if self.kind == "equal pair" else tuple(combinations(range(n_modes), 2))

    def can_be_right(self, scenario: Scenario) -> bool:
        """Whether anything is planted that could be found; if not, whatever is concluded is wrong."""
        match self.kind:
            case "best":
                return scenario.best is not None
            case "order":
                return len(set(scenario.worth)) == len(scenario.worth)
            case "pair":
                return scenario.worth[self.pair[0]] != scenario.worth[self.pair[1]]
            case "equal" | "equal pair":
                ability = scenario.ability
                return all(
                    abs(ability[i] - ability[j]) <= EQUIVALENT_BELOW
                    for i, j in self.equal_pairs(len(ability))
                )

    def of(self, question: QuestionFit, scenario: Scenario) -> Verdict:
        """What a fitted question comes to, against what was planted."""
        if not question.ranked or question.draws is None:
            return "unranked"
        ability = question.draws.ability.reshape(-1, len(scenario.worth))
        match self.kind:
            case "best":
                chances = np.array([mode.p_best for mode in question.modes])
                truth: object = scenario.best
                concluded: object = int(chances.argmax())
                chance = float(chances.max())
            case "order":
                orders, counts = np.unique(np.argsort(-ability, axis=1), axis=0, return_counts=True)
                truth = tuple(int(k) for k in np.argsort([-w for w in scenario.worth]))
                concluded = tuple(int(k) for k in orders[counts.argmax()])
                chance = float(counts.max() / len(ability))
            case "pair":
                i, j = self.pair
                above = float((ability[:, i] > ability[:, j]).mean())
                chance = max(above, 1.0 - above)
                concluded = i if above > 0.5 else j
                truth = max(self.pair, key=lambda k: scenario.worth[k])
            case "equal" | "equal pair":
                # As a report reads its pairs: each by itself.
                chance = min(
                    float((np.abs(ability[:, i] - ability[:, j]) <= EQUIVALENT_BELOW).mean())
                    for i, j in self.equal_pairs(ability.shape[1])
                )
                truth = concluded = "equal"
        if chance <= self.confidence:
            return "open"
        return "right" if concluded == truth and self.can_be_right(scenario) else "wrong"

    def sentence(self, names: Sequence[str]) -> str:
        """What counts as a conclusion."""
        i, j = (names[k] for k in self.pair)
        alike = f"equal in practice (at most {EQUIVALENT_BELOW:.2f} logits apart)"
        what = {
            "best": "which mode is best",
            "order": "the whole order of the modes",
            "pair": f"which of {i} and {j} is better",
            "equal": f"that all modes are {alike}",
            "equal pair": f"that {i} and {j} are {alike}",
        }[self.kind]
        each = " of each two" if self.kind == "equal" and len(names) > 2 else ""
        return f"{what},{each} with a probability above {self.confidence:g}"


EQUALITY_CONFIDENCE = LIKELY
"""Probability from which a report calls two modes equal in practice; a conclusion about equality takes it."""
BEST = Conclusion()
"""Which mode is best, with a probability above 0.95."""
