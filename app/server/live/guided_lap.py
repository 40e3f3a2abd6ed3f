"""Finishing a lap that a person guided: it runs once more from its inputs, in a process of the robot pool."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from data.records import Outcome, StuckEvent
from data.study import Study

if TYPE_CHECKING:
    from sim_trials.trace import LapInputs


@dataclass(frozen=True)
class GuidedLap:
    """What the web process gets of a lap.

    Attributes
    ----------
    recording, recording_sha256 : str
        The lap's file in the store's folder of recordings.
    """

    outcome: Outcome
    duration_s: float
    metrics: Mapping[str, float]
    events: tuple[StuckEvent, ...]
    recording: str
    recording_sha256: str


def finish_lap(study: Study, mode_name: str, inputs: "LapInputs", lap: int, recording: Path) -> GuidedLap:
    """Compute what a lap's inputs come to, and write its recording."""
    from sim_trials.trial import finish

    result = finish(study, mode_name, inputs, lap=lap)
    return GuidedLap(
        outcome=result.outcome,
        duration_s=result.duration_s,
        metrics=result.metrics,
        events=result.events,
        recording=recording.name,
        recording_sha256=result.recording.write(recording),
    )


def warm_up(study: Study) -> None:
    """Load and compile what finishing a lap needs, by one that nobody guided."""
    from sim_trials.live import LiveTrial
    from sim_trials.trial import finish

    trial = LiveTrial(study, study.mode_names[0])
    trial.abandon()
    finish(study, study.mode_names[0], trial.inputs, lap=1)
