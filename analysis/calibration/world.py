"""What the data of a calibration come from: true values drawn from the priors, and people's answers.

Nothing here uses a formula of the density that is put to the test. True values come from the stated
distributions, and an answer from what one person feels: under the cumulative link a lead with logistic noise
between cut-points (Agresti 1992), under the adjacent link the highest of three log-odds with Gumbel noise
(Yellott 1977: that has the odds of Davidson's model).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.model import CUT_GAP_SCALE, LOG_NU_SD, SIDE_EFFECT_SD, SUBJECT_SD_SCALE, Model
from data.answers import SCALES
from data.errors import InputError
from data.responses import QuestionScale, ResponseTable

QUESTION = "calibration"
MOST_MODES = 8
MOST_ANSWERS = 20_000


@dataclass(frozen=True)
class Design:
    """Who compares what: every pair of modes, so many times, by so many people.

    The sides of a pair are exchanged from one repetition and from one person to the next.
    """

    participants: int = 7
    repetitions: int = 2
    n_modes: int = 3

    def __post_init__(self) -> None:
        for what, number, least in (
            ("participants", self.participants, 1),
            ("repetitions", self.repetitions, 1),
            ("modes", self.n_modes, 2),
        ):
            if number < least:
                raise InputError(f"{what}: {number!r} is fewer than {least}")
        if self.n_modes > MOST_MODES:
            raise InputError(f"modes: {self.n_modes} is more than {MOST_MODES}")
        if self.answers > MOST_ANSWERS:
            raise InputError(
                f"participants, repetitions, modes: {self.answers} answers a replicate are more than "
                f"{MOST_ANSWERS}"
            )

    @property
    def modes(self) -> tuple[str, ...]:
        """Names of the modes: M1, M2, ..."""
        return tuple(f"M{k + 1}" for k in range(self.n_modes))

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Every pair of modes by their places."""
        return tuple(combinations(range(self.n_modes), 2))

    @property
    def answers(self) -> int:
        """Answers in one replicate."""
        return self.participants * self.repetitions * len(self.pairs)


@dataclass(frozen=True)
class Truth:
    """What one replicate's answers come from.

    Attributes
    ----------
    ability : ndarray, shape (mode,)
        Sums to 0 [logit].
    parameters : mapping of str to float
        The model's parameters beside the abilities, by their names in the report.
    """

    ability: NDArray[np.float64]
    parameters: Mapping[str, float]


def draw_truth(model: Model, n_modes: int, rng: np.random.Generator) -> Truth:
    """True values from the priors of ``analysis.model``."""
    parameters: dict[str, float] = {}
    cut = 0.0
    for name in model.parameter_names:
        if name == "side_effect":
            parameters[name] = SIDE_EFFECT_SD * rng.normal()
        elif name == "log_nu":
            parameters[name] = LOG_NU_SD * rng.normal()
        elif name == "subject_sd":
            parameters[name] = SUBJECT_SD_SCALE * abs(rng.normal())
        else:
            cut += CUT_GAP_SCALE * abs(rng.normal())
            parameters[name] = cut
    return Truth(model.prior_sd * _zero_sum(rng.normal(size=n_modes)), parameters)


def draw_answers(model: Model, truth: Truth, design: Design, rng: np.random.Generator) -> ResponseTable:
    """One study's answers to one question by people to whom the truth applies."""
    modes, scale = design.modes, SCALES[model.levels]
    side, spread = truth.parameters.get("side_effect", 0.0), truth.parameters.get("subject_sd", 0.0)
    rows = []
    for person in range(design.participants):
        own = truth.ability + spread * _zero_sum(rng.normal(size=design.n_modes))
        for place, pair in enumerate(design.pairs):
            for repetition in range(design.repetitions):
                a, b = pair if (person + place + repetition) % 2 == 0 else pair[::-1]
                answer = scale[_felt(own[a] - own[b] + side, model, truth, rng)]
                rows.append((f"p{person + 1}", modes[a], modes[b], answer, repetition + 1))
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response", "repetition"])
    frame = frame.assign(question=QUESTION, count=1, comparison="", source="simulated", check=False)
    question = QuestionScale(QUESTION, QUESTION, QUESTION, model.levels)
    return ResponseTable(frame, modes, (question,), True, True, "", "simulated for calibration")


def _felt(lead: float, model: Model, truth: Truth, rng: np.random.Generator) -> int:
    """Place on the scale, from A much, of one person's answer to one comparison."""
    if model.link == "adjacent":
        log_odds = np.array([lead / 2, truth.parameters["log_nu"], -lead / 2])
        return int(np.argmax(log_odds + rng.gumbel(size=3)))
    cuts = [truth.parameters[f"cut_{k + 1}"] for k in range(model.n_gaps)]
    edges = [-cut for cut in reversed(cuts)] + (cuts or [0.0])
    return len(edges) - int(np.searchsorted(edges, lead + rng.logistic()))


def _zero_sum(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Independent normals less their mean are ZeroSumNormal."""
    return x - x.mean()
