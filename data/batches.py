"""Imported files whose rows name no comparisons: each is a batch of its own.

Nothing in such a file says whether a row that looks like an earlier file's is that row again, or another
answer. A file none of which was seen before is further comparisons. A file that repeats an earlier one could
be that file, continued, or other people's answers that happen to be the same: whoever imports it decides.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from sqlalchemy import select

from data.store import Store, StoredStudy
from data.store.rows import every
from data.store.tables import comparisons, imports, participants, responses

Repeats = Literal["continues", "another batch"]
"""What a file is that repeats an earlier one: that one, grown, or other answers."""

NEARLY_ALL = 0.9
"""Share of rows that are alike, place by place, from which on a file repeats another. Untuned: people who are
asked the same again on another day give fewer answers alike."""
DIGITS = 8
"""Digits of a file's hash that stand in the names of its comparisons."""
_UNNAMED = re.compile(rf"\.(?:b(?P<batch>[0-9a-f]{{{DIGITS}}})\.|u)[0-9a-f]{{10}}\.[0-9]+")


@dataclass(frozen=True)
class UnnamedAnswer:
    """An answer in a comparison that has no name of its own.

    Attributes
    ----------
    participant : str
        The participant's id in the store.
    """

    participant: str
    question: str
    mode_a: str
    mode_b: str
    answer: str
    repetition: int
    check: bool


@dataclass(frozen=True)
class Batch:
    """The answers of a file that was imported before.

    Attributes
    ----------
    name : str
        The first digits of the file's hash; empty for all that version 0.1.0 imported, which kept no batches
        apart.
    at : datetime or None
        When it was imported; None if that is not known.
    """

    name: str
    answers: tuple[UnnamedAnswer, ...]
    at: datetime | None


@dataclass(frozen=True)
class Repetition:
    """An earlier batch that a file seems to repeat, and how many rows are alike."""

    batch: Batch
    rows: int


def batch_name(sha256: str) -> str:
    """The name of the batch that a file with this hash is."""
    return sha256[:DIGITS]


def unnamed_id(participant: str, batch: str, digest: str, number: int) -> str:
    """The id of a comparison that a file gives no name.

    Parameters
    ----------
    batch : str
        Empty where the comparison continues what version 0.1.0 imported.
    digest : str
        Ten digits for what was shown.
    number : int
        How often it was shown so far in the batch, from 1.
    """
    return f"{participant}.b{batch}.{digest}.{number}" if batch else f"{participant}.u{digest}.{number}"


def earlier_batches(store: Store, study: StoredStudy) -> tuple[Batch, ...]:
    """What was imported into a study from files that name no comparisons, by batch, the latest first."""
    query = (
        select(
            comparisons.c.id,
            comparisons.c.participant,
            responses.c.question,
            comparisons.c.mode_a,
            comparisons.c.mode_b,
            responses.c.answer,
            comparisons.c.repetition,
            comparisons.c.check,
        )
        .join_from(responses, comparisons)
        .join(participants)
        .where(participants.c.study == study.id)
        .order_by(comparisons.c.participant, comparisons.c.position)
    )
    with store.reading() as connection:
        rows = every(connection, query)
        times = {
            batch_name(row["sha256"]): row["at"]
            for row in every(
                connection, select(imports).where(imports.c.study == study.id, imports.c.kind == "responses")
            )
        }
    answers: dict[str, list[UnnamedAnswer]] = defaultdict(list)
    for row in rows:
        # The participant's own name must not be taken for a part of the pattern.
        match = _UNNAMED.fullmatch(row["id"].removeprefix(row["participant"]))
        if match:
            values = {name: row[name] for name in UnnamedAnswer.__dataclass_fields__}
            answers[match["batch"] or ""].append(UnnamedAnswer(**values))
    batches = [Batch(name, tuple(those), times.get(name)) for name, those in answers.items()]
    return tuple(sorted(batches, key=lambda batch: -batch.at.timestamp() if batch.at else 0.0))


def repetitions(new: Sequence[UnnamedAnswer], earlier: Iterable[Batch]) -> tuple[Repetition, ...]:
    """Earlier batches that a file seems to repeat, the one with most rows alike first.

    Of the people who are in both, a file repeats a batch if all rows of the smaller are in the other, however
    ordered, or if nearly all are alike place by place. That may be chance where rows are few or the files of
    very different size: then whoever imports it is asked without need, and no answer counts twice.
    """
    repeated = [Repetition(batch, rows) for batch in earlier if (rows := _alike(new, batch.answers))]
    return tuple(sorted(repeated, key=lambda repetition: -repetition.rows))


def _alike(new: Sequence[UnnamedAnswer], earlier: Sequence[UnnamedAnswer]) -> int:
    """Rows of a file that an earlier one has as well; 0 if it does not seem to repeat that one."""
    in_both = {a.participant for a in new} & {a.participant for a in earlier}
    those = [a for a in new if a.participant in in_both]
    before = [a for a in earlier if a.participant in in_both]
    fewer = min(len(those), len(before))
    if not fewer:
        return 0
    shared = (Counter(those) & Counter(before)).total()
    ours, theirs = _by_place(those), _by_place(before)
    in_place = sum(
        a == b for key in ours.keys() & theirs.keys() for a, b in zip(ours[key], theirs[key], strict=False)
    )
    return shared if shared == fewer or in_place >= NEARLY_ALL * fewer else 0


def _by_place(answers: Iterable[UnnamedAnswer]) -> Mapping[tuple[str, str], list[UnnamedAnswer]]:
    """Each participant's answers to each question, in order."""
    by_place: dict[tuple[str, str], list[UnnamedAnswer]] = defaultdict(list)
    for answer in answers:
        by_place[answer.participant, answer.question].append(answer)
    return by_place
