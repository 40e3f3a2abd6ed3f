"""Study file: what this study is, whether it is locked, and whether another file would be valid."""

import streamlit as st

from app.console.overview import is_locked
from app.console.study_check import StudyCheck, check_study
from app.console.style import Mark, card, heading, headline, table
from app.server.desk import Desk
from data.study import Study

_LONGEST_SHOWN = 100
"""Changes that are listed of a candidate file."""


def show(desk: Desk) -> None:
    """Its facts and its lock, a check of another file, then the file itself."""
    stored = desk.stored_study
    locked = is_locked(desk)
    state = Mark("good", "locked") if locked else Mark("off", "not locked")
    headline("Study file", (stored.label, state, stored.sha256[:8]))
    with card("facts"):
        heading("What it says")
        table(("What", "Value"), [*study_facts(desk.study), ("Hash", stored.sha256)])
    with card("lock"):
        heading("Lock")
        _lock(desk, locked)
    with card("check"):
        heading("Check a file")
        _check(desk)
    with card("file"):
        heading("The file")
        st.caption("It names the modes, as its author wrote them; which letter is which it doesn't say.")
        # Without a height: what scrolls within the page is out of reach for the keyboard.
        st.code(stored.toml, language=None, wrap_lines=True)
        name = f"{desk.study.name}.toml"
        st.download_button("Download the study file", stored.toml, file_name=name, mime="application/toml")


def study_facts(study: Study) -> list[tuple[str, str]]:
    """The study in a few lines."""
    protocol = study.protocol
    sources = {
        "guided": "guided by the participants",
        "observed": "watched",
        "external": "on a robot in the lab",
    }
    laps = [("Laps per method and comparison", str(protocol.laps_per_condition))]
    return [
        ("Title", study.title),
        ("Trials", sources[protocol.trial_source]),
        ("Modes", str(len(study.modes))),
        ("Questions", ", ".join(question.name for question in study.questions)),
        ("Pairs", str(len(study.pairs))),
        ("Showings of each pair", str(protocol.repetitions)),
        *(laps if protocol.trial_source == "observed" else []),
        ("Least time with each method", f"{protocol.minimum_exposure_s:g} s"),
        ("Attention checks", str(protocol.attention_checks)),
        ("Planned participants", str(protocol.planned_participants)),
    ]


def _lock(desk: Desk, locked: bool) -> None:
    if locked:
        st.markdown(
            "This revision is locked: it never changes, and an edited file becomes the next revision, with "
            "participants and results of its own."
        )
        return
    text, button = st.columns([0.78, 0.22], vertical_alignment="center")
    text.markdown(
        "Nobody has taken part yet. The first participant locks this revision; you can do so beforehand, "
        "to fix what you have registered. The audit log keeps when."
    )
    if button.button("Lock this revision", width="stretch"):
        _confirm(desk)


@st.dialog("Lock this revision?")
def _confirm(desk: Desk) -> None:
    st.markdown(
        f"**{desk.stored_study.label}**, hash `{desk.stored_study.sha256[:16]}`, is marked as final. "
        "**This can't be undone.**"
    )
    yes, no = st.columns(2)
    if yes.button("Lock now", type="primary", width="stretch"):
        desk.store.lock_study(desk.stored_study, "researcher", desk.clock())
        st.rerun()
    if no.button("Not yet", width="stretch"):
        st.rerun()


def _check(desk: Desk) -> None:
    st.caption("Another study file is checked here as serving it would, and nothing of it is stored.")
    given = st.file_uploader("Study file", type=["toml"], label_visibility="collapsed")
    if given is None:
        return
    found = check_study(given.getvalue(), given.name, desk.stored_study)
    said = Mark("bad" if found.standing == "wrong" else "good", found.sentence)
    st.html(f"<p>{said.html}</p>")
    for caution in found.cautions:
        st.html(f"<p>{Mark('warn', f'{caution[0].upper()}{caution[1:]}.').html}</p>")
    if found.changes:
        _changes(found)
    elif found.standing == "another study" and found.study is not None:
        table(("What", "Value"), study_facts(found.study))


def _changes(found: StudyCheck) -> None:
    table(("Where", "Now", "In the file"), found.changes[:_LONGEST_SHOWN])
    left_out = len(found.changes) - _LONGEST_SHOWN
    if left_out > 0:
        st.caption(f"And {left_out} more.")
