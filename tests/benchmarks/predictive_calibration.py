"""How often the predictive checks raise an alarm: when the model is right, and when it is wrong.

``right``: true values from the priors, real fits, and how many checks are pointed out, against how many each
report says to expect. ``wrong``: people compare three modes twice on five levels, with a fault of a known
kind, and the share of studies in which each check points it out. Figures stand in analysis/README.md.

    python tests/benchmarks/predictive_calibration.py right --studies 400
    python tests/benchmarks/predictive_calibration.py wrong --studies 100
"""

import argparse
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.calibration.world import QUESTION, Design, draw_answers, draw_truth
from analysis.fit import fit
from analysis.model import model_of
from analysis.predictive import PredictiveChecks, predictive_checks
from analysis.results import FitSettings
from data.answers import SCALES
from data.responses import QuestionScale, ResponseTable

FloatArray = NDArray[np.float64]
DESIGNS = ((Design(7, 2, 3), 5), (Design(7, 2, 3), 3), (Design(20, 2, 3), 5), (Design(20, 1, 4), 2))
"""Studies of the first part: who compares what, and levels of the scale."""
ABILITY = np.array([0.5, 0.0, -0.5])
CUTS = np.array([0.5, 1.5])
SUBJECT_SD, SIDE_EFFECT = 0.7, 0.1
"""True values of the second part [logit]."""


@dataclass
class Person:
    """How one simulated person answers; the defaults are the model's."""

    own: FloatArray
    side: float = SIDE_EFFECT
    width: float = 1.0
    careless: float = 0.0
    remembers: float = 0.0
    drift: float = 0.0
    last: dict[tuple[int, int], int] = field(default_factory=dict)

    def answer(self, a: int, b: int, time: float, rng: np.random.Generator) -> int:
        """Place on the scale, from A much (0) to B much (4); ``time`` runs from -1 to 1."""
        pair, is_turned = (min(a, b), max(a, b)), a > b
        if pair in self.last and rng.random() < self.remembers:
            return 4 - self.last[pair] if is_turned else self.last[pair]
        lead = self.own[a] - self.own[b] + self.side + self.drift * time + rng.logistic()
        edges = self.width * np.concatenate([-CUTS[::-1], CUTS])
        level = 4 - int(np.searchsorted(edges, lead))
        if rng.random() < self.careless:
            level = int(rng.integers(5))
        self.last[pair] = 4 - level if is_turned else level
        return level


def normal_person(rng: np.random.Generator, strength: float = 1.0) -> FloatArray:
    """A person's own abilities, as the model has them."""
    z = rng.normal(size=3)
    return strength * ABILITY + SUBJECT_SD * (z - z.mean())


def in_camps(rng: np.random.Generator) -> FloatArray:
    """A person of one of two camps that want the opposite."""
    return ABILITY + rng.choice([-1.0, 1.0]) * np.array([1.5, 0.0, -1.5])


FAULTS: dict[str, Callable[[np.random.Generator], Person]] = {
    "none": lambda rng: Person(normal_person(rng)),
    "15 % of answers careless": lambda rng: Person(normal_person(rng), careless=0.15),
    "15 % careless, preferences six times as strong": lambda rng: Person(
        normal_person(rng, 6.0), careless=0.15
    ),
    "width of scale by person, sd .6": lambda rng: Person(
        normal_person(rng), width=np.exp(0.6 * rng.normal())
    ),
    "width of scale by person, sd 1": lambda rng: Person(normal_person(rng), width=np.exp(rng.normal())),
    "70 % of repeats remembered": lambda rng: Person(normal_person(rng), remembers=0.7),
    "side effect by person, sd .8": lambda rng: Person(normal_person(rng), side=0.8 * rng.normal()),
    "two camps": lambda rng: Person(in_camps(rng)),
    "side effect from -1 to 1 over time": lambda rng: Person(normal_person(rng), drift=1.0),
}


