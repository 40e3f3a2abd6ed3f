"""Answers beside metrics: what has nothing to do with each other is not named, what has is."""

from dataclasses import fields, replace
from math import isnan
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.association import Association, association_claims, associations, laps_behind, pair_tests
from analysis.measures import MEASURES, mode_measures
from analysis.report.physics import _association_words, physics_section
from data.answers import MIRRORED, SCALES
from data.responses import MetricTable, QuestionScale, ResponseTable

METRICS = [m.name for m in MEASURES]
PAIRS = [("M1", "M2"), ("M2", "M3"), ("M3", "M1")]
QUESTIONS = tuple(
    QuestionScale(f"Q{k}", f"short {k}", f"wording {k}", levels) for k, levels in enumerate((5, 5, 3, 2))
)
FIT = SimpleNamespace(questions=[SimpleNamespace(question=q) for q in QUESTIONS], modes=("M1", "M2", "M3"))
"""What the words take from a fit."""
SETS = 200


def schedule(people, repetitions=2):
    """Every pair in turn, sides exchanged; one row a comparison."""
    rows = []
    for p in range(people):
        for r in range(repetitions):
            for a, b in PAIRS:
                a, b = (a, b) if (p + r) % 2 == 0 else (b, a)
                rows.append((f"p{p:02}", f"p{p:02}.{len(rows)}", a, b))
    return pd.DataFrame(rows, columns=["participant", "comparison", "mode_a", "mode_b"])


def draw_laps(rows, rng):
    """Metrics that differ between modes and people and hang together, of every mode of every comparison."""
    of_mode = {mode: rng.normal(size=len(METRICS)) for mode in ("M1", "M2", "M3")}
    of_person = {who: rng.normal(size=len(METRICS)) for who in rows["participant"].unique()}
    laps = []
    for row in rows.itertuples():
        for mode in (row.mode_a, row.mode_b):
            own = of_mode[mode] + of_person[row.participant] + 0.5 * rng.normal(size=len(METRICS))
            laps.append((row.participant, row.comparison, mode, *np.exp(0.3 * (own + own.mean()))))
    return MetricTable(pd.DataFrame(laps, columns=["participant", "comparison", "mode", *METRICS]))


def answered(rows, answer, questions=QUESTIONS):
    """A table in which ``answer(question)`` gives every comparison's answer to a question."""
    parts = [rows.assign(question=q.name, response=answer(q), check=False) for q in questions]
    return ResponseTable(
        pd.concat(parts, ignore_index=True), ("M1", "M2", "M3"), questions, True, False, "0" * 64, "test"
    )


def following(rows, metrics, metric, sign=1):
    """Answers that say of every comparison which lap had more of a metric."""
    values = metrics.rows.set_index(["comparison", "mode"])[metric]
    lead = np.array(
        [values[c, a] - values[c, b] for c, a, b in rows[["comparison", "mode_a", "mode_b"]].values]
    )
    return ["A>B" if x > 0 else "B>A" for x in sign * lead]


def product_ranks(values):
    """Ranks of the sizes with the signs of the values."""
    return np.sign(values) * stats.rankdata(np.abs(values))


def words(found):
    fit = SimpleNamespace(
        questions=[SimpleNamespace(question=q) for q in QUESTIONS], modes=("M1", "M2", "M3")
    )
    return " ".join(_association_words(found, fit, simulated=False))


def test_answers_without_a_preference_are_named_in_no_more_than_5_percent_of_studies():
    rng = np.random.default_rng(11)
    rows = schedule(7)
    named = 0
    for number in range(SETS):
        if number % 20 == 0:
            metrics = draw_laps(rows, rng)
        side = dict(zip(rows["participant"].unique(), rng.normal(0.5, 1.5, 7), strict=True))
        felt = rows["participant"].map(side).to_numpy()

        def answer(question, felt=felt):
            place = stats.norm.cdf(rng.normal(size=len(rows)) - felt) * question.levels
            return [SCALES[question.levels][int(k)] for k in place]

        named += any(a.passes for a in associations(answered(rows, answer), metrics))
    assert named <= stats.binom.ppf(0.999, SETS, 0.05)
    assert named > 0


