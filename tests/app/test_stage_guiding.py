"""The stage's modules for guiding, run as the browser runs them: the wire, the socket, the devices."""

import numpy as np
import pytest
from playwright.sync_api import Page

from app.server.live.wire import ENABLED, SPRAYING, STATE, STROKES, InputFrame, unpack_input

from .conftest import run_module

pytestmark = pytest.mark.browser


def test_the_server_reads_an_input_as_the_page_means_it(stage_page: Page) -> None:
    sent = run_module(
        stage_page,
        "wire",
        """const input = { y: 0.25, z: -0.5, tiltY: 12.5, tiltZ: -3.25, enable: true, blast: true };
        const facts = { device: 'touch', seq: 70000, latency: 17.5, frames: 123456, clock: 98765.4321 };
        return [...new Uint8Array(m.packInput(input, facts))];""",
    )
    assert isinstance(sent, list)
    assert unpack_input(bytes(sent)) == InputFrame(
        3, "touch", 70000, 0.25, -0.5, 12.5, -3.25, 17.5, 123456, 98765.4321
    )


def test_the_page_reads_a_state_as_the_server_means_it(stage_page: Page) -> None:
    numbers = (1.5, 0.25, 0.5, 3.0, -4.0, 0.125, 0.75, 0.5, 0.0625, 0.25, *(0.5 * i for i in range(6)))
    state = STATE.pack(2, 1, ENABLED | SPRAYING, 0, 7, 99, 41, *numbers)
    found = run_module(
        stage_page, "wire", "return m.unpack(new Uint8Array(given).buffer).state;", list(state)
    )
    assert isinstance(found, dict)
    assert found.pop("direction") == pytest.approx(np.arctan2(4.0, -3.0))
    assert found == {
        "trial": 7, "frame": 99, "inputSeq": 41, "t": 1.5, "y": 0.25, "z": 0.5, "tilt": 5.0,
        "hand": {"y": 0.125, "z": 0.75}, "pull": 0.5, "speed": 0.0625, "share": 0.25, "moving": True,
        "spraying": True, "resting": False, "ended": False, "q": [0.0, 0.5, 1.0, 1.5, 2.0, 2.5],
    }  # fmt: skip


STAGED_SOCKET = """
    const sockets = [], waits = [], heard = [];
    class Staged {
      constructor() { this.bufferedAmount = 0; this.sent = []; sockets.push(this); }
      send(what) { this.sent.push(what); }
      close() {}
      hears(data) { this.onmessage({ data: typeof data === 'string' ? data : new Uint8Array(data).buffer }); }
      tells(message) { this.hears(JSON.stringify(message)); }
    }
    const own = { WebSocket: window.WebSocket, setTimeout: window.setTimeout };
    window.WebSocket = Staged;
    window.setTimeout = (act, wait) => { waits.push(wait); window.next = act; return 1; };
    const note = (kind) => (said) => heard.push(said === true || said === false ? `${kind} ${said}` : kind);
    const names = ['welcome', 'trial', 'ended', 'elsewhere', 'gone', 'away'];
    const source = new m.LiveSource('/live', Object.fromEntries(names.map((name) => [name, note(name)])));
    const begin = (trial) => {
      sockets.at(-1).tells({ type: 'welcome' });
      sockets.at(-1).tells({ type: 'trial', trial });
    };
    const done = (found) => { Object.assign(window, own); return found; };
    source.connect();
"""


def strokes(first: int, ys: list[float], trial: int = 5) -> list[int]:
    points = np.array([[y, 0.45, 0.1, 0.0] for y in ys], "<f4")
    return list(STROKES.pack(3, 1, len(ys), trial, first) + points.tobytes())


