"""What a reader must know of the parameters beside the abilities: a favoured side, and strained priors."""

from collections.abc import Sequence

from analysis.figures.labels import isolated
from analysis.model import (
    CUT_GAP_SCALE,
    LOG_NU_SD,
    SCALE_SD_SCALE,
    SIDE_DRIFT_SD,
    SIDE_EFFECT_SD,
    SIDE_SD_SCALE,
    SUBJECT_SD_SCALE,
)
from analysis.report.findings import listed
from analysis.results import Fit, QuestionFit

STRAINED = 2.0
"""A parameter whose posterior mean lies beyond so many scales of its prior is pointed out: a normal has 4.6 %
beyond them, a half-normal the same."""
_MOST_NAMED = 6
_SCALES = {
    "side_effect": ("side effect", SIDE_EFFECT_SD),
    "log_nu": ("log nu, for the share of ties,", LOG_NU_SD),
    "subject_sd": ("spread between people", SUBJECT_SD_SCALE),
    "side_drift": ("drift of the side effect", SIDE_DRIFT_SD),
    "side_sd": ("spread of side effects between people", SIDE_SD_SCALE),
    "scale_sd": ("spread of widths of the scale between people", SCALE_SD_SCALE),
}


def about_priors(fit: Fit) -> list[str]:
    """Where the answers say what the priors hardly allow, so that the priors pull; a sentence a parameter."""
    sentences = []
    names = dict.fromkeys(p.name for q in fit.questions for p in q.parameters)
    for name in names:
        strained = [(abs(value), value, q) for q in fit.questions if (value := _beyond(q, name)) is not None]
        if not strained:
            continue
        _, value, question = max(strained, key=lambda one: one[0])
        what, scale = _SCALES.get(name, (f"gap below cut-point {name.removeprefix('cut_')}", CUT_GAP_SCALE))
        more = f" and in {len(strained) - 1} more" if len(strained) > 1 else ""
        unit = " on the log scale" if name == "scale_sd" else " logits"
        sentences.append(
            f"In {isolated(question.question.name)}{more} the {what} lies beyond what its prior expects "
            f"({value:.1f}{unit}; the prior gives less than 5 % to more than {STRAINED * scale:g}). So the "
            "prior draws it towards 0, and what it cannot take up is taken up by the worths."
        )
    return sentences


def is_strained(question: QuestionFit, name: str) -> bool:
    """Whether a parameter lies beyond what its prior expects."""
    return _beyond(question, name) is not None


def _beyond(question: QuestionFit, name: str) -> float | None:
    """Posterior mean of what the prior is about, if it lies beyond so many scales of the prior."""
    means = {p.name: p.mean for p in question.parameters}
    if name not in means or not (name in _SCALES or name.startswith("cut_")):
        return None
    value, scale = means[name], _SCALES.get(name, ("", CUT_GAP_SCALE))[1]
    if name.startswith("cut_"):
        value -= means.get(f"cut_{int(name.removeprefix('cut_')) - 1}", 0.0)
    return value if abs(value) > STRAINED * scale else None


def about_sides(fit: Fit) -> list[str]:
    """Where one side was favoured, and what the model does about it."""
    favoured = [
        (question, p.mean)
        for question in fit.questions
        for p in question.parameters
        if p.name == "side_effect" and (p.hdi_low > 0 or p.hdi_high < 0)
    ]
    apart = [one for one in favoured if one[0].is_side_told_apart]
    ordinary = [one for one in apart if not is_strained(one[0], "side_effect")]
    sentences = []
    if ordinary:
        sentences.append(
            f"{_named(ordinary)}: whatever was shown as {_side(ordinary)} was favoured. The model has a side "
            "effect for that, the same for every person and every pair; the worths are those without it if "
            "that is so."
        )
    beyond = [one for one in apart if is_strained(one[0], "side_effect")]
    if beyond:
        sentences.append(
            f"{_named(beyond)}: whatever was shown as {_side(beyond)} was favoured by more than the model's "
            "side effect can take up. These worths still hold some of that, and are too close to each other "
            "or too far apart, as the modes stood as A and B. Look at who answered so, and whether the sides "
            "in the data are those that people saw."
        )
    confounded = [one for one in favoured if not one[0].is_side_told_apart]
    if confounded:
        sentences.append(
            f"{_named(confounded)}: whatever stood as {_side(confounded)} was chosen more often, but no pair "
            "was shown with its sides exchanged: how much of that is the side and how much the modes rests "
            "on the priors."
        )
    return sentences


_Favoured = Sequence[tuple[QuestionFit, float]]


def _named(favoured: _Favoured) -> str:
    names = [isolated(question.question.name) for question, _ in favoured]
    more = f" and {len(names) - _MOST_NAMED} more" if len(names) > _MOST_NAMED else ""
    return ", ".join(names[:_MOST_NAMED]) + more if more else listed(names)


def _side(favoured: _Favoured) -> str:
    means = [mean for _, mean in favoured]
    return "A" if min(means) > 0 else "B" if max(means) < 0 else "one side"
