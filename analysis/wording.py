"""What the model's parameters are called: in a sentence, in a table and in a formula."""

from dataclasses import dataclass

from analysis.model import LEARNING

_ORDINALS = ("first", "second", "third", "fourth")
_SUBSCRIPTS = "₁₂₃₄"


@dataclass(frozen=True)
class Wording:
    """Names of one parameter.

    Attributes
    ----------
    sentence : str
        With its article: "the side effect".
    table : str
        "side effect".
    symbol : str
        What the formulas of the methods call it.
    """

    sentence: str
    table: str
    symbol: str


_WORDINGS = {
    "ability": Wording("the ability", "ability", "a"),
    "side_effect": Wording("the side effect", "side effect", "b"),
    "log_nu": Wording("the parameter of the ties", "log nu", "log ν"),
    "lapse": Wording("the share of careless answers", "careless answers", "λ"),
    "side_drift": Wording("the drift of the side effect", "side drift", "d"),
    "learning": Wording("the learning", "learning", "g"),
    "subject_sd": Wording("the spread between participants", "subject sd", "τ"),
    "side_sd": Wording("the spread of side effects between participants", "side sd", "σ"),
    "scale_sd": Wording("the spread of widths of the scale between participants", "scale sd", "ω"),
    "z": Wording("the deviations", "z", "z"),
    "s": Wording("a participant's own side", "s", "s"),
    "w": Wording("a participant's own width", "w", "v"),
    "worth": Wording("the worth", "worth", "w"),
    "theta": Wording("the ties", "theta", "θ"),
}


def wording(name: str) -> Wording:
    """What a parameter of the fit is called; ``name`` is that of its draws or of its prior."""
    if name.startswith("cut_"):
        k = int(name.removeprefix("cut_"))
        return Wording(f"the {_ORDINALS[k - 1]} cut-point", f"cut-point {k}", f"c{_SUBSCRIPTS[k - 1]}")
    if name.startswith(LEARNING):
        mode = name.removeprefix(LEARNING)
        return Wording(f"the learning of {mode}", f"learning of {mode}", "g")
    return _WORDINGS[name]
