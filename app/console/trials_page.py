"""Trials: all of them as a table, and the replay of the one whose id is in the address."""

from dataclasses import asdict

import pandas as pd
import streamlit as st

from app.console import replay_page
from app.console.evidence import simulated_switch
from app.console.labels import shown_labels
from app.console.style import headline
from app.console.trial_rows import OUTCOME_WORDS, Filter, TrialRow, lines, trial_rows
from app.server.desk import Desk

_TABLE_PX = 560
_TABLE = "trials-table"
_COLUMNS = {
    "participant": st.column_config.TextColumn("Participant"),
    "comparison": st.column_config.NumberColumn("Comparison"),
    "slot": st.column_config.TextColumn("Method"),
    "trial": st.column_config.NumberColumn("Trial"),
    "mode": st.column_config.TextColumn("Mode"),
    "outcome": st.column_config.TextColumn("Outcome"),
    "duration_s": st.column_config.NumberColumn("Duration, s", format="%.1f"),
    "force_mean_n": st.column_config.NumberColumn("Mean force, N", format="%.1f"),
    "sigma_min": st.column_config.NumberColumn("σ min", format="%.4f"),
    "delay_ms": st.column_config.NumberColumn("Delay, ms", format="%.0f"),
    "source": st.column_config.TextColumn("Source"),
    "started": st.column_config.DatetimeColumn("Started", format="YYYY-MM-DD HH:mm", timezone="UTC"),
}


def show(desk: Desk) -> None:
    """The table, or a replay."""
    rows = trial_rows(desk)
    wanted = st.query_params.get(replay_page.TRIAL)
    if wanted:
        replay_page.show(desk, wanted, rows)
        return
    headline("Trials")
    simulated_switch(desk)
    rows = trial_rows(desk)
    if not rows:
        st.caption("No trials are stored yet.")
        return
    chosen = _filtered(desk, rows)
    st.caption(f"{len(chosen)} of {len(rows)} trials. Choose a line to see its replay.")
    table = pd.DataFrame([asdict(line) for line in lines(chosen)], columns=list(_COLUMNS))
    picked = st.dataframe(
        table.dropna(axis="columns", how="all"),
        hide_index=True,
        height=_TABLE_PX,
        column_config=_COLUMNS,
        on_select="rerun",
        selection_mode="single-row",
        key=_TABLE,
    )
    selected = picked["selection"]["rows"]
    if selected:
        replay_page.open_trial(chosen[selected[0]].trial.id)
        # Else the same line is chosen again as soon as the table is back.
        del st.session_state[_TABLE]
        st.rerun()


def _filtered(desk: Desk, rows: tuple[TrialRow, ...]) -> list[TrialRow]:
    people, outcomes, labels = st.columns(3)
    wanted = Filter(
        people=tuple(
            people.multiselect(
                "Participants", list(dict.fromkeys(row.who for row in rows)), placeholder="All"
            )
        ),
        outcomes=tuple(outcomes.multiselect("Outcomes", list(OUTCOME_WORDS.values()), placeholder="All")),
        labels=tuple(labels.multiselect("Modes", list(shown_labels(desk).values()), placeholder="All")),
    )
    return [row for row in rows if wanted.lets(row)]
