"""The schedule: balanced, complete, and the same for the same seed."""

from collections import Counter

from hypothesis import given, settings
from hypothesis import strategies as st

from data.schedule import plan_session
from data.study import Study
from data.study_file import read_study

BUILT_IN = read_study("carmichael2017")


def study_with(**protocol: object) -> Study:
    """The built-in study under another protocol, seed or number of modes."""
    changes: dict[str, object] = {}
    if "seed" in protocol:
        changes["seed"] = protocol.pop("seed")
    if "modes" in protocol:
        mode = BUILT_IN.modes[0]
        changes["modes"] = tuple(
            mode.model_copy(update={"name": f"M{k}"}) for k in range(protocol.pop("modes"))
        )
    changes["protocol"] = BUILT_IN.protocol.model_copy(update=protocol)
    return BUILT_IN.model_copy(update=changes)


studies = st.builds(
    study_with,
    seed=st.integers(0, 2**63 - 1),
    modes=st.integers(2, 6),
    repetitions=st.integers(1, 5),
    attention_checks=st.integers(0, 3),
)


@given(study=studies, participant=st.integers(1, 10_000))
@settings(max_examples=60, deadline=None)
def test_every_pair_is_shown_the_right_number_of_times(study, participant):
    session = plan_session(study, participant)
    shown = Counter(frozenset((c.mode_a, c.mode_b)) for c in session if not c.check)
    assert shown == {frozenset(pair): study.protocol.repetitions for pair in study.pairs}
    assert sum(c.check for c in session) == study.protocol.attention_checks
    assert [c.position for c in session] == list(range(1, len(session) + 1))


@given(study=studies, participant=st.integers(1, 10_000))
@settings(max_examples=60, deadline=None)
def test_repetitions_of_a_pair_count_up_and_checks_have_none(study, participant):
    seen: Counter[frozenset[str]] = Counter()
    for comparison in plan_session(study, participant):
        if comparison.check:
            assert comparison.mode_a == comparison.mode_b
            assert comparison.repetition == 0
        else:
            pair = frozenset((comparison.mode_a, comparison.mode_b))
            seen[pair] += 1
            assert comparison.repetition == seen[pair]


def as_a(study: Study, *participants: int) -> dict[frozenset[str], Counter[str]]:
    """How often each mode of each pair stands as A."""
    counts: dict[frozenset[str], Counter[str]] = {}
    for participant in participants:
        for c in plan_session(study, participant):
            if not c.check:
                counts.setdefault(frozenset((c.mode_a, c.mode_b)), Counter())[c.mode_a] += 1
    return counts


@given(study=studies, block=st.integers(0, 5000))
@settings(max_examples=60, deadline=None)
def test_each_mode_of_a_pair_stands_as_a_equally_often_over_two_participants(study, block):
    for pair, sides in as_a(study, 2 * block + 1, 2 * block + 2).items():
        assert set(sides.values()) == {study.protocol.repetitions}
        assert set(sides) == pair


@given(study=studies, participant=st.integers(1, 10_000))
@settings(max_examples=60, deadline=None)
def test_with_even_repetitions_sides_are_balanced_within_each_participant(study, participant):
    if study.protocol.repetitions % 2:
        return
    for sides in as_a(study, participant).values():
        assert set(sides.values()) == {study.protocol.repetitions // 2}


@given(study=studies, participant=st.integers(1, 10_000))
@settings(max_examples=30, deadline=None)
def test_the_same_seed_is_the_same_schedule(study, participant):
    assert plan_session(study, participant) == plan_session(study.model_copy(deep=True), participant)


def test_seeds_and_participants_differ_in_their_schedules():
    assert len({plan_session(BUILT_IN, n) for n in range(1, 31)}) > 25
    assert len({plan_session(study_with(seed=s), 1) for s in range(30)}) > 25


def test_the_order_of_pairs_and_which_side_comes_first_are_spread_evenly():
    first = Counter(
        frozenset((s[0].mode_a, s[0].mode_b)) for s in (plan_session(BUILT_IN, n) for n in range(1, 601))
    )
    assert all(160 < count < 240 for count in first.values())
    leads = Counter(plan_session(BUILT_IN, n)[0].mode_a for n in range(1, 601))
    assert all(160 < count < 240 for count in leads.values())


def test_chosen_pairs_alone_are_shown():
    study = study_with(pairs=(("M1", "M3"),), repetitions=3)
    assert {frozenset((c.mode_a, c.mode_b)) for c in plan_session(study, 1)} == {frozenset(("M1", "M3"))}
    assert len(plan_session(study, 1)) == 3