def test_strokes_that_come_twice_are_painted_once_and_a_gap_asks_for_all_of_them(stage_page: Page) -> None:
    found = run_module(
        stage_page,
        "live_source",
        STAGED_SOCKET
        + """begin(5);
        const [once, again, other, late] = given;
        sockets[0].hears(once);
        sockets[0].hears(again);
        sockets[0].hears(other);
        const ys = source.takePoints().map((point) => point.y);
        sockets[0].hears(late);
        window.next();
        return done({ ys, sockets: sockets.length, heard });""",
        [strokes(0, [1, 2]), strokes(1, [2, 3]), strokes(3, [9], trial=4), strokes(5, [6])],
    )
    assert found == {"ys": [1, 2, 3], "sockets": 2, "heard": ["away false", "welcome", "trial", "away true"]}


def test_a_lost_connection_is_sought_again_at_growing_pauses_of_at_most_a_second(stage_page: Page) -> None:
    found = run_module(
        stage_page,
        "live_source",
        STAGED_SOCKET
        + """for (let i = 0; i < 4; i++) { sockets.at(-1).onclose({ code: 1006 }); window.next(); }
        begin(1);
        sockets.at(-1).onclose({ code: 1006 });
        return done({ waits, unsent: source.send({ enable: true }, { device: 'mouse' }) });""",
    )
    assert found == {"waits": [250, 500, 1000, 1000, 250], "unsent": 0}


@pytest.mark.parametrize(("code", "heard"), [(4001, []), (4002, ["gone"]), (4003, ["gone"])])
def test_what_was_closed_for_good_is_not_sought_again(stage_page: Page, code: int, heard: list[str]) -> None:
    script = "sockets[0].onclose({ code: given }); return done({ waits, heard });"
    assert run_module(stage_page, "live_source", STAGED_SOCKET + script, code) == {
        "waits": [],
        "heard": heard,
    }


def test_the_newest_state_of_this_trial_is_kept(stage_page: Page) -> None:
    numbers = (0.0,) * 16
    states = [
        list(STATE.pack(2, 1, 0, 0, trial, frame, 0, *numbers)) for trial, frame in ((5, 3), (5, 2), (4, 9))
    ]
    script = "begin(5); given.forEach((s) => sockets[0].hears(s)); return done(source.state.frame);"
    assert run_module(stage_page, "live_source", STAGED_SOCKET + script, states) == 3


def test_latency_runs_from_each_input_to_the_first_picture_that_shows_it(stage_page: Page) -> None:
    found = run_module(
        stage_page,
        "latency",
        """const l = new m.Latency();
        l.began(1, 100); l.began(2, 108); l.drew(0, 110); l.began(3, 116); l.drew(2, 120); l.drew(2, 136);
        l.forget(); l.drew(3, 140);
        return [l.take(), l.take(), l.take()];""",
    )
    assert found == [20, 12, -1]


def test_inputs_are_at_least_eight_milliseconds_apart_but_letting_go_does_not_wait(stage_page: Page) -> None:
    found = run_module(
        stage_page,
        "input_pump",
        """const times = [], { setInterval } = window;
        const pump = new m.InputPump((now) => times.push(now));
        // Without its heartbeat, which may come right before a change.
        window.setInterval = () => 1;
        pump.start();
        Object.assign(window, { setInterval });
        await new Promise((done) => {
          let left = 400;
          const channel = new MessageChannel();
          channel.port1.onmessage = () => {
            pump.poke();
            if (left-- && times.length < 12) channel.port2.postMessage(0);
            else done();
          };
          channel.port2.postMessage(0);
        });
        const gaps = times.slice(1).map((time, i) => time - times[i]);
        const before = times.length;
        pump.flush(); pump.flush();
        pump.stop();
        pump.flush();
        return { least: Math.min(8, ...gaps), flushed: times.length - before };""",
    )
    assert isinstance(found, dict)
    assert found["least"] >= 7
    assert found["flushed"] == 2


