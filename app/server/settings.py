"""Streamlit's options, set by the program: no file or variable of the place it is started from decides."""

from app.server.public_url import PublicUrl

LIGHT = {
    "backgroundColor": "#FAFAF8",
    "secondaryBackgroundColor": "#F1F2EF",
    "textColor": "#1D2930",
    "primaryColor": "#22404E",
    "borderColor": "#DDE1DE",
    "linkColor": "#22404E",
    "codeTextColor": "#1D2930",
}
DARK = {
    "backgroundColor": "#12181C",
    "secondaryBackgroundColor": "#222C33",
    "textColor": "#E8EDEF",
    "primaryColor": "#D5E3E9",
    "borderColor": "#313D45",
    "linkColor": "#D5E3E9",
    "codeTextColor": "#E8EDEF",
}
_SANS = '-apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif'

OPTIONS: dict[str, object] = {
    "browser.gatherUsageStats": False,
    "client.showErrorDetails": "none",
    "client.showErrorLinks": False,
    "client.toolbarMode": "minimal",
    "logger.level": "error",
    "runner.magicEnabled": False,
    "server.enableStaticServing": False,
    "server.fileWatcherType": "none",
    "server.headless": True,
    "server.maxUploadSize": 1,
    "theme.font": _SANS,
    "theme.baseRadius": "8px",
    "theme.buttonRadius": "8px",
    **{f"theme.light.{name}": value for name, value in LIGHT.items()},
    **{f"theme.dark.{name}": value for name, value in DARK.items()},
}


def apply_settings(public_url: PublicUrl | None = None) -> None:
    """Set the options; before the app is built, which reads some of them once."""
    from streamlit import config

    for name, value in OPTIONS.items():
        config.set_option(name, value)
    if public_url is not None:
        # Streamlit compares Origin with Host as well, and a proxy may have changed Host.
        config.set_option("browser.serverAddress", public_url.host)
