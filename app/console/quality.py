"""How good the data are, at a glance: people's consistency, the connection, the balance of pairs."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import pandas as pd

from app.console.style import Mark, Sign
from data.records import Trial

AGREEMENT_FROM = 0.6
CHECKS_FROM = 0.6
SKIPPED_UP_TO = 0.01
SLOW_FROM_MS = 50.0
SLOW_UP_TO = 0.05
UNEVEN_FROM = 0.15
"""From where on a sign warns: shares, and a 95th percentile of the delay from hand to picture. Untuned."""

_TOWARDS_A = {"A>>B": 1, "A>B": 1, "A=B": 0, "B>A": -1, "B>>A": -1}


@dataclass(frozen=True)
class Quality:
    """One line: what is judged, and how it looks."""

    what: str
    mark: Mark


def quality(
    answers: pd.DataFrame | None, trials: Iterable[Trial], labels: Mapping[str, str]
) -> tuple[Quality, ...]:
    """What can be said so far; nothing of what was not measured.

    Parameters
    ----------
    answers : DataFrame or None
        Rows of a ``data.responses.ResponseTable``, attention checks included.
    trials : iterable of Trial
    labels : mapping
        What the modes are called now.
    """
    trials = tuple(trials)
    found = [*_of_connection(trials)]
    if answers is not None:
        found = [*_agreement(answers), *_checks(answers), *found, *_balance(answers, labels)]
    return tuple(found)


def repeat_agreement(answers: pd.DataFrame) -> tuple[int, int]:
    """How many answers to a pair that was shown again point the same way as the time before, and of how many.

    Sides are taken out: preferring X as A and again as B agrees.
    """
    rows = answers[~answers["check"]]
    same = total = 0
    first = rows[["mode_a", "mode_b"]].min(axis=1)
    second = rows[["mode_a", "mode_b"]].max(axis=1)
    for _, asked in rows.groupby(["participant", "question", first, second], sort=False):
        way_of = {min(asked["mode_a"].iloc[0], asked["mode_b"].iloc[0]): 1}
        ways = [
            _TOWARDS_A[answer] * way_of.get(a, -1)
            for a, answer in zip(asked["mode_a"], asked["response"], strict=True)
        ]
        total += len(ways) - 1
        same += sum(one == next_one for one, next_one in pairwise(ways))
    return same, total


def _agreement(answers: pd.DataFrame) -> list[Quality]:
    same, total = repeat_agreement(answers)
    return [_share("Repeats answered alike", same, total, AGREEMENT_FROM)] if total else []


def _checks(answers: pd.DataFrame) -> list[Quality]:
    """Hidden checks show one mode twice: whoever tells A from B there reports what is not."""
    checked = answers[answers["check"]]
    if checked.empty:
        return []
    return [
        _share("A/A checks felt alike", int((checked["response"] == "A=B").sum()), len(checked), CHECKS_FROM)
    ]


def _share(what: str, good: int, total: int, enough: float) -> Quality:
    sign: Sign = "good" if good >= enough * total else "warn"
    return Quality(what, Mark(sign, f"{round(100 * good / total)} % of {total}"))


def _of_connection(trials: tuple[Trial, ...]) -> list[Quality]:
    found = []
    ticks = sum(trial.metrics.get("ticks", 0.0) for trial in trials)
    if ticks:
        skipped = sum(trial.metrics.get("skipped_ticks", 0.0) for trial in trials) / ticks
        sign: Sign = "good" if skipped <= SKIPPED_UP_TO else "warn"
        found.append(Quality("Skipped control ticks", Mark(sign, f"{100 * skipped:.1f} %")))
    delays = [trial.metrics["latency_p95_ms"] for trial in trials if "latency_p95_ms" in trial.metrics]
    if delays:
        slow = sum(delay > SLOW_FROM_MS for delay in delays)
        sign = "good" if slow <= SLOW_UP_TO * len(delays) else "warn"
        found.append(Quality("Trials on a slow connection", Mark(sign, f"{slow} of {len(delays)}")))
    return found


def _balance(answers: pd.DataFrame, labels: Mapping[str, str]) -> list[Quality]:
    rows = answers[~answers["check"]].drop_duplicates("comparison")
    counted = Counter(frozenset(pair) for pair in zip(rows["mode_a"], rows["mode_b"], strict=True))
    if len(counted) < 2:
        return []
    pair, fewest = min(counted.items(), key=lambda item: item[1])
    most = max(counted.values())
    if fewest >= (1 - UNEVEN_FROM) * most:
        return [
            Quality(
                "Pairs compared",
                Mark("good", f"{fewest} to {most} times" if fewest < most else f"{most} times each"),
            )
        ]
    names = " and ".join(sorted(labels[mode] for mode in pair))
    return [Quality(f"Pair {names}", Mark("warn", f"{fewest}, others up to {most}"))]
