"""The study file: what is wrong with it is said in one line that lists what is valid."""

import re
import tomllib

import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st

from data.errors import InputError
from data.study import Study
from data.study_file import built_in_studies, parse_study, read_study, study_text

TEXT = study_text("carmichael2017")


def error_of(text: str) -> str:
    with pytest.raises(InputError) as raised:
        parse_study(text, "my.toml")
    said = str(raised.value)
    assert "\n" not in said
    assert said.startswith("my.toml: ")
    return said.removeprefix("my.toml: ")


@pytest.mark.parametrize("name", built_in_studies())
def test_every_built_in_study_is_valid_and_survives_being_written_as_toml(name):
    study = read_study(name)
    written = tomli_w.dumps(study.model_dump(mode="json", exclude_none=True))
    assert parse_study(written, name) == study
    assert parse_study(written, name).sha256 == study.sha256


def test_the_2017_study_has_its_modes_questions_and_42_comparisons():
    study = read_study("carmichael2017")
    assert [m.parameters.get("lambda0") for m in study.modes] == [0.2, 0.6, None]
    assert [q.levels for q in study.questions] == [5, 5, 5, 3, 3, 3]
    assert len(study.pairs) * study.protocol.repetitions * study.protocol.planned_participants == 42


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "seed = 2017",
            "sed = 2017",
            "sed: unknown key (did you mean seed?); valid keys: background, consent, controller",
        ),
        (
            "dwell_s = 5.0",
            "dwel_s = 5.0",
            "stuck.dwel_s: unknown key (did you mean dwell_s?); valid keys: definition",
        ),
        ("repetitions = 2", "repetition = 2", "protocol.repetition: unknown key (did you mean repetitions?)"),
        (
            'short = "safest"',
            'brief = "safest"',
            "questions.6.brief: unknown key; valid keys: answers, emphasis",
        ),
        ("levels = 5", "levels = 4", "questions.1.levels: 4 is not one of: 2, 3, 5"),
        ('polarity = "lower_is_better"', 'polarity = "low"', "questions.3.polarity: 'low' is not one of: "),
        ('name = "M2"', 'name = "M1"', "modes: the name 'M1' is given twice"),
        ('name = "Q2"', 'name = "Q1"', "questions: the name 'Q1' is given twice"),
        ('name = "M2"', 'name = "2nd"', "modes.2.name: '2nd' is no name"),
        ('pairs = "all"', 'pairs = [["M1", "M9"]]', "protocol.pairs: 'M9' is not one of: M1, M2, M3"),
        ('pairs = "all"', 'pairs = [["M1", "M1"]]', "protocol.pairs: 'M1' is paired with itself"),
        ('pairs = "all"', 'pairs = [["M1", "M2"], ["M2", "M1"]]', "protocol.pairs: a pair is given twice"),
        ("repetitions = 2", "repetitions = 0", "protocol.repetitions: "),
        ("dwell_s = 5.0", "dwell_s = nan", "stuck.dwell_s: "),
        ("right_y_m = -1.045", "right_y_m = 0.4", "maze: right_y_m must be smaller than left_y_m"),
        ('emphasis = "safest"', 'emphasis = "fastest"', "questions.6: emphasis: 'fastest' does not occur"),
        ('name = "games"', 'name = "robots"', "background: the name 'robots' is given twice"),
        (
            'name = "games"',
            'nam = "games"',
            "background.2.nam: unknown key (did you mean name?); valid keys: ",
        ),
        (
            'choices = ["Left", "Right", "Either"]',
            'kind = "scale"',
            "background.3.kind: 'scale' is not one of: 'choice', 'number', 'text'",
        ),
        ('choices = ["Left", "Right", "Either"]', "", "background.3: choices: at least two are needed"),
        ('"Left", "Right", "Either"', '"Left"', "background.3: choices: at least two are needed"),
        ('"Left", "Right", "Either"', '"Left", "Left"', "background.3: choices: one is given twice"),
        (
            'choices = ["Left", "Right", "Either"]',
            'kind = "text"\nchoices = ["Left", "Right"]',
            "background.3: choices: not for the kind 'text'",
        ),
        (
            'choices = ["Left", "Right", "Either"]',
            'kind = "number"\nlowest = 9\nhighest = 9',
            "background.3: lowest must be smaller than highest",
        ),
        (
            'trial_source = "guided"',
            'trial_source = "lab"',
            "protocol.trial_source: 'lab' is not one of: 'guided', 'observed', 'external'",
        ),
        (
            'returning = "resume"',
            'returning = "never"',
            "protocol.returning: 'never' is not one of: 'resume', 'restart_comparison'",
        ),
        ("break_every = 3", "break_every = -1", "protocol.break_every: "),
        ("break_every = 3", "returning_within_h = -1", "protocol.returning_within_h: "),
        (
            "break_every = 3",
            'finish_url = "javascript:alert(1)"',
            "protocol.finish_url: 'javascript:alert(1)' is no web address: https://",
        ),
        ("laps = 1", "laps = 11", "practice.laps: "),
        ("laps = 1", 'mode = "M9"', "practice.mode: 'M9' is not one of: M1, M2, M3"),
        (
            "right_y_m = -0.50",
            "right_y_m = 0.3",
            "practice.right_y_m must be smaller than maze.left_y_m: y grows to the left",
        ),
        ('"A felt safer", ', "", "questions.6: answers: 2 labels for a scale of 3 levels"),
        ("seed = 2017", "seed = ", "not valid TOML: "),
        ("seed = 2017", "seed = 2017\nseed = 2018", "not valid TOML: "),
    ],
)
def test_a_wrong_study_file_is_one_line_that_lists_what_is_valid(old, new, message):
    assert old in TEXT
    assert message in error_of(TEXT.replace(old, new, 1))


