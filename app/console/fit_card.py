"""The full fit on the page Results: asking for it, watching it, reading and downloading what it gave."""

import streamlit as st

from app.console.aside_bar import running_bar
from app.console.evidence import includes_simulated
from app.console.full_fit import FittedReport, FullFit, full_fit, log_reading
from app.console.style import Mark, card, heading
from app.server.desk import Desk
from data.errors import ElbowroomError

_AGREED = "report-names-the-modes"


def fit_card(desk: Desk) -> None:
    """The card; it goes on while other pages are shown, and is the same for every researcher."""
    with card("full-fit"):
        heading("Full fit")
        st.markdown(
            "The model with participants' differences, checked for convergence, as `elbowroom report` "
            "writes it: a page with figures and tables. It takes seconds to minutes, in a process of its own."
        )
        if full_fit().state == "running":
            running_bar(full_fit())
        else:
            _rest(desk, full_fit())


def _rest(desk: Desk, fit: FullFit) -> None:
    """What there is while nothing is under way."""
    is_blinded = not desk.store.is_unblinded(desk.stored_study)
    agreed = not is_blinded or st.checkbox(
        "The report names the modes. I know that I am not blind to the results once I read it.", key=_AGREED
    )
    if fit.state == "failed":
        why = fit.trouble if agreed else "tick the box to read why"
        st.html(f"<p>{Mark('bad', f'The last fit failed: {why}').html}</p>")
    elif fit.state == "cancelled":
        st.caption("The last fit was cancelled.")
    has_report = fit.report is not None
    with st.container(horizontal=True, vertical_alignment="center"):
        if fit.report is not None and agreed:
            _report(desk, fit.report)
        name = "Fit again" if has_report else "Fit the full model"
        if st.button(name, disabled=not agreed, type="secondary" if has_report else "primary"):
            try:
                fit.start(desk, includes_simulated())
            except ElbowroomError as error:
                st.error(str(error))
            else:
                st.rerun()


def _report(desk: Desk, report: FittedReport) -> None:
    st.link_button("Open the report", "/report/report.html", type="primary")
    name = f"{desk.study.name}-report-{report.finished_at:%Y%m%d-%H%M}.zip"
    st.download_button(
        "Download the report",
        report.zipped,
        file_name=name,
        mime="application/zip",
        on_click=lambda: log_reading(desk, "download report"),
    )
    simulated = ", with simulated participants" if report.includes_simulated else ""
    st.caption(f"Fitted {report.finished_at:%Y-%m-%d %H:%M} UTC{simulated}.")
