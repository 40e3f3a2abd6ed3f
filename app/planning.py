"""Planning a study's size: a plan from what a researcher writes, and what to expect of the planned number."""

from dataclasses import dataclass, replace

from analysis.power.glance import glance
from analysis.power.plan import Plan, check_plan, mode_pairs
from analysis.power.scenario import CUTS, SIDE_EFFECT, SUBJECT_SD, Conclusion, Scenario, cuts_for_ties
from data.errors import InputError, one_of
from data.study import Study

_MULTIPLES = (1, 2, 3, 4, 6)
"""Sizes that are tried where none are given, in planned numbers."""


@dataclass(frozen=True)
class Wish:
    """What a researcher writes about a study to be planned; empty texts and None are the study's defaults.

    Attributes
    ----------
    worth, cuts, participants, repetitions : str
        Numbers with commas between them.
    ties : float or None
        Share of answers "about the same", instead of cut-points.
    conclusion : str
        ``best``, ``order``, or two modes as ``M1:M3``.
    """

    worth: str = ""
    participants: str = ""
    repetitions: str = ""
    levels: int | None = None
    cuts: str = ""
    ties: float | None = None
    subject_sd: float = SUBJECT_SD
    side_effect: float = SIDE_EFFECT
    conclusion: str = "best"
    confidence: float = Conclusion.confidence
    wanted: float = Plan.wanted
    replicates: int = Plan.replicates
    seed: int = Plan.seed


def plan_of(study: Study, wish: Wish) -> Plan:
    """The plan that a wish stands for.

    Raises
    ------
    InputError
        One line: which value, and what is valid.
    """
    levels = wish.levels or min(question.levels for question in study.questions)
    if wish.cuts and wish.ties is not None:
        raise InputError("ties, cuts: give one of them; the share of ties decides the cut-points")
    scenario = Scenario(
        worth=numbers("worth", wish.worth) or (1.0,) * (len(study.modes) - 1) + (2.0,),
        levels=levels,
        cuts=numbers("cuts", wish.cuts) or CUTS.get(levels, ()),
        subject_sd=wish.subject_sd,
        side_effect=wish.side_effect,
    )
    plan = Plan(
        study=study,
        scenario=scenario,
        participants=whole_numbers("participants", wish.participants)
        or tuple(k * study.protocol.planned_participants for k in _MULTIPLES),
        repetitions=whole_numbers("repetitions", wish.repetitions) or (study.protocol.repetitions,),
        conclusion=conclusion_of(study, wish.conclusion, wish.confidence),
        wanted=wish.wanted,
        replicates=wish.replicates,
        seed=wish.seed,
    )
    check_plan(plan)
    return plan if wish.ties is None else _with_ties(plan, wish.ties)


def _with_ties(plan: Plan, share: float) -> Plan:
    cuts = cuts_for_ties(mode_pairs(plan.study), plan.scenario, share)
    return replace(plan, scenario=replace(plan.scenario, cuts=cuts))


def conclusion_of(study: Study, text: str, confidence: float) -> Conclusion:
    """What a study shall conclude, from ``best``, ``order`` or two modes as ``M1:M3``."""
    if text == "best":
        return Conclusion("best", confidence)
    if text == "order":
        return Conclusion("order", confidence)
    names = text.split(":")
    if len(names) != 2:
        raise one_of(
            "conclusion", text, ("best", "order", "two modes such as " + ":".join(study.mode_names[:2]))
        )
    for name in names:
        if name not in study.mode_names:
            raise one_of("conclusion: mode", name, study.mode_names)
    return Conclusion(
        "pair", confidence, (study.mode_names.index(names[0]), study.mode_names.index(names[1]))
    )


def numbers(what: str, text: str) -> tuple[float, ...]:
    """Numbers written with commas between them."""
    try:
        return tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise InputError(f"{what}: {text!r} is no list of numbers, such as 1, 1, 2") from None


def whole_numbers(what: str, text: str) -> tuple[int, ...]:
    """Whole numbers written with commas between them."""
    try:
        return tuple(int(part) for part in text.split(",") if part.strip())
    except ValueError:
        raise InputError(f"{what}: {text!r} is no list of whole numbers, such as 7, 20, 45") from None


def expectation(study: Study) -> str:
    """What the planned number of participants is good for, in a sentence with its assumption."""
    plan = plan_of(study, Wish(participants="1"))
    planned, expected = study.protocol.planned_participants, glance(plan)
    people = "1 participant" if planned == 1 else f"{planned} participants"
    better = "the other" if len(study.modes) == 2 else "each of the others"
    enough, wanted = expected.enough, percent(plan.wanted)
    needed = (
        f"for {wanted} it takes about {enough}"
        if enough is not None
        else f"hardly any number reaches {wanted}"
    )
    return (
        f"With the planned {people}, {answers_each(plan, study.protocol.repetitions)}, about "
        f"{percent(expected.share(planned))} of studies would find the best mode, were it twice as good as "
        f"{better}; {needed} (if people differ with sd {plan.scenario.subject_sd:g} logits)."
    )


def answers_each(plan: Plan, repetitions: int) -> str:
    """How many answers to a question come from each participant."""
    number = plan.answers_each(repetitions)
    return f"{number} answer{'' if number == 1 else 's'} each to a question"


def percent(share: float) -> str:
    """A share in a sentence; never a bare 0 or 100."""
    if share < 0.005:
        return "under 1 %"
    return "over 99 %" if share > 0.995 else f"{100 * share:.0f} %"
