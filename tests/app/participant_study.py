"""A guided study, and a participant of it on a store with a clock of the test's own."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

from app.participant.progress import Place, Progress, progress_of
from app.server.desk import Desk
from app.server.laps import LapKeeper
from app.server.visitors import admit, new_participant_cookie
from data.records import Comparison, Participant, Slot, Trial
from data.store import Store, token_sha256
from data.study_file import parse_study

from .conftest import TINY_STUDY

GUIDED_STUDY = TINY_STUDY.replace('"observed"', '"guided"').replace("repetitions = 1", "repetitions = 3") + (
    """
[[background]]
name = "pflaume"
wording = "Have you guided a robot by hand before?"
choices = ["Never", "Often"]
[[background]]
name = "years"
wording = "How old are you?"
kind = "number"
lowest = 18
highest = 99
required = true
[[background]]
name = "work"
wording = "What do you do?"
kind = "text"
"""
)
NOON = datetime(2026, 3, 4, 12, 0, tzinfo=UTC)


def with_protocol(study: str, *lines: str) -> str:
    """The study file with more lines in its protocol."""
    return study.replace("[protocol]", "\n".join(("[protocol]", *lines)))


@dataclass
class Guest:
    """A participant who has agreed, and the desk that serves them."""

    desk: Desk
    cookie: str
    participant: Participant
    clock: list[datetime] = field(repr=False)

    @property
    def store(self) -> Store:
        return self.desk.store

    @property
    def progress(self) -> Progress:
        return progress_of(self.store, self.store.participant(self.participant.id))

    @property
    def place(self) -> Place:
        return self.progress.place_in(self.desk.study, self.desk.clock())

    def wait(self, **time: float) -> None:
        self.clock[0] += timedelta(**time)

    def tell_background(self) -> None:
        self.store.record_background(self.participant.id, {"years": "33"}, self.desk.clock())

    def choose_device(self) -> None:
        self.store.record_device(self.participant.id, "touch")

    def practise(self) -> None:
        self.store.record_practice(self.participant.id, self.desk.clock())

    def begin(self) -> Comparison:
        coming = self.progress.next
        assert coming is not None
        return self.store.start_comparison(coming.id, self.desk.clock())

    def guide(self, slot: Slot, seconds: float, *, is_whole: bool = False) -> None:
        """Guide the robot until now."""
        comparison = self.progress.comparison
        assert comparison is not None
        number = 1 + sum(trial.slot == slot for trial in self.store.trials(comparison=comparison.id))
        self.store.add_trial(
            Trial(
                id=f"{comparison.id}.{slot}{number}",
                comparison=comparison.id,
                slot=slot,
                number=number,
                mode=comparison.mode_of(slot),
                source="guided",
                outcome="completed" if is_whole else "abandoned",
                started_at=self.desk.clock() - timedelta(seconds=seconds),
                duration_s=seconds,
                seed=0,
            )
        )

    def answer(self) -> None:
        comparison = self.progress.comparison
        assert comparison is not None
        answers = {question.name: question.scale[0] for question in self.desk.study.questions}
        self.store.submit_responses(comparison.id, answers, self.desk.clock())


@contextmanager
def guest(folder: Path, study: str = GUIDED_STUDY) -> Iterator[Guest]:
    """A participant who agreed at noon."""
    clock = [NOON]
    with Store.open(folder / "study.sqlite", clock=lambda: clock[0]) as store:
        stored = store.add_study(parse_study(study, "study.toml"), study)
        desk = Desk(stored, store, LapKeeper(stored.study, store.recordings_folder, 1))
        store.create_link("participant", stored, token_sha256("token"))
        cookie = new_participant_cookie(desk, "token")
        assert cookie is not None
        yield Guest(desk, cookie, admit(desk, cookie), clock)
