"""Planning a study's size: a plan from what a researcher writes, and what to expect of the planned number."""

from dataclasses import dataclass, replace

from analysis.power.glance import glance
from analysis.power.plan import Plan, check_plan, mode_pairs
from analysis.power.scenario import (
    CUTS,
    EQUALITY_CONFIDENCE,
    SIDE_EFFECT,
    SUBJECT_SD,
    Conclusion,
    Kind,
    Scenario,
    cuts_for_ties,
)
from data.errors import InputError, one_of
from data.study import Study

_MULTIPLES = (1, 2, 3, 4, 6)
"""Sizes that are tried where none are given, in planned numbers."""
_OF_ALL_MODES: dict[str, Kind] = {"best": "best", "order": "order", "equal": "equal"}
"""Conclusions that name no modes, as they are written."""
_ABOUT_ENOUGH = (0.5, 0.75, 1.0, 1.5)
"""Sizes for equality, of which the planned numbers mostly show nothing: multiples of what should do."""


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
        ``best``, ``order``, two modes as ``M1:M3``, ``equal``, or two modes as ``M1=M3``.
    confidence : float or None
        None is 0.95, or for equality what a report calls it from.
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
    confidence: float | None = None
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
    conclusion = conclusion_of(study, wish.conclusion, wish.confidence)
    last = 1.0 if conclusion.is_equality else 2.0
    scenario = Scenario(
        worth=numbers("worth", wish.worth) or (1.0,) * (len(study.modes) - 1) + (last,),
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
        conclusion=conclusion,
        wanted=wish.wanted,
        replicates=wish.replicates,
        seed=wish.seed,
    )
    check_plan(plan)
    plan = plan if wish.ties is None else _with_ties(plan, wish.ties)
    return _about_enough(plan) if conclusion.is_equality and not wish.participants else plan


def _about_enough(plan: Plan) -> Plan:
    """The same with numbers of participants about the one that a quick estimate calls enough."""
    enough = glance(plan, max(plan.repetitions)).enough
    if enough is None:
        return plan
    sizes = tuple(max(1, round(share * enough)) for share in _ABOUT_ENOUGH)
    found = replace(plan, participants=tuple(dict.fromkeys(sizes)))
    check_plan(found)
    return found


def _with_ties(plan: Plan, share: float) -> Plan:
    cuts = cuts_for_ties(mode_pairs(plan.study), plan.scenario, share)
    return replace(plan, scenario=replace(plan.scenario, cuts=cuts))


def conclusion_of(study: Study, text: str, confidence: float | None = None) -> Conclusion:
    """What a study shall conclude, from ``best``, ``order``, ``M1:M3``, ``equal`` or ``M1=M3``."""
    is_equality = text == "equal" or ("=" in text and ":" not in text)
    if confidence is None:
        confidence = EQUALITY_CONFIDENCE if is_equality else Conclusion.confidence
    if text in _OF_ALL_MODES:
        return Conclusion(_OF_ALL_MODES[text], confidence)
    names = text.split("=" if is_equality else ":")
    if len(names) != 2:
        pair = study.mode_names[:2]
        raise one_of(
            "conclusion",
            text,
            ("best", "order", "equal", f"two modes such as {':'.join(pair)} or {'='.join(pair)}"),
        )
    for name in names:
        if name not in study.mode_names:
            raise one_of("conclusion: mode", name, study.mode_names)
    return Conclusion(
        "equal pair" if is_equality else "pair",
        confidence,
        (study.mode_names.index(names[0]), study.mode_names.index(names[1])),
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
