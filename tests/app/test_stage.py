"""The stage's modules, run as the browser runs them."""

from typing import TYPE_CHECKING

import numpy as np
import pytest
from playwright.sync_api import Page

from app.server.lap_wire import pack_lap
from app.server.live.wire import ENABLED, SPRAYING, STATE, STROKES, InputFrame, unpack_input
from sim_trials.frames import Frames

from .conftest import Server

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
MAZE = "{ left: 0.35, right: -1.045, top: 0.45, bottom: 0.05 }"


@pytest.fixture(scope="module")
def page(chromium: "Browser", server: Server) -> "Iterator[Page]":
    """A page of the server, to import its modules from."""
    context = chromium.new_context()
    opened = context.new_page()
    opened.goto(f"{server.base}/healthz")
    yield opened
    context.close()


def run(page: Page, module: str, script: str, argument: object = None) -> object:
    return page.evaluate(
        f"async (given) => {{ const m = await import('/stage/{module}.js'); {script} }}", argument
    )


def test_a_lap_arrives_as_it_was_sent(page: Page) -> None:
    n, direction = 3, np.array([0.0, np.pi / 2, np.pi])
    frames = Frames(
        time_s=np.arange(n) / 25,
        q_rad=np.arange(6 * n).reshape(n, 6) / 10,
        cursor_m=np.array([[0.35, 0.45], [0.25, 0.45], [0.15, 0.45]]),
        tilt_deg=np.array([5.0, 10.0, 20.0]),
        tilt_direction_rad=direction,
        is_blasting=np.array([False, True, True]),
        is_enabled=np.array([True, True, True]),
        speed_m_s=np.array([0.0, 0.1, 0.2]),
        hand_m=np.array([[0.3, 0.4], [0.2, 0.4], [0.1, 0.4]]),
        force_share=np.array([0.0, 0.5, 1.0]),
    )
    content = list(pack_lap(frames, 25.0, 0.08, "stuck"))
    found = run(
        page,
        "lap",
        """const lap = new m.Lap(new Uint8Array(given).buffer);
        const states = [0, 0.04, 0.06, 0.08].map((t) => lap.at(t));
        return { outcome: lap.outcome, duration: lap.duration, states };""",
        content,
    )
    assert isinstance(found, dict)
    assert found["outcome"] == "stuck"
    assert found["duration"] == pytest.approx(0.08)
    first, second, between, last = found["states"]
    assert [first["spraying"], second["spraying"], last["moving"]] == [False, True, True]
    assert between["y"] == pytest.approx(0.2)
    assert between["pull"] == pytest.approx(0.75)
    assert last["q"] == pytest.approx([1.2, 1.3, 1.4, 1.5, 1.6, 1.7])
    assert last["hand"] == pytest.approx({"y": 0.1, "z": 0.4})
    for state, tilt, angle in zip((first, second, last), (5.0, 10.0, 20.0), direction, strict=True):
        assert state["tilt"] == pytest.approx(tilt)
        # The screen's y points down: up on the wall is a negative angle there.
        assert np.cos(state["direction"]) == pytest.approx(np.cos(angle), abs=1e-6)
        assert np.sin(state["direction"]) == pytest.approx(-np.sin(angle), abs=1e-6)


def painted(page: Page, strokes: list[tuple[float, float]]) -> list[int]:
    """Opacity in the middle of the top edge after strokes along it: (speed, how often)."""
    found = run(
        page,
        "path",
        f"""const {{ Frame }} = await import('/stage/frame.js');
        const path = new m.Path({{ solidUpTo: 0.15, faintFrom: 0.3 }});
        path.fit(new Frame({MAZE}, 880, 300), 1);
        const out = [];
        for (const [speed, times] of given) {{
          for (let i = 0; i < times; i++) {{
            path.sprayTo(-0.2, 0.45, speed);
            path.sprayTo(-0.5, 0.45, speed);
            path.lift();
          }}
          const frame = path.frame;
          const at = [Math.round(frame.x(-0.35)), Math.round(frame.y(0.45)), 1, 1];
          out.push(path.context.getImageData(...at).data[3]);
        }}
        return out;""",
        strokes,
    )
    assert isinstance(found, list)
    return found


