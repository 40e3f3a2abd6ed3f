"""Everybody can take part: no page breaks a rule that axe knows."""

import json
from collections.abc import Callable, Iterator
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import axe_playwright_python
import pytest
from playwright.sync_api import Page, WebSocketRoute, expect

from app.server.passphrase import VARIABLE
from app.server.visitors import PARTICIPANT_COOKIE, new_token
from data.records import Comparison, Device, Slot, Trial
from data.store import token_sha256

from .conftest import BACKGROUND, GUIDED_STUDY, Server, serving
from .drawn import until_drawn
from .test_external_runs import LAB_STUDY

if TYPE_CHECKING:
    from playwright.sync_api import Browser, ColorScheme

pytestmark = pytest.mark.browser
SIZE = {"width": 1280, "height": 800}
AXE = Path(axe_playwright_python.__file__).with_name("axe.min.js").read_text(encoding="utf-8")
RUN_AXE = """async () => {
    const { violations } = await axe.run(document, { resultTypes: ['violations'] });
    const marked = document.querySelectorAll('[data-testid="stException"]').length;
    const bad = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical');
    const told = bad.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html.slice(0, 160)).join(' | ')}`);
    return marked ? ['an exception is shown', ...told] : told;
}"""
THREE_COMPARISONS = (GUIDED_STUDY + BACKGROUND).replace("repetitions = 1", "repetitions = 3\nbreak_every = 2")
CONSOLE_PAGES = (
    "Overview", "Sessions", "Trials", "Modes", "Results", "Data", "Study file", "Links", "Planning",
)  # fmt: skip


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A guided study with all the pages that a study can have; a passphrase opens its console."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(VARIABLE, "seven green apples")
        with serving(tmp_path_factory.mktemp("access"), THREE_COMPARISONS) as running:
            yield running


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A study on a robot in the lab."""
    with serving(tmp_path_factory.mktemp("lab"), LAB_STUDY) as running:
        yield running


class Visit:
    """Somebody new in a browser of their own, taken to a page by what is stored of them.

    Parameters
    ----------
    size : dict
        Width and height of the window [px].
    """

    def __init__(
        self,
        chromium: "Browser",
        server: Server,
        scheme: "ColorScheme" = "light",
        device: Device = "keyboard",
        size: dict[str, int] = SIZE,
    ) -> None:
        self.server, self.device = server, device
        self.context = chromium.new_context(viewport=size, color_scheme=scheme)  # type: ignore[arg-type]
        self.page = self.context.new_page()
        self.who = ""

    def join(self, *, starts: bool = False) -> None:
        cookie, participant = self.server.join(starts=starts)
        self.who = participant.id
        self.context.add_cookies([{"name": PARTICIPANT_COOKIE, "value": cookie, "url": self.server.base}])

    def looks_at(self, address: str, sees: str | None = None) -> Page:
        """Open a page of the server, and wait until it shows a heading, the wall if there is to be one."""
        self.page.goto(self.server.base + address)
        if sees is None:
            expect(self.page.get_by_label("Wall", exact=True)).to_be_visible()
        else:
            expect(self.page.get_by_role("heading", name=sees).first).to_be_visible()
        until_drawn(self.page)
        return self.page

    def comparison(self, position: int) -> Comparison:
        return self.server.store.comparison(f"{self.who}.c{position}")

    def begin(self, position: int) -> None:
        self.server.store.start_comparison(self.comparison(position).id, self.server.store.clock())

    def guide(self, position: int) -> None:
        """So long that the questions open."""
        store, comparison = self.server.store, self.comparison(position)
        slots: tuple[Slot, Slot] = ("A", "B")
        for slot in slots:
            store.add_trial(
                Trial(
                    id=f"{comparison.id}.{slot}99",
                    comparison=comparison.id,
                    slot=slot,
                    number=99,
                    mode=comparison.mode_of(slot),
                    source="guided",
                    outcome="completed",
                    started_at=store.clock() - timedelta(seconds=2),
                    duration_s=1.0,
                    seed=0,
                )
            )

    def answer(self, position: int) -> None:
        study = self.server.store.studies()[0].study
        answers = {question.name: question.scale[0] for question in study.questions}
        self.server.store.submit_responses(self.comparison(position).id, answers, self.server.store.clock())


def participants_pages(visit: Visit) -> Iterator[tuple[str, Page]]:
    """Each page of a guided session, from consent to the last one."""
    store, now = visit.server.store, visit.server.store.clock
    yield "no link", visit.looks_at("/", "Please open your link")
    visit.page.goto(visit.server.participant_url)
    expect(visit.page.get_by_role("button", name="I agree")).to_be_visible()
    until_drawn(visit.page)
    yield "consent", visit.page
    visit.join()
    page = visit.looks_at("/", "A few questions about you")
    page.get_by_label("How old are you?").fill("7")
    page.get_by_role("button", name="Continue").click()
    expect(page.get_by_text("from 18 to 99")).to_be_visible()
    until_drawn(page)
    yield "background", page
    store.record_background(visit.who, {"years": "33"}, now())
    yield "instructions", visit.looks_at("/", "What you will do")
    yield "device", visit.looks_at("/?step=device", "How you guide the robot")
    store.record_device(visit.who, visit.device)
    yield "practice", visit.looks_at("/")
    store.record_practice(visit.who, now())
    yield "ready", visit.looks_at("/", "Next: compare two methods")
    visit.begin(1)
    yield "guide", visit.looks_at("/")
    yield "stuck", says_stuck(visit)
    visit.guide(1)
    yield "questions", visit.looks_at("/?step=questions-1", "Comparison 1 of 3")
    visit.answer(1)
    yield "between", visit.looks_at("/", "Your answers are stored")
    visit.begin(2)
    visit.guide(2)
    visit.answer(2)
    yield "break", visit.looks_at("/", "Time for a break")
    visit.begin(3)
    visit.guide(3)
    visit.answer(3)
    yield "thanks", visit.looks_at("/", "Thank you")
    store.withdraw(visit.who, "researcher", now())
    yield "withdrawn", visit.looks_at("/", "Your data were deleted")


def says_stuck(visit: Visit) -> Page:
    """The page as the server tells it that the robot got stuck."""

    def listen(socket: WebSocketRoute) -> None:
        server = socket.connect_to_server()

        def pass_on(message: str | bytes) -> None:
            socket.send(message)
            said = json.loads(message) if isinstance(message, str) else {}
            if said.get("type") == "trial":
                ended = {"slot": said["slot"], "trial": said["trial"], "outcome": "stuck", "next_in_s": 60.0}
                socket.send(json.dumps({"type": "ended", **ended}))

        server.on_message(pass_on)

    visit.page.route_web_socket("**/live", listen)
    page = visit.looks_at("/")
    expect(page.get_by_role("heading", name="The robot is stuck")).to_be_visible()
    return page


def researchers_pages(visit: Visit) -> Iterator[tuple[str, Page]]:
    """The console's door, and each page behind it."""
    yield "door", visit.looks_at("/researcher", "Elbowroom console")
    visit.page.get_by_label("Passphrase").fill("seven green apples")
    visit.page.keyboard.press("Enter")
    for name in CONSOLE_PAGES:
        visit.page.get_by_role("link", name=name, exact=True).click()
        title = "Zweifelhaft" if name == "Overview" else name
        expect(visit.page.get_by_role("heading", name=title, level=1)).to_be_visible()
        until_drawn(visit.page)
        yield name, visit.page


