"""Questions with modes of their own, and the largest group of modes that comparisons connect."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.consistency import consistencies
from analysis.counts import count_responses
from analysis.fit import fit
from analysis.groups import largest_groups
from analysis.leaving_out import left_out
from analysis.model import Problem, model_of
from analysis.report import write_report
from analysis.results import FitSettings
from data.response_csv import read_response_csv

QUICK = FitSettings(seed=3)
HEADER = "participant,question,mode_a,mode_b,response"
SPEECH, MUSIC, NOISE = ("a1", "a2", "a3"), ("x1", "x2"), ("n1", "a2", "n3", "n4")


def answers(question: str, modes: tuple[str, ...], people: int = 5) -> list[str]:
    """Every pair both ways for everybody; the earlier mode of a pair wins two times in three."""
    rows, n = [], 0
    for person in range(people):
        for i, first in enumerate(modes):
            for second in modes[i + 1 :]:
                for a, b, wins in ((first, second, "A>B"), (second, first, "B>A")):
                    n += 1
                    rows.append(f"p{person},{question},{a},{b},{'A=B' if n % 3 == 0 else wins}")
    return rows


def write(folder: Path, rows: list[str]) -> Path:
    path = folder / "answers.csv"
    path.write_text("\n".join([HEADER, *rows, ""]), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def mixed(tmp_path_factory) -> Path:
    rows = [*answers("speech", SPEECH), *answers("music", MUSIC), *answers("noise", NOISE)]
    return write(tmp_path_factory.mktemp("mixed"), rows)


@pytest.fixture
def split(tmp_path) -> Path:
    """One question about two groups of modes that no comparison connects."""
    return write(tmp_path, [*answers("Q1", ("A", "B", "C")), *answers("Q1", ("D", "E"))])


def test_a_question_is_fitted_as_if_it_were_alone_with_its_own_modes(mixed, tmp_path):
    whole = fit(read_response_csv(mixed), QUICK)
    assert whole.ranked
    for question, modes in zip(whole.questions, (SPEECH, MUSIC, NOISE), strict=True):
        assert set(question.mode_names) == set(modes)
        assert question.draws is not None
        assert question.draws.worth.shape[-1] == len(modes)
        np.testing.assert_allclose(question.draws.worth.sum(axis=-1), 1)
        rows = [row for row in mixed.read_text().splitlines() if f",{question.question.name}," in row]
        alone = fit(read_response_csv(write(tmp_path, rows)), QUICK).questions[0]
        by_name = {mode.mode: mode for mode in alone.modes}
        assert {mode.mode: mode for mode in question.modes} == by_name


def test_an_unranked_question_still_names_its_modes(split):
    question = fit(read_response_csv(split), QUICK).questions[0]
    assert not question.ranked
    assert question.mode_names == ("A", "B", "C", "D", "E")
    assert question.reason.endswith("“elbowroom report --largest-group” ranks the largest group alone.")


def test_every_section_and_file_holds_a_questions_own_modes(mixed, tmp_path):
    table = read_response_csv(mixed)
    fitted = fit(table, QUICK)
    write_report(table, fitted, tmp_path / "report")
    own = {q.question.name: set(q.mode_names) for q in fitted.questions}
    for name, columns in (
        ("worth.csv", ("mode",)),
        ("pairwise.csv", ("mode_i", "mode_j")),
        ("equivalence.csv", ("mode_i", "mode_j")),
        ("people.csv", ("mode",)),
    ):
        rows = pd.read_csv(tmp_path / "report" / name)
        named = {
            question: {mode for column in columns for mode in group[column]}
            for question, group in rows.groupby("question")
        }
        assert named == own, name
    summary = json.loads((tmp_path / "report" / "summary.json").read_text())
    assert summary["ranked"]
    assert {name: entry["modes"] for name, entry in summary["questions"].items()} == {
        "speech": 3,
        "music": 2,
        "noise": 4,
    }
    drawn = {path.stem for path in (tmp_path / "report" / "figures").glob("*.svg")}
    assert {f"figure_1_worth_modes_{k}" for k in (1, 2, 3)} <= drawn
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "1 over the number of its modes (dotted) is no preference" in page


def test_modes_that_a_question_is_not_about_have_no_draws_in_the_posterior(mixed):
    posterior = fit(read_response_csv(mixed), QUICK).posterior["posterior"]
    absent = np.isnan(posterior["worth"]).all(dim=("chain", "draw"))
    for question, modes in (("speech", SPEECH), ("music", MUSIC), ("noise", NOISE)):
        is_absent = absent.sel(question=question)
        assert {str(m) for m in posterior["mode"].values if not is_absent.sel(mode=m)} == set(modes)
    np.testing.assert_allclose(posterior["worth"].sum(dim="mode"), 1)


def test_a_person_can_be_left_out_of_a_question_with_its_own_modes(mixed):
    table = read_response_csv(mixed)
    music = next(q for q in table.questions if q.name == "music")
    rows = table.rows[table.rows["question"] == "music"].reset_index(drop=True)
    one = type(table)(rows, table.modes, (music,), True, False, table.sha256, table.title)
    assert np.isfinite(left_out(one, 0, QUICK))


def test_the_largest_group_is_ranked_as_if_the_others_were_not_in_the_file(split, tmp_path):
    cut = largest_groups(read_response_csv(split))
    question = fit(cut, QUICK).questions[0]
    only = [row for row in split.read_text().splitlines()[1:] if ",D," not in row and ",E," not in row]
    alone = fit(read_response_csv(write(tmp_path, only)), QUICK).questions[0]
    assert question.ranked
    assert question.modes == alone.modes
    assert cut.notes == (
        "Q1: no comparison connects the 2 groups that the modes are in, and the largest alone is ranked, as "
        "asked: A, B and C. D and E are left out, with 10 of 40 answers.",
    )


def test_what_was_left_out_stands_on_the_page_and_in_the_summary(split, tmp_path):
    cut = largest_groups(read_response_csv(split))
    write_report(cut, fit(cut, QUICK), tmp_path / "report")
    summary = json.loads((tmp_path / "report" / "summary.json").read_text())
    assert cut.notes[0] in summary["warnings"]
    assert cut.notes[0] in summary["before_you_quote_this"]
    assert summary["counts"]["responses"] == 30
    assert "D and E are left out, with 10 of 40 answers." in (tmp_path / "report" / "report.html").read_text()


def test_a_mode_of_a_study_that_was_never_shown_is_left_out_if_asked(table_of):
    rows = pd.DataFrame(
        [("a", "b", "A>B", 5), ("a", "b", "B>A", 4)], columns=["mode_a", "mode_b", "response", "count"]
    )
    table = table_of(rows, modes=["a", "b", "c"])
    assert not fit(table, QUICK).questions[0].ranked
    cut = largest_groups(table)
    assert fit(cut, QUICK).questions[0].mode_names == ("a", "b")
    assert cut.notes[0].endswith("asked: a and b. c is left out, with 0 of 9 answers.")


def test_connected_questions_stay_as_they_are(mixed):
    table = read_response_csv(mixed)
    assert largest_groups(table) is table


@given(
    st.lists(
        st.tuples(st.integers(0, 7), st.integers(0, 7)).filter(lambda p: p[0] != p[1]), min_size=1, max_size=9
    )
)
@settings(max_examples=150, deadline=None)
def test_the_group_kept_is_connected_and_no_other_has_more_modes(table_of, pairs):
    rows = pd.DataFrame(
        [(f"m{a}", f"m{b}", "A>B") for a, b in pairs], columns=["mode_a", "mode_b", "response"]
    )
    cut = largest_groups(table_of(rows, levels=3))
    # An independent way to the groups: names spread along the pairs until nothing changes.
    group = {mode: mode for pair in pairs for mode in pair}
    for _ in group:
        for a, b in pairs:
            group[a] = group[b] = min(group[a], group[b])
    sizes = pd.Series(group.values()).value_counts()
    kept = {int(mode[1:]) for mode in cut.modes_of(cut.questions[0])}
    assert len({group[mode] for mode in kept}) == 1
    assert len(kept) == sizes.max()
    counts = count_responses(cut, cut.questions[0])
    assert counts.n == sum(a in kept for a, _ in pairs)


def test_more_modes_are_larger_than_more_answers_and_answers_decide_between_equal_ones(table_of):
    def kept(counts: dict[str, int]) -> tuple[str, ...]:
        rows = [(*pair, "A>B", n) for pair, n in counts.items()]
        cut = largest_groups(
            table_of(pd.DataFrame(rows, columns=["mode_a", "mode_b", "response", "count"]), levels=3)
        )
        return cut.modes_of(cut.questions[0])

    assert kept({"ab": 90, "cd": 1, "de": 1}) == ("c", "d", "e")
    assert kept({"ab": 3, "cd": 4}) == ("c", "d")
    assert kept({"cd": 4, "ab": 4}) == ("c", "d")


def test_people_are_as_consistent_as_if_the_question_were_alone(mixed, tmp_path):
    together = consistencies(read_response_csv(mixed))
    for name in ("speech", "noise"):
        rows = [row for row in mixed.read_text().splitlines() if f",{name}," in row]
        alone = consistencies(read_response_csv(write(tmp_path, rows)))
        own = [c for c in together if c.question == name]
        assert [(c.triads, c.circular, repr(c.zeta), repr(c.u)) for c in own] == [
            (c.triads, c.circular, repr(c.zeta), repr(c.u)) for c in alone
        ]


def test_the_joint_model_of_pymc_keeps_questions_with_as_many_modes_together(tmp_path):
    from analysis.engines import pymc_engine

    rows = [*answers("speech", SPEECH), *answers("music", MUSIC), *answers("tone", ("t1", "t2", "t3"))]
    table = read_response_csv(write(tmp_path, rows))
    model = model_of(QUICK, 3, has_participants=True)
    joint = pymc_engine.joint_model([Problem(count_responses(table, q), model) for q in table.questions])
    assert [block.members for block in joint.blocks] == [(0, 2), (1,)]
    shapes = {variable.name: variable.type.shape for variable in joint.model.free_RVs}
    assert {name: shape for name, shape in shapes.items() if name.endswith("ability")} == {
        "cumulative3_3_modes_ability": (2, 3),
        "cumulative3_2_modes_ability": (1, 2),
    }
