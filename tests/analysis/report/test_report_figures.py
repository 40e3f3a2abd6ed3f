"""What the figures draw, and that no name can break one."""

import io
import re
import xml.etree.ElementTree as ElementTree
from collections import Counter
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text
from PIL import Image

from analysis.answer_shares import answer_shares
from analysis.figures.labels import (
    distinct,
    fitted,
    isolated,
    one_line,
    p_value,
    percent,
    shortened,
    width_px,
)
from analysis.figures.parameters import PANELS, draw_parameters
from analysis.figures.worth import draw_worth
from analysis.results import Quantity

SVG = "{http://www.w3.org/2000/svg}"


def texts_of(drawing) -> list[str]:
    root = ElementTree.fromstring(drawing.svg)
    return ["".join(element.itertext()).strip() for element in root.iter(f"{SVG}text")]


def test_the_first_figure_names_every_mode_with_its_chance_on_every_question(study_case):
    texts = texts_of(draw_worth(study_case.fit.questions, study_case.fit.modes)[0])
    for mode in study_case.fit.modes:
        assert texts.count(mode) == len(study_case.fit.questions)
    chances = [percent(m.p_best) for q in study_case.fit.questions for m in q.modes]
    assert not Counter(chances) - Counter(texts)


def test_a_likely_first_place_is_bold_and_an_open_one_is_not(study_case):
    svg = draw_worth(study_case.fit.questions[:2], study_case.fit.modes)[0].svg
    bold = set(re.findall(r"font-weight: 700; font-size: 9px[^>]*>([&;lgt\d]+)<", svg))
    likely = {percent(m.p_best) for q in study_case.fit.questions[:2] for m in q.modes if m.p_best >= 0.8}
    assert {text.replace("&gt;", ">") for text in bold} == likely


def test_hostile_names_are_drawn_as_text_in_every_figure(hostile_report):
    drawings = sorted((hostile_report / "figures").glob("*.svg"))
    assert len(drawings) >= 7
    for path in drawings:
        svg = path.read_text(encoding="utf-8")
        ElementTree.fromstring(svg)
        assert "<script" not in svg
        assert "<img" not in svg
        assert path.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    worth = ElementTree.parse(hostile_report / "figures" / "figure_1_worth.svg")
    texts = {"".join(element.itertext()).strip() for element in worth.iter(f"{SVG}text")}
    assert {"$\\frac{a}{b}$ $x", "line break tab", "(no name)"} <= texts


@pytest.mark.parametrize(("modes", "questions"), [(2, 1), (3, 12), (9, 2), (40, 1), (100, 1)])
def test_no_drawing_outgrows_its_page_and_none_loses_a_mode(modes, questions):
    fit = invented(modes, questions)
    drawings = draw_worth(fit.questions, fit.modes)
    texts = [text for drawing in drawings for text in texts_of(drawing)]
    for drawing in drawings:
        _, _, width, height = (float(x) for x in re.search(r'viewBox="([^"]+)"', drawing.svg)[1].split())
        assert width * 96 / 72 <= 667
        assert height * 96 / 72 <= 940
    for mode in fit.modes:
        assert texts.count(mode) == questions


def invented(n_modes, n_questions):
    """A fit of random draws, summarised by the code that summarises real ones."""
    from analysis.counts import count_responses
    from analysis.results import Draws, Fit, FitSettings, QuestionFit
    from analysis.summaries import mode_results, pair_results
    from data.responses import QuestionScale, ResponseTable

    rng = np.random.default_rng(3)
    modes = tuple(f"m{k}" for k in range(n_modes))
    fits = []
    for k in range(n_questions):
        scale = QuestionScale(f"Q{k}", f"short {k}", "?", 3)
        rows = pd.DataFrame(
            [("p", scale.name, modes[0], modes[1], "A>B", 1, "c", 1, "human", False)],
            columns=["participant", "question", "mode_a", "mode_b", "response", "count", "comparison",
                     "repetition", "source", "check"],
        )  # fmt: skip
        table = ResponseTable(rows, modes, (scale,), True, False, "0" * 64, "invented")
        ability = rng.normal(size=(2, 100, n_modes)) + rng.normal(size=n_modes)
        ability -= ability.mean(axis=-1, keepdims=True)
        worth = np.exp(ability) / np.exp(ability).sum(axis=-1, keepdims=True)
        draws = Draws(ability, worth, {}, np.zeros((2, 100), dtype=bool))
        fits.append(
            QuestionFit(
                scale, True, "", mode_results(draws, modes),
                pair_results(count_responses(table, scale), modes, draws),
                (), draws, 1.0, 400.0, 0, (), 1, 1,
            )
        )  # fmt: skip
    return Fit(tuple(fits), FitSettings(), modes, "invented")


def with_every_parameter(fit):
    """The same fit with values for every parameter that a panel shows, about as long as they get."""
    names = [name for _, own in PANELS for name in own]
    values = tuple(
        Quantity(name, *((0.4, 0.3, 0.0, 1.45) if name.endswith("sd") else (-0.1, 0.5, -1.06, 0.94)))
        for name in names
    )
    return replace(fit, questions=tuple(replace(q, parameters=values) for q in fit.questions))