def test_the_path_is_solid_when_slow_and_faint_when_fast(page: Page) -> None:
    solid, middle, faint = (painted(page, [(speed, 1)])[0] for speed in (0.15, 0.225, 0.30))
    assert solid == pytest.approx(0.97 * 255, abs=1)
    assert middle == pytest.approx((0.97 + 0.20) / 2 * 255, abs=1)
    assert faint == pytest.approx(0.20 * 255, abs=1)


def test_strokes_never_add_up_and_the_strongest_stays(page: Page) -> None:
    once, again, strong, weak_after = painted(page, [(0.3, 1), (0.3, 9), (0.1, 1), (0.3, 1)])
    assert once == again
    assert strong == weak_after > again


def test_a_change_of_speed_goes_straight_across_the_path(page: Page) -> None:
    found = run(
        page,
        "path",
        f"""const {{ Frame }} = await import('/stage/frame.js');
        const path = new m.Path({{ solidUpTo: 0.15, faintFrom: 0.3 }});
        const frame = new Frame({MAZE}, 880, 300);
        path.fit(frame, 1);
        for (let i = 0; i <= 40; i++) path.sprayTo(-0.2 - 0.01 * i, 0.45, i < 10 || i > 30 ? 0.1 : 0.3);
        const row = (z) => {{
          const [from, to] = [Math.round(frame.x(-0.25)), Math.round(frame.x(-0.55))];
          const data = path.context.getImageData(from, Math.round(frame.y(z)), to - from, 1).data;
          return [...data].filter((_, k) => k % 4 === 3);
        }};
        return [row(0.45), row(0.45 + 0.011), row(0.45 - 0.011)];""",
    )
    assert isinstance(found, list)
    middle, above, below = found
    assert min(middle) == pytest.approx(0.20 * 255, abs=1)
    assert max(middle) == pytest.approx(0.97 * 255, abs=1)
    faint = [[k for k, alpha in enumerate(row) if alpha < 90] for row in (middle, above, below)]
    # The edge of a round brush would be 4 px further on in the middle of the path than here.
    assert [row[0] for row in faint] == pytest.approx([faint[0][0]] * 3, abs=2)
    assert [row[-1] for row in faint] == pytest.approx([faint[0][-1]] * 3, abs=2)


def test_turning_back_fast_leaves_a_slow_line_solid(page: Page) -> None:
    found = run(
        page,
        "path",
        f"""const {{ Frame }} = await import('/stage/frame.js');
        const path = new m.Path({{ solidUpTo: 0.15, faintFrom: 0.3 }});
        const frame = new Frame({MAZE}, 880, 300);
        path.fit(frame, 1);
        for (let i = 0; i <= 100; i++) path.sprayTo(-0.2 - 0.002 * i, 0.452, 0.1);
        for (let i = 0; i <= 100; i++) path.sprayTo(-0.4 + 0.002 * i, 0.449, 0.3);
        const [from, to] = [Math.round(frame.x(-0.205)), Math.round(frame.x(-0.39))];
        const data = path.context.getImageData(from, Math.round(frame.y(0.45)), to - from, 1).data;
        return [...data].filter((_, k) => k % 4 === 3);""",
    )
    assert isinstance(found, list)
    assert min(found) == pytest.approx(0.97 * 255, abs=2)


def test_the_cursor_changes_its_look_with_two_degrees_of_hysteresis(page: Page) -> None:
    looks = run(
        page,
        "cursor",
        "const t = new m.TiltLook({ greenBelow: 8, redFrom: 16 }); return given.map((deg) => t.at(deg));",
        [7.9, 8, 6.5, 5.9, 16, 14.5, 13.9, 5],
    )
    assert looks == ["straight", "little", "little", "straight", "too", "too", "little", "straight"]


