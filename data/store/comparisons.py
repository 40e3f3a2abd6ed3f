"""Comparisons in the store: what was shown, which way the participant turned, and the answers."""

from collections.abc import Iterable, Mapping
from datetime import datetime

from sqlalchemy import Connection, RowMapping, select, update

from data.answers import Answer
from data.errors import ElbowroomError, InputError, one_of
from data.records import Comparison, Response, Switch
from data.store.participants import StoredParticipants
from data.store.rows import every, first, insert_all, record_of, row_of
from data.store.studies import StoredStudy
from data.store.tables import comparisons, participants, responses, switches
from data.study import Study

_PLANNED = ("participant", "position", "repetition", "mode_a", "mode_b", "check")


class StoredComparisons(StoredParticipants):
    """The comparisons of a store, with their switches and responses."""

    def add_comparisons(self, new: Iterable[Comparison]) -> None:
        """Keep the comparisons planned for participants; those that are known stay as they are.

        Raises
        ------
        ElbowroomError
            If a comparison is stored with other modes or at another position, or its participant withdrew.
        InputError
            If a mode is not of the study.
        """
        with self.transaction() as connection:
            rows = []
            studies: dict[str, StoredStudy] = {}
            for comparison in new:
                if comparison.participant not in studies:
                    if self._participant(connection, comparison.participant).withdrawn_at is not None:
                        raise ElbowroomError(
                            f"participant {comparison.participant} has withdrawn: nothing more is kept"
                        )
                    studies[comparison.participant] = self.study_of(comparison.participant)
                stored = self._comparison_row(connection, comparison.id)
                if stored is None:
                    _check_modes(comparison, studies[comparison.participant].study)
                    rows.append(row_of(comparison, comparisons))
                elif any(stored[name] != getattr(comparison, name) for name in _PLANNED):
                    raise ElbowroomError(f"comparison {comparison.id}: the store has another one of this id")
            insert_all(connection, comparisons, rows)

    def comparison(self, comparison_id: str) -> Comparison:
        """One comparison.

        Raises
        ------
        ElbowroomError
            If there is none of this id.
        """
        with self.reading() as connection:
            return self._comparison(connection, comparison_id)

    def comparisons(
        self, study: StoredStudy | None = None, participant: str | None = None
    ) -> tuple[Comparison, ...]:
        """The comparisons of a study or of one participant, by participant and position."""
        query = select(comparisons).join(participants)
        if study is not None:
            query = query.where(participants.c.study == study.id)
        if participant is not None:
            query = query.where(comparisons.c.participant == participant)
        query = query.order_by(
            participants.c.source, participants.c.number, participants.c.id, comparisons.c.position
        )
        with self.reading() as connection:
            return tuple(record_of(Comparison, row) for row in every(connection, query))

    def start_comparison(self, comparison_id: str, at: datetime) -> Comparison:
        """Keep when a comparison was first shown; the first time stands."""
        with self.transaction() as connection:
            if self._comparison(connection, comparison_id).started_at is None:
                here = comparisons.c.id == comparison_id
                connection.execute(update(comparisons).where(here).values(started_at=at))
            return self._comparison(connection, comparison_id)

    def restart_comparison(self, comparison_id: str, at: datetime) -> Comparison:
        """Keep that an open comparison is begun anew; one that is answered stays as it is."""
        with self.transaction() as connection:
            stored = self._comparison(connection, comparison_id)
            if stored.started_at is None or stored.answered_at is not None:
                return stored
            here = comparisons.c.id == comparison_id
            connection.execute(update(comparisons).where(here).values(restarted_at=at))
            return self._comparison(connection, comparison_id)

    def add_switch(self, switch: Switch) -> None:
        """Keep that the participant turned to A or B; the same switch again changes nothing."""
        with self.transaction() as connection:
            here = (switches.c.comparison == switch.comparison) & (switches.c.number == switch.number)
            row = first(connection, select(switches).where(here))
            if row is None:
                self._comparison(connection, switch.comparison)
                connection.execute(switches.insert(), row_of(switch, switches))
            elif record_of(Switch, row) != switch:
                raise ElbowroomError(f"switch {switch.number} of {switch.comparison} is stored otherwise")

    def switches(self, comparison_id: str) -> tuple[Switch, ...]:
        """The switches of a comparison, in order."""
        query = select(switches).where(switches.c.comparison == comparison_id).order_by(switches.c.number)
        with self.reading() as connection:
            return tuple(record_of(Switch, row) for row in every(connection, query))

    def submit_responses(
        self, comparison_id: str, answers: Mapping[str, str], at: datetime
    ) -> tuple[Response, ...]:
        """Keep a participant's answers to all questions of a comparison, together or not at all.

        The same answers again change nothing; the first time of submission stands.

        Parameters
        ----------
        answers : mapping
            One answer per question of the study.

        Raises
        ------
        InputError
            If a question is missing or unknown, or an answer is not on its question's scale.
        ElbowroomError
            If other answers were submitted before.
        """
        with self.transaction() as connection:
            comparison = self._comparison(connection, comparison_id)
            study = self.study_of(comparison.participant).study
            given = _checked_answers(study, answers, comparison_id)
            stored = self.responses(comparison_id)
            if stored:
                if {response.question: response.answer for response in stored} != given:
                    raise ElbowroomError(f"comparison {comparison_id}: other answers were submitted before")
                return stored
            insert_all(
                connection,
                responses,
                [
                    {"comparison": comparison_id, "question": name, "answer": answer, "answered_at": at}
                    for name, answer in given.items()
                ],
            )
            here = comparisons.c.id == comparison_id
            connection.execute(update(comparisons).where(here).values(answered_at=at))
            return self.responses(comparison_id)

    def responses(self, comparison_id: str) -> tuple[Response, ...]:
        """The answers of a comparison, in the order of the study's questions."""
        query = select(responses).where(responses.c.comparison == comparison_id)
        with self.reading() as connection:
            found = [record_of(Response, row) for row in every(connection, query)]
            if not found:
                return ()
            study = self.study_of(self._comparison(connection, comparison_id).participant).study
        order = [question.name for question in study.questions]
        return tuple(sorted(found, key=lambda response: order.index(response.question)))

    def _comparison(self, connection: Connection, comparison_id: str) -> Comparison:
        row = self._comparison_row(connection, comparison_id)
        if row is None:
            raise ElbowroomError(f"comparison {comparison_id!r} is not in the store")
        return record_of(Comparison, row)

    @staticmethod
    def _comparison_row(connection: Connection, comparison_id: str) -> RowMapping | None:
        query = select(comparisons).where(comparisons.c.id == comparison_id)
        return first(connection, query)


def _check_modes(comparison: Comparison, study: Study) -> None:
    for mode in (comparison.mode_a, comparison.mode_b):
        if mode not in study.mode_names:
            raise one_of(f"comparison {comparison.id}: mode", mode, study.mode_names)
    if comparison.mode_a == comparison.mode_b and not comparison.check:
        raise InputError(f"comparison {comparison.id}: {comparison.mode_a} against itself is no check")


def _checked_answers(study: Study, answers: Mapping[str, str], comparison_id: str) -> dict[str, Answer]:
    """The answers in the order of the questions, each on its question's scale."""
    names = [question.name for question in study.questions]
    for name in answers:
        if name not in names:
            raise one_of(f"comparison {comparison_id}: question", name, names)
    checked: dict[str, Answer] = {}
    for question in study.questions:
        if question.name not in answers:
            raise InputError(f"comparison {comparison_id}: question {question.name} has no answer")
        on_scale = [answer for answer in question.scale if answer == answers[question.name]]
        if not on_scale:
            raise one_of(
                f"comparison {comparison_id}: answer to {question.name}",
                answers[question.name],
                question.scale,
            )
        checked[question.name] = on_scale[0]
    return checked
