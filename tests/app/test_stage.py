"""The stage's modules, run as the browser runs them."""

import numpy as np
import pytest
from playwright.sync_api import Page

from app.server.lap_wire import pack_lap
from sim_trials.frames import Frames

from .conftest import run_module

pytestmark = pytest.mark.browser
MAZE = "{ left: 0.35, right: -1.045, top: 0.45, bottom: 0.05 }"


def test_a_lap_arrives_as_it_was_sent(stage_page: Page) -> None:
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
    found = run_module(
        stage_page,
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


def painted(stage_page: Page, strokes: list[tuple[float, float]]) -> list[int]:
    """Opacity in the middle of the top edge after strokes along it: (speed, how often)."""
    found = run_module(
        stage_page,
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


def test_the_path_is_solid_when_slow_and_faint_when_fast(stage_page: Page) -> None:
    solid, middle, faint = (painted(stage_page, [(speed, 1)])[0] for speed in (0.15, 0.225, 0.30))
    assert solid == pytest.approx(0.97 * 255, abs=1)
    assert middle == pytest.approx((0.97 + 0.20) / 2 * 255, abs=1)
    assert faint == pytest.approx(0.20 * 255, abs=1)


def test_strokes_never_add_up_and_the_strongest_stays(stage_page: Page) -> None:
    once, again, strong, weak_after = painted(stage_page, [(0.3, 1), (0.3, 9), (0.1, 1), (0.3, 1)])
    assert once == again
    assert strong == weak_after > again


def test_a_change_of_speed_goes_straight_across_the_path(stage_page: Page) -> None:
    found = run_module(
        stage_page,
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


def test_turning_back_fast_leaves_a_slow_line_solid(stage_page: Page) -> None:
    found = run_module(
        stage_page,
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


def test_the_cursor_changes_its_look_with_two_degrees_of_hysteresis(stage_page: Page) -> None:
    looks = run_module(
        stage_page,
        "cursor",
        "const t = new m.TiltLook({ greenBelow: 8, redFrom: 16 }); return given.map((deg) => t.at(deg));",
        [7.9, 8, 6.5, 5.9, 16, 14.5, 13.9, 5],
    )
    assert looks == ["straight", "little", "little", "straight", "too", "too", "little", "straight"]


def test_the_drawn_arm_ends_where_the_simulated_one_does(stage_page: Page) -> None:
    from sim_trials.kinematics import HANDLE_OFFSET_M, NOZZLE_LENGTH_M, handle_pose

    q, pose = np.array([3.4504, -1.4226, 1.7185, -0.2959, 1.8796, 0.3]), np.empty((4, 4))
    handle_pose(q, pose)
    tip = pose[:3, 3] + (NOZZLE_LENGTH_M - HANDLE_OFFSET_M) * pose[:3, 2]
    assert run_module(stage_page, "arm", "return m.nozzleTip(given);", q.tolist()) == pytest.approx(
        tip.tolist()
    )


@pytest.mark.parametrize(
    ("watched", "said"),
    [
        ({"A": 0, "B": 0}, "20 and 20"),
        ({"A": 25, "B": 7.5}, "13 of B"),
        ({"A": 19.2, "B": 20}, "one of A"),
        ({"A": 20, "B": 20}, "open"),
    ],
)
def test_the_unlock_text_says_how_long_is_missing(
    stage_page: Page, watched: dict[str, float], said: str
) -> None:
    texts = "{ both: '{a} and {b}', one: '{seconds} of {slot}', one_second: 'one of {slot}', open: 'open' }"
    assert run_module(stage_page, "unlock", f"return new m.Unlock(20, {texts}).text(given);", watched) == said


def test_what_streamlit_did_not_hear_is_told_again_until_the_page_has_changed(stage_page: Page) -> None:
    told = run_module(
        stage_page,
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


def test_time_in_hand_is_what_is_stored_and_what_cannot_be_stored_yet(stage_page: Page) -> None:
    found = run_module(
        stage_page,
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


def test_the_robot_is_drawn_in_a_quarter_of_the_time_whatever_a_picture_costs(stage_page: Page) -> None:
    found = run_module(
        stage_page,
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


def test_practice_ticks_off_what_was_done(stage_page: Page) -> None:
    found = run_module(
        stage_page,
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
