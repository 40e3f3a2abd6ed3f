"""A scripted hand takes part in a whole guided session, by mouse in a real browser.

``python -m tests.app.guided_session --out DIR`` serves the 2017 study, follows its link in headless Chromium,
agrees, practises, guides the robot under A and B in every comparison, answers, and reaches the last page.
Then it writes the export and prints what the store holds. The study is renamed, so that nobody takes its
answers for a person's.
"""

import argparse
import math
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from statistics import median

from playwright.sync_api import Error, Locator, Page, expect, sync_playwright
from rich.console import Console
from rich.table import Table

from data.study import Study
from data.study_file import parse_study, study_text
from sim_trials.live import HandInput
from sim_trials.scripted_hand import ScriptedHand
from tests.conftest import FLAGS, PATIENCE_S

from .conftest import Server, serving
from .scene import Hold, Scene

STEP_S = 1 / 50
NOTCH_PX, NOTCH_DEG = 100.0, 6.0
"""A notch of the wheel, and the tilt it asks for (``app/stage/modules/devices/mouse.js``)."""
WHEEL_EVERY_S = 0.1
"""Sooner than the wanted tilt springs back."""


class MouseHand:
    """Moves the mouse as the scripted hand says, from taking the nozzle until the lap or the time is over."""

    def __init__(self, scene: Scene, study: Study, pace_m_s: float) -> None:
        self.scene, self.study = scene, study
        self.hand = ScriptedHand(study, pace_m_s)
        self._lean = (0.0, 0.0)
        self._wheeled = -math.inf

    def guide(self, seconds: float) -> bool:
        """Guide for a while; whether the lap ended by itself."""
        scene, mouse, keyboard = self.scene, self.scene.page.mouse, self.scene.page.keyboard
        assert scene.state is not None
        trial = scene.state.trial
        view = scene.state.view
        mouse.move(*scene.at(view.cursor_y_m, view.cursor_z_m))
        hold = Hold(scene, mouse.down, mouse.up)
        begun = looked = time.monotonic()
        while time.monotonic() - begun < seconds and not self._is_over(trial):
            hold.look()
            now = time.monotonic()
            wanted = self.hand.aim(scene.state.view, max(now - looked, 1e-3))
            looked = now
            mouse.move(*scene.at(wanted.y_m, wanted.z_m))
            if wanted.blast and not scene.state.view.is_spraying:
                # A key that is held comes again and again.
                keyboard.down(" ")
            self._tilt(wanted, now)
            scene.page.wait_for_timeout(max(0.0, 1000 * (STEP_S - (time.monotonic() - now))))
        over = self._is_over(trial)
        keyboard.up(" ")
        mouse.up()
        return over

    def _is_over(self, trial: int) -> bool:
        state = self.scene.state
        return state is None or state.trial != trial or state.has_ended

    def _tilt(self, wanted: HandInput, now: float) -> None:
        lean = (wanted.tilt_y_deg, wanted.tilt_z_deg)
        if now - self._wheeled < WHEEL_EVERY_S or lean == self._lean == (0.0, 0.0):
            return
        change_y, change_z = (wanted - had for wanted, had in zip(lean, self._lean, strict=True))
        # A wheel to the right, or down, is one towards -y; with Shift towards -z.
        keyboard, mouse = self.scene.page.keyboard, self.scene.page.mouse
        mouse.wheel(0, -change_y / NOTCH_DEG * NOTCH_PX or 0.01)
        if abs(change_z) > 0.05:
            keyboard.down("Shift")
            mouse.wheel(0, -change_z / NOTCH_DEG * NOTCH_PX)
            keyboard.up("Shift")
        self._lean, self._wheeled = lean, now


def picture(page: Page, folder: Path | None, name: str) -> None:
    """Keep how the page looks."""
    if folder is not None:
        page.screenshot(path=folder / f"{name}.png")


def through(page: Page, study: Study, pace_m_s: float, pictures: Path | None) -> None:
    """From consent to Thank you."""
    practice = Scene(page, study.practice_study.maze)
    page.get_by_role("button", name="I agree to take part").click()
    if study.background:
        expect(page.get_by_role("radiogroup").first).to_be_visible()
        picture(page, pictures, "background")
    wall = page.get_by_label("Wall", exact=True)
    lead_on(page, wall, pictures)
    if study.has_practice:
        practice.until_trial(after=0)
        hand = MouseHand(practice, study.practice_study, pace_m_s)
        hand.guide(4.0)
        picture(page, pictures, "practice")
        while not hand.guide(120.0):
            pass
        picture(page, pictures, "practised")
        page.get_by_role("button", name="Continue").click()
    for number in range(
        1, 1 + len(study.pairs) * study.protocol.repetitions + study.protocol.attention_checks
    ):
        compare(page, study, pace_m_s, number, pictures)
    expect(page.get_by_role("heading", name="Thank you")).to_be_visible()
    picture(page, pictures, "thanks")


def lead_on(page: Page, goal: Locator, pictures: Path | None = None) -> None:
    """Through the pages that only lead on, until something is there."""
    go_on = page.get_by_role("button", name="Continue")
    seen: set[str] = set()
    end = time.monotonic() + PATIENCE_S
    while not goal.is_visible():
        assert time.monotonic() < end, f"{goal} never came"
        # The page may turn at any of these steps.
        with suppress(Error):
            if go_on.count() == 1 and go_on.is_enabled(timeout=500):
                title = page.get_by_role("heading").first.inner_text(timeout=500)
                if title not in seen:
                    picture(page, pictures, f"page_{len(seen)}_{title.lower().replace(' ', '_')[:24]}")
                    go_on.click(timeout=2000)
                    seen.add(title)
        page.wait_for_timeout(100)


