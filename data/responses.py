"""Responses in the shape the analysis takes, whether they come from a store or from a CSV."""

from dataclasses import dataclass

import pandas as pd


@dataclass(frozen=True)
class QuestionScale:
    """What the analysis must know of a question.

    Attributes
    ----------
    levels : int
        2, 3 or 5.
    levels_inferred : bool
        True if the levels were guessed from the answers, since no study was given.
    """

    name: str
    short: str
    wording: str
    levels: int
    polarity: str = "neutral"
    levels_inferred: bool = False


@dataclass(frozen=True)
class ResponseTable:
    """Validated responses.

    Attributes
    ----------
    rows : DataFrame
        One row a response or a group of equal ones, with the columns ``participant`` (str),
        ``question`` (str), ``mode_a``, ``mode_b`` (str; what was shown as A and B), ``response``
        (str), ``count`` (int64), ``comparison`` (str), ``repetition`` (int64), ``source`` (str) and
        ``check`` (bool); further columns of a CSV are kept behind them. Missing optional columns
        are filled: participant and comparison "", count 1, repetition 0, source "human".
    modes : tuple of str
        All modes in the order of the study, else in order of first appearance. A mode of the
        study that no row names is listed too.
    questions : tuple of QuestionScale
    has_participants : bool
        False if the model must be pooled.
    is_simulated : bool
        True if any row's source is ``simulated``.
    sha256 : str
        Hash of the data as read.
    title : str
        What the report calls the study.
    """

    rows: pd.DataFrame
    modes: tuple[str, ...]
    questions: tuple[QuestionScale, ...]
    has_participants: bool
    is_simulated: bool
    sha256: str
    title: str


@dataclass(frozen=True)
class StuckTable:
    """Which comparisons had the robot stuck under which mode.

    Attributes
    ----------
    rows : DataFrame
        One row per comparison and mode in it: ``participant``, ``comparison``, ``mode`` (str),
        ``stuck`` (bool: at least once under that mode) and ``exposure_s`` (float).
    """

    rows: pd.DataFrame
