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

from analysis.model import (
    CUT_GAP_SCALE,
    LAPSE_BETA,
    LEARNING,
    LEARNING_SD,
    LOG_NU_SD,
    SCALE_SD_SCALE,
    SIDE_DRIFT_SD,
    SIDE_EFFECT_SD,
    SIDE_SD_SCALE,
    SUBJECT_SD_SCALE,
    Model,
)
from data.answers import SCALES
from data.errors import InputError
from data.responses import QuestionScale, ResponseTable

QUESTION = "calibration"
MOST_MODES = 8
MOST_ANSWERS = 20_000
_NORMAL = {"side_effect": SIDE_EFFECT_SD, "log_nu": LOG_NU_SD, "side_drift": SIDE_DRIFT_SD}
_HALF_NORMAL = {"subject_sd": SUBJECT_SD_SCALE, "side_sd": SIDE_SD_SCALE, "scale_sd": SCALE_SD_SCALE}
"""Scales of the priors that are normal or half normal, by parameter."""


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
        return modes_of(self.n_modes)

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Every pair of modes by their places."""
        return tuple(combinations(range(self.n_modes), 2))

    @property
    def answers(self) -> int:
        """Answers in one replicate."""
        return self.participants * self.repetitions * len(self.pairs)


def modes_of(n_modes: int) -> tuple[str, ...]:
    """Names of so many modes: M1, M2, ..."""
    return tuple(f"M{k + 1}" for k in range(n_modes))


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
    cut, modes = 0.0, modes_of(n_modes)
    for name in model.parameter_names(modes):
        if name in _NORMAL:
            parameters[name] = _NORMAL[name] * rng.normal()
        elif name in _HALF_NORMAL:
            parameters[name] = _HALF_NORMAL[name] * abs(rng.normal())
        elif name == "lapse":
            parameters[name] = rng.beta(1.0, LAPSE_BETA)
        elif name.startswith(LEARNING):
            parameters[name] = LEARNING_SD * rng.normal()
        else:
            cut += CUT_GAP_SCALE * abs(rng.normal())
            parameters[name] = cut
    if model.position:
        mean = sum(parameters[LEARNING + mode] for mode in modes) / n_modes
        parameters |= {LEARNING + mode: parameters[LEARNING + mode] - mean for mode in modes}
    return Truth(model.prior_sd * _zero_sum(rng.normal(size=n_modes)), parameters)


def draw_answers(model: Model, truth: Truth, design: Design, rng: np.random.Generator) -> ResponseTable:
    """One study's answers to one question by people to whom the truth applies."""
    modes, scale = design.modes, SCALES[model.levels]
    said = {name: truth.parameters.get(name, 0.0) for name in (*_NORMAL, *_HALF_NORMAL, "lapse")}
    gains = np.array([truth.parameters.get(LEARNING + mode, 0.0) for mode in modes])
    n_answers, most = len(design.pairs) * design.repetitions, (design.n_modes - 1) * design.repetitions
    rows = []
    for person in range(design.participants):
        own = truth.ability + said["subject_sd"] * _zero_sum(rng.normal(size=design.n_modes))
        side, wider = said["side_effect"], 1.0
        if model.person_side:
            side += said["side_sd"] * rng.normal()
        if model.person_scale:
            wider = float(np.exp(said["scale_sd"] * rng.normal()))
        met = np.zeros(design.n_modes)
        for number, (repetition, place) in enumerate(_sequence(design, model, rng)):
            pair = design.pairs[place]
            a, b = pair if (person + place + repetition) % 2 == 0 else pair[::-1]
            lead = own[a] - own[b] + side
            if model.position:
                now = own + gains * (met / max(most - 1, 1) - 0.5)
                lead = now[a] - now[b] + side + said["side_drift"] * (number / max(n_answers - 1, 1) - 0.5)
                met[[a, b]] += 1
            answer = scale[_felt(lead, wider, model, truth, rng)]
            if model.lapse and rng.random() < said["lapse"]:
                answer = scale[rng.integers(model.levels)]
            rows.append((f"p{person + 1}", modes[a], modes[b], answer, repetition + 1))
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response", "repetition"])
    frame = frame.assign(question=QUESTION, count=1, comparison="", source="simulated", check=False)
    question = QuestionScale(QUESTION, QUESTION, QUESTION, model.levels)
    return ResponseTable(frame, modes, (question,), True, True, "", "simulated for calibration")


def _sequence(design: Design, model: Model, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Repetition and pair of a person's comparisons, in a random order where that matters."""
    planned = [(r, p) for p in range(len(design.pairs)) for r in range(design.repetitions)]
    return [planned[k] for k in rng.permutation(len(planned))] if model.position else planned


def _felt(lead: float, wider: float, model: Model, truth: Truth, rng: np.random.Generator) -> int:
    """Place on the scale, from A much, of one person's answer to one comparison."""
    if model.link == "adjacent":
        log_odds = np.array([lead / 2, truth.parameters["log_nu"] + np.log(wider), -lead / 2])
        return int(np.argmax(log_odds + rng.gumbel(size=3)))
    cuts = [wider * truth.parameters[f"cut_{k + 1}"] for k in range(model.n_gaps)]
    edges = [*(-cut for cut in reversed(cuts)), *([] if model.levels % 2 else [0.0]), *cuts]
    return len(edges) - int(np.searchsorted(edges, lead + rng.logistic()))


def _zero_sum(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Independent normals less their mean are ZeroSumNormal."""
    return x - x.mean()
