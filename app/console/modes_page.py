"""Modes: what each one does near the singularity and on the maze, for whoever chooses what to compare."""

import streamlit as st

from app.atlas import PAGE, Atlas, atlas_page, with_every_method, with_modes
from app.atlas_tables import (
    CURVES_SAY,
    LAPS_SAY,
    Cells,
    by_method,
    claims,
    curves_table,
    laps_table,
    names,
    parameters_table,
    verdicts,
)
from app.console.aside_bar import running_bar
from app.console.charts import drawing
from app.console.mode_bench import ModeBench, mode_bench
from app.console.style import Mark, card, heading, headline, table
from app.server.desk import Desk
from app.studies import resolved_modes
from data.study import Study
from sim_trials.modes.method import ResolvedMode
from sim_trials.standstill import caution

_CHOSEN, _LAPS = "modes-chosen", "modes-with-laps"
_KEPT = "modes-kept"
"""What was chosen, while another page is shown: Streamlit forgets what no page shows."""
_FEW = 4
"""Up to so many rules stand open."""


def show(desk: Desk) -> None:
    """The choice, what was worked out of it, and the rules."""
    headline("Modes")
    study = with_every_method(desk.study)
    own = tuple(mode.name for mode in study.modes if mode.name in desk.study.mode_names)
    says = "What the modes of this study, and every method that is known, do in simulation."
    if not desk.store.is_unblinded(desk.stored_study):
        says += (
            " This page names the modes, as the study file does. Which letter is which in the results it"
            " doesn't say, but a mode that gets stuck in simulated laps may be told by that."
        )
    st.caption(says)
    bench = mode_bench()
    with card("choice"):
        heading("What to compare")
        if not own:
            st.caption("This study's modes run on a robot in the lab: the simulator knows nothing of them.")
        chosen = _choice(study, own)
        _work(bench, study, chosen)
    if not chosen:
        return
    modes = resolved_modes(with_modes(study, chosen), desk.study.name)
    for mode in modes:
        if said := caution(mode, study.maze):
            st.html(f"<p>{Mark('warn', f'{mode.name} {said}.').html}</p>")
    found = bench.atlas(study, chosen)
    if found is not None:
        _curves(found)
        _laps(found, len(chosen))
    _rules(modes)


def _choice(study: Study, own: tuple[str, ...]) -> tuple[str, ...]:
    """The modes that were chosen, in the study's order and then the alphabet's."""
    every = tuple(mode.name for mode in study.modes)
    methods = {mode.name: mode.method for mode in study.modes}
    if _CHOSEN not in st.session_state:
        st.session_state[_CHOSEN] = st.session_state.get(_KEPT, list(own))

    def said(name: str) -> str:
        return f"{name} ({methods[name]})" if name in own else f"{methods[name]}, at its defaults"

    chosen = st.multiselect("Modes", every, key=_CHOSEN, format_func=said, placeholder="Choose modes")
    with st.container(horizontal=True):
        for label, modes in (("This study's modes", own), ("Every known method", every)):
            if modes:
                st.button(label, on_click=_choose, args=(modes,))
    st.session_state[_KEPT] = chosen
    return tuple(name for name in every if name in chosen)


def _choose(modes: tuple[str, ...]) -> None:
    st.session_state[_CHOSEN] = list(modes)


def _work(bench: ModeBench, study: Study, chosen: tuple[str, ...]) -> None:
    """The button that compares them, or how far that has come."""
    if bench.state == "running":
        running_bar(bench, bench.given)
        return
    with_laps = st.checkbox("With laps on the maze: some seconds a mode", value=True, key=_LAPS)
    if bench.state == "failed":
        st.html(f"<p>{Mark('bad', f'The last comparison failed: {bench.trouble}').html}</p>")
    elif bench.state == "cancelled":
        st.caption("The last comparison was cancelled.")
    if st.button("Compare", type="primary", disabled=not chosen):
        bench.start(study, chosen, with_laps)
        st.rerun()


def _curves(found: Atlas) -> None:
    with card("curves"):
        heading("Into the lock and out of it")
        st.caption(CURVES_SAY)
        drawing(found.drawing)
        _show(curves_table(found.curves))


def _laps(found: Atlas, n: int) -> None:
    with card("laps"):
        heading("On the maze", "simulated")
        if not found.laps:
            st.caption("No laps were run yet.")
            return
        st.caption(LAPS_SAY.format(n=len(found.laps[0].laps)))
        _show(laps_table(found.laps))
        st.markdown("\n".join(f"- {said}" for said in verdicts(found.laps)))
        if len(found.laps) < n:
            st.caption(f"{len(found.laps)} of {n} modes so far.")
        st.download_button(
            "Download as one page", lambda: atlas_page(found), file_name=PAGE, mime="text/html"
        )


def _rules(modes: tuple[ResolvedMode, ...]) -> None:
    methods = by_method(modes)
    with card("rules"):
        heading("Rules")
        for alike in methods:
            method, called = alike[0].method, names(alike)
            title = f"**{method.name}**" + (f" ({called})" if called else "")
            with st.expander(title, expanded=len(methods) <= _FEW):
                st.markdown(f"{method.summary}.")
                if method.latex:
                    st.latex(method.latex)
                st.caption(f"`{method.equation}`")
                _show(parameters_table(alike))
                st.caption(f"{method.source}. Tested claims: {claims(method)}.")


def _show(cells: Cells) -> None:
    table(cells.head, cells.rows, numbers=cells.numbers)
