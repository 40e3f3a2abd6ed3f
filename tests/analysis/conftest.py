"""Response tables for the tests of the analysis: simulated with a known truth, or published."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from data.answers import SCALES, inferred_levels
from data.responses import QuestionScale, ResponseTable

REFERENCE = Path(__file__).parents[1] / "reference"
DEFAULTS = {
    "participant": "",
    "question": "preference",
    "count": 1,
    "comparison": "",
    "repetition": 0,
    "source": "human",
    "check": False,
}


def make_table(
    rows: pd.DataFrame, *, modes: Sequence[str] = (), levels: int = 0, has_participants: bool | None = None
) -> ResponseTable:
    """A response table from rows that may lack the optional columns."""
    filled = rows.assign(**{name: value for name, value in DEFAULTS.items() if name not in rows})
    questions = tuple(
        QuestionScale(str(name), str(name), str(name), levels or inferred_levels(set(group["response"])))
        for name, group in filled.groupby("question", sort=False)
    )
    seen = tuple(dict.fromkeys(filled[["mode_a", "mode_b"]].to_numpy().ravel()))
    known = "participant" in rows if has_participants is None else has_participants
    return ResponseTable(filled, tuple(modes) or seen, questions, known, False, "0" * 64, "test")


@dataclass(frozen=True)
class Truth:
    """What a simulated cohort's answers come from; abilities sum to zero."""

    ability: tuple[float, ...] = (0.6, -0.8, 0.2)
    side_effect: float = 0.3
    subject_sd: float = 0.7
    cuts: tuple[float, ...] = (0.5, 1.2, 1.8, 2.5)


def simulate(
    truth: Truth, *, levels: int, participants: int, repetitions: int = 2, seed: int = 1, question: str = "Q1"
) -> pd.DataFrame:
    """Answers drawn from the model by a latent logistic variable: no formula of the package is used."""
    rng = np.random.default_rng(seed)
    ability, n = np.array(truth.ability), len(truth.ability)
    cuts = truth.cuts[: (levels - 1) // 2]
    edges = [*(-cut for cut in reversed(cuts)), *([] if levels % 2 else [0.0]), *cuts]
    rows = []
    for s in range(participants):
        z = rng.normal(size=n)
        own = ability + truth.subject_sd * (z - z.mean())
        for repetition in range(repetitions):
            for i in range(n):
                for j in range(i + 1, n):
                    a, b = (i, j) if (repetition + s) % 2 == 0 else (j, i)
                    felt = own[a] - own[b] + truth.side_effect + rng.logistic()
                    answer = SCALES[levels][levels - 1 - int(np.searchsorted(edges, felt))]
                    rows.append((f"p{s:03d}", question, f"M{a + 1}", f"M{b + 1}", answer))
    return pd.DataFrame(rows, columns=["participant", "question", "mode_a", "mode_b", "response"])


def from_wins(wins: list[list[int]], ties: dict[tuple[int, int], int] | None = None) -> ResponseTable:
    """A pooled table of three modes M1.. from wins of row over column and ties by pair."""
    rows = [
        (f"M{i + 1}", f"M{j + 1}", "A>B", n) for i, row in enumerate(wins) for j, n in enumerate(row) if n
    ]
    rows += [(f"M{i + 1}", f"M{j + 1}", "A=B", n) for (i, j), n in (ties or {}).items()]
    return make_table(
        pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"]),
        modes=[f"M{i + 1}" for i in range(len(wins))],
    )


@pytest.fixture(scope="session")
def cems() -> ResponseTable:
    return make_table(pd.read_csv(REFERENCE / "cems.csv"))


@pytest.fixture(scope="session")
def baseball() -> ResponseTable:
    return make_table(pd.read_csv(REFERENCE / "baseball.csv"), has_participants=False)


@pytest.fixture(scope="session")
def table_of() -> Callable[..., ResponseTable]:
    return make_table


@pytest.fixture(scope="session")
def answers_of() -> Callable[..., pd.DataFrame]:
    return simulate


@pytest.fixture(scope="session")
def truth() -> Truth:
    return Truth()


@pytest.fixture(scope="session")
def wins_table() -> Callable[..., ResponseTable]:
    return from_wins


@pytest.fixture(scope="session")
def simulated() -> Callable[..., ResponseTable]:
    """A cohort's table with a known truth: ``simulated(levels, participants, seed)``."""

    def table(levels: int, participants: int = 12, seed: int = 1) -> ResponseTable:
        rows = simulate(Truth(), levels=levels, participants=participants, seed=seed)
        return make_table(rows, modes=("M1", "M2", "M3"), levels=levels)

    return table
