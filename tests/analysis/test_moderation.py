"""Groups of people by what they said of themselves: planted differences are found, small groups refused."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.background_groups import groups_of
from analysis.engines import fast
from analysis.fit import fit
from analysis.moderation import moderation
from analysis.report.moderated import moderation_section
from analysis.results import FitSettings
from data.responses import BackgroundTable
from data.study import BackgroundQuestion

SETTINGS = FitSettings(draws=1000, tune=500, chains=2)
ROBOTS = BackgroundQuestion(name="robots", wording="Before?", choices=("Never", "Once", "Often"))
AGE = BackgroundQuestion(name="age", wording="How old?", kind="number", lowest=0, highest=99)


@pytest.fixture(scope="module")
def case(table_of, answers_of, truth):
    """Six people who never did and six who did, with the order of the modes turned round or not."""

    def make(turned):
        abilities = (1.5, -1.5, 0.0), (-1.5, 1.5, 0.0) if turned else (1.5, -1.5, 0.0)
        rows = [
            answers_of(replace(truth, ability=a), levels=3, participants=6, repetitions=3, seed=k + 1).assign(
                participant=lambda r, k=k: f"g{k}" + r["participant"]
            )
            for k, a in enumerate(abilities)
        ]
        table = table_of(pd.concat(rows, ignore_index=True), modes=("M1", "M2", "M3"), levels=3)
        people = sorted(set(table.rows["participant"]))
        said = {who: {"robots": "Never" if who.startswith("g0") else "Once"} for who in people}
        return table, fit(table, SETTINGS), BackgroundTable((ROBOTS,), said)

    return make


def test_planted_moderation_is_found_with_its_sign(case):
    found = {d.mode: d for d in moderation(*case(turned=True)).differences}
    assert found["M1"].difference_hdi_high < 0 < found["M2"].difference_hdi_low
    assert not found["M3"].is_clear
    assert (found["M1"].people_first, found["M1"].people_second) == (6, 6)
    assert (found["M1"].first, found["M1"].second) == ("“Never”", "“Once” or “Often”")
    assert found["M1"].difference_mean == pytest.approx(found["M1"].worth_second - found["M1"].worth_first)


def test_groups_that_prefer_alike_are_not_told_apart(case):
    table, fitted, background = case(turned=False)
    found = moderation(table, fitted, background)
    assert not any(d.is_clear for d in found.differences)
    section = moderation_section(found, fitted, "")
    said = " ".join(section.words)
    assert "None of 3 differences of worth is told apart from 0" in said
    assert "robots (“Before?”): “Never” (6 people) and “Once” or “Often” (6)." in said
    assert "That is not to say that the groups agree" in said
    assert "need not come from it" in said
    assert [d.name for d in section.drawings] == ["groups"]


def test_whoever_said_nothing_is_in_no_group_and_small_groups_are_refused(case):
    table, fitted, background = case(turned=False)
    few = {who: said for who, said in background.answers.items() if who != "g1p000" and who != "g1p001"}
    found = moderation(table, fitted, BackgroundTable((ROBOTS,), few))
    assert found.differences == ()
    assert found.reasons == ("robots: the groups have 4 and 6 people; each takes 5.",)
    job = BackgroundQuestion(name="job", wording="Your job?", kind="text")
    words = {who: {"job": "nurse", "robots": "Never"} for who in background.answers}
    assert moderation(table, fitted, BackgroundTable((job, ROBOTS, AGE), words)).reasons == (
        "job: it is answered in words of one's own.",
        "robots: all gave the same answer.",
        "age: nobody answered it.",
    )


def test_a_group_whose_sampling_does_not_converge_is_not_compared_and_that_is_told(case, monkeypatch):
    table, fitted, background = case(turned=True)
    sample = fast.sample

    def stuck_for_those_who_did(problems, settings, done=lambda k: None):
        draws = sample(problems, settings, done)
        for problem, d in zip(problems, draws, strict=True):
            d.ability[0] += problem.counts.participants[0].startswith("g1") * np.array([1.0, -1.0, 0.0])
        return draws

    monkeypatch.setattr(fast, "sample", stuck_for_those_who_did)
    found = moderation(table, fitted, background)
    assert found.differences == ()
    (reason,) = found.reasons
    assert reason.startswith(
        "robots on Q1: “Once” or “Often” by themselves are not ranked. The sampling did not"
    )


def test_those_who_did_not_say_are_counted(case):
    table, fitted, background = case(turned=True)
    few = {who: said for who, said in background.answers.items() if who != "g1p000"}
    section = moderation_section(moderation(table, fitted, BackgroundTable((ROBOTS,), few)), fitted, "")
    assert "“Once” or “Often” (5); 1 did not say." in section.words[0]
    assert section.words[1].startswith("2 of 3 differences of worth leave out 0, the largest first: M")


def test_why_there_are_no_groups_is_said_in_a_line(case):
    table, fitted, background = case(turned=False)
    silent = BackgroundTable((ROBOTS,), {})
    for reason, given in (
        ("came without what participants said", (table, fitted, None)),
        ("asks participants nothing", (table, fitted, BackgroundTable((), {}))),
        ("No participant answered", (table, fitted, silent)),
        ("Simulated participants are not asked", (replace(table, is_simulated=True), fitted, silent)),
        (
            "Participants are pooled",
            (table, replace(fitted, settings=replace(SETTINGS, pooled=True)), background),
        ),
    ):
        found = moderation(*given)
        assert reason in found.reasons[0]
        assert found.reasons[0].endswith(".")
        assert reason in moderation_section(found, fitted, "").words[0]


def test_a_scale_is_cut_where_the_smaller_group_is_largest():
    said = dict(zip("abcdef", ["Never", "Never", "Once", "Often", "Often", "Often"], strict=True))
    groups = groups_of(ROBOTS, said)
    assert (groups.first, groups.second, groups.sizes) == ("“Never” or “Once”", "“Often”", (3, 3))
    ages = groups_of(AGE, {"a": "20", "b": "30", "c": "9", "d": "41"})
    assert (ages.first, ages.second) == ("below 30", "30 or more")
    assert [who for who, second in ages.is_second.items() if second] == ["b", "d"]


def test_answers_in_words_and_answers_that_all_share_part_nobody():
    words = BackgroundQuestion(name="job", wording="Your job?", kind="text")
    assert groups_of(words, {"a": "x", "b": "y"}) is None
    assert groups_of(ROBOTS, {"a": "Never", "b": "Never"}) is None
