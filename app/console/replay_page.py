"""The replay of one trial: what happened at the wall, in the robot, in the hand, under one playhead."""

from collections.abc import Sequence

import streamlit as st

from app.console.replay_view import replay_view
from app.console.style import Mark, headline, table
from app.console.trial_rows import OUTCOME_WORDS, TrialRow
from app.server.desk import Desk
from data.metric_meanings import LAP_METRICS, LAP_PHASES, meaning_of
from data.records import StuckEvent, Trial
from data.study import Study

TRIAL = "trial"
"""The address's parameter with the trial's id."""

_EVENT_WORDS = {
    "stuck": "stuck",
    "elbow_inversion": "elbow inverted",
    "protective_stop": "protective stop",
}


def open_trial(trial_id: str) -> None:
    """Turn to a trial's replay."""
    st.query_params[TRIAL] = trial_id


def show(desk: Desk, trial_id: str, rows: Sequence[TrialRow]) -> None:
    """A trial's replay with the trials before and after it in ``rows``."""
    place = next((k for k, row in enumerate(rows) if row.trial.id == trial_id), None)
    if place is None:
        headline("Trials")
        st.caption("There is no such trial, or it is simulated and simulated trials are not shown.")
        st.button("All trials", on_click=st.query_params.clear)
        return
    row = rows[place]
    left, right = st.columns([0.62, 0.38], vertical_alignment="center")
    with left:
        headline(row.title, (_outcome(row.trial),))
    with right.container(horizontal=True, horizontal_alignment="right", gap="xsmall"):
        st.button("All trials", on_click=st.query_params.clear)
        _step("Earlier", rows, place - 1)
        _step("Later", rows, place + 1)
        _download(desk, row.trial)
    if row.trial.recording is None:
        st.caption("There is no recording of this trial, so there is nothing to replay.")
    else:
        replay_view(replay_data(desk.study, row, _damping_threshold(desk, row.trial)), key=row.trial.id)
    with st.expander("Measures of this trial"):
        _measures(row.trial)


def replay_data(study: Study, row: TrialRow, damping_below: float | None) -> dict[str, object]:
    """What the browser needs beside the recording; no mode goes by its name while the study is blinded.

    Parameters
    ----------
    damping_below : float or None
        sigma_min below which the mode damps, if that may be shown.
    """
    trial, maze, feedback = row.trial, study.maze, study.feedback
    return {
        "trial": trial.id,
        "address": f"/replays/{trial.id}",
        "facts": facts(row),
        "recording": (trial.recording_sha256 or "")[:8],
        "duration_s": trial.duration_s,
        "events": [_event(event) for event in trial.events],
        "stuck": {"sigma_below": study.stuck.sigma_below, "dwell_s": study.stuck.dwell_s},
        "damping_below": damping_below,
        "maze": {
            "left": maze.left_y_m,
            "right": maze.right_y_m,
            "top": maze.top_z_m,
            "bottom": maze.bottom_z_m,
        },
        "wall_x": maze.wall_x_m,
        "path": {"solidUpTo": feedback.path_solid_up_to_m_s, "faintFrom": feedback.path_faint_from_m_s},
        "tilt": {
            "greenBelow": feedback.tilt_green_below_deg,
            "redFrom": feedback.tilt_red_from_deg,
            "fullEllipse": feedback.tilt_full_ellipse_deg,
        },
    }


def facts(row: TrialRow) -> list[tuple[str, str]]:
    """The line below the title: words and what they are of."""
    trial, metrics = row.trial, row.trial.metrics
    other = "B" if trial.slot == "A" else "A"
    found = [(f"{trial.slot} was", row.label), (f"{other} was", row.other_label)]
    if row.comparison.check:
        found.append(("hidden", "check"))
    if trial.source != "guided":
        found.append(("trial", trial.source))
    elif row.device:
        found.append(("by", row.device))
    if "lap" in metrics:
        found.append(("lap", f"{metrics['lap']:.0f}"))
    if "latency_median_ms" in metrics:
        found.append(("delay", f"{metrics['latency_median_ms']:.0f} ms"))
    if "frame_rate_hz" in metrics:
        found.append(("frames", f"{metrics['frame_rate_hz']:.0f}/s"))
    if metrics.get("ticks"):
        found.append(("skipped ticks", f"{100 * metrics.get('skipped_ticks', 0) / metrics['ticks']:.1f} %"))
    return found


def common_damping_threshold(study: Study) -> float | None:
    """The sigma_t of all modes that have one, if it is the same for all: then it tells them not apart."""
    thresholds = [_sigma_t(study, name) for name in study.mode_names]
    return thresholds[0] if len(set(thresholds)) == 1 else None


def _damping_threshold(desk: Desk, trial: Trial) -> float | None:
    if desk.store.is_unblinded(desk.stored_study):
        return _sigma_t(desk.study, trial.mode)
    return common_damping_threshold(desk.study)


def _sigma_t(study: Study, mode_name: str) -> float | None:
    from sim_trials.modes.registry import resolve

    mode = next(mode for mode in study.modes if mode.name == mode_name)
    if "method" not in mode.model_fields_set:
        return None
    resolved = resolve(mode)
    named = dict(zip(resolved.method.parameter_names, resolved.values, strict=True))
    return named.get("sigma_t")


def _outcome(trial: Trial) -> Mark | str:
    words = OUTCOME_WORDS[trial.outcome].capitalize()
    minutes, seconds = divmod(trial.duration_s, 60)
    at = f"{words} at {minutes:.0f}:{seconds:04.1f}"
    return Mark("bad", at) if trial.outcome == "stuck" else at


def _event(event: StuckEvent) -> dict[str, object]:
    return {
        "kind": event.kind,
        "name": _EVENT_WORDS[event.kind],
        "time_s": event.time_s,
        "phase": event.phase,
    }


def _step(name: str, rows: Sequence[TrialRow], place: int) -> None:
    is_there = 0 <= place < len(rows)
    st.button(
        name, disabled=not is_there, on_click=open_trial, args=(rows[place].trial.id,) if is_there else None
    )


def _download(desk: Desk, trial: Trial) -> None:
    if trial.recording is None:
        return
    if desk.store.is_unblinded(desk.stored_study):
        st.link_button("Download", f"/recordings/{trial.id}")
    else:
        st.button("Download", disabled=True, help="A recording names its mode: unblind first.")


def _measures(trial: Trial) -> None:
    """The trial's metrics, for the whole and by phase, and what happened in it."""
    split = [
        (
            meaning_of(metric.name()).label,
            *(_shown(trial, metric.name(phase)) for phase in ("", *LAP_PHASES)),
        )
        for metric in LAP_METRICS
    ]
    named = {metric.name(phase) for metric in LAP_METRICS for phase in ("", *LAP_PHASES)}
    rest = [
        (meaning_of(name).label, _shown(trial, name), "", "", "")
        for name in sorted(trial.metrics)
        if name not in named
    ]
    head = ("Measure", "Whole trial", *(phase.capitalize() for phase in LAP_PHASES))
    table(head, [*split, *rest], numbers=(1, 2, 3, 4))
    if trial.events:
        table(
            ("Event", "At", "σ min", "Phase", "Definition"),
            [
                (_EVENT_WORDS[e.kind], f"{e.time_s:.2f} s", f"{e.sigma_min:.4f}", e.phase, e.definition)
                for e in trial.events
            ],
        )


def _shown(trial: Trial, name: str) -> str:
    return f"{trial.metrics[name]:.4g}" if name in trial.metrics else ""
