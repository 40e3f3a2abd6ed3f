"""Study file: what this study is, as it is stored."""

import streamlit as st

from app.console.style import headline, table
from app.server.desk import Desk


def show(desk: Desk) -> None:
    """Its facts, then the file itself."""
    stored, study = desk.stored_study, desk.study
    headline("Study file", (stored.label, stored.sha256[:8]))
    protocol = study.protocol
    table(
        ("What", "Value"),
        [
            ("Title", study.title),
            ("Modes", str(len(study.modes))),
            ("Pairs", str(len(study.pairs))),
            ("Showings of each pair", str(protocol.repetitions)),
            ("Laps per method and comparison", str(protocol.laps_per_condition)),
            ("Least time with each method", f"{protocol.minimum_exposure_s:g} s"),
            ("Attention checks", str(protocol.attention_checks)),
            ("Planned participants", str(protocol.planned_participants)),
            ("Hash", stored.sha256),
        ],
    )
    st.code(stored.toml, language=None)
    st.download_button(
        "Download the study file", stored.toml, file_name=f"{study.name}.toml", mime="application/toml"
    )