def faulty_study(fault: str, rng: np.random.Generator, people: int = 20) -> ResponseTable:
    """Twenty people, three pairs, twice, the second time with the sides exchanged; pairs in random order."""
    pairs, names = [(0, 1), (0, 2), (1, 2)], ("M1", "M2", "M3")
    rows = []
    for who in range(people):
        person = FAULTS[fault](rng)
        flips = rng.integers(2, size=3)
        for repetition in range(2):
            for place, k in enumerate(rng.permutation(3)):
                a, b = pairs[k] if (flips[k] + repetition) % 2 == 0 else pairs[k][::-1]
                level = person.answer(a, b, (3 * repetition + place - 2.5) / 2.5, rng)
                rows.append((f"p{who:02d}", names[a], names[b], SCALES[5][level], repetition + 1))
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response", "repetition"])
    frame = frame.assign(question=QUESTION, count=1, comparison="", source="simulated", check=False)
    question = QuestionScale(QUESTION, QUESTION, QUESTION, 5)
    return ResponseTable(frame, names, (question,), True, True, "", "simulated")


def checked(table: ResponseTable, seed: int) -> PredictiveChecks | None:
    """The checks of one study; None if it is not ranked."""
    fitted = fit(table, FitSettings(seed=seed))
    return predictive_checks(table, fitted) if fitted.ranked else None


def when_right(studies: int) -> None:
    """Print seen and expected alarms, and how often any check passes the limit for all of them."""
    for design, levels in DESIGNS:
        model = model_of(FitSettings(), levels, has_participants=True)
        n, seen, expected, any_, above, by_kind = 0, [], [], 0, 0, Counter[str]()
        for k in range(studies):
            rng = np.random.default_rng([2017, levels, design.participants, k])
            table = draw_answers(model, draw_truth(model, design.n_modes, rng), design, rng)
            found = checked(table, seed=k)
            if found is None:
                continue
            far = [c for c in found.checks if c.is_unlikely]
            n += len(found.checks)
            seen.append(len(far))
            expected.append(found.expected)
            any_ += any(c.is_surely_unlikely for c in found.checks)
            above += len(far) > found.at_most
            by_kind.update(c.kind for c in far)
        error = np.std(seen) / np.sqrt(len(seen))
        print(
            f"{design.participants} people, {design.n_modes} modes, {levels} levels, {len(seen)} studies: "
            f"{n / len(seen):.1f} checks, {np.mean(seen):.2f} (+- {error:.2f}) pointed out, "
            f"{np.mean(expected):.2f} expected; more than at most {above / len(seen):.3f}; "
            f"any caution {any_ / len(seen):.3f}",
            flush=True,
        )
        print(
            "   ", {kind: round(count / len(seen), 3) for kind, count in sorted(by_kind.items())}, flush=True
        )


def when_wrong(studies: int) -> None:
    """Print the share of studies in which a check of each kind is pointed out, and becomes a caution."""
    for fault in FAULTS:
        n, far, sure, ups = 0, Counter[str](), Counter[str](), Counter[str]()
        for k in range(studies):
            found = checked(faulty_study(fault, np.random.default_rng([7, k])), seed=k)
            if found is None:
                continue
            n += 1
            far.update({c.kind for c in found.checks if c.is_unlikely})
            sure.update({c.kind for c in found.checks if c.is_surely_unlikely})
            ups.update({c.kind for c in found.checks if c.is_unlikely and c.is_high})
        print(f"{fault}: {n} studies", flush=True)
        for kind, count in far.most_common():
            print(
                f"    {kind:16} {count / n:.2f} (high {ups[kind] / n:.2f}), caution {sure[kind] / n:.2f}",
                flush=True,
            )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("right", "wrong"))
    parser.add_argument("--studies", type=int, default=100)
    options = parser.parse_args()
    {"right": when_right, "wrong": when_wrong}[options.part](options.studies)
