"""Two groups of participants by what they said about themselves, formed without a look at their
preferences."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from data.study import BackgroundQuestion


@dataclass(frozen=True)
class Groups:
    """Those who gave one of the first answers, and those who gave one of the others.

    Attributes
    ----------
    question, wording : str
        Of the background question.
    first, second : str
        What the people of each group said, in words.
    is_second : mapping of str to bool
        By participant; whoever did not answer is in neither.
    """

    question: str
    wording: str
    first: str
    second: str
    is_second: Mapping[str, bool]

    @property
    def sizes(self) -> tuple[int, int]:
        """People in the first group and in the second."""
        second = sum(self.is_second.values())
        return len(self.is_second) - second, second


def groups_of(question: BackgroundQuestion, said: Mapping[str, str]) -> Groups | None:
    """Cut the scale of a background question where the smaller group is largest.

    The order is that of the choices in the study file, or of the numbers.

    Parameters
    ----------
    said : mapping of str to str
        By participant.

    Returns
    -------
    Groups or None
        None for a question that is answered in words, and where all gave the same answer.
    """
    if question.kind == "text":
        return None
    if question.kind == "number":
        levels: dict[str, float] = {answer: float(answer) for answer in said.values()}
    else:
        levels = {choice: float(k) for k, choice in enumerate(question.choices)}
    place = {who: levels[answer] for who, answer in said.items() if answer in levels}
    cuts = sorted(set(place.values()))[1:]
    if not cuts:
        return None
    cut = max(cuts, key=lambda c: min(_below(place.values(), c), len(place) - _below(place.values(), c)))
    if question.kind == "number":
        first, second = f"below {cut:g}", f"{cut:g} or more"
    else:
        choices = question.choices
        first, second = _either(choices[: int(cut)]), _either(choices[int(cut) :])
    return Groups(question.name, question.wording, first, second, {who: x >= cut for who, x in place.items()})


def _below(values: Iterable[float], cut: float) -> int:
    return sum(value < cut for value in values)


def _either(choices: tuple[str, ...]) -> str:
    """``“a”, “b” or “c”``."""
    quoted = [f"“{choice}”" for choice in choices]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
