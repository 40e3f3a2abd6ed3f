"""The answers a participant can give to a question, from A much to B much."""

from typing import Literal, get_args

Answer = Literal["A>>B", "A>B", "A=B", "B>A", "B>>A"]
ANSWERS: tuple[Answer, ...] = get_args(Answer)

SCALES: dict[int, tuple[Answer, ...]] = {
    2: ("A>B", "B>A"),
    3: ("A>B", "A=B", "B>A"),
    5: ANSWERS,
}
"""The answers of a scale by its number of levels, in the order A much .. B much."""

MIRRORED: dict[Answer, Answer] = dict(zip(ANSWERS, reversed(ANSWERS), strict=True))
"""The same opinion with the sides A and B exchanged."""


def inferred_levels(answers: set[str]) -> int:
    """Levels of a scale known only by the answers given on it: any ``>>`` 5, any tie 3, else 2."""
    if answers & {"A>>B", "B>>A"}:
        return 5
    return 3 if "A=B" in answers else 2
