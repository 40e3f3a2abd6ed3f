"""The script that Streamlit runs for every page: the console at its own addresses, else the study.

Streamlit makes it the process's main module, which a worker process that starts later imports, under another
name: there it must do nothing.
"""

if __name__ == "__main__":
    from urllib.parse import urlsplit

    import streamlit as st

    from app.console.pages import PATHS, show_console
    from app.participant.pages import show_study

    if urlsplit(st.context.url or "").path.strip("/") in PATHS:
        show_console()
    else:
        show_study()