def test_answers_that_follow_a_metric_go_with_it_whatever_the_sides():
    rng = np.random.default_rng(1)
    rows = schedule(8)
    metrics = draw_laps(rows, rng)
    table = answered(rows, lambda q: following(rows, metrics, "jerk_rms_m_s3", sign=-1), QUESTIONS[3:])
    found = {a.metric: a for a in associations(table, metrics)}
    jerk = found["jerk_rms_m_s3"]
    assert (jerk.comparisons, jerk.participants) == (48, 8)
    assert jerk.correlation < -0.7
    assert jerk.correlation_high < -0.4
    assert jerk.passes

    turned = table.rows.assign(
        mode_a=table.rows["mode_b"],
        mode_b=table.rows["mode_a"],
        response=[MIRRORED[r] for r in table.rows["response"]],
    )
    for other in associations(replace(table, rows=turned), metrics):
        same = found[other.metric]
        assert other.correlation == pytest.approx(same.correlation)
        assert other.correlation_low == pytest.approx(same.correlation_low)
        assert other.p_in_list == same.p_in_list


def test_who_always_gives_the_same_answer_makes_no_pair_clearer():
    rng = np.random.default_rng(2)
    rows = schedule(9)
    metrics = draw_laps(rows, rng)
    own = np.array(following(rows, metrics, "duration_s"))
    is_line = (rows["participant"] >= "p06").to_numpy()

    def found(answers, kept=slice(None)):
        table = answered(rows[kept], lambda q: list(answers[kept]), QUESTIONS[3:])
        return {a.metric: a for a in associations(table, metrics)}["duration_s"]

    lined = found(np.where(is_line, "A>B", own))
    alone = found(own, ~is_line)
    assert lined.p_alone == alone.p_alone == 1 / 32
    assert lined.correlation < alone.correlation


def test_people_whose_laps_hardly_differ_count_as_much_as_others():
    rng = np.random.default_rng(4)
    rows = schedule(6)
    person = rows["participant"].str[1:].to_numpy(int)
    lead = rng.normal(size=len(rows)) * np.where(person == 0, 1e-3, 1.0)
    laps = [rows.assign(mode=rows["mode_a"], gain_exit=lead), rows.assign(mode=rows["mode_b"], gain_exit=0.0)]
    table = answered(rows, lambda q: ["A>B" if x > 0 else "B>A" for x in lead], QUESTIONS[3:])
    laps = laps_behind(table.rows, MetricTable(pd.concat(laps)))
    (product,) = pair_tests(table.rows, laps, table.questions, seed=1).products
    own = [np.corrcoef(product_ranks(lead)[person == p], np.sign(lead[person == p]))[0, 1] for p in range(6)]
    assert product.contributions == pytest.approx(np.sqrt(5) * np.array(own))
    assert product.crossed[0] < 0.5 * product.crossed[1:].min()


def test_five_people_who_agree_do_not_pass_and_the_report_says_how_many_it_takes():
    rng = np.random.default_rng(3)
    for people, passes in ((5, False), (6, True)):
        rows = schedule(people, repetitions=6)
        metrics = draw_laps(rows, rng)
        metrics = MetricTable(metrics.rows[["participant", "comparison", "mode", "gain_exit"]])
        table = answered(rows, lambda q: following(rows, metrics, "gain_exit"), QUESTIONS[3:])  # noqa: B023
        (gain,) = found = associations(table, metrics)
        assert gain.p_alone == 2.0 ** (1 - people)
        assert gain.passes is passes
        assert ("With 5 people none can: it takes 6." in words(found)) is not passes


def test_where_nothing_passes_one_sentence_says_so_and_no_metric_is_named():
    rng = np.random.default_rng(5)
    rows = schedule(7)
    metrics = draw_laps(rows, rng)
    table = answered(rows, lambda q: [SCALES[q.levels][k] for k in rng.integers(0, q.levels, len(rows))])
    found = associations(table, metrics)
    assert not any(a.passes for a in found)
    said = words(found)
    assert said.startswith("No metric went with the answers of single comparisons")
    assert "20 pairs of a question and a metric were tested together" in said
    assert not any(m.words in said or m.more in said for m in MEASURES)
    assert association_claims(found, FIT) == ()


