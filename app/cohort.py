"""A simulated cohort: through the same schedule, allocation and store as people, lap by lap.

A demonstration and a dress rehearsal. Nothing it produces is evidence about people, and all of it is
stored as ``simulated``.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from app.studies import OpenedStudy, check_can_be_simulated
from data.answers import Answer
from data.records import Comparison, Participant, Slot, Switch, Trial
from data.schedule import PlannedComparison, plan_session
from data.store import Store, StoredStudy
from data.study import Study
from sim_trials.batch import map_jobs
from sim_trials.operators import draw_operator
from sim_trials.raters import answer, draw_rater, experience
from sim_trials.trial import run_trial

Progress = Callable[[int, int, str], None]

CLOCK_START = datetime(2017, 1, 2, 9, 0, tzinfo=UTC)
"""The cohort's clock is simulated, so that the same seed gives the same bytes."""
A_DAY = timedelta(days=1)
"""From one simulated participant to the next."""
READING = timedelta(seconds=90)
ANSWERING = timedelta(seconds=8)
"""Simulated time for consent and instructions, and for each question."""

# Streams of random numbers, so that people, hands, raters and their noise don't share draws.
_OPERATOR, _LAP, _TASTE, _NOISE = range(4)


@dataclass(frozen=True)
class Cohort:
    """What a simulation added to a store."""

    participants: int
    already_there: int
    comparisons: int
    trials: int
    stuck: int

    @property
    def sentence(self) -> str:
        """One line for the terminal."""
        kept = f" ({self.already_there} were there already)" if self.already_there else ""
        return (
            f"{self.participants} simulated participants{kept}, {self.comparisons} comparisons, "
            f"{self.trials} laps, {self.stuck} of them stuck"
        )


@dataclass(frozen=True)
class _Errand:
    """One simulated participant's comparison, to be run in any process."""

    study: Study
    participant: str
    number: int
    seed: int
    planned: PlannedComparison
    recordings: Path


@dataclass(frozen=True)
class _Done:
    """A comparison as it was experienced; its times start at zero of the simulated clock."""

    comparison: Comparison
    trials: tuple[Trial, ...]
    switches: tuple[Switch, ...]
    answers: dict[str, Answer]
    took: timedelta


def simulate_cohort(
    opened: OpenedStudy,
    store: Store,
    participants: int,
    *,
    seed: int,
    n_jobs: int,
    progress: Progress | None = None,
) -> Cohort:
    """Send ``participants`` simulated people through a study and store all that happens.

    A participant is stored in one transaction when all their comparisons are done, so that an
    interrupted cohort is completed by calling again with the same seed.

    Parameters
    ----------
    opened : OpenedStudy
    store : Store
    participants : int
        How many there shall be of this seed.
    seed : int
        Decides people, hands, tastes and noise; the schedule is the study's own.
    n_jobs : int
        Processes; the result does not depend on it.

    Raises
    ------
    InputError
        If the study cannot be simulated (`app.studies.check_can_be_simulated`).
    """
    study = opened.study
    check_can_be_simulated(study, study.name)
    stored = store.add_study(study, opened.text)
    people = store.participants(stored)
    known = {p.id for p in people if p.finished_at is not None or p.withdrawn_at is not None}
    numbers = [n for n in range(1, participants + 1) if participant_id(study, seed, n) not in known]
    errands = [
        _Errand(study, participant_id(study, seed, n), n, seed, planned, store.recordings_folder)
        for n in numbers
        for planned in plan_session(study, n)
    ]
    per_person = len(errands) // len(numbers) if numbers else 0
    results = map_jobs(_run, errands, n_jobs)
    trials = stuck = 0
    unkept = [participant_id(study, seed, n) for n in numbers]
    try:
        for index, number in enumerate(numbers):
            done = []
            for k in range(per_person):
                done.append(next(results))
                if progress:
                    progress(index * per_person + k + 1, len(errands), f"participant {number}")
            _keep(store, stored, unkept[0], number, done)
            del unkept[0]
            trials += sum(len(d.trials) for d in done)
            stuck += sum(t.outcome == "stuck" for d in done for t in d.trials)
    except BaseException:
        results.close()
        _drop_recordings(store, stored, unkept)
        raise
    return Cohort(participants, participants - len(numbers), len(errands), trials, stuck)


