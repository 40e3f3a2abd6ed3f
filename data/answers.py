"""The answers a participant can give to a question, from A much to B much."""

from typing import Literal, get_args

Answer = Literal["A>>>>B", "A>>>B", "A>>B", "A>B", "A=B", "B>A", "B>>A", "B>>>A", "B>>>>A"]
ANSWERS: tuple[Answer, ...] = get_args(Answer)
"""The answers of the widest scale. A longer arrow is a stronger preference."""

FEWEST_LEVELS, MOST_LEVELS = 2, len(ANSWERS)


def _scale(levels: int) -> tuple[Answer, ...]:
    """The middle of the widest scale; an even number of levels has no ``A=B``."""
    middle, arrows = len(ANSWERS) // 2, levels // 2
    tie = ANSWERS[middle : middle + levels % 2]
    return ANSWERS[middle - arrows : middle] + tie + ANSWERS[middle + 1 : middle + 1 + arrows]


SCALES: dict[int, tuple[Answer, ...]] = {
    levels: _scale(levels) for levels in range(FEWEST_LEVELS, MOST_LEVELS + 1)
}
"""The answers of a scale by its number of levels, in the order A much .. B much."""

MIRRORED: dict[Answer, Answer] = dict(zip(ANSWERS, reversed(ANSWERS), strict=True))
"""The same opinion with the sides A and B exchanged."""


def inferred_levels(answers: set[str]) -> int:
    """Levels of a scale known only by the answers given on it.

    A longest arrow of ``k`` signs means ``2 k + 1`` levels, or 2 where no arrow is longer than one sign and
    no answer is a tie. Scales of 4, 6 and 8 levels cannot be inferred.
    """
    longest = max((answer.count(">") for answer in answers), default=0)
    return 2 if longest == 1 and "A=B" not in answers else max(3, 2 * longest + 1)
