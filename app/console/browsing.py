"""The study's data as tables to sort and search, under the labels that are shown now."""

from collections.abc import Callable, Mapping

import pandas as pd
import streamlit as st

from app.console.evidence import includes_simulated
from app.console.labels import shown_labels
from app.console.trial_rows import TrialRow, trial_rows
from app.server.desk import Desk
from data.errors import InputError
from data.records import Participant

_TABLE_PX = 320


def browse(desk: Desk) -> None:
    """Responses, trials or participants."""
    tables: dict[str, Callable[[Desk], pd.DataFrame]] = {
        "Responses": responses_table,
        "Trials": trials_table,
        "Participants": participants_table,
    }
    choice = st.segmented_control("Table", list(tables), default="Responses", label_visibility="collapsed")
    if choice is None:
        return
    table = tables[choice](desk)
    if table.empty:
        st.caption("Nothing is stored yet.")
        return
    labels = (
        "by name" if desk.store.is_unblinded(desk.stored_study) else "by letter while the study is blinded"
    )
    st.caption(f"{len(table)} rows; modes {labels}. Click a column's name to sort.")
    st.dataframe(table, hide_index=True, height=_TABLE_PX)


def responses_table(desk: Desk) -> pd.DataFrame:
    """One row an answer: who, which comparison, what stood for A and for B, the question, the answer."""
    try:
        rows = desk.store.responses_table(desk.stored_study, includes_simulated()).rows
    except InputError:
        return pd.DataFrame()
    labels, people = shown_labels(desk), _people(desk)
    return pd.DataFrame(
        {
            "participant": [_name(people[one]) for one in rows["participant"]],
            "comparison": [int(one.rpartition(".c")[2]) for one in rows["comparison"]],
            "repetition": rows["repetition"],
            "A": rows["mode_a"].map(dict(labels)),
            "B": rows["mode_b"].map(dict(labels)),
            "question": rows["question"],
            "answer": rows["response"],
            "check": rows["check"],
            "count": rows["count"],
        }
    )


def trials_table(desk: Desk) -> pd.DataFrame:
    """One row a trial, with all its metrics."""
    return pd.DataFrame([_trial(row) for row in trial_rows(desk)])


def participants_table(desk: Desk) -> pd.DataFrame:
    """One row a participant, with what they said about themselves."""
    asked = [question.name for question in desk.study.background]
    rows = [
        {
            "participant": _name(person),
            "source": person.source,
            "joined": person.joined_at,
            "consented": person.consented_at,
            "consent": person.consent_version,
            "input": person.device,
            "practised": person.practised_at,
            "finished": person.finished_at,
            "withdrawn": person.withdrawn_at,
            **{name: person.background.get(name) for name in asked},
        }
        for person in _people(desk).values()
    ]
    return pd.DataFrame(rows)


def _trial(row: TrialRow) -> dict[str, object]:
    trial = row.trial
    return {
        "participant": row.who,
        "comparison": row.comparison.position,
        "method": trial.slot,
        "trial": trial.number,
        "mode": row.label,
        "outcome": trial.outcome,
        "source": trial.source,
        "started": trial.started_at,
        **dict(sorted(trial.metrics.items())),
    }


def _people(desk: Desk) -> Mapping[str, Participant]:
    everyone = desk.store.participants(desk.stored_study)
    return {p.id: p for p in everyone if p.source == "human" or includes_simulated()}


def _name(person: Participant) -> str:
    return f"{'P' if person.source == 'human' else 'S'}{person.number:02d}"
