"""Bringing answers that were collected elsewhere into a store.

Each import happens whole or not at all, and the same file again changes nothing. The file is the response CSV
(``data.response_csv``).
"""

import json
import re
from collections import Counter
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import get_args

import pandas as pd
from sqlalchemy import select

from data.batches import Repeats, UnnamedAnswer, batch_name, earlier_batches, repetitions, unnamed_id
from data.errors import InputError
from data.records import Comparison, Participant, Source
from data.response_csv import read_response_csv
from data.responses import ResponseTable
from data.store import Store, StoredStudy
from data.store.rows import every, first, insert_all
from data.store.tables import comparisons as comparison_rows
from data.store.tables import imports, participants, responses
from data.study import Study

LARGEST_IMPORT = 200_000
"""Responses; a store keeps each of them as a row of its own."""

_SAFE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,59}")
_OWN_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,119}")
_COLUMNS = ["question", "mode_a", "mode_b", "response", "count", "comparison", "repetition", "check"]


def import_responses(
    path: Path,
    study: Study,
    toml_text: str,
    store: Store,
    *,
    repeats: Repeats | None = None,
    note: Callable[[str], None] = lambda text: None,
) -> int:
    """Add the answers of a response CSV to a study in a store.

    Rows of one participant with the same ``comparison`` belong together. Rows without are a batch of their
    own (``data.batches``): those with the same pair and repetition belong together, and a second answer to
    the same question, or a count above 1, begins another comparison. Answers without a participant are kept
    as pooled.

    Parameters
    ----------
    repeats : {"continues", "another batch"}, optional
        What the file is if it repeats rows of an earlier one.
    note : callable, optional
        Called with each sentence on how the file was read.

    Returns
    -------
    int
        Responses that were added: 0 for a file that was imported before.

    Raises
    ------
    InputError
        If the file is wrong, does not fit what the store has of the study, or repeats an earlier file and
        ``repeats`` does not say what it is.
    """
    table = read_response_csv(path, study)
    total = int(table.rows["count"].sum())
    if total > LARGEST_IMPORT:
        raise InputError(f"{path}: {total} responses; at most {LARGEST_IMPORT} can be imported at once")
    for text in table.notes:
        note(text)
    with store.transaction():
        stored = store.add_study(study, toml_text)
        if was_imported(store, stored, "responses", table.sha256):
            note("This very file was imported before: nothing is added.")
            return 0
        _refuse_to_mix_pooled(store, stored, path, table.has_participants)
        batch = _batch(store, stored, path, table, repeats, note)
        added = 0
        for label in table.rows["participant"].unique():
            of_them = table.rows[table.rows["participant"] == label]
            for source in get_args(Source):
                rows = of_them[of_them["source"] == source]
                if len(rows):
                    given = _Answers(store, stored, path, str(label), source, table.has_participants, batch)
                    given.read(rows)
                    added += given.write()
        remember(store, stored, "responses", table.sha256, added)
        return added


def _batch(
    store: Store,
    study: StoredStudy,
    path: Path,
    table: ResponseTable,
    repeats: Repeats | None,
    note: Callable[[str], None],
) -> str:
    """The name of the batch that the rows without a comparison belong to."""
    own = batch_name(table.sha256)
    rows = table.rows[table.rows["comparison"] == ""]
    if rows.empty:
        if repeats is not None:
            raise InputError(
                f"{path}: every row names its comparison: --continues and --another-batch are for files that "
                "do not"
            )
        return own
    earlier = earlier_batches(store, study)
    answers = _unnamed_answers(store, study, table, rows)
    repeated = repetitions(answers, earlier)
    if repeats == "another batch" or not repeated:
        if repeats == "continues":
            raise InputError(f"{path}: --continues: it repeats no file that was imported before")
        if earlier:
            note("The file names no comparisons: its rows are further ones, beside those in the store.")
        return own
    first = repeated[0]
    when = f" (imported {first.batch.at:%Y-%m-%d %H:%M})" if first.batch.at is not None else ""
    alike = f"{first.rows} of its {len(answers)} answers are as in an earlier file{when}"
    if repeats is None:
        raise InputError(
            f"{path}: {alike}: add --continues if it is that file, grown, or --another-batch if these are "
            "other answers; in the file, a column comparison decides it"
        )
    rest = Counter(answers) - Counter(first.batch.answers)
    if any(Counter(other.batch.answers) <= rest for other in repeated[1:]):
        raise InputError(
            f"{path}: --continues: it holds the answers of several earlier files, and can continue one: a "
            "column comparison says which answers are the same"
        )
    note(f"{alike}, and are not added again.")
    return first.batch.name


def _unnamed_answers(
    store: Store, study: StoredStudy, table: ResponseTable, rows: pd.DataFrame
) -> list[UnnamedAnswer]:
    """The answers of rows without a comparison, one each, in order."""
    ids: dict[str, str] = {}
    answers: list[UnnamedAnswer] = []
    columns = ["participant", "source", *_COLUMNS]
    for person, source, question, a, b, answer, count, _, repetition, check in rows[columns].itertuples(
        index=False
    ):
        label = str(person) if table.has_participants else f"pooled-{source}"
        if label not in ids:
            ids[label] = participant_id(store, study, label)
        answers += [UnnamedAnswer(ids[label], question, a, b, answer, int(repetition), bool(check))] * count
    return answers


