"""From an input to the first picture of a state that was computed with it: median and 95th percentile [ms].

``python -m tests.benchmarks.live_latency [--seconds 30]`` serves the built-in study and lets a pointer
that lives in the page move the nozzle to and fro on the wall, at moments that know nothing of the display's.
The page measures, as it does for every participant, and the figures are read from the store.
"""

import argparse
import shutil
import tempfile
from pathlib import Path

from playwright.sync_api import expect, sync_playwright

from app.server.visitors import PARTICIPANT_COOKIE
from data.study_file import study_text
from tests.app.conftest import serving
from tests.conftest import FLAGS

TIMEOUT_MS = 90_000
MOVE = """async (seconds) => {
  const find = (root) => {
    for (const e of root.querySelectorAll('*')) {
      if (e.matches('section.wall')) return e;
      const inside = e.shadowRoot && find(e.shadowRoot);
      if (inside) return inside;
    }
    return null;
  };
  const wall = find(document);
  const box = wall.getBoundingClientRect();
  const point = (t) => ({
    clientX: box.left + box.width * (0.3 + 0.1 * Math.sin(0.8 * t)),
    clientY: box.top + box.height * (0.35 + 0.1 * Math.sin(0.5 * t)),
  });
  const tell = (type, t, buttons) =>
    wall.dispatchEvent(new PointerEvent(type, { ...point(t), pointerId: 7, buttons,
      button: type === 'pointermove' ? -1 : 0, bubbles: true, pointerType: 'mouse' }));
  const begun = performance.now();
  const passed = () => (performance.now() - begun) / 1000;
  tell('pointerdown', 0, 1);
  while (passed() < seconds) {
    await new Promise((resolve) => setTimeout(resolve, 4 + 20 * Math.random()));
    tell('pointermove', passed(), 1);
  }
  tell('pointerup', passed(), 0);
}"""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=30.0)
    chosen = parser.parse_args()
    folder = Path(tempfile.mkdtemp())
    try:
        with serving(folder, study_text("carmichael2017")) as server, sync_playwright() as playwright:
            cookie, participant = server.join()
            server.store.record_background(participant.id, {}, server.store.clock())
            server.store.record_device(participant.id, "mouse")
            server.store.record_practice(participant.id, server.store.clock())
            browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=list(FLAGS))
            context = browser.new_context(viewport={"width": 1280, "height": 800})
            context.add_cookies([{"name": PARTICIPANT_COOKIE, "value": cookie, "url": server.base}])
            context.set_default_timeout(TIMEOUT_MS)
            page = context.new_page()
            page.goto(server.base)
            for slot in ("A", "B"):
                page.get_by_role("radio", name=f"Method {slot}", exact=True).check()
                status = page.locator(f".option.{slot.lower()} .status")
                expect(status).to_have_text("in your hand now", timeout=TIMEOUT_MS)
                page.evaluate(MOVE, chosen.seconds / 2)
            page.get_by_role("radio", name="Method A", exact=True).check()
            page.wait_for_timeout(1500)
            for trial in server.store.trials(comparison=f"{participant.id}.c1"):
                found = trial.metrics
                skipped = found["skipped_ticks"] / (found["ticks"] + found["skipped_ticks"])
                delays = f"median {found['latency_median_ms']:.1f} ms, p95 {found['latency_p95_ms']:.1f} ms"
                print(f"{trial.slot}: {delays} of {found['latency_samples']:.0f} inputs", end="; ")
                print(
                    f"{found['frame_rate_hz']:.1f} pictures a second; {skipped:.2%} of control ticks skipped"
                )
            browser.close()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
