"""How far work beside the server has come, and a button to give it up."""

import streamlit as st

from app.console.aside import Aside

_REFRESH_S = 1


@st.fragment(run_every=_REFRESH_S)
def running_bar(aside: Aside, seen: int = 0) -> None:
    """The bar, read anew every second; when the work ends, or has given more, the whole page is.

    Parameters
    ----------
    aside : Aside
    seen : int
        How many results the page shows already (`Aside.given`).
    """
    if aside.state != "running" or aside.given > seen:
        st.rerun()
    step = aside.step
    words = f"{step.part}: {step.done} of {step.total}" if step.part else "Starting"
    words += f", {step.now}" if step.now else ""
    bar, button = st.columns([0.84, 0.16], vertical_alignment="center")
    bar.progress(min(1.0, step.done / step.total), text=words)
    # In a callback: the bar is drawn anew every second, and no click may get lost on its way to the button.
    button.button("Cancel", width="stretch", on_click=aside.cancel)
