"""Do people who said different things about themselves prefer different modes?

Each group is fitted by itself, with the report's model and priors and nothing shared: no assumption that
both use the scale, the sides or each other's order alike, at the price of wide intervals. Nobody was
assigned to a group, so a difference goes with what people said and need not come from it.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.background_groups import Groups, groups_of
from analysis.diagnostics import hdi
from analysis.fit import fit
from analysis.results import HDI_PROBABILITY, Fit, FitSettings, QuestionFit
from data.responses import BackgroundTable, ResponseTable, rows_sha256
from data.study import BackgroundQuestion

Progress = Callable[[int, int, str], None]
FloatArray = NDArray[np.float64]
FEWEST_PEOPLE = 5
"""People in each group, below which a group is no more than its members. Untuned."""
_SECOND = 1
"""Added to the seed for the second group: the same draws in both would make differences of equal groups
vanish."""


@dataclass(frozen=True)
class GroupDifference:
    """One mode on one question in two groups of people.

    Attributes
    ----------
    background, wording : str
        The background question that parts the groups: its name, and as it was asked.
    first, second : str
        What the people of each group said.
    people_first, people_second : int
        With answers to this question.
    worth_first, worth_second : float
        Posterior mean worth in each group.
    difference_mean, difference_hdi_low, difference_hdi_high : float
        Worth in the second group less that in the first; 94 % HDI.
    p_positive : float
        Posterior probability that the worth is larger in the second group.
    """

    background: str
    wording: str
    first: str
    second: str
    question: str
    mode: str
    people_first: int
    people_second: int
    worth_first: float
    worth_second: float
    difference_mean: float
    difference_hdi_low: float
    difference_hdi_high: float
    p_positive: float

    @property
    def is_clear(self) -> bool:
        """Whether the interval leaves out 0."""
        return not self.difference_hdi_low <= 0 <= self.difference_hdi_high


@dataclass(frozen=True)
class Moderation:
    """All differences between groups, and why there are not more, as sentences."""

    differences: tuple[GroupDifference, ...] = ()
    reasons: tuple[str, ...] = ()


def moderation(
    table: ResponseTable, fitted: Fit, background: BackgroundTable | None, progress: Progress | None = None
) -> Moderation:
    """Every background question that parts people into two groups of at least five, on every ranked
    question."""
    refusal = _refusal(table, fitted, background)
    if refusal or background is None:
        return Moderation(reasons=(refusal,))
    rows = table.rows[~table.rows["check"].astype(bool)]
    people = [str(who) for who in rows["participant"].unique()]
    parted, reasons = [], []
    for asked in background.questions:
        said = {who: background.answers.get(who, {}).get(asked.name, "") for who in people}
        groups = groups_of(asked, {who: answer for who, answer in said.items() if answer})
        reason = _too_few(asked, groups, any(said.values()))
        if groups is None or reason:
            reasons.append(reason)
        else:
            parted.append(groups)
    ranked = tuple(q.question for q in fitted.questions if q.ranked)
    whole = replace(table, questions=ranked)
    tell = progress or (lambda done, total, now: None)
    tell(0, len(parted), "")
    found: list[GroupDifference] = []
    for done, groups in enumerate(parted, start=1):
        first, second = _fits(whole, groups, fitted.settings)
        for one, other in zip(first.questions, second.questions, strict=True):
            own = _differences(groups, one, other)
            if not own:
                reasons.append(f"{groups.question} on {one.question.name}: {_why(groups, one, other)}")
            found += own
        tell(done, len(parted), groups.question)
    return Moderation(tuple(found), tuple(reasons))


def _refusal(table: ResponseTable, fitted: Fit, background: BackgroundTable | None) -> str:
    if background is None:
        return "These answers came without what participants said about themselves."
    if not background.questions:
        return "The study asks participants nothing about themselves."
    if not background.answers:
        if table.is_simulated:
            return "Simulated participants are not asked about themselves, so there are no groups to compare."
        return "No participant answered a question about themselves."
    if not table.has_participants:
        return "The answers name no participants, so nobody's preference can be set beside what they said."
    if fitted.settings.pooled or fitted.settings.engine == "gibbs":
        return (
            "Participants are pooled in this report: groups of people are compared only where people may "
            "differ."
        )
    if not any(q.ranked for q in fitted.questions):
        return "No question is ranked, so there is no preference to compare."
    return ""


def _too_few(asked: BackgroundQuestion, groups: Groups | None, any_said: bool) -> str:
    if not any_said:
        return f"{asked.name}: nobody answered it."
    if asked.kind == "text":
        return f"{asked.name}: it is answered in words of one's own."
    if groups is None:
        return f"{asked.name}: all gave the same answer."
    if min(groups.sizes) < FEWEST_PEOPLE:
        small, large = sorted(groups.sizes)
        return f"{asked.name}: the groups have {small} and {large} people; each takes {FEWEST_PEOPLE}."
    return ""


def _fits(table: ResponseTable, groups: Groups, settings: FitSettings) -> tuple[Fit, Fit]:
    """The model of the report for either group alone, both at a time."""
    with ThreadPoolExecutor(2) as pool:
        first, second = pool.map(
            lambda is_second: fit(
                _group(table, groups, is_second), replace(settings, seed=settings.seed + _SECOND * is_second)
            ),
            (False, True),
        )
    return first, second


def _group(table: ResponseTable, groups: Groups, is_second: bool) -> ResponseTable:
    chosen = [who for who, second in groups.is_second.items() if second == is_second]
    rows = table.rows[table.rows["participant"].isin(chosen)].reset_index(drop=True)
    return replace(table, rows=rows, sha256=rows_sha256(rows))


def _why(groups: Groups, one: QuestionFit, other: QuestionFit) -> str:
    if min(one.n_participants, other.n_participants) < FEWEST_PEOPLE:
        return f"{one.n_participants} and {other.n_participants} people answered."
    who, found = (groups.first, one) if not one.ranked else (groups.second, other)
    return f"{who} by themselves are not ranked. {found.reason}"


def _differences(groups: Groups, one: QuestionFit, other: QuestionFit) -> list[GroupDifference]:
    small = min(one.n_participants, other.n_participants) < FEWEST_PEOPLE
    if small or not (one.ranked and other.ranked) or one.draws is None or other.draws is None:
        return []
    n_modes = len(one.modes)
    first, second = (draws.worth.reshape(-1, n_modes) for draws in (one.draws, other.draws))
    # The groups' posteriors are independent, so any pairing of their draws is a draw of both.
    lead = second - first
    low, high = hdi(lead, HDI_PROBABILITY)
    return [
        GroupDifference(
            groups.question,
            groups.wording,
            groups.first,
            groups.second,
            one.question.name,
            mode.mode,
            one.n_participants,
            other.n_participants,
            mode.worth_mean,
            other.modes[k].worth_mean,
            float(lead[:, k].mean()),
            float(low[k]),
            float(high[k]),
            float((lead[:, k] > 0).mean()),
        )
        for k, mode in enumerate(one.modes)
    ]
