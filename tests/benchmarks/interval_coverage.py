"""Do the report's 94 % intervals hold the truth, those that `elbowroom calibrate` does not look at?

    python tests/benchmarks/interval_coverage.py --sets 300

True values come from the priors, seven people answer three pairs twice on five levels, and the report's own
functions read the fit. Printed with the Monte Carlo error over sets: each person's own worths, the share of
people whose own first is the group's, the shares of answers among new people (``strength.csv`` takes "much"
from these), and the difference of worths between two groups of people. Then, without a fit, the intervals of
a mode's mean metric and of the correlation within people, for normal and for log-normal people.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.answer_shares import _expected, answer_shares
from analysis.association import associations
from analysis.background_groups import Groups
from analysis.calibration import Design, world_of
from analysis.calibration.world import Truth, draw_truth
from analysis.fit import fit
from analysis.measures import mode_measures
from analysis.moderation import _differences
from analysis.persons import agreements
from analysis.results import Draws, FitSettings, QuestionFit
from analysis.softmax import worth_of
from data.answers import SCALES
from data.responses import MetricTable, QuestionScale, ResponseTable

FloatArray = NDArray[np.float64]
DESIGN = Design(7, 2, 3)
LEVELS = 5
SETTINGS = FitSettings()
_GROUPS = Groups("groups", "", "one", "other", {})


@dataclass(frozen=True)
class Answered:
    """Answers and the abilities of each person, (person, mode), that they came from."""

    table: ResponseTable
    own: FloatArray


def answered(truth: Truth, rng: np.random.Generator) -> Answered:
    """People with their own abilities around the truth, and what they answer."""
    z = rng.normal(size=(DESIGN.participants, DESIGN.n_modes))
    own = truth.ability + truth.parameters["subject_sd"] * (z - z.mean(axis=1, keepdims=True))
    cuts = np.array([truth.parameters["cut_1"], truth.parameters["cut_2"]])
    edges = np.concatenate([-cuts[::-1], cuts])
    rows: list[tuple[str, ...]] = []
    for person in range(DESIGN.participants):
        for place, pair in enumerate(DESIGN.pairs):
            for repetition in range(DESIGN.repetitions):
                a, b = pair if (person + place + repetition) % 2 == 0 else pair[::-1]
                felt = own[person, a] - own[person, b] + truth.parameters["side_effect"] + rng.logistic()
                answer = SCALES[LEVELS][len(edges) - int(np.searchsorted(edges, felt))]
                rows.append((f"p{person}", f"c{len(rows)}", DESIGN.modes[a], DESIGN.modes[b], answer))
    frame = pd.DataFrame(rows, columns=["participant", "comparison", "mode_a", "mode_b", "response"])
    frame = frame.assign(question="Q", count=1, repetition=1, source="simulated", check=False)
    scale = QuestionScale("Q", "Q", "Q", LEVELS)
    return Answered(ResponseTable(frame, DESIGN.modes, (scale,), True, True, "", "coverage"), own)


def _true_shares(truth: Truth, i: int, j: int, pair_rows: pd.DataFrame) -> FloatArray:
    """Shares of answers among new people under the truth, orders as they were shown."""
    once = Draws(
        truth.ability[None, None],
        worth_of(truth.ability)[None, None],
        {name: np.array([[value]]) for name, value in truth.parameters.items()},
        np.zeros((1, 1), bool),
    )
    as_ij = int((pair_rows["mode_a"] == DESIGN.modes[i]).sum())
    shares = _expected(once, LEVELS, i, j, as_ij, len(pair_rows) - as_ij)
    assert shares is not None, "the truth has every parameter of the scale"
    return shares[0]


def one_set(rng: np.random.Generator) -> tuple[dict[str, list[bool]], Truth, QuestionFit]:
    """Which of a fit's intervals hold their truth, by kind."""
    truth = draw_truth(world_of(SETTINGS, LEVELS), DESIGN.n_modes, rng)
    drawn = answered(truth, rng)
    fitted = fit(drawn.table, replace(SETTINGS, seed=int(rng.integers(2**31))))
    place = [fitted.modes.index(mode) for mode in DESIGN.modes]
    assert place == sorted(place), "the table names the modes in their order"
    held: dict[str, list[bool]] = {"own worth": [], "share of own firsts": [], "share of answers": []}
    (agreement,) = agreements(drawn.table, fitted, int(rng.integers(2**31)))
    own_worth = worth_of(drawn.own)
    for k, person in enumerate(agreement.people):
        true = own_worth[divmod(k, DESIGN.n_modes)]
        held["own worth"].append(person.worth_hdi_low <= true <= person.worth_hdi_high)
    if agreement.people:
        first = DESIGN.modes.index(agreement.first)
        share = float((drawn.own.argmax(axis=1) == first).mean())
        held["share of own firsts"].append(
            agreement.share_hdi_low - 1e-9 <= share <= agreement.share_hdi_high + 1e-9
        )
    rows = drawn.table.rows
    for pair in answer_shares(drawn.table, fitted)[0]:
        is_pair = rows[["mode_a", "mode_b"]].isin([pair.mode_i, pair.mode_j]).all(axis=1)
        i, j = DESIGN.modes.index(pair.mode_i), DESIGN.modes.index(pair.mode_j)
        true_shares = _true_shares(truth, i, j, rows[is_pair])
        ends = zip(pair.expected_low, true_shares, pair.expected_high, strict=True)
        held["share of answers"] += [low <= share <= high for low, share, high in ends]
    return held, truth, fitted.questions[0]


