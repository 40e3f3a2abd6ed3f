"""The operator's page, on a screen that participants don't see: what to load, and how each run goes.

Everything on it stands in the store and is read anew every second, so two windows, a reload and a new server
show the same. It is the one page on which modes have their names before the study is unblinded.
"""

from collections.abc import Callable
from html import escape
from pathlib import Path

import streamlit as st

from app.console.style import card, heading, headline, table
from app.operator import session
from app.operator.roster import roster
from app.operator.session import Standing, Step
from app.participant.progress import SLOTS, Progress
from app.server.access_log import LOG
from app.server.desk import Desk
from data.errors import ElbowroomError
from data.records import Outcome, Slot, Trial
from data.study import Mode

_REFRESH_S = 1.0
_OPENED = "operator-opened"
_FAILED = "operator-failed"
_OUTCOMES: dict[Outcome, str] = {
    "completed": "Done",
    "stuck": "Stuck",
    "abandoned": "Ended early",
    "failed": "Robot stopped",
}
_PLACES = {
    "background": "answers the questions about themselves",
    "instructions": "reads the instructions",
    "between": "is between two comparisons",
    "break": "takes a break",
}
_ORDERS: dict[Step, tuple[str, str]] = {
    "load": ("Load", "Put the robot to the start, then press Loaded."),
    "reset": ("Reset", "It stays loaded. Back at the start, press Loaded."),
    "start": ("Start", "Press Start as the participant begins."),
    "run": ("Running:", "Press Done after a whole lap."),
}
_STYLE = Path(__file__).with_name("operator.css")


def show(desk: Desk) -> None:
    """The page. That it was opened is kept in the audit log: who sees it knows the modes."""
    if not st.session_state.get(_OPENED):
        desk.store.log("researcher", "open operator page", {"study": desk.stored_study.label}, desk.clock())
        st.session_state[_OPENED] = True
    st.html(f"<style>{_STYLE.read_text(encoding='utf-8')}</style>")
    headline("Operator", ("Shows which method is which: keep it out of participants' sight",))
    _desk(desk)


@st.fragment(run_every=_REFRESH_S)
def _desk(desk: Desk) -> None:
    try:
        _show_participant(desk)
    except ElbowroomError as error:
        LOG.error("operator's page: %s", error)
        st.session_state[_FAILED] = True
    if st.session_state.pop(_FAILED, False):
        st.warning(
            "The store could not be written or read just now. Please look whether your last click shows."
        )


def _show_participant(desk: Desk) -> None:
    people = roster(desk.store, desk.stored_study)
    progress = _chosen(people)
    if progress is None:
        with card("nobody"):
            heading("Nobody is in a session")
            st.caption("As soon as a participant has agreed to take part, this page shows what to load.")
        return
    comparison = progress.comparison
    if comparison is None:
        place = _PLACES.get(progress.place_in(desk.study, desk.clock()), "is not in a comparison")
        with card("waiting"):
            heading(f"Participant {progress.participant.number} {place}")
            st.caption("There is nothing to load yet.")
        return
    standing = session.standing(desk.store, comparison)
    wide, narrow = st.columns([0.64, 0.36], gap="small")
    with card("robot", wide):
        st.caption(
            f"Participant {progress.participant.number}, comparison {comparison.position} "
            f"of {len(progress.comparisons)}"
        )
        _order(desk, standing)
        _acts(desk, standing)
    with card("exposure", narrow):
        _exposure(desk, progress, standing)
    with card("runs"):
        _runs(desk, standing)


def _chosen(people: tuple[Progress, ...]) -> Progress | None:
    if len(people) < 2:
        return people[0] if people else None
    by_id = {progress.participant.id: progress for progress in people}
    chosen = st.selectbox(
        "Participant at the robot",
        list(by_id),
        format_func=lambda person: f"Participant {by_id[person].participant.number}",
        key="operator-participant",
        width=320,
    )
    return by_id.get(chosen) if chosen is not None else None


def _order(desk: Desk, standing: Standing) -> None:
    """What is to be done now, in one sentence, with the mode behind the slot and the clock of the run."""
    slot = standing.run.wanted
    mode = _mode(desk, standing, slot)
    what, how = _ORDERS[standing.step]
    seconds = int(standing.running_s(desk.clock()))
    values = ", ".join(f"{name} = {value:g}" for name, value in mode.parameters.items())
    st.html(
        f'<div class="order" role="status"><span class="sign {slot.lower()}" aria-hidden="true">{slot}</span>'
        f"<div><h2>{escape(f'{what} {mode.name} as method {slot}')}</h2><p>{how}</p>"
        f'<p class="values">{escape(mode.description)}</p>'
        f'<p class="values">{escape(values)}</p></div>'
        f'<span class="clock{" runs" if standing.step == "run" else ""}" aria-label="time of this run">'
        f"{_clock(seconds)}</span></div>"
    )


