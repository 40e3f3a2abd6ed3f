"""Responses in the shape the analysis takes, whether they come from a store or from a CSV."""

import hashlib
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Self

import pandas as pd

from data.records import Look
from data.study import BackgroundQuestion


@dataclass(frozen=True)
class QuestionScale:
    """What the analysis must know of a question.

    Attributes
    ----------
    levels : int
        2 to 9.
    levels_inferred : bool
        True if the levels were guessed from the answers, since no study was given.
    modes : tuple of str
        The modes that the question is about, in the order of the table; empty if it is about all of the
        table's.
    """

    name: str
    short: str
    wording: str
    levels: int
    polarity: str = "neutral"
    levels_inferred: bool = False
    modes: tuple[str, ...] = ()


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
    notes : tuple of str
        What a reader must know of how the data were read, a sentence each.
    """

    rows: pd.DataFrame
    modes: tuple[str, ...]
    questions: tuple[QuestionScale, ...]
    has_participants: bool
    is_simulated: bool
    sha256: str
    title: str
    notes: tuple[str, ...] = ()

    def modes_of(self, question: QuestionScale) -> tuple[str, ...]:
        """The modes that a question is about, in the order of the table."""
        return question.modes or self.modes

    @property
    def look(self) -> Look:
        """What whoever sees results of these answers has seen of people."""
        rows = self.rows[(self.rows["source"] != "simulated") & ~self.rows["check"].astype(bool)]
        people = rows.loc[rows["participant"] != "", "participant"].nunique()
        return Look(int(people), int(rows["count"].sum()))

    def without(self, comparisons: Collection[str]) -> Self:
        """The same without the answers to some comparisons; modes and questions stay."""
        rows = self.rows[~self.rows["comparison"].isin(list(comparisons))].reset_index(drop=True)
        return replace(self, rows=rows, sha256=rows_sha256(rows))


def rows_sha256(rows: pd.DataFrame) -> str:
    """Hash of a table's contents."""
    return hashlib.sha256(rows.to_csv(index=False, lineterminator="\n").encode()).hexdigest()


@dataclass(frozen=True)
class StuckTable:
    """Which comparisons had the robot stuck under which mode.

    Attributes
    ----------
    rows : DataFrame
        One row per comparison and mode in it: ``participant``, ``comparison``, ``mode`` (str),
        ``stuck`` (bool: at least once under that mode) and ``exposure_s`` (float; NaN or 0 if unknown).
        ``participant`` is "" if nobody knows who it was.
    """

    rows: pd.DataFrame

    def without(self, comparisons: Collection[str]) -> Self:
        """The same without some comparisons."""
        kept = ~self.rows["comparison"].isin(list(comparisons))
        return replace(self, rows=self.rows[kept].reset_index(drop=True))


@dataclass(frozen=True)
class LagTable:
    """How promptly the robot followed the hand in trials that people guided.

    Attributes
    ----------
    rows : DataFrame
        One row per guided trial: ``participant``, ``comparison``, ``mode`` (str), and as float, NaN where it
        was not measured, ``latency_median_ms`` and ``latency_p95_ms`` (from sending a movement of the hand to
        drawing what came of it), ``frame_rate_hz`` (of the page), ``ticks`` of the control loop and
        ``skipped_ticks``, those that it lost to keep up with time.
    """

    rows: pd.DataFrame


@dataclass(frozen=True)
class PaceTable:
    """How long the answers to a comparison took.

    Attributes
    ----------
    rows : DataFrame
        One row per comparison of which it is known: ``participant``, ``comparison`` (str), ``seconds``
        (float; from the end of its last trial to the submission) and ``questions`` (int64; answered then).
    """

    rows: pd.DataFrame


@dataclass(frozen=True)
class MetricTable:
    """Objective metrics of the laps behind the answers.

    Attributes
    ----------
    rows : DataFrame
        One row per comparison and mode in it with any lap that was finished or ended stuck: ``participant``,
        ``comparison``, ``mode`` (str), then a float column a metric, units in the names: the mean over those
        laps, NaN where none has it.
    """

    rows: pd.DataFrame

    def without(self, comparisons: Collection[str]) -> Self:
        """The same without some comparisons."""
        kept = ~self.rows["comparison"].isin(list(comparisons))
        return replace(self, rows=self.rows[kept].reset_index(drop=True))


@dataclass(frozen=True)
class BackgroundTable:
    """What participants said about themselves.

    Attributes
    ----------
    questions : tuple of BackgroundQuestion
        Those of the study, in its order.
    answers : mapping of str to mapping of str to str
        By participant, by the question's name; without an entry where nothing was answered.
    """

    questions: tuple[BackgroundQuestion, ...]
    answers: Mapping[str, Mapping[str, str]]
