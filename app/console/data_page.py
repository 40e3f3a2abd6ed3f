"""Data: tables to browse, the export as one file, and the audit log."""

import io
import tempfile
import zipfile
from pathlib import Path

import streamlit as st

from app.console.browsing import browse
from app.console.evidence import includes_simulated, simulated_switch
from app.console.style import card, heading, headline, table
from app.server.desk import Desk
from data.errors import ElbowroomError
from data.export import export_study

_LOG_ROWS = 50


def show(desk: Desk) -> None:
    """Tables, export and audit log."""
    headline("Data")
    simulated_switch(desk)
    with card("browse"):
        heading("Browse")
        browse(desk)
    with card("export"):
        heading("Export")
        _export(desk)
    with card("audit"):
        heading("Audit log")
        st.caption(desk.store.verify_audit().sentence)
        entries = desk.store.audit_log()[: -_LOG_ROWS - 1 : -1]
        table(
            ("Number", "When", "Who", "What", "With"),
            [
                (
                    str(e.number),
                    e.at.strftime("%Y-%m-%d %H:%M:%S UTC"),
                    e.actor,
                    e.action,
                    ", ".join(f"{name} {value}" for name, value in e.detail.items() if name != "sha256"),
                )
                for e in entries
            ],
        )


def _export(desk: Desk) -> None:
    st.markdown("Tidy CSV tables, a codebook, the study file and every recording, in one ZIP file.")
    is_blinded = not desk.store.is_unblinded(desk.stored_study)
    agreed = not is_blinded or st.checkbox(
        "The export names the modes. I know that I am not blind to what is in it."
    )
    if st.button("Prepare the export", disabled=not agreed):
        try:
            with st.spinner("Writing the export"):
                content = _zipped(desk)
        except ElbowroomError as error:
            st.error(str(error))
            return
        detail = {"study": desk.stored_study.label, "blinded": "yes" if is_blinded else "no"}
        desk.store.log("researcher", "export", detail, desk.clock())
        name = f"{desk.study.name}-{desk.clock():%Y%m%d-%H%M}.zip"
        st.download_button(
            "Download the export", content, file_name=name, mime="application/zip", type="primary"
        )


def _zipped(desk: Desk) -> bytes:
    content = io.BytesIO()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "export"
        export_study(desk.store, desk.stored_study, folder, include_simulated=includes_simulated())
        with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
            for file in sorted(folder.rglob("*")):
                archive.write(file, file.relative_to(folder))
    return content.getvalue()