def test_the_wanted_tilt_stays_within_its_limit_and_springs_back_within_half_a_second(
    stage_page: Page,
) -> None:
    found = run_module(
        stage_page,
        "devices/lean",
        """const l = new m.Lean();
        const at = (ms) => l.at(l.start + ms);
        l.start = performance.now();
        for (let i = 0; i < 9; i++) l.push(-6, 0, l.start);
        const wheel = [at(100).y, at(180).y];
        for (let ms = 190; ms <= 500; ms += 10) at(ms);
        wheel.push(l.y);
        l.hold(1, 1);
        for (let ms = 510; ms <= 1500; ms += 10) at(ms);
        const held = Math.hypot(l.y, l.z);
        l.hold(0, 0);
        for (let ms = 1510; ms <= 1900; ms += 10) at(ms);
        return { wheel, held, after: [l.y, l.z] };""",
    )
    assert isinstance(found, dict)
    assert found["wheel"] == [-25, -25, 0]
    assert found["held"] == pytest.approx(25)
    assert found["after"] == [0, 0]


def test_a_hand_moved_by_keys_starts_at_the_nozzle_and_stays_within_reach_of_it(stage_page: Page) -> None:
    found = run_module(
        stage_page,
        "devices/reach",
        """const sight = { nozzle: { y: 0.3, z: 0.4 } };
        const reach = new m.Reach(sight);
        const before = reach.at(0, { y: -1, z: 0 });
        reach.take();
        const start = performance.now();
        const first = reach.at(start + 100, { y: -0.1, z: 0 });
        let far = null;
        for (let i = 2; i < 100; i++) far = reach.at(start + 100 * i, { y: -0.1, z: 0 });
        return { before, moved: first.y - 0.3, far: far.y - 0.3 };""",
    )
    assert isinstance(found, dict)
    assert found["before"] == {"y": 0.3, "z": 0.4}
    assert found["moved"] == pytest.approx(-0.01, abs=2e-3)
    assert found["far"] == pytest.approx(-0.35)


def test_a_tap_is_told_by_when_the_key_went_down_and_up_however_late_the_page_hears_of_it(
    stage_page: Page,
) -> None:
    found = run_module(
        stage_page,
        "devices/keyboard",
        """const wall = document.createElement('div');
        document.body.append(wall);
        const device = new m.Keyboard(() => {});
        device.start(wall, { nozzle: { y: 0, z: 0 } });
        const space = (type, at) => {
          const event = new KeyboardEvent(type, { key: ' ', bubbles: true });
          Object.defineProperty(event, 'timeStamp', { value: at });
          wall.dispatchEvent(event);
          return device.read(performance.now()).blast;
        };
        const tapped = [space('keydown', 1000), space('keyup', 1200)];
        const off = [space('keydown', 2000), space('keyup', 2100)];
        const held = [space('keydown', 3000), space('keyup', 3400)];
        device.dispose();
        wall.remove();
        return { tapped, off, held };""",
    )
    assert found == {"tapped": [True, True], "off": [False, False], "held": [True, False]}


def test_a_gamepad_holds_moves_sprays_and_tilts_and_must_be_let_go_after_a_release(stage_page: Page) -> None:
    found = run_module(
        stage_page,
        "devices/gamepad",
        """const buttons = Array.from({ length: 16 }, () => ({ value: 0 }));
        const pad = { connected: true, axes: [1, 0, 0, -1], buttons };
        const getGamepads = navigator.getGamepads;
        navigator.getGamepads = () => [null, pad];
        const device = new m.Gamepad();
        device.start(null, { nozzle: { y: 0, z: 0 } });
        let now = performance.now();
        const read = () => device.read((now += 50));
        const idle = read();
        pad.buttons[6].value = 1;
        pad.buttons[7].value = 1;
        for (let i = 0; i < 20; i++) read();
        const held = read();
        device.release();
        const released = read().enable;
        pad.buttons[6].value = 0;
        read();
        pad.buttons[6].value = 1;
        const again = read().enable;
        navigator.getGamepads = getGamepads;
        return { idle, held, released, again, drift: m.stick(0.1, 0.1) };""",
    )
    assert isinstance(found, dict)
    assert (found["idle"]["enable"], found["idle"]["blast"]) == (False, False)
    held = found["held"]
    assert (held["enable"], held["blast"], held["tiltZ"]) == (True, True, 25)
    assert held["y"] < -0.1
    assert (found["released"], found["again"]) == (False, True)
    assert found["drift"] == {"x": 0, "y": 0}
