"""The page of a report: self-contained, escaped, plain and honest."""

import html.parser
import re
from dataclasses import replace

import pytest

from analysis.report.page import diagnostics_table


class Reader(html.parser.HTMLParser):
    """Collects tags, addresses that a browser would load, and the text of a page."""

    def __init__(self):
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.handlers: list[str] = []
        self.labels: list[str] = []
        self.text: list[str] = []
        self.hidden = 0

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.hidden += tag == "style"
        for name, value in attrs:
            if name in ("src", "href", "xlink:href", "srcset", "action", "poster", "data"):
                self.addresses.append(value)
            if name.startswith("on"):
                self.handlers.append(name)
            if tag == "svg" and name == "aria-label":
                self.labels.append(value)

    def handle_endtag(self, tag):
        self.hidden -= tag == "style"

    def handle_data(self, data):
        if not self.hidden:
            self.text.append(data)

    @property
    def words(self) -> str:
        return " ".join("".join(self.text).replace("\u00a0", " ").split())


def read(folder) -> tuple[Reader, str]:
    page = (folder / "report.html").read_text(encoding="utf-8")
    reader = Reader()
    reader.feed(page)
    return reader, page


@pytest.fixture(scope="module")
def study_page(study_report):
    return read(study_report)


def test_the_page_loads_nothing_from_anywhere(study_page):
    reader, page = study_page
    assert all(a.startswith(("#", "data:image/png;base64,")) for a in reader.addresses)
    assert "script" not in reader.tags
    assert "link" not in reader.tags
    assert "@import" not in page
    assert not re.search(r"url\((?!#)", page)
    assert "default-src 'none'" in page


def test_every_drawing_has_words_for_who_cannot_see_it_and_numbers_behind_it(study_page):
    reader, page = study_page
    assert len(reader.labels) == 11
    assert all(len(label) > 40 for label in reader.labels)
    assert reader.tags.count("figcaption") == 10
    folded = re.findall(r"<summary>(.*?)</summary>", page)
    assert folded == ["The numbers"] * 9 + ["The figure"]


def test_every_id_of_the_page_is_given_once(study_page):
    _, page = study_page
    ids = re.findall(r'\sid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'(?:url\(|href=")#([^")]+)', page)) <= set(ids)


def test_the_page_tells_the_order_with_its_chance_and_its_limits(study_page, study_case):
    words = study_page[0].words
    assert "Which control mode do people prefer?" in words
    assert "6 participants, 36 comparisons, 108 answers" in words
    assert "M1 likely ranks first for" in words
    assert "“most responsive”" in words
    assert "which isn't better" in words
    assert "6 participants are few" in words
    assert "in 5 of 24 comparisons with M1 (2 of 6 people) and in none with M2 and M3" in words
    assert study_case.table.sha256 in words
    assert "Bradley, R. A. and Terry, M. E. (1952)" in words


def test_the_page_never_crowns_a_winner(study_page):
    words = study_page[0].words.lower()
    for word in ("winner", "the best", "significant", "proves", "clearly"):
        assert word not in words


def test_the_page_holds_no_time_of_day_and_no_path(study_page, tmp_path):
    _, page = study_page
    assert not re.search(r"\b\d\d:\d\d\b", page)
    assert not re.search(r"\b20[2-9]\d-\d\d-\d\d\b", page)
    assert str(tmp_path.parent) not in page


def test_simulated_answers_are_said_to_be_simulated_wherever_they_are_shown(simulated_report):
    reader, page = read(simulated_report)
    words = reader.words
    assert "do simulated participants prefer?" in words
    assert "These answers were simulated, so they say nothing about people." in words
    captions = re.findall(r"<figcaption>.*?</figcaption>", page)
    assert len(captions) == 10
    assert all("Simulated data." in caption for caption in captions)
    for drawing in (simulated_report / "figures").glob("*.svg"):
        assert "simulated data" in drawing.read_text(encoding="utf-8"), drawing.name


def test_answers_of_people_are_never_called_simulated(study_page):
    reader, page = study_page
    assert "simulated data" not in page.lower()
    assert "simulated participants" not in reader.words


def test_a_mixture_is_said_to_be_one(simulated_case, tmp_path, write_case):
    rows = simulated_case.table.rows.copy()
    rows.loc[: len(rows) // 2, "source"] = "human"
    mixed = replace(simulated_case, table=replace(simulated_case.table, rows=rows))
    words = read(write_case(mixed, tmp_path))[0].words
    assert "partly simulated data" in words
    assert "53 of 108 answers were made by simulated participants" in words


def test_hostile_names_stay_text(hostile_report):
    reader, page = read(hostile_report)
    assert "script" not in reader.tags
    assert "img" not in reader.tags
    assert reader.handlers == []
    assert "<script>document.title='owned'</script>" in reader.words
    assert "<img src=x onerror=alert(1)>" in reader.words
    assert "\u202e" not in page
    assert "$\\frac{a}{b}$ $x" in reader.words


def test_an_unranked_question_appears_with_its_reason(refused_report):
    words = read(refused_report)[0].words
    assert "Q3 is not ranked. M3 was never compared with another mode." in words
    assert "M1 against M3" in words
    assert "There is no ranking for “most force”" in words


def test_levels_guessed_from_the_answers_are_said_to_be_guessed(hostile_report, study_page):
    assert "were inferred from the answers" in read(hostile_report)[0].words
    assert "inferred" not in study_page[0].words


def test_many_modes_are_sorted_and_still_named(many_case, tmp_path, write_case):
    assert "Modes are sorted by worth." in read(write_case(many_case, tmp_path))[0].words
    drawing = (tmp_path / "report" / "figures" / "figure_1_worth.svg").read_text(encoding="utf-8")
    ordered = sorted(many_case.fit.questions[0].modes, key=lambda m: -m.worth_mean)
    places = [drawing.index(f">{mode.mode}<") for mode in ordered]
    assert places == sorted(places)


def test_unknown_people_are_left_blank_and_not_counted_as_none(study_case):
    questions = (study_case.fit.questions[0], replace(study_case.fit.questions[1], n_participants=0))
    people = [row[3] for row in diagnostics_table(replace(study_case.fit, questions=questions)).rows]
    assert people == ["6", ""]