def test_the_drawn_arm_ends_where_the_simulated_one_does(page: Page) -> None:
    from sim_trials.kinematics import HANDLE_OFFSET_M, NOZZLE_LENGTH_M, handle_pose

    q, pose = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.3]), np.empty((4, 4))
    handle_pose(q, pose)
    tip = pose[:3, 3] + (NOZZLE_LENGTH_M - HANDLE_OFFSET_M) * pose[:3, 2]
    assert run(page, "arm", "return m.nozzleTip(given);", q.tolist()) == pytest.approx(tip.tolist())


@pytest.mark.parametrize(
    ("watched", "said"),
    [
        ({"A": 0, "B": 0}, "20 and 20"),
        ({"A": 25, "B": 7.5}, "13 of B"),
        ({"A": 19.2, "B": 20}, "one of A"),
        ({"A": 20, "B": 20}, "open"),
    ],
)
def test_the_unlock_text_says_how_long_is_missing(page: Page, watched: dict[str, float], said: str) -> None:
    texts = "{ both: '{a} and {b}', one: '{seconds} of {slot}', one_second: 'one of {slot}', open: 'open' }"
    assert run(page, "unlock", f"return new m.Unlock(20, {texts}).text(given);", watched) == said


def test_what_streamlit_did_not_hear_is_told_again_until_the_page_has_changed(page: Page) -> None:
    told = run(
        page,
        "component",
        """
        const told = [], timers = new Map();
        const { setInterval, clearInterval } = window;
        window.setInterval = (act) => timers.set(timers.size + 1, act).size;
        window.clearInterval = (timer) => timers.delete(timer);
        const place = document.createElement('div');
        document.body.append(place);
        const hear = (name) => told.push(name);
        const part = { parentElement: place, data: {}, name: 'x', setTriggerValue: hear };
        let tell = null;
        const remove = m.mount(part, (root, { setTriggerValue }) => {
          tell = setTriggerValue;
          return { update() {}, dispose() {} };
        });
        tell('answer', 1);
        for (const act of timers.values()) act();
        remove();
        for (const act of timers.values()) act();
        Object.assign(window, { setInterval, clearInterval });
        return told;""",
    )
    assert told == ["answer", "answer"]


def test_the_server_reads_an_input_as_the_page_means_it(page: Page) -> None:
    sent = run(
        page,
        "wire",
        """const input = { y: 0.25, z: -0.5, tiltY: 12.5, tiltZ: -3.25, enable: true, blast: true };
        const facts = { device: 'touch', seq: 70000, latency: 17.5, frames: 123456, clock: 98765.4321 };
        return [...new Uint8Array(m.packInput(input, facts))];""",
    )
    assert isinstance(sent, list)
    assert unpack_input(bytes(sent)) == InputFrame(
        3, "touch", 70000, 0.25, -0.5, 12.5, -3.25, 17.5, 123456, 98765.4321
    )


def test_the_page_reads_a_state_as_the_server_means_it(page: Page) -> None:
    numbers = (1.5, 0.25, 0.5, 3.0, -4.0, 0.125, 0.75, 0.5, 0.0625, 0.25, *(0.5 * i for i in range(6)))
    state = STATE.pack(2, 1, ENABLED | SPRAYING, 0, 7, 99, 41, *numbers)
    found = run(page, "wire", "return m.unpack(new Uint8Array(given).buffer).state;", list(state))
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