def test_an_unknown_key_anywhere_lists_all_valid_ones():
    for table, key in [
        ("consent", "text"),
        ("protocol", "pairs"),
        ("maze", "right_y_m"),
        ("stuck", "dwell_s"),
    ]:
        said = error_of(re.sub(rf"^\[{table}\]$", f"[{table}]\nzzz = 1", TEXT, flags=re.MULTILINE))
        assert said.startswith(f"{table}.zzz: unknown key; valid keys: ")
        assert key in said


def test_neither_a_name_nor_a_file_lists_the_built_in_studies(tmp_path):
    with pytest.raises(InputError, match=r"no such file, and no built-in study \(built in: .*carmichael2017"):
        read_study("carmichael2018")
    with pytest.raises(InputError, match="no such file"):
        read_study(tmp_path)


def test_a_file_that_is_no_text_is_one_line(tmp_path):
    (tmp_path / "study.toml").write_bytes(b"name = '\xff'")
    with pytest.raises(InputError, match="not UTF-8 text"):
        read_study(tmp_path / "study.toml")


def test_the_hash_follows_the_meaning_and_not_the_layout():
    study = parse_study(TEXT, "a")
    assert (
        parse_study("# a comment\n" + TEXT.replace("seed = 2017", "seed  =  2017  # why"), "b").sha256
        == study.sha256
    )
    assert parse_study(TEXT.replace("dwell_s = 5.0", "dwell_s = 5.1"), "c").sha256 != study.sha256
    assert parse_study(TEXT.replace("smoothest to use", "smoothest"), "d").sha256 != study.sha256


@pytest.mark.parametrize("pairs", ["[]", '[["M1", "M2", "M3"]]', '"some"', '[["M1", 2]]'])
def test_pairs_that_compare_nothing_are_refused(pairs):
    assert error_of(TEXT.replace('pairs = "all"', f"pairs = {pairs}")).startswith("protocol.pairs: ")


@pytest.mark.parametrize("value", ["true", '"2"', "2.0"])
def test_a_count_that_is_no_whole_number_is_refused_not_converted(value):
    said = error_of(TEXT.replace("repetitions = 2", f"repetitions = {value}"))
    assert said.startswith("protocol.repetitions: input should be a valid integer")


def test_a_parameter_that_is_no_number_is_refused_not_converted():
    said = error_of(TEXT.replace("lambda0 = 0.2", "lambda0 = true", 1))
    assert said.startswith("modes.1.parameters.lambda0: input should be a valid number")


def test_two_answers_with_one_label_are_refused():
    said = error_of(TEXT.replace('"A: less frustrating", "About the same"', '"Same", "Same"'))
    assert said == "questions.5: answers: the label 'Same' is given twice"


@pytest.mark.parametrize(
    "line", ["x = " + "9" * 5000, "x = 0x" + "f" * 5000, "x = " + "[" * 5000 + "]" * 5000, '"\\n" = 1']
)
def test_odd_toml_is_one_line_and_no_traceback(line):
    assert error_of(f"{line}\n{TEXT}")


values = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 9**20) | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@given(data=st.data(), value=values)
@settings(max_examples=150, deadline=None)
def test_no_value_in_any_place_is_a_traceback(data, value):
    content: dict = tomllib.loads(TEXT)
    place = content
    while True:
        key = data.draw(st.sampled_from(sorted(place) if isinstance(place, dict) else range(len(place))))
        if not isinstance(place[key], dict | list) or not place[key] or data.draw(st.booleans()):
            break
        place = place[key]
    place[key] = value
    try:
        text = tomli_w.dumps(content)
    except (TypeError, ValueError):
        return
    try:
        parsed = parse_study(text, "my.toml")
    except InputError as error:
        said = str(error)
    else:
        said = ""
        assert isinstance(parsed, Study)
    assert "\n" not in said
