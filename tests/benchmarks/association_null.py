"""How often a report says "went together" of answers that follow nothing, or one metric, on real lap metrics.

    elbowroom demo --out demo
    python tests/benchmarks/association_null.py --store demo/study.sqlite

The laps are those of a store; the answers to all its questions are drawn anew for each set and go through
`analysis.association` as in a report. Without a preference: ``even``, every answer as likely; ``ties``,
people have tie rates of their own; ``sides``, and side effects of their own (sd 1 logit about 0.3);
``lines``, and three in ten always give the same answer. Prints the share of sets with any
claim, to be at most 6 %.
With ``--follow METRIC`` the lead of A is so many logits (``--strength``) for each standard deviation of that
metric's difference between the two laps, with tie rates and side effects, and people whose own strengths
spread by half of it: prints the share of sets that name the metric.
"""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.association import LIST_ERROR, Laps, laps_behind, pair_tests
from data.answers import SCALES
from data.responses import MetricTable, ResponseTable
from data.store import Store

FloatArray = NDArray[np.float64]
KINDS = ("even", "ties", "sides", "lines")


@dataclass(frozen=True)
class Study:
    """Laps and questions of a store, and whose each answer is."""

    table: ResponseTable
    metrics: MetricTable
    laps: Laps
    person: NDArray[np.intp]


def read(path: Path, people: int) -> Study:
    """The first people of the only study in a store; all of them for 0."""
    with Store.open(str(path), create=False) as store:
        stored = store.study(None)
        table = store.responses_table(stored, include_simulated=True)
        metrics = store.metric_table(stored, include_simulated=True)
    assert metrics is not None, "a store with laps"
    names = list(dict.fromkeys(table.rows["participant"]))[: people or None]
    rows = table.rows[table.rows["participant"].isin(names)].reset_index(drop=True)
    table = replace(table, rows=rows)
    laps = laps_behind(rows, metrics)
    return Study(table, metrics, laps, laps.person)


def standardised(study: Study, metric: str) -> FloatArray:
    """Difference of a metric between the laps of each answer, in its own root mean square; 0 if unknown."""
    values = study.metrics.rows.set_index(["comparison", "mode"])[metric]
    rows = study.table.rows
    of_a, of_b = (
        values.reindex(pd.MultiIndex.from_arrays([rows["comparison"], rows[side]])).to_numpy()
        for side in ("mode_a", "mode_b")
    )
    lead = np.nan_to_num(of_a - of_b)
    return np.asarray(lead / np.sqrt((lead**2).mean()))


def answers(study: Study, kind: str, lead: FloatArray, rng: np.random.Generator) -> list[str]:
    """One set of answers, a person's questions with tie rates, sides and lines of their own."""
    rows, n = study.table.rows, int(study.person.max()) + 1
    drawn = np.empty(len(rows), dtype=object)
    for question in study.table.questions:
        own = np.flatnonzero((rows["question"] == question.name).to_numpy())
        scale = np.array(SCALES[question.levels], dtype=object)
        person = study.person[own]
        if kind == "even":
            drawn[own] = scale[rng.integers(0, len(scale), len(own))]
            continue
        first = np.exp(rng.normal(-0.5, 1.0, n))[person]
        cuts = np.outer(first, 1.0 + 1.5 * np.arange(question.levels // 2))
        felt = lead[own] + rng.logistic(size=len(own))
        if kind != "ties":
            felt += rng.normal(0.3, 1.0, n)[person]
        if kind == "lines":
            felt += (12.0 * (rng.random(n) < 0.3) * rng.choice([-1.0, 1.0], n))[person]
        steps = (np.abs(felt)[:, None] > cuts).sum(axis=1) * np.sign(felt).astype(int)
        drawn[own] = scale[question.levels // 2 - steps]
    return list(drawn)


def main() -> None:
    """Read the command line, draw, test, print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--store", type=Path, required=True)
    parser.add_argument("--people", type=int, default=0, help="the first so many; 0 for all")
    parser.add_argument("--sets", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--follow", help="a metric that all answers follow")
    parser.add_argument("--strength", type=float, default=1.0, help="logits a standard deviation")
    wish = parser.parse_args()
    study = read(wish.store, wish.people)
    people = int(study.person.max()) + 1
    lead = np.zeros(len(study.person)) if wish.follow is None else standardised(study, wish.follow)
    for kind in KINDS if wish.follow is None else ("sides",):
        named, right, pairs = 0, 0, 0
        for number in range(wish.sets):
            rng = np.random.default_rng([wish.seed, KINDS.index(kind), number])
            strength = wish.strength * rng.normal(1.0, 0.5, people)[study.person]
            rows = study.table.rows.assign(response=answers(study, kind, strength * lead, rng))
            tested = pair_tests(rows, study.laps, study.table.questions, seed=number)
            passing = [
                metric
                for (_, metric), p in zip(tested.pairs, tested.flips.in_list, strict=True)
                if p <= LIST_ERROR
            ]
            named += bool(passing)
            right += wish.follow in passing
            pairs += len(passing)
        share = named / wish.sets
        error = np.sqrt(max(share * (1 - share), 1e-9) / wish.sets)
        print(f"{people} people, {kind}: {share:.4f} ({error:.4f}) of {wish.sets} sets name any pair", end="")
        print(f", {pairs / wish.sets:.2f} pairs a set", end="")
        print("" if wish.follow is None else f"; {right / wish.sets:.3f} name {wish.follow}", flush=True)


if __name__ == "__main__":
    main()