def _group_differences(one: tuple[Truth, QuestionFit], other: tuple[Truth, QuestionFit]) -> list[bool]:
    lead = worth_of(other[0].ability) - worth_of(one[0].ability)
    return [
        d.difference_hdi_low <= true <= d.difference_hdi_high
        for d, true in zip(_differences(_GROUPS, one[1], other[1]), lead, strict=False)
    ]


def _print(name: str, sets: list[list[bool]]) -> None:
    """Coverage and its error: the intervals of a set hang together, so sets are the units."""
    shares = np.array([np.mean(own) for own in sets if own])
    print(f"{name}: {shares.mean():.3f} ({shares.std(ddof=1) / np.sqrt(len(shares)):.3f})", flush=True)


def _laps(people: int, is_skewed: bool, rng: np.random.Generator) -> Iterator[tuple[str, str, str, float]]:
    for person in range(people):
        level = rng.normal()
        for comparison in range(6):
            for mode in ("M1", "M2"):
                value = 0.5 * level + 0.3 * rng.normal() + 0.2 * (mode == "M1")
                yield (
                    f"p{person}",
                    f"{person}.{comparison}",
                    mode,
                    float(np.exp(value) if is_skewed else value),
                )


def mean_intervals(people: int, is_skewed: bool, rng: np.random.Generator) -> list[bool]:
    """Whether the intervals of two modes' means hold 0.2 and 0: of the logs for log-normal people."""
    name = "jerk_rms_m_s3" if is_skewed else "gain_exit"
    columns = ["participant", "comparison", "mode", name]
    table = MetricTable(pd.DataFrame(_laps(people, is_skewed, rng), columns=columns))
    # A person's own mean of six log-normal laps lies above the middle of them, the same for everybody.
    shift = 0.0 if not is_skewed else _SHIFT
    true = [np.exp(0.2 + shift), np.exp(shift)] if is_skewed else [0.2, 0.0]
    measured = mode_measures(table, ("M1", "M2"))
    return [m.low <= t <= m.high for m, t in zip(measured, true, strict=True)]


_SHIFT = float(np.log(np.exp(0.3 * np.random.default_rng(0).normal(size=(200_000, 6))).mean(axis=1)).mean())


def correlation_interval(
    people: int, strength: float, rng: np.random.Generator
) -> tuple[float, float, float]:
    """Correlation within people and its interval, of answers that follow a metric with people's own
    strengths."""
    person = np.repeat(np.arange(people), 6)
    x = rng.normal(size=6 * people)
    lead = (strength + 0.7 * rng.normal(size=people))[person] * x + rng.normal(0.2, 0.7, people)[person]
    steps = np.searchsorted([-1.6, -0.6, 0.6, 1.6], lead + rng.logistic(size=len(x)))
    comparison = [f"c{k}" for k in range(len(x))]
    rows = pd.DataFrame({"participant": [f"p{k:06}" for k in person], "comparison": comparison})
    rows = rows.assign(mode_a="M1", mode_b="M2", question="Q", check=False)
    rows["response"] = [SCALES[LEVELS][LEVELS - 1 - k] for k in steps]
    laps = pd.concat([rows.assign(mode="M1", gain_exit=x), rows.assign(mode="M2", gain_exit=0.0)])
    table = ResponseTable(rows, ("M1", "M2"), (QuestionScale("Q", "Q", "Q", LEVELS),), True, True, "", "")
    (own,) = associations(table, MetricTable(laps))
    return own.correlation, own.correlation_low, own.correlation_high


def main() -> None:
    """Read the command line, simulate, print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sets", type=int, default=300, help="fits")
    parser.add_argument("--fast-sets", type=int, default=3000, help="sets without a fit")
    parser.add_argument("--seed", type=int, default=1)
    wish = parser.parse_args()
    for people in (7, 20):
        for is_skewed in (False, True):
            rng = np.random.default_rng([wish.seed, people, is_skewed])
            _print(
                f"mean metric, {people} people, {'log-normal' if is_skewed else 'normal'}",
                [mean_intervals(people, is_skewed, rng) for _ in range(wish.fast_sets)],
            )
        for strength in (0.0, 1.0):
            rng = np.random.default_rng([wish.seed, people, int(strength), 7])
            true = correlation_interval(5_000, strength, rng)[0]
            ends = [correlation_interval(people, strength, rng)[1:] for _ in range(wish.fast_sets)]
            held = [[low <= true <= high] for low, high in ends if not np.isnan(low)]
            _print(f"correlation within people, {people} people, true {true:+.2f}", held)
    sets: dict[str, list[list[bool]]] = {"difference between groups": []}
    before: tuple[Truth, QuestionFit] | None = None
    for number in range(wish.sets):
        held_here, truth, question = one_set(np.random.default_rng([wish.seed, number]))
        for kind, own in held_here.items():
            sets.setdefault(kind, []).append(own)
        if before is not None and number % 2:
            sets["difference between groups"].append(_group_differences(before, (truth, question)))
        before = truth, question
    for kind, held in sets.items():
        _print(kind, held)


if __name__ == "__main__":
    main()