def participant_id(study: Study, seed: int, number: int) -> str:
    """The id of a cohort's participant: which study, which seed, which number."""
    return f"{study.sha256[:6]}-s{seed}-{number:03d}"


def _run(errand: _Errand) -> _Done:
    """All laps of one comparison under A and then under B, and the answers they lead to."""
    study, planned, number = errand.study, errand.planned, errand.number
    comparison_id = f"{errand.participant}.c{planned.position:02d}"
    person = draw_operator(_seed_of(errand, _OPERATOR))
    now = CLOCK_START
    trials: list[Trial] = []
    switches: list[Switch] = []
    felt = []
    slots: tuple[Slot, ...] = ("A", "B")
    for order, slot in enumerate(slots):
        mode = planned.mode_a if slot == "A" else planned.mode_b
        switches.append(Switch(comparison_id, order + 1, slot, now))
        laps = []
        for lap in range(1, study.protocol.laps_per_condition + 1):
            # The same hand under A and under B: the modes, not the noise, make the difference.
            lap_seed = _seed_of(errand, _LAP, planned.position, lap)
            result = run_trial(study, mode, person, seed=lap_seed, lap=lap)
            name = f"{comparison_id}.{slot}{lap}"
            sha256 = result.recording.write(errand.recordings / f"{name}.parquet")
            laps.append(
                Trial(
                    id=name,
                    comparison=comparison_id,
                    slot=slot,
                    number=lap,
                    mode=mode,
                    source="simulated",
                    outcome=result.outcome,
                    started_at=now,
                    duration_s=result.duration_s,
                    seed=lap_seed,
                    metrics=result.metrics,
                    events=result.events,
                    recording=f"{name}.parquet",
                    recording_sha256=sha256,
                )
            )
            now += timedelta(seconds=result.duration_s)
        felt.append(experience([lap.metrics for lap in laps], [lap.outcome == "stuck" for lap in laps]))
        trials.extend(laps)
    rater = draw_rater(study, np.random.default_rng([errand.seed, number, _TASTE]))
    noise = np.random.default_rng([errand.seed, number, _NOISE, planned.position])
    answers = {q.name: answer(q, rater, felt[0], felt[1], noise) for q in study.questions}
    now += len(answers) * ANSWERING
    comparison = Comparison(
        id=comparison_id,
        participant=errand.participant,
        position=planned.position,
        repetition=planned.repetition,
        mode_a=planned.mode_a,
        mode_b=planned.mode_b,
        check=planned.check,
        started_at=CLOCK_START,
    )
    return _Done(comparison, tuple(trials), tuple(switches), answers, now - CLOCK_START)


def _keep(store: Store, stored: StoredStudy, participant_id: str, number: int, done: Sequence[_Done]) -> None:
    """Write one participant whole, their comparisons one after the other on the simulated clock."""
    joined = CLOCK_START + (number - 1) * A_DAY
    now = joined + READING
    consent = stored.study.consent.version
    with store.transaction():
        store.add_participant(stored, Participant(participant_id, number, "simulated", joined))
        store.record_consent(participant_id, consent, now)
        for d in done:
            later = now - CLOCK_START
            store.add_comparisons([replace(d.comparison, started_at=now)])
            for trial in d.trials:
                store.add_trial(replace(trial, started_at=trial.started_at + later))
            for switch in d.switches:
                store.add_switch(replace(switch, at=switch.at + later))
            now += d.took
            store.submit_responses(d.comparison.id, d.answers, now)
        store.finish_participant(participant_id, now)
        store.log("elbowroom simulate", "participant simulated", {"participant": participant_id}, at=now)


def _drop_recordings(store: Store, stored: StoredStudy, participants: Sequence[str]) -> None:
    """Remove the laps of participants who were not stored: no recording without its row.

    The same cohort may be under way in another process: whom that one stored, keeps the recordings.
    """
    kept = {p.id for p in store.participants(stored)}
    for participant in participants:
        if participant in kept:
            continue
        for recording in store.recordings_folder.glob(f"{participant}.c*.parquet"):
            recording.unlink(missing_ok=True)


def _seed_of(errand: _Errand, *what: int) -> int:
    """A seed for one purpose, from the cohort's seed and the participant's number."""
    sequence = np.random.SeedSequence([errand.seed, errand.number, *what])
    return int(sequence.generate_state(1, np.uint32)[0])
