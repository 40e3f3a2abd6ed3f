"""Schedule and people of a study that was run, as far as quick estimates of what it can show need them."""

from dataclasses import dataclass

from analysis.power.scenario import CUTS, Scenario
from analysis.results import Fit, QuestionFit

MOST_PAIRS = 200
"""Pairs up to which a person's information is worked out: all of 20 modes. Its cost grows with their cube."""


@dataclass(frozen=True)
class ObservedDesign:
    """What is taken to be known of people who prefer no mode, and of how they were asked.

    Attributes
    ----------
    pairs : tuple of (int, int)
        Pairs of modes that were compared, by their places.
    repetitions : int
        How often a person is taken to have seen each.
    scenario : Scenario
        Equal worths, with the cut-points, the spread between people and the side effect of the study.
    people : float
        How many people with all these answers the study's answers are worth.
    is_pooled : bool
        True if the estimate in question leaves out that people differ, as a quick one does.
    """

    pairs: tuple[tuple[int, int], ...]
    repetitions: int
    scenario: Scenario
    people: float
    is_pooled: bool = False


def observed_design(fit: Fit) -> ObservedDesign | None:
    """The design of the ranked question with the most answers; None without one, or with too many pairs."""
    ranked = [q for q in fit.questions if q.ranked]
    if not ranked:
        return None
    question = max(ranked, key=lambda q: q.n)
    place = {mode: k for k, mode in enumerate(question.mode_names)}
    pairs = tuple((place[p.mode_i], place[p.mode_j]) for p in question.pairs if p.n)
    if not 0 < len(pairs) <= MOST_PAIRS:
        return None
    each = question.n / max(question.n_participants, 1)
    # Who names no people has each answer from somebody else.
    repetitions = max(1, round(each / len(pairs))) if question.n_participants else 1
    return ObservedDesign(
        pairs,
        repetitions,
        _scenario(question, len(question.mode_names)),
        question.n / (len(pairs) * repetitions),
        question.n_participants > 0 and not question.hierarchical,
    )


def _scenario(question: QuestionFit, n_modes: int) -> Scenario:
    """People as the fit finds them, but for their preferences."""
    means = {p.name: p.mean for p in question.parameters}
    cuts = tuple(means[name] for name in sorted(means) if name.startswith("cut_"))
    if len(cuts) != (question.question.levels - 1) // 2:
        cuts = CUTS[question.question.levels]
    return Scenario(
        worth=(1.0,) * n_modes,
        levels=question.question.levels,
        cuts=cuts,
        subject_sd=means.get("subject_sd", 0.0),
        side_effect=means.get("side_effect", 0.0),
    )
