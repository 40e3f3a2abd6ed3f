"""A headless browser for the tests that are marked ``browser``, and how patient tests are."""

import os
import shutil
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

if TYPE_CHECKING:
    from playwright.sync_api import Browser

PATIENCE_S = 120.0
"""So long a test waits for what must come [s]: a loaded machine takes its time, and so does compiling."""
FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # WebGL without a graphics card.
    "--enable-unsafe-swiftshader",
)

# How long an example takes says nothing on a loaded machine.
settings.register_profile(
    "patient", parent=settings(), deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("patient")


@pytest.fixture(scope="session")
def chromium() -> Iterator["Browser"]:
    """Chromium with a fresh profile; ``CHROMIUM`` names another program than the one on the PATH.

    Whatever a test looks for on a page, or clicks on, it waits for as long as `PATIENCE_S`.
    """
    program = os.environ.get("CHROMIUM") or shutil.which("chromium")
    if program is None:
        reason = "no Chromium on the PATH: apt-get install chromium"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    from playwright.sync_api import expect, sync_playwright

    patience_ms = 1000 * PATIENCE_S
    expect.set_options(timeout=patience_ms)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=list(FLAGS), timeout=patience_ms)
        browser.on("context", lambda context: context.set_default_timeout(patience_ms))
        yield browser
        browser.close()
