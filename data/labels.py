"""Names in files as people see them: which look alike, and how to print one so that it does not.

``M1`` and ``M1`` with a no-break space behind it are two names for a computer and one for a reader. So are
``ä`` as one character and as ``a`` with a mark, and mostly ``m1`` and ``M1``.
"""

import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

_LONGEST = 60
"""Characters of a name that an error on one line quotes."""
_NAMED = 6
"""Names that a sentence lists before it counts the rest."""


@dataclass(frozen=True)
class LookAlike:
    """Two spellings that a reader takes for one name."""

    earlier: str
    later: str


def without_the_invisible(text: str) -> str:
    """A name with composed characters, no invisible characters, and single blanks between words alone.

    References
    ----------
    Unicode Standard Annex 15, normalisation form C; general category Cf ("format") has no shape of its own.
    """
    composed = unicodedata.normalize("NFC", text)
    seen = "".join(c for c in composed if unicodedata.category(c) != "Cf")
    return " ".join(seen.split())


def folded(text: str) -> str:
    """A name as `without_the_invisible` gives it, in small letters: equal where two names look alike."""
    return unicodedata.normalize("NFC", without_the_invisible(text).casefold())


def look_alikes(names: Iterable[str], *, case_counts: bool = False) -> tuple[LookAlike, ...]:
    """Names that a reader cannot tell from an earlier one.

    Parameters
    ----------
    names : iterable of str
        Distinct names in order of appearance.
    case_counts : bool
        True takes ``m1`` and ``M1`` as names that differ visibly.
    """
    fold = without_the_invisible if case_counts else folded
    earliest: dict[str, str] = {}
    pairs = []
    for name in names:
        earlier = earliest.setdefault(fold(name), name)
        if earlier != name:
            pairs.append(LookAlike(earlier, name))
    return tuple(pairs)


def as_known(names: Iterable[str], valid: Iterable[str]) -> Mapping[str, str]:
    """By name that is not valid but looks like one that is: the valid name."""
    by_fold = {folded(name): name for name in valid}
    return {
        name: by_fold[folded(name)]
        for name in names
        if name not in by_fold.values() and folded(name) in by_fold
    }


def quoted(text: str) -> str:
    r"""A name in quotes, on one line and not too long, what cannot be seen in it as escapes.

    Blanks other than the plain one and characters without a shape are escaped (``\xa0``, ``\u200b``), and
    marks that stand apart from a letter that they could be one character with (``a\u0308``).
    """
    short = text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
    quote = repr(short)
    if unicodedata.is_normalized("NFC", short):
        return quote
    return "".join(c if not unicodedata.combining(c) else c.encode("unicode_escape").decode() for c in quote)


def plain_or_quoted(text: str) -> str:
    """A name as it is where all of it can be seen, else in quotes."""
    is_plain = text == without_the_invisible(text) and text.isprintable() and text != ""
    return text if is_plain and len(text) <= _LONGEST else quoted(text)


def listed_names(names: Sequence[str]) -> str:
    """Names in quotes, of many the first ones and how many there are beside them."""
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return ", ".join(map(quoted, names[:_NAMED])) + more