def test_strokes_that_come_twice_are_painted_once_and_a_gap_asks_for_all_of_them(page: Page) -> None:
    found = run(
        page,
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


def test_a_lost_connection_is_sought_again_at_growing_pauses_of_at_most_a_second(page: Page) -> None:
    found = run(
        page,
        "live_source",
        STAGED_SOCKET
        + """for (let i = 0; i < 4; i++) { sockets.at(-1).onclose({ code: 1006 }); window.next(); }
        begin(1);
        sockets.at(-1).onclose({ code: 1006 });
        return done({ waits, unsent: source.send({ enable: true }, { device: 'mouse' }) });""",
    )
    assert found == {"waits": [250, 500, 1000, 1000, 250], "unsent": 0}


@pytest.mark.parametrize(("code", "heard"), [(4001, []), (4002, ["gone"]), (4003, ["gone"])])
def test_what_was_closed_for_good_is_not_sought_again(page: Page, code: int, heard: list[str]) -> None:
    script = "sockets[0].onclose({ code: given }); return done({ waits, heard });"
    assert run(page, "live_source", STAGED_SOCKET + script, code) == {"waits": [], "heard": heard}


def test_the_newest_state_of_this_trial_is_kept(page: Page) -> None:
    numbers = (0.0,) * 16
    states = [
        list(STATE.pack(2, 1, 0, 0, trial, frame, 0, *numbers)) for trial, frame in ((5, 3), (5, 2), (4, 9))
    ]
    script = "begin(5); given.forEach((s) => sockets[0].hears(s)); return done(source.state.frame);"
    assert run(page, "live_source", STAGED_SOCKET + script, states) == 3


def test_latency_runs_from_each_input_to_the_first_picture_that_shows_it(page: Page) -> None:
    found = run(
        page,
        "latency",
        """const l = new m.Latency();
        l.began(1, 100); l.began(2, 108); l.drew(0, 110); l.began(3, 116); l.drew(2, 120); l.drew(2, 136);
        l.forget(); l.drew(3, 140);
        return [l.take(), l.take(), l.take()];""",
    )
    assert found == [20, 12, -1]


def test_inputs_are_at_least_eight_milliseconds_apart_but_letting_go_does_not_wait(page: Page) -> None:
    found = run(
        page,
        "input_pump",
        """const times = [];
        const pump = new m.InputPump((now) => times.push(now));
        pump.start();
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


def test_the_wanted_tilt_stays_within_its_limit_and_springs_back_within_half_a_second(page: Page) -> None:
    found = run(
        page,
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


def test_a_hand_moved_by_keys_starts_at_the_nozzle_and_stays_within_reach_of_it(page: Page) -> None:
    found = run(
        page,
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


def test_a_gamepad_holds_moves_sprays_and_tilts_and_must_be_let_go_after_a_release(page: Page) -> None:
    found = run(
        page,
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


def test_time_in_hand_is_what_is_stored_and_what_cannot_be_stored_yet(page: Page) -> None:
    found = run(
        page,
        "exposure",
        """const e = new m.Exposure({ A: 10, B: 1 });
        const totals = [];
        e.run('A', 4); totals.push(e.total);
        e.end(); totals.push(e.total);
        e.run('B', 2); totals.push(e.total);
        e.agree({ A: 14, B: 1 }); totals.push(e.total);
        return totals.map(({ A, B }) => [A, B]);""",
    )
    assert found == [[14, 1], [14, 1], [14, 3], [14, 3]]


def test_the_robot_is_drawn_in_a_quarter_of_the_time_whatever_a_picture_costs(page: Page) -> None:
    found = run(
        page,
        "pace",
        """const p = new m.Pace();
        const waits = [p.wait(0)];
        p.drew(0, 50); waits.push(p.wait(50));
        for (let i = 0; i < 60; i++) p.drew(1000, 1);
        waits.push(p.wait(1000));
        p.restart(); waits.push(p.wait(1000));
        return waits;""",
    )
    assert found == [0, 150, 30, 0]


def test_practice_ticks_off_what_was_done(page: Page) -> None:
    found = run(
        page,
        "practice",
        """const steps = ['hold', 'move', 'spray', 'tilt', 'lap'];
        const words = Object.fromEntries(steps.map((step) => [`do_${step}`, step]));
        const practice = new m.Practice({ step_done: 'done' }, words, { greenBelow: 8 });
        const still = { y: 0, z: 0, tilt: 0, moving: false, spraying: false };
        const texts = [];
        for (const change of given) { practice.see({ ...still, ...change }); texts.push(practice.text); }
        practice.tick('lap');
        return [...texts, practice.text];""",
        [{}, {"moving": True}, {"y": -0.1, "tilt": 12}, {"spraying": True}, {"tilt": 2}],
    )
    assert found == ["hold", "move", "spray", "lap", "lap", ""]
