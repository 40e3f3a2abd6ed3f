"""Results: the quick estimate as numbers, a table behind every chart; the full fit on request."""

import streamlit as st

from app.console.charts import percent, worth_chart
from app.console.evidence import evidence, reliability, simulated_switch
from app.console.findings import ONLY_THESE
from app.console.fit_card import fit_card
from app.console.style import card, heading, headline, table
from app.server.desk import Desk


def show(desk: Desk) -> None:
    """Each question with its chart and its table."""
    headline("Results")
    simulated_switch(desk)
    found = evidence(desk)
    if found.questions:
        fit_card(desk)
    st.caption(
        "A quick estimate while the study runs: the highest point of the pooled model and its curvature "
        "there. Participants' differences are left out, so intervals are too narrow. "
        "The full fit has them, is checked, and says when it must not rank."
    )
    if not found.questions:
        st.markdown(found.why_none)
    reliability(desk, found)
    for question in found.questions:
        with card(question.name):
            heading(f"{question.name}: {question.wording}")
            st.caption(f"{question.responses} answers")
            if not question.standings:
                st.markdown(question.reason)
                continue
            left, right = st.columns(2)
            left.altair_chart(worth_chart(question), width="stretch")
            with right:
                table(
                    ("Mode", "Worth", "94 % interval", "Chance to rank first"),
                    [
                        (s.label, f"{s.worth:.2f}", f"{s.low:.2f} to {s.high:.2f}", percent(s.p_best))
                        for s in question.standings
                    ],
                    numbers=(1, 2, 3),
                )
    if found.stuck:
        with card("stuck"):
            heading("Robot stuck, per comparison")
            table(
                ("Mode", "Comparisons", "Stuck", "Rate", "94 % interval"),
                [
                    (
                        r.label,
                        str(r.comparisons),
                        str(r.stuck),
                        percent(r.rate),
                        f"{percent(r.low)} to {percent(r.high)}",
                    )
                    for r in found.stuck
                ],
                numbers=(1, 2, 3, 4),
            )
            st.caption(ONLY_THESE)