def _acts(desk: Desk, standing: Standing) -> None:
    """Five buttons that stay in place; each says what it was meant for, so that a late click does no harm."""
    store, comparison, slot = desk.store, standing.comparison, standing.run.wanted
    started, step = standing.run.started_at, standing.step
    name = f"{comparison.id}-{slot}-{started.timestamp() if started else 0}"

    def button(label: str, key: str, steps: tuple[Step, ...], act: Callable[[], None], is_main: bool) -> None:
        st.button(
            label,
            key=f"{label}-{name}",
            on_click=_attempt,
            args=(act,),
            type="primary" if is_main and step in steps else "secondary",
            disabled=step not in steps,
            shortcut=key,
            width="stretch",
        )

    def load() -> None:
        session.loaded(store, comparison, slot)

    def begin() -> None:
        session.start(store, comparison, slot, desk.clock())

    def ended(outcome: Outcome) -> Callable[[], None]:
        return lambda: session.end(store, comparison, started, outcome, desk.clock())

    with st.container(key="acts"):
        before = st.columns(2)
        with before[0]:
            button("Loaded", "L", ("load", "reset"), load, True)
        with before[1]:
            button("Start", "S", ("start",), begin, True)
        after = st.columns(3)
        with after[0]:
            button("Done", "D", ("run",), ended("completed"), True)
        with after[1]:
            button("Stuck", "K", ("run",), ended("stuck"), False)
        with after[2]:
            button("Reset", "B", ("run",), ended("abandoned"), False)
    st.caption(
        "Done: a lap is completed. Stuck: the robot can't be guided any further. Reset: the run ends for "
        "another reason. Keys: L, S, D, K for Stuck, B for Reset (back to the start)."
    )


def _exposure(desk: Desk, progress: Progress, standing: Standing) -> None:
    least = desk.study.protocol.minimum_exposure_s
    exposure = standing.exposure_by(desk.clock())
    heading("Exposure")
    rows = ""
    for slot in SLOTS:
        share = min(1.0, exposure[slot] / least) if least > 0 else 1.0
        rows += (
            f"<b>{slot}</b><span class='bar'><i style='width:{100 * share:.0f}%'></i></span>"
            f"<span>{int(exposure[slot])} of {least:g} s</span>"
        )
    st.html(f'<div class="exposure">{rows}</div>')
    is_open = progress.may_answer(desk.study, exposure)
    st.caption(
        "The participant can answer the questions now, and may be doing so."
        if is_open
        else "The questions open when both have had their time."
    )


def _runs(desk: Desk, standing: Standing) -> None:
    heading("Runs of this comparison", "times in UTC")
    if not standing.trials:
        st.caption("None yet.")
        return
    table(
        ("Method", "Run", "Ended", "Began", "Lasted"),
        [
            (
                trial.slot,
                str(trial.number),
                _OUTCOMES[trial.outcome],
                f"{trial.started_at:%H:%M:%S}",
                f"{trial.duration_s:.1f} s",
            )
            for trial in reversed(standing.trials)
        ],
        numbers=(1, 4),
    )
    _correction(desk, standing.trials[-1])


def _correction(desk: Desk, last: Trial) -> None:
    key = f"correct-{last.id}-{last.outcome}"

    def correct() -> None:
        chosen = st.session_state.get(key)
        if chosen is not None:
            _attempt(lambda: session.correct(desk.store, last, chosen, desk.clock()))

    outcomes = list(_OUTCOMES)
    st.selectbox(
        "Correct the last run",
        outcomes,
        index=outcomes.index(last.outcome),
        format_func=lambda outcome: _OUTCOMES[outcome],
        key=key,
        on_change=correct,
        help="Both what it was and what it is now are kept in the audit log.",
        width=320,
    )


def _mode(desk: Desk, standing: Standing, slot: Slot) -> Mode:
    name = standing.comparison.mode_of(slot)
    return next(mode for mode in desk.study.modes if mode.name == name)


def _attempt(act: Callable[[], None]) -> None:
    """Do what a click asks for; if the store refuses, the page that follows says so."""
    try:
        act()
    except ElbowroomError as error:
        LOG.error("operator's page: %s", error)
        st.session_state[_FAILED] = True


def _clock(seconds: int) -> str:
    return f"{seconds // 60}:{seconds % 60:02d}"
