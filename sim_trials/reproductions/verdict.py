"""What came of a published claim when its experiment was run again."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import pandas as pd

Progress = Callable[[int, int, str], None]
"""Told how much of an experiment is done, of how much, and a word on what is under way."""


class Judgement(StrEnum):
    """How a claim fared."""

    REPRODUCED = "reproduced"
    UNDER_ASSUMPTION = "reproduced under assumption"
    CONTRADICTED = "contradicted"
    NOT_DETERMINABLE = "not determinable"


@dataclass(frozen=True)
class Verdict:
    """One checkable claim of a document, what it says, what came out here, and the judgement.

    Attributes
    ----------
    claim : str
        In this project's words, with the equation, table or section it stands in.
    published, ours : str
        The document's figure or statement, and the one found here.
    assumption : str
        What had to be assumed because the document leaves it open; empty if nothing.
    """

    claim: str
    published: str
    ours: str
    assumption: str
    judgement: Judgement


@dataclass(frozen=True)
class Reproduction:
    """A document's experiment, run again: its tables by name and a verdict per claim.

    Attributes
    ----------
    simulated : str
        Who was simulated, for every figure and page; empty if the document's experiment has no people.
    """

    name: str
    source: str
    tables: dict[str, pd.DataFrame]
    verdicts: tuple[Verdict, ...]
    simulated: str = ""


def judge(holds: bool | Sequence[bool], assumption: str = "") -> Judgement:
    """A claim that was checked under every reading of what the document leaves open.

    Parameters
    ----------
    holds : bool or sequence of bool
        Whether the claim holds, under each reading. All: reproduced, unless ``assumption`` names something
        that no reading varied. Some: reproduced under assumption. None: contradicted.
    """
    found = [holds] if isinstance(holds, bool) else [bool(h) for h in holds]
    if not found:
        return Judgement.NOT_DETERMINABLE
    if not any(found):
        return Judgement.CONTRADICTED
    return Judgement.REPRODUCED if all(found) and not assumption else Judgement.UNDER_ASSUMPTION


def percent(share: float) -> str:
    """A share as it is written in verdicts and figures: ``39 %``."""
    return f"{100.0 * share:.0f} %"


def verdict_table(verdicts: Sequence[Verdict]) -> pd.DataFrame:
    """The verdicts as ``claim, published, ours, assumption, verdict``, one row each."""
    return pd.DataFrame(
        [(v.claim, v.published, v.ours, v.assumption, v.judgement.value) for v in verdicts],
        columns=["claim", "published", "ours", "assumption", "verdict"],
    )
