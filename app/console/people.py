"""Who is where: what the store knows of every participant, and what is live at the robot now."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.participant.progress import Place, Progress
from app.server.desk import Desk
from app.server.live.board import LiveRow
from data.records import Comparison, Device, Participant

PLACES: dict[Place, str] = {
    "withdrawn": "withdrawn",
    "closed": "time is over",
    "background": "questions about themselves",
    "instructions": "reading",
    "practice": "practising",
    "ready": "about to begin",
    "comparison": "comparing",
    "between": "between comparisons",
    "break": "having a break",
    "thanks": "finished",
}
_UNITS = (("days", 86_400, 172_800), ("h", 3600, 3600), ("min", 60, 60))
"""Name, size [s], and from how many seconds on it is used."""
_OVER: frozenset[Place] = frozenset({"withdrawn", "closed", "thanks"})
RECENTLY = timedelta(hours=3)
"""Who did nothing for longer isn't in a session any more."""


@dataclass(frozen=True)
class Seat:
    """One participant as the console shows them. Slots are A and B; a mode is never named.

    Attributes
    ----------
    comparison, comparisons : int
        Position of the comparison that is open, 0 for none; how many there are.
    seen_at : datetime
        The last thing that is stored of them, or since when they are connected or away.
    live : LiveRow or None
        Their session at the robot.
    """

    participant: Participant
    place: Place
    comparison: int
    answered: int
    comparisons: int
    trials: int
    stuck: int
    seen_at: datetime
    live: LiveRow | None

    @property
    def name(self) -> str:
        """What the console calls them."""
        return f"P{self.participant.number:02d}"

    @property
    def where(self) -> str:
        """Where they are, in words: at the robot with the slot and the lap."""
        if self.live is None or self.live.slot is None:
            return PLACES[self.place]
        doing = "practising" if self.live.comparison is None else "guiding"
        slot = "" if self.live.comparison is None else f" {self.live.slot},"
        return f"{doing}{slot} lap {self.live.lap}"

    @property
    def device(self) -> Device | None:
        """What the robot is guided with."""
        return (self.live.device if self.live else None) or self.participant.device

    def is_present(self, now: datetime) -> bool:
        """Whether they are in a session: at the robot, or not done and seen a short while ago."""
        if self.live is not None and self.live.is_connected:
            return True
        return self.place not in _OVER and now - self.seen_at < RECENTLY


def seats(desk: Desk) -> tuple[Seat, ...]:
    """All people of the study, by number; simulated participants sit nowhere."""
    people = desk.store.participants(desk.stored_study, source="human")
    planned: dict[str, list[Comparison]] = {}
    for comparison in desk.store.comparisons(desk.stored_study):
        planned.setdefault(comparison.participant, []).append(comparison)
    tallies = _tallies(desk, people)
    live = {row.participant: row for row in live_rows(desk)}
    return tuple(
        _seat(
            desk,
            Progress(person, tuple(planned.get(person.id, ()))),
            tallies.get(person.id, Tally()),
            live.get(person.id),
        )
        for person in people
    )


@dataclass(frozen=True)
class Tally:
    """What the trials of one participant come to; ``until`` is when the last one ended."""

    trials: int = 0
    stuck: int = 0
    until: datetime | None = None


_counted: dict[str, tuple[tuple[int, int], Mapping[str, Tally]]] = {}


def _tallies(desk: Desk, people: Sequence[Participant]) -> Mapping[str, Tally]:
    """The tally of everybody with trials.

    A page asks every other second, and thousands of trials take long to read. A stored trial never changes,
    and it goes only with its participant: the numbers of trials and of withdrawals tell what is new.
    """
    withdrawn = sum(person.withdrawn_at is not None for person in people)
    state = (desk.store.counts(desk.stored_study).trials, withdrawn)
    where = f"{desk.store.address.shown} {desk.stored_study.id}"
    known = _counted.get(where)
    if known is not None and known[0] == state:
        return known[1]
    found: dict[str, Tally] = {}
    for trial in desk.store.trials(desk.stored_study):
        person = trial.comparison.rpartition(".")[0]
        so_far = found.get(person, Tally())
        ended = trial.started_at + timedelta(seconds=trial.duration_s)
        found[person] = Tally(
            so_far.trials + 1,
            so_far.stuck + (trial.outcome == "stuck"),
            ended if so_far.until is None else max(so_far.until, ended),
        )
    _counted[where] = (state, found)
    return found


def live_rows(desk: Desk) -> tuple[LiveRow, ...]:
    """Who is at the robot; nobody ever is where a study's trials are observed or external."""
    return tuple(desk.live.board()) if desk.live is not None else ()


def _seat(desk: Desk, progress: Progress, tally: Tally, live: LiveRow | None) -> Seat:
    open_now = progress.comparison
    return Seat(
        participant=progress.participant,
        place=progress.place_in(desk.study, desk.clock()),
        comparison=open_now.position if open_now else 0,
        answered=progress.answered,
        comparisons=len(progress.comparisons),
        trials=tally.trials,
        stuck=tally.stuck,
        seen_at=live.since if live else _last_stored(progress, tally),
        live=live,
    )


def _last_stored(progress: Progress, tally: Tally) -> datetime:
    person = progress.participant
    times = [person.joined_at, person.consented_at, person.background_at, person.practised_at]
    times += [person.finished_at, person.withdrawn_at, tally.until]
    for comparison in progress.comparisons:
        times += [comparison.started_at, comparison.answered_at, comparison.restarted_at]
    return max(time for time in times if time is not None)


def ago(since: timedelta) -> str:
    """How long ago, roughly: in the largest unit that fits."""
    seconds = max(0.0, since.total_seconds())
    if seconds < 5:
        return "now"
    for unit, size, least in _UNITS:
        if seconds >= least:
            return f"{int(seconds // size)} {unit} ago"
    return f"{int(seconds)} s ago"