def compare(page: Page, study: Study, pace_m_s: float, number: int, pictures: Path | None) -> None:
    """One comparison: a lap and more with A and with B, then the questions."""
    scene = Scene(page, study.maze)
    first = page.get_by_role("radio", name="Method A", exact=True)
    lead_on(page, first, pictures if number in (1, 2, 4) else None)
    answer = page.get_by_role("button", name="Answer the questions")
    done = 0  # the last trial before the method that is tried now
    for slot in ("A", "B"):
        chosen = page.get_by_role("radio", name=f"Method {slot}", exact=True)
        if not chosen.is_checked():
            done = scene.trial
            chosen.check()
        scene.until_trial(after=done)
        lap = MouseHand(scene, study, pace_m_s)
        lap.guide(15.0)
        picture(page, pictures, f"guide_{number}{slot}")
        # To the end of the lap at least, and for the least time.
        while not lap.guide(120.0):
            pass
        page.wait_for_timeout(300)
        picture(page, pictures, f"end_{number}{slot}")
        while (missing := study.protocol.minimum_exposure_s + 1 - exposure(scene, done)) > 0:
            assert scene.state is not None
            scene.until_trial(after=scene.trial if scene.state.has_ended else 0)
            MouseHand(scene, study, pace_m_s).guide(missing)
    expect(answer).to_have_attribute("aria-disabled", "false")
    answer.click()
    expect(page.get_by_role("button", name="Submit answers")).to_be_visible()
    expect(page.get_by_label("Wall", exact=True)).to_have_count(0)
    for k, group in enumerate(page.get_by_role("radiogroup").all()):
        options = group.get_by_role("radio")
        options.nth((number + k) % options.count()).check()
    picture(page, pictures, f"questions_{number}")
    page.get_by_role("button", name="Submit answers").click()


def exposure(scene: Scene, after: int) -> float:
    """How long the robot was in hand in the trials after one [s]."""
    return sum(seconds for trial, seconds in scene.times_s.items() if trial > after)


def told(server: Server) -> Table:
    """What the store holds of the session."""
    table = Table("Comparison", "A", "B", "Switches", "Answers", "Delay [ms]", "Frames [Hz]", "Skipped [%]")
    for comparison in server.store.comparisons(server.store.studies()[0]):
        trials = server.store.trials(comparison=comparison.id)
        ends = {
            slot: f"{comparison.mode_of(slot)}: " + ", ".join(
                f"{trial.outcome} {trial.duration_s:.0f} s" for trial in trials if trial.slot == slot
            )
            for slot in ("A", "B")
        }  # fmt: skip
        delays = [
            trial.metrics["latency_median_ms"] for trial in trials if "latency_median_ms" in trial.metrics
        ]
        worst = [trial.metrics["latency_p95_ms"] for trial in trials if "latency_p95_ms" in trial.metrics]
        rates = [trial.metrics["frame_rate_hz"] for trial in trials if "frame_rate_hz" in trial.metrics]
        ticks = sum(trial.metrics.get("ticks", 0.0) for trial in trials)
        skipped = sum(trial.metrics.get("skipped_ticks", 0.0) for trial in trials)
        table.add_row(
            str(comparison.position),
            ends["A"],
            ends["B"],
            str(len(server.store.switches(comparison.id))),
            str(len(server.store.responses(comparison.id))),
            f"{median(delays):.1f}, p95 {median(worst):.1f}" if delays else "",
            f"{median(rates):.0f}" if rates else "",
            f"{100 * skipped / max(ticks + skipped, 1):.2f}",
        )
    return table


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--study", default="carmichael2017", help="a built-in study or a study file")
    parser.add_argument("--out", type=Path, required=True, help="a new folder for store, export and pictures")
    parser.add_argument("--pace", type=float, default=0.10, help="how fast the hand follows the line [m/s]")
    parser.add_argument(
        "--comparisons", choices=["all", "pairs"], default="all", help="pairs: each pair once"
    )
    parser.add_argument("--pictures", action="store_true", help="keep screenshots of the pages")
    parser.add_argument("--size", default="1280x800", help="of the window [px]")
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True)
    text = study_text(chosen.study)
    study = parse_study(text, where=chosen.study)
    text = text.replace(f'name = "{study.name}"', f'name = "{study.name}-scripted"', 1)
    text = text.replace(f'title = "{study.title}"', f'title = "Scripted hand: {study.title}"', 1)
    if chosen.comparisons == "pairs":
        text = text.replace(f"repetitions = {study.protocol.repetitions}", "repetitions = 1", 1)
    study = parse_study(text, where=chosen.study)
    pictures = chosen.out / "pictures" if chosen.pictures else None
    if pictures is not None:
        pictures.mkdir()
    width, height = (int(side) for side in chosen.size.split("x"))
    console = Console(width=140)
    begun = time.monotonic()
    with serving(chosen.out, text) as server, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=list(FLAGS))
        page = browser.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(1000 * PATIENCE_S)
        expect.set_options(timeout=1000 * PATIENCE_S)
        page.goto(server.participant_url)
        picture(page, pictures, "consent")
        through(page, study, chosen.pace, pictures)
        browser.close()
        console.print(told(server))
    export = chosen.out / "export"
    store = chosen.out / "study.sqlite"
    command = [sys.executable, "-m", "app.cli", "export", "--store", str(store), "--out", str(export)]
    subprocess.run(command, check=True)
    console.print(f"{time.monotonic() - begun:.0f} s; store {store}, export {export}")


if __name__ == "__main__":
    main()
