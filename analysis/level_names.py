"""What the answers of a scale are called in tables and figures."""

from data.answers import SCALES

SAME = "about the same"
_WORDS = ("more", "much more")


def strength_names(most: int) -> tuple[str, ...]:
    """Names of the strengths of preference from the weakest to the strongest, of so many.

    Words reach for two; the answers' own arrows name more.
    """
    return _WORDS[:most] if most <= len(_WORDS) else tuple(">" * (k + 1) for k in range(most))


def level_names(levels: int) -> tuple[str, ...]:
    """Names of the answers from A much to B much."""
    half = levels // 2
    middle = (SAME,) * (levels % 2)
    if half > len(_WORDS):
        return (*SCALES[levels][:half], *middle, *SCALES[levels][-half:])
    words = [name.removesuffix("more") for name in reversed(strength_names(half))]
    return (*(f"{word}A" for word in words), *middle, *(f"{word}B" for word in reversed(words)))
