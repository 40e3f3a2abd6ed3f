"""When a page is drawn."""

from playwright.sync_api import Page

_IS_DRAWN = """() => {
    const app = document.querySelector('[data-testid="stApp"]');
    const under = '[data-stale="true"], [data-testid="stSkeleton"]';
    const moves = (a) => a.playState === 'running' && a.effect.getComputedTiming().endTime < Infinity;
    if (app && (app.dataset.testScriptState !== 'notRunning' || app.querySelector(under))) return false;
    return !document.getAnimations().some(moves);
}"""


def until_drawn(page: Page) -> None:
    """Wait until the page's script is through, and nothing is left of what the page showed before.

    What was asked of the page must show already: before the server has heard of a click, the script isn't
    running either.
    """
    page.wait_for_function(_IS_DRAWN)
