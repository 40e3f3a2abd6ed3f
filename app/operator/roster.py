"""Who is in a session: the participants whom the operator may have at the robot."""

from app.participant.progress import Progress
from data.records import Comparison
from data.store import Store, StoredStudy


def roster(store: Store, study: StoredStudy) -> tuple[Progress, ...]:
    """Participants who have not finished, whoever began a comparison last first."""
    planned: dict[str, list[Comparison]] = {}
    with store.reading():
        for comparison in store.comparisons(study):
            planned.setdefault(comparison.participant, []).append(comparison)
        people = store.participants(study, source="human")
    here = [
        Progress(person, tuple(planned.get(person.id, ())))
        for person in people
        if person.consented_at is not None and person.finished_at is None and person.withdrawn_at is None
    ]
    return tuple(sorted(here, key=_newest, reverse=True))


def _newest(progress: Progress) -> tuple[float, int]:
    started = [c.started_at.timestamp() for c in progress.comparisons if c.started_at is not None]
    return max(started, default=0.0), progress.participant.number