def test_what_passes_is_named_with_the_error_rate_of_the_list():
    rng = np.random.default_rng(6)
    rows = schedule(10)
    metrics = draw_laps(rows, rng)
    table = answered(rows, lambda q: following(rows, metrics, "duration_s", sign=-1))
    found = associations(table, metrics)
    said = words(found)
    assert "“short 0” with shorter laps" in said
    assert "false-discovery rate of its list is at most 5 % too" in said
    claims = association_claims(found, FIT)
    assert len(claims) == sum(a.passes for a in found) > 0
    assert min(c.probability for c in claims) >= 0.95
    assert "In single comparisons “short 0” went with shorter laps." in [c.text for c in claims]


def test_the_section_prints_every_pair_with_its_corrected_p_and_says_whom_a_mean_leaves_out():
    rng = np.random.default_rng(6)
    rows = schedule(7)
    laps = draw_laps(rows, rng).rows
    metrics = MetricTable(laps.assign(longest_lock_s=laps["longest_lock_s"].where(laps["mode"] == "M1", 0.0)))
    table = answered(rows, lambda q: [SCALES[q.levels][k] for k in rng.integers(0, q.levels, len(rows))])
    found = associations(table, metrics)
    look = SimpleNamespace(measures=mode_measures(metrics, table.modes), associations=found)
    unranked = SimpleNamespace(
        questions=[SimpleNamespace(question=q, ranked=False) for q in QUESTIONS], modes=table.modes
    )
    section = physics_section(look, unranked, "", simulated=False)
    assert section.table.columns[-1] == "Corrected p"
    assert [row[-1] for row in section.table.rows] == [f"{a.p_in_list:.3f}" for a in found]
    assert "the mean of longest time locked leaves out people at 0, and is 0 where all are" in section.caption
    assert "likely" not in " ".join(section.words)


def test_the_share_that_comes_from_the_modes_is_all_of_it_or_none():
    rows = schedule(6)
    laps = draw_laps(rows, np.random.default_rng(7)).rows
    level = laps["mode"].map({"M1": 1.0, "M2": 2.0, "M3": 5.0})
    only_modes = MetricTable(laps.assign(jerk_rms_m_s3=level, gain_exit=laps.index % 2 * level.sum()))
    table = answered(rows, lambda q: ["A>B"] * len(rows), QUESTIONS[3:])
    found = {a.metric: a for a in associations(table, only_modes)}
    assert found["jerk_rms_m_s3"].mode_share == pytest.approx(1.0)
    assert found["gain_exit"].mode_share < 0.05
    assert isnan(found["jerk_rms_m_s3"].correlation)


def test_nothing_is_correlated_over_modes():
    assert not [f.name for f in fields(Association) if "mode" in f.name and f.name != "mode_share"]


@pytest.mark.parametrize("strength", [0.0, 1.0])
def test_the_interval_of_the_correlation_holds_94_percent_with_seven_people(strength):
    def interval(people, rng):
        x = rng.normal(size=(people, 6))
        lead = rng.normal(strength, 0.7, (people, 1)) * x + rng.normal(0.2, 0.7, (people, 1))
        steps = np.searchsorted([-1.6, -0.6, 0.6, 1.6], lead + rng.logistic(size=x.shape)).ravel()
        rows = pd.DataFrame({"participant": np.repeat(np.arange(people), 6), "comparison": np.arange(x.size)})
        rows = rows.assign(mode_a="M1", mode_b="M2")
        table = answered(rows, lambda q: [SCALES[5][4 - k] for k in steps], QUESTIONS[:1])
        laps = [rows.assign(mode="M1", gain_exit=x.ravel()), rows.assign(mode="M2", gain_exit=0.0)]
        (found,) = associations(table, MetricTable(pd.concat(laps)))
        return found.correlation, found.correlation_low, found.correlation_high

    rng = np.random.default_rng(8)
    true = interval(3000, rng)[0]
    ends = [interval(7, rng)[1:] for _ in range(250)]
    held = sum(low <= true <= high for low, high in ends)
    least, most = stats.binom.ppf([0.001, 0.999], 250, 0.94)
    assert least <= held <= most