@pytest.mark.parametrize("kept", [5, 6, 8])
def test_no_text_of_the_parameters_runs_into_another(monkeypatch, kept):
    """Titles, numbers at ticks and names of questions, where the model has all its options."""
    from analysis.figures import parameters as drawing

    boxes = []

    def measured(figure, *rest):
        figure.canvas.draw()
        shown = [t for t in figure.findobj(Text) if t.get_text().strip() and t.get_visible()]
        ticks = [t for a in figure.axes for t in a.get_yticklabels() + _outside(a)]
        boxes.extend((t.get_text(), t.get_window_extent()) for t in shown if t not in ticks)
        return finish(figure, *rest)

    finish = drawing.finish
    monkeypatch.setattr(drawing, "finish", measured)
    monkeypatch.setattr(drawing, "PANELS", PANELS[-kept:])
    assert draw_parameters(with_every_parameter(invented(3, 2)).questions) is not None
    meeting = [
        (one, other) for k, (one, box) in enumerate(boxes) for other, at in boxes[:k] if box.overlaps(at)
    ]
    assert len(boxes) > 3 * kept
    assert meeting == []


def _outside(axes):
    """Labels of ticks beyond the limits, which are not drawn."""
    low, high = axes.get_xlim()
    return [t for t, x in zip(axes.get_xticklabels(), axes.get_xticks(), strict=True) if not low <= x <= high]


def test_what_is_expected_of_a_pair_is_the_mean_over_draws_orders_and_people():
    from analysis.answer_shares import _expected, _Shown
    from analysis.results import Draws

    rng = np.random.default_rng(0)
    ability = rng.normal(size=(1, 50, 2))
    side, tau = rng.normal(size=(1, 50)), np.abs(rng.normal(size=(1, 50)))
    draws = Draws(ability, ability, {"side_effect": side, "subject_sd": tau}, np.zeros((1, 50), dtype=bool))
    people = rng.normal(size=200_000) * np.sqrt(2)
    lead = ability[0, :, 0] - ability[0, :, 1]
    shown = [
        np.mean(1 / (1 + np.exp(-(d + s + t * people))))
        for d, s, t in zip(lead, side[0], tau[0], strict=True)
    ]
    swapped = [
        np.mean(1 / (1 + np.exp(-(d - s + t * people))))
        for d, s, t in zip(lead, side[0], tau[0], strict=True)
    ]
    by_hand = (3 * np.mean(shown) + 1 * np.mean(swapped)) / 4
    ways = [_Shown(3, None), _Shown(1, None)]
    first, second = _expected(draws, 2, ("M1", "M2"), 0, 1, ways).mean(axis=0)
    assert first == pytest.approx(by_hand, abs=2e-3)
    assert first + second == pytest.approx(1, abs=1e-12)


def test_the_shares_of_a_pair_do_not_depend_on_the_side_it_was_shown_on(study_case):
    from dataclasses import replace

    from data.answers import MIRRORED

    rows = study_case.table.rows
    turned = rows.assign(
        mode_a=rows["mode_b"], mode_b=rows["mode_a"], response=rows["response"].map(MIRRORED)
    )
    here = answer_shares(study_case.table, study_case.fit)
    there = answer_shares(replace(study_case.table, rows=turned), study_case.fit)
    assert [[p.counts for p in pairs] for pairs in here] == [[p.counts for p in pairs] for pairs in there]
    assert sum(p.n for pairs in here for p in pairs) == rows["count"].sum()


def test_a_png_has_two_hundred_dots_to_the_inch(study_case):
    drawing = draw_worth(study_case.fit.questions, study_case.fit.modes)[0]
    with Image.open(io.BytesIO(drawing.png)) as png:
        assert png.info["dpi"][0] == pytest.approx(200, abs=0.5)
        assert png.width == pytest.approx(666 / 96 * 200, abs=1.5)


def test_shortened_names_keep_both_ends_and_stay_distinct():
    assert shortened("abcdefghij", 10) == "abcdefghij"
    assert shortened("abcdefghijk", 10) == "abcdef…ijk"
    names = tuple(f"a very long common beginning {k} and a common end of names" for k in range(3))
    assert len(set(distinct(names, 20))) == 3
    assert all(len(name) <= 20 for name in distinct(names, 20))


def test_a_fitted_name_is_no_wider_than_its_room():
    assert width_px(fitted("W" * 300, 80)) <= 80
    assert fitted("short", 80) == "short"


def test_marks_that_turn_text_round_are_dropped_and_right_to_left_names_isolated():
    assert one_line("a\u202eb\n c") == "a b c".replace("a b", "ab")
    assert isolated("שלום") == "\u2068שלום\u2069"
    assert isolated("M1") == "M1"


@pytest.mark.parametrize(
    ("chance", "said"), [(0.0, "<1"), (0.004, "<1"), (0.005, "1"), (0.5, "50"), (0.994, "99"), (0.995, ">99")]
)
def test_a_chance_is_never_rounded_to_certainty(chance, said):
    assert percent(chance) == said


def test_a_p_value_is_never_rounded_to_nothing():
    assert [p_value(p) for p in (0.0, 0.0004, 0.0006, 0.03, 1.0)] == [
        "<0.001", "<0.001", "0.001", "0.030", "1.000",
    ]  # fmt: skip
    assert p_value(float("nan")) == ""