def lab_pages(visit: Visit) -> Iterator[tuple[str, Page]]:
    """A robot in the lab: the participant's page, and the operator's."""
    visit.join(starts=True)
    yield "external", visit.looks_at("/", "Comparison 1 of 1")
    # A link of its own, since it opens once.
    token = new_token()
    store = visit.server.store
    store.create_link("researcher", store.studies()[0], token_sha256(token))
    visit.page.goto(f"{visit.server.base}/researcher/{token}")
    visit.page.get_by_role("link", name="Operator").click()
    expect(visit.page.get_by_role("heading", name="as method A")).to_be_visible()
    until_drawn(visit.page)
    yield "operator", visit.page


def watching_pages(visit: Visit) -> Iterator[tuple[str, Page]]:
    """A robot that is only watched."""
    visit.join(starts=True)
    yield "watch", visit.looks_at("/")


Pages = Callable[[Visit], Iterator[tuple[str, Page]]]


def broken_rules(pages: Iterator[tuple[str, Page]]) -> dict[str, list[str]]:
    """What axe calls serious or critical, by page; it looks into shadow roots as well."""
    found = {}
    for name, page in pages:
        page.evaluate(AXE)
        if page.evaluate(RUN_AXE):
            # What was just fading, or drawn anew, isn't broken a moment later.
            until_drawn(page)
            if broken := page.evaluate(RUN_AXE):
                found[name] = broken
    return found


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(
    ("fixture", "pages"),
    [
        ("served", participants_pages),
        ("served", researchers_pages),
        ("lab", lab_pages),
        ("server", watching_pages),
    ],
    ids=["participant", "researcher", "lab", "watching"],
)
def test_no_page_breaks_a_serious_rule(
    chromium: "Browser", request: pytest.FixtureRequest, fixture: str, pages: Pages, scheme: "ColorScheme"
) -> None:
    visit = Visit(chromium, request.getfixturevalue(fixture), scheme)
    assert broken_rules(pages(visit)) == {}
    visit.context.close()
