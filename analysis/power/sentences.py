"""What a power analysis says, in plain sentences: how many participants are enough, and how sure that is."""

from analysis.power.glance import glance
from analysis.power.outcome import Power


def sentences(result: Power) -> tuple[str, ...]:
    """The answer, one sentence for each number of repetitions."""
    several = len(result.repetitions) > 1
    return tuple(
        f"{showings(r)}: {_answer(result, r)}" if several else _answer(result, r) for r in result.repetitions
    )


def showings(repetitions: int) -> str:
    """How often a person sees each pair."""
    return "Each pair " + {1: "once", 2: "twice"}.get(repetitions, f"{repetitions} times")


def _answer(result: Power, repetitions: int) -> str:
    points, curve = result.of(repetitions), result.curve(repetitions)
    wanted = f"{100 * result.plan.wanted:.0f} %"
    first, last = points[0], points[-1]
    if not result.plan.conclusion.can_be_right(result.plan.scenario):
        drawn = _share(last.wrong_share, last.wrong_low, last.wrong_high)
        why = (
            "Modes are planted that are not equal in practice"
            if result.plan.conclusion.is_equality
            else "None is planted as better"
        )
        return (
            f"{why}, so every conclusion is wrong; {drawn} of studies with "
            f"{last.participants} participants draw one."
        )
    if curve is None:
        reached = _share(last.right_share, last.right_low, last.right_high)
        return f"{reached} of studies with {last.participants} participants come to the right conclusion."
    enough = curve.enough(result.plan.wanted)
    if enough is None:
        quick = glance(result.plan, repetitions).enough
        about = f"more participants (a quick estimate says about {quick})" if quick else "more participants"
        return (
            f"The share of right conclusions does not rise clearly enough to tell how many are needed for "
            f"{wanted}: try {about}, or simulate more studies."
        )
    found = f"{enough.participants} {enough.interval}"
    if enough.participants > last.participants:
        return (
            f"{last.participants} participants are too few for {wanted} right conclusions; if the curve goes "
            f"on as it does, about {found} are enough. Try numbers about that."
        )
    if enough.participants < first.participants:
        return (
            f"{first.participants} participants are more than enough for {wanted} right conclusions; "
            f"about {found} would do, if the curve goes on downwards. Try numbers about that."
        )
    return f"{found} participants are enough for {wanted} right conclusions."


def _share(share: float, low: float, high: float) -> str:
    return f"{100 * share:.0f} % [{100 * low:.0f}, {100 * high:.0f}]"