class _Answers:
    """One participant's answers on their way into the store."""

    def __init__(
        self,
        store: Store,
        study: StoredStudy,
        path: Path,
        label: str,
        source: Source,
        has_participants: bool,
        batch: str,
    ) -> None:
        self.store, self.path, self.label, self.batch = store, path, label, batch
        self.at = store.clock()
        self.who = participant_id(store, study, label if has_participants else f"pooled-{source}")
        self._join(study, source, pooled=not has_participants)
        self.known = {comparison.id: comparison for comparison in store.comparisons(participant=self.who)}
        self.new: list[Comparison] = []
        self.position = max((c.position for c in self.known.values()), default=0)
        self.answers: dict[tuple[str, str], str] = {}
        self.unnamed: Counter[tuple[str, ...]] = Counter()

    def _join(self, study: StoredStudy, source: Source, pooled: bool) -> None:
        with self.store.transaction() as connection:
            query = select(participants.c.source).where(participants.c.id == self.who)
            stored = first(connection, query)
            if stored is None:
                number = self.store.next_number(study, source)
                background = {"imported_as": self.label} if self.label not in ("", self.who) else {}
                joined = Participant(self.who, number, source, self.at, background)
                self.store.add_participant(study, joined, pooled=pooled)
            elif stored["source"] != source:
                raise InputError(f"{self.path}: participant {self.label!r} is both human and simulated")

    def read(self, rows: pd.DataFrame) -> None:
        """Sort rows into comparisons, refusing those that contradict what the store has of them."""
        for question, a, b, answer, count, name, repetition, check in rows[_COLUMNS].itertuples(index=False):
            where = f"{self.path}: participant {self.label!r}, comparison {name!r}, {question}"
            for _ in range(count):
                shown = (a, b, str(repetition), str(check))
                key = comparison_id(self.who, name) if name else self._unnamed(shown, question)
                self._show(key, int(repetition), a, b, bool(check), where)
                self.answers[key, question] = answer

    def _unnamed(self, shown: tuple[str, ...], question: str) -> str:
        """The id of a comparison that the file gives no name: what was shown, and how often before."""
        self.unnamed[(*shown, question)] += 1
        digest = sha256(json.dumps(shown).encode()).hexdigest()[:10]
        return unnamed_id(self.who, self.batch, digest, self.unnamed[(*shown, question)])

    def _show(self, comparison_id: str, repetition: int, a: str, b: str, check: bool, where: str) -> None:
        known = self.known.get(comparison_id)
        if known is None:
            self.position += 1
            known = Comparison(
                comparison_id, self.who, self.position, repetition, a, b, check, self.at, self.at
            )
            self.known[comparison_id] = known
            self.new.append(known)
        elif (known.mode_a, known.mode_b, known.check) != (a, b, check):
            raise InputError(
                f"{where}: shows {a} and {b}, but in the store {known.mode_a} and {known.mode_b}"
            )

    def write(self) -> int:
        """Add what the store lacks; returns how many responses that is."""
        self.store.add_comparisons(self.new)
        query = select(responses).join_from(responses, comparison_rows)
        with self.store.transaction() as connection:
            stored = {
                (row["comparison"], row["question"]): row["answer"]
                for row in every(connection, query.where(comparison_rows.c.participant == self.who))
            }
            for (comparison, question), answer in self.answers.items():
                before = stored.get((comparison, question), answer)
                if before != answer:
                    where = f"{self.path}: comparison {comparison}, {question}"
                    raise InputError(f"{where}: the store has {before}, not {answer}")
            new = [
                {"comparison": key[0], "question": key[1], "answer": answer, "answered_at": self.at}
                for key, answer in self.answers.items()
                if key not in stored
            ]
            insert_all(connection, responses, new)
        return len(new)


def participant_id(store: Store, study: StoredStudy, label: str) -> str:
    """The id that a participant's name in a file gets: the name itself where it can be one."""
    safe = label if _SAFE.fullmatch(label) else f"p{sha256(label.encode()).hexdigest()[:12]}"
    with store.reading() as connection:
        owner = first(connection, select(participants.c.study).where(participants.c.id == safe))
    if owner is None or owner["study"] == study.id:
        return safe
    return f"{safe}-{study.sha256[:8]}"


def comparison_id(participant: str, name: str) -> str:
    """The id that a comparison's name in a file gets; names count within a participant."""
    if name.startswith(f"{participant}.") and _OWN_ID.fullmatch(name):
        return name
    safe = name if _SAFE.fullmatch(name) else f"x{sha256(name.encode()).hexdigest()[:12]}"
    return f"{participant}.{safe}"


def was_imported(store: Store, study: StoredStudy, kind: str, digest: str) -> bool:
    here = (imports.c.study == study.id) & (imports.c.kind == kind) & (imports.c.sha256 == digest)
    with store.reading() as connection:
        return bool(every(connection, select(imports.c.rows).where(here)))


def remember(store: Store, study: StoredStudy, kind: str, digest: str, added: int) -> None:
    row = {"study": study.id, "kind": kind, "sha256": digest, "at": store.clock(), "rows": added}
    with store.transaction() as connection:
        connection.execute(imports.insert(), row)
    store.log("elbowroom import", f"{kind} imported", {"study": study.label, "sha256": digest})


def _refuse_to_mix_pooled(store: Store, study: StoredStudy, path: Path, has_participants: bool) -> None:
    """Answers of unknown people and of known ones cannot be analysed together as either."""
    query = select(participants.c.pooled).where(participants.c.study == study.id).distinct()
    with store.reading() as connection:
        present = {bool(row["pooled"]) for row in every(connection, query)}
    if has_participants and True in present:
        raise InputError(f"{path}: names participants, but the study in the store holds responses without")
    if not has_participants and False in present:
        raise InputError(
            f"{path}: the column participant is missing, and the study in the store has participants"
        )
