"""What the 2017 paper says of its people, beside many simulated studies of the same size."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd

from app.carmichael2017.cohorts import OF_THE_STUDY, PLAIN
from sim_trials.reproductions.carmichael2017.claims import OF_THE_ROBOT, STUCK_PERCENT, STUCK_TIMES
from sim_trials.reproductions.verdict import Judgement, Verdict, judge, percent

LIKELY, UNLIKELY = 0.8, 0.2
"""An order comes out if it does in so many of the simulated studies, and does not if it stays away from as
many; between the two, studies of this size disagree and decide nothing."""
RATERS = (
    "Assumed: simulated raters. What they weigh was chosen by this project with the paper at hand, so an "
    "order that comes out says nothing of people"
)
KINDS = {OF_THE_STUDY: "the study file's raters", PLAIN: "raters who go by the plain magnitude over a lap"}
Worth = Mapping[str, float]


@dataclass(frozen=True)
class Order:
    """A published statement on how a question ranked the modes."""

    question: str
    claim: str
    published: str
    holds: Callable[[Worth], bool]
    by_chance: float


def _falls(*modes: str) -> Callable[[Worth], bool]:
    return lambda worth: all(worth[a] > worth[b] for a, b in pairwise(modes))


def _is_last(mode: str) -> Callable[[Worth], bool]:
    return lambda worth: min(worth, key=lambda m: worth[m]) == mode


ORDERS = (
    Order("Q1", "Q1, the smoothest: M2 was ranked the worst (3)", "M2 last", _is_last("M2"), 1 / 3),
    Order(
        "Q2",
        "Q2, the most responsive: M1, then M3, then M2 (3)",
        "M1 > M3 > M2",
        _falls("M1", "M3", "M2"),
        1 / 6,
    ),
    Order(
        "Q3",
        "Q3, the most force: M2, then M3, then M1 (3)",
        "M2 > M3 > M1",
        _falls("M2", "M3", "M1"),
        1 / 6,
    ),
    Order("Q4", "Q4, the most in control: M1 fared the worst (3)", "M1 last", _is_last("M1"), 1 / 3),
    Order(
        "Q5",
        "Q5, the least frustrating: M3 before M2, M1 the worst (3)",
        "M3 > M2 > M1",
        _falls("M3", "M2", "M1"),
        1 / 6,
    ),
    Order(
        "Q6", "Q6, the safest: M2 first, M1 the worst (3)", "M2 > M3 > M1", _falls("M2", "M3", "M1"), 1 / 6
    ),
)
"""Section 3; what it says of "Q3-Q6" is taken to mean Q4 to Q6."""


def order_table(cohorts: pd.DataFrame) -> pd.DataFrame:
    """In what share of the simulated studies each published order came out, and which order was commonest.

    Parameters
    ----------
    cohorts : DataFrame
        As `cohorts.cohort_table` makes it.
    """
    rows = []
    for order in ORDERS:
        for raters in (OF_THE_STUDY, PLAIN):
            worths = _worths(cohorts, raters, order.question)
            if worths:
                share = float(np.mean([order.holds(worth) for worth in worths]))
                found = pd.Series([_written(worth) for worth in worths]).value_counts()
                commonest, times = str(found.index[0]), float(found.iloc[0] / len(worths))
                named = (order.question, raters, order.published)
                rows.append((*named, share, order.by_chance, commonest, times, len(worths)))
    columns = ["question", "raters", "published", "share", "by_chance", "commonest", "commonest_share"]
    return pd.DataFrame(rows, columns=[*columns, "cohorts"])


def of_stuck(cohorts: pd.DataFrame, surface: pd.DataFrame) -> tuple[Verdict, ...]:
    """How often the robot got stuck; ``surface`` as `sim_trials.sweep.sweep` makes it."""
    stuck = stuck_by_cohort(cohorts)
    m1, others = stuck["M1"], stuck[["M2", "M3"]]
    low, high = (int(q) for q in np.quantile(m1, [0.05, 0.95]))
    cells = surface[surface["mode"] == "M1"]["rate"]
    swept = surface[surface["mode"] != "M1"]
    in_studies, edge = int(others.to_numpy().sum()), swept["right_y_m"].min()
    by_dwell = swept.groupby("dwell_s")["stuck"].sum()
    conditions = int(swept.groupby("dwell_s")["participants"].sum().iloc[0])
    found = ", ".join(f"{n} with {dwell:g} s" for dwell, n in by_dwell.items() if n) or "0"
    holds = [in_studies == 0, *(by_dwell == 0)]
    return (
        Verdict(
            "The robot got stuck in 39 % of the comparisons with M1 (3)",
            f"{STUCK_TIMES} of 28: {STUCK_PERCENT} %",
            f"median {m1.median():g} of {_comparisons(cohorts)}, in nine of ten studies {low} to {high}; "
            f"with other edges of the maze and dwell times {percent(cells.min())} to {percent(cells.max())} "
            "of conditions",
            "edge of the maze and dwell time, which the paper does not give, were chosen to come near 39 %: "
            "a calibration, no prediction",
            judge(low <= STUCK_TIMES <= high, "calibrated"),
        ),
        Verdict(
            "Every time the robot got stuck it was under M1 (3)",
            "M2, M3: never",
            f"M2 and M3: {in_studies} in {len(stuck)} studies; with the edge at {edge:g} m, of {conditions} "
            f"conditions, by dwell time: {found}",
            f"holds in {sum(holds)} of {len(holds)} choices of edge and dwell time. {OF_THE_ROBOT}",
            judge(holds, OF_THE_ROBOT),
        ),
    )


def of_the_ranks(cohorts: pd.DataFrame, orders: pd.DataFrame, worth: pd.DataFrame) -> tuple[Verdict, ...]:
    """What was published of the ranking.

    Parameters
    ----------
    orders : DataFrame
        From `order_table`.
    worth : DataFrame
        ``question, mode, worth`` of the one study that is drawn as figure 5.
    """
    return (
        *(_of_an_order(order, orders, worth) for order in ORDERS),
        _of_the_largest_difference(cohorts),
        _of_the_preferred(cohorts),
    )


def stuck_by_cohort(cohorts: pd.DataFrame) -> pd.DataFrame:
    """Comparisons with the robot stuck: a row a study, a column a mode."""
    first = cohorts[(cohorts["raters"] == OF_THE_STUDY) & (cohorts["question"] == "Q1")]
    return first.pivot(index="cohort", columns="mode", values="stuck")


def _comparisons(cohorts: pd.DataFrame) -> int:
    """With M1, in one study."""
    return int(cohorts.loc[cohorts["mode"] == "M1", "comparisons"].iloc[0])


def _of_an_order(order: Order, orders: pd.DataFrame, worth: pd.DataFrame) -> Verdict:
    rows = orders[orders["question"] == order.question]
    drawn = worth[worth["question"] == order.question].set_index("mode")["worth"].sort_values(ascending=False)
    one_study = ", ".join(f"{mode} {value:.2f}" for mode, value in drawn.items()) or "not ranked"
    shares = ", ".join(
        f"{percent(row['share'])} with {KINDS[row['raters']]} "
        f"(commonest {row['commonest']}, {percent(row['commonest_share'])})"
        for row in rows.to_dict("records")
    )
    return Verdict(
        order.claim,
        order.published,
        f"in {shares}; by chance {percent(order.by_chance)}. The study of fig. 5: {one_study}",
        RATERS,
        _by_share(rows["share"].tolist()),
    )


def _of_the_largest_difference(cohorts: pd.DataFrame) -> Verdict:
    questions = ("Q4", "Q5", "Q6")
    by_question = [_worths(cohorts, OF_THE_STUDY, q) for q in questions]
    gaps = np.array([[abs(w["M3"] - w["M2"]) for w in worths] for worths in by_question])
    share = float((gaps.argmax(axis=0) == 1).mean())
    return Verdict(
        "Of Q4 to Q6, M2 and M3 differ the most in Q5 (3)",
        "Q5",
        f"in {percent(share)} of the studies; by chance 33 %. Mean difference "
        + ", ".join(f"{q} {gap:.2f}" for q, gap in zip(questions, gaps.mean(axis=1), strict=True)),
        RATERS,
        _by_share([share]),
    )


def _of_the_preferred(cohorts: pd.DataFrame) -> Verdict:
    shares = {}
    for question in ("Q1", "Q4", "Q5", "Q6"):
        worths = _worths(cohorts, OF_THE_STUDY, question)
        shares[question] = float(np.mean([max(w, key=lambda m: w[m]) == "M3" for w in worths]))
    return Verdict(
        "The asymmetric mode can be the preferred one (abstract)",
        "M3 the least frustrating",
        "M3 ranks first in " + ", ".join(f"{percent(share)} of {q}" for q, share in shares.items()),
        f"to rank first in Q5, the question it won, is taken as preferred. {RATERS}",
        _by_share([shares["Q5"]]),
    )


def _by_share(shares: list[float]) -> Judgement:
    """One share for each kind of raters; see `LIKELY`."""
    if any(share >= LIKELY for share in shares):
        return Judgement.UNDER_ASSUMPTION
    if any(share > UNLIKELY for share in shares):
        return Judgement.NOT_DETERMINABLE
    return Judgement.CONTRADICTED


def _worths(cohorts: pd.DataFrame, raters: str, question: str) -> list[dict[str, float]]:
    rows = cohorts[(cohorts["raters"] == raters) & (cohorts["question"] == question)]
    table = rows.pivot(index="cohort", columns="mode", values="worth")
    return [{str(mode): float(value) for mode, value in row.items()} for _, row in table.iterrows()]


def _written(worth: Worth) -> str:
    return " > ".join(sorted(worth, key=lambda mode: -worth[mode]))
