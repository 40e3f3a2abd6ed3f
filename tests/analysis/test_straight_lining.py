"""People who answer in a line are named, and the ranking without them is told."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.fit import fit
from analysis.report.cautions import cautions
from analysis.report.findings import findings
from analysis.report.straight_lines import straight_section
from analysis.results import FitSettings
from analysis.straight_lining import straight_lining
from data.responses import PaceTable

QUICK = FitSettings(draws=400, tune=300, chains=2)
PAIRS = ((0, 1), (0, 2), (1, 2))
LEVELS = ("A>>B", "A>B", "A=B", "B>A", "B>>A")


def rows_of(who, answer, questions=("Q1", "Q2"), seed=1, turned=True):
    rng = np.random.default_rng([seed, sum(map(ord, who))])
    rows = []
    for repetition in range(2):
        for pair in PAIRS:
            a, b = pair[::-1] if repetition and turned else pair
            rows += [(who, name, f"M{a}", f"M{b}", answer(rng, a, b), repetition + 1) for name in questions]
    return rows


def honest(rng, a, b):
    lead = 0.8 * (b - a) + rng.logistic()
    return LEVELS[4 - int(np.searchsorted([-1.5, -0.5, 0.5, 1.5], lead))]


def study(table_of, lines, people=9, **more):
    rows = [row for k in range(people) for row in rows_of(f"p{k}", honest)]
    for who, answer in lines.items():
        rows += rows_of(who, answer, **more)
    columns = ["participant", "question", "mode_a", "mode_b", "response", "repetition"]
    return table_of(pd.DataFrame(rows, columns=columns), modes=("M0", "M1", "M2"), levels=5)


def found_in(table, **more):
    return straight_lining(table, fit(table, QUICK), **more)


def test_who_answers_in_a_line_is_named_with_the_line(table_of):
    table = study(
        table_of,
        {
            "all-a": lambda rng, a, b: "A>>B" if rng.random() < 0.5 else "A>B",
            "equal": lambda rng, a, b: "A=B",
            "much": lambda rng, a, b: "A>>B" if rng.random() < 0.5 else "B>>A",
        },
    )
    found = found_in(table)
    assert {(line.participant, line.kind) for line in found.lines} == {
        ("all-a", "all A"),
        ("equal", "all equal"),
        ("much", "all much"),
    }
    assert all(line.answers == line.of == 12 and line.chance < 0.001 for line in found.lines)


def test_honest_people_and_people_with_few_answers_are_not_named(table_of):
    assert found_in(study(table_of, {})).lines == ()
    few = study(table_of, {})
    rows = pd.concat([few.rows, few.rows[:2].assign(participant="new", response="A>B")], ignore_index=True)
    assert found_in(replace(few, rows=rows)).lines == ()


def test_a_side_that_one_order_of_the_modes_explains_is_no_line(table_of):
    """M0 stood as A before M1 and M2, and M1 before M2: who prefers them in this order always says A."""
    table = study(table_of, {"keen": lambda rng, a, b: "A>B"}, turned=False)
    assert "all A" not in {line.kind for line in found_in(table).lines}


def test_a_long_run_in_the_middle_is_seen(table_of):
    rng = np.random.default_rng(5)
    rows = []
    for k in range(12):
        for n in range(24):
            a, b = PAIRS[n % 3] if n % 2 else PAIRS[n % 3][::-1]
            answer = "A>B" if k == 7 and 4 <= n < 20 else honest(rng, a, b)
            rows.append((f"p{k}", f"M{a}", f"M{b}", answer))
    table = table_of(
        pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response"]),
        modes=("M0", "M1", "M2"),
        levels=5,
    )
    (line,) = found_in(table).lines
    assert (line.participant, line.kind) == ("p7", "run")
    assert line.answers >= 16


def test_answers_that_took_less_than_a_second_are_seen(table_of):
    table = study(table_of, {})
    pace = pd.DataFrame(
        [("p3", f"c{k}", 1.0, 2) for k in range(6)] + [("p4", f"d{k}", 6.0, 2) for k in range(6)],
        columns=["participant", "comparison", "seconds", "questions"],
    )
    (line,) = found_in(table, pace=PaceTable(pace)).lines
    assert (line.participant, line.kind, line.answers, line.of, line.seconds) == ("p3", "fast", 6, 6, 0.5)


def test_the_ranking_without_them_is_that_of_the_others(table_of):
    table = study(table_of, {"all-a": lambda rng, a, b: "A>>B"})
    fitted = fit(table, QUICK)
    found = straight_lining(table, fitted)
    others = table.rows[table.rows["participant"] != "all-a"].reset_index(drop=True)
    alone = fit(replace(table, rows=others), QUICK)
    assert [c.worth_without for c in found.changes] == [
        m.worth_mean for q in alone.questions for m in q.modes
    ]
    assert [c.worth_with for c in found.changes] == [m.worth_mean for q in fitted.questions for m in q.modes]
    section = straight_section(found)
    assert "all-a chose what was shown as A in all of 12 answers" in section.words[0]
    assert len(section.table.rows) == 6
    said = cautions(table, fitted, findings(fitted), None, 0, lines=found)
    (text,) = [text for text in said if text.startswith("all-a answers in a line: chose what was shown as A")]
    assert ". Without this person the same modes come first; the largest change of a worth is" in text


def test_where_the_file_names_the_winner_first_nobody_is_accused(table_of):
    rows = [(f"p{k % 4}", *(("M1", "M2") if k % 3 else ("M2", "M1")), "A>B") for k in range(40)]
    table = table_of(pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response"]), levels=2)
    assert found_in(table).lines == ()


@pytest.mark.parametrize("known", [True, False])
def test_without_participants_nobody_is_looked_at(table_of, known):
    rows = [("x", "M1", "M2", "A>B"), ("x", "M2", "M1", "A>B")] * 20
    table = table_of(
        pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response"]),
        levels=3,
        has_participants=known,
    )
    assert found_in(table).lines == ()
