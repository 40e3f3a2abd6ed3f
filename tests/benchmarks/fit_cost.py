"""What a fit costs: python tests/benchmarks/fit_cost.py

Prints seconds and the smallest effective sample size, of the built-in study's size (42 answers to each of six
questions) cold and warm, and of 303 people's preferences between six business schools.
"""

import time

START = time.perf_counter()

from pathlib import Path  # noqa: E402

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402

from analysis.fit import fit  # noqa: E402
from analysis.results import FitSettings  # noqa: E402
from data.answers import SCALES  # noqa: E402
from data.responses import QuestionScale, ResponseTable  # noqa: E402


def study_table() -> ResponseTable:
    """Seven people, three modes, each pair twice, six questions; answers at random."""
    rng = np.random.default_rng(1)
    rows = [
        (
            f"p{s}",
            f"Q{q}",
            *pair[::side],
            SCALES[5 if q < 4 else 3][rng.integers(5 if q < 4 else 3)],
            1,
            False,
        )
        for q in range(1, 7)
        for s in range(7)
        for pair in (("M1", "M2"), ("M1", "M3"), ("M2", "M3"))
        for side in (1, -1)
    ]
    columns = ["participant", "question", "mode_a", "mode_b", "response", "count", "check"]
    questions = tuple(QuestionScale(f"Q{q}", f"Q{q}", "", 5 if q < 4 else 3) for q in range(1, 7))
    return ResponseTable(
        pd.DataFrame(rows, columns=columns), ("M1", "M2", "M3"), questions, True, True, "", ""
    )


def schools_table() -> ResponseTable:
    """Dittrich, Hatzinger, Katzenbeisser 1998."""
    rows = pd.read_csv(Path(__file__).parents[1] / "reference" / "cems.csv").assign(count=1, check=False)
    modes = tuple(sorted({*rows["mode_a"], *rows["mode_b"]}))
    scale = QuestionScale("preferred school", "preferred", "", 3)
    return ResponseTable(rows, modes, (scale,), True, False, "", "")


def report(name: str, table: ResponseTable, settings: FitSettings) -> None:
    start = time.perf_counter()
    found = fit(table, settings)
    seconds = time.perf_counter() - start
    print(f"{name:<42} {seconds:6.2f} s   ESS {found.ess_min:6.0f}   R-hat {found.rhat_max:.4f}")


if __name__ == "__main__":
    print(f"{'imports':<42} {time.perf_counter() - START:6.2f} s")
    report("6 questions x 42 answers, first", study_table(), FitSettings())
    report("6 questions x 42 answers, again", study_table(), FitSettings())
    report("303 people x 15 pairs, pooled", schools_table(), FitSettings(pooled=True, side_effect=False))
    report("303 people x 15 pairs, hierarchical", schools_table(), FitSettings(side_effect=False))
