"""Reproductions as folders: tables, figures and verdicts, as the command writes them."""

import re
from collections import Counter
from dataclasses import dataclass
from functools import partial
from html import escape
from pathlib import Path

import pandas as pd
import pytest

from app.carmichael2017.experiment import Extent
from app.carmichael2017.experiment import reproduce as study_again
from app.cli.reproduce import Document
from app.reproducing import EXPERIMENTS, page_name, reproduce
from data.errors import InputError

COLUMNS = ["claim", "published", "ours", "assumption", "verdict"]


def verdicts(folder: Path) -> pd.DataFrame:
    return pd.read_csv(folder / "verdicts.csv", keep_default_na=False)


@dataclass(frozen=True)
class Ran:
    """A reproduction's folder and what was told of its progress."""

    folder: Path
    told: list[tuple[int, int]]


def ran(document: str, tmp_path_factory: pytest.TempPathFactory) -> Ran:
    out, told = tmp_path_factory.mktemp("reproductions") / document, []
    reproduce(document, out, progress=lambda done, total, what: told.append((done, total)))
    return Ran(out, told)


@pytest.fixture(scope="module")
def mulumbwa_run(tmp_path_factory: pytest.TempPathFactory) -> Ran:
    return ran("mulumbwa", tmp_path_factory)


@pytest.fixture(scope="module")
def beaudoin2022_run(tmp_path_factory: pytest.TempPathFactory) -> Ran:
    return ran("beaudoin2022", tmp_path_factory)


@pytest.fixture(scope="module")
def carmichael2017_run(tmp_path_factory: pytest.TempPathFactory) -> Ran:
    """With three people instead of 21, and so on: the whole takes a minute."""
    few = Extent(people=2, pool=3, cohorts=4, swept=1, edges=(-1.045, -1.06), braked=1, draws=500)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(EXPERIMENTS, "carmichael2017", partial(study_again, extent=few))
        return ran("carmichael2017", tmp_path_factory)


@pytest.fixture(scope="module")
def mulumbwa(mulumbwa_run: Ran) -> Path:
    return mulumbwa_run.folder


@pytest.fixture(scope="module")
def beaudoin2022(beaudoin2022_run: Ran) -> Path:
    return beaudoin2022_run.folder


@pytest.fixture(scope="module")
def carmichael2017(carmichael2017_run: Ran) -> Path:
    return carmichael2017_run.folder


def judged(folder: Path, words: str) -> str:
    table = verdicts(folder)
    found = table[table["claim"].str.contains(words, regex=False)]
    assert len(found) == 1
    return str(found["verdict"].iloc[0])


def test_every_claim_has_a_verdict_and_what_it_rests_on(
    mulumbwa: Path, beaudoin2022: Path, carmichael2017: Path
) -> None:
    for folder, least in ((mulumbwa, 12), (beaudoin2022, 6), (carmichael2017, 30)):
        table = verdicts(folder)
        assert list(table) == COLUMNS
        assert len(table) >= least
        assert table["claim"].is_unique
        assert (table[["published", "ours"]] != "").all(axis=None)
        assumed = table[table["verdict"] == "reproduced under assumption"]
        assert (assumed["assumption"] != "").all()
        assert (table.loc[table["verdict"] == "reproduced", "assumption"] == "").all()


def test_the_verdicts_of_the_thesis(mulumbwa: Path) -> None:
    assert judged(mulumbwa, "iterations of SVF+SDLS, within") == "reproduced under assumption"
    for claim in ("iterations of JP, within", "iterations of DLS, within", "takes about 10 %"):
        assert judged(mulumbwa, claim) == "contradicted"
    assert judged(mulumbwa, "Table 2: the sets") == "reproduced"
    assert judged(mulumbwa, "the arm meets no singularity") == "contradicted"
    assert judged(mulumbwa, "Table 1 with eq. (1)") == "contradicted"
    assert judged(mulumbwa, "the joints of the spherical wrist") == "not determinable"
    assert Counter(verdicts(mulumbwa)["verdict"]) == {
        "reproduced": 4,
        "reproduced under assumption": 9,
        "contradicted": 11,
        "not determinable": 1,
    }


def test_the_verdicts_of_the_shell_paper(beaudoin2022: Path) -> None:
    assert judged(beaudoin2022, "psi in the initial configuration") == "reproduced"
    assert judged(beaudoin2022, "Eq. (29) as printed") == "contradicted"
    assert judged(beaudoin2022, "Fig. 6 (trajectory 2)") == "contradicted"
    assert judged(beaudoin2022, "about joint 2 alone") == "reproduced under assumption"
    assert judged(beaudoin2022, "A user would feel") == "not determinable"


def test_the_verdicts_of_the_study_that_no_number_of_people_changes(carmichael2017: Path) -> None:
    assert judged(carmichael2017, "are one figure") == "reproduced"
    assert judged(carmichael2017, "all three adding up to 1") == "reproduced"
    assert judged(carmichael2017, "resists it least") == "reproduced"
    assert judged(carmichael2017, "had constant damping") == "contradicted"
    assert judged(carmichael2017, "is the lowest without") == "contradicted"
    assert judged(carmichael2017, "it must be tilted") == "reproduced under assumption"
    assert judged(carmichael2017, "Every time the robot got stuck it was under M1") == (
        "reproduced under assumption"
    )
    assert judged(carmichael2017, "no clear consensus") == "not determinable"


def test_nothing_that_rests_on_simulated_people_is_plainly_reproduced(carmichael2017: Path) -> None:
    table = verdicts(carmichael2017)
    simulated = table["assumption"].str.contains("simulated")
    assert simulated.sum() >= 15
    assert (table.loc[simulated, "verdict"] != "reproduced").all()
    assert simulated[table["claim"].str.match(r"Q[1-6],")].all()


def test_the_tables_of_the_study_hold_what_was_asked_for(carmichael2017: Path) -> None:
    laps = pd.read_csv(carmichael2017 / "laps.csv").set_index("mode")
    assert list(laps["laps"]) == [3 * 4 * 3] * 3
    assert list(laps["stuck"])[1:] == [0, 0]
    assert (laps["completed"] + laps["stuck"] == laps["laps"]).all()
    cohorts = pd.read_csv(carmichael2017 / "cohorts.csv")
    assert len(cohorts) == 4 * (6 + 3) * 3
    assert (cohorts["comparisons"] == 2 * 4).all()
    surface = pd.read_csv(carmichael2017 / "stuck_surface.csv")
    assert sorted(set(surface.loc[surface["mode"] == "M1", "right_y_m"])) == [-1.06, -1.045]
    assert set(surface.loc[surface["mode"] == "M2", "right_y_m"]) == {-1.06}


def test_figures_are_written_as_png_and_svg(mulumbwa: Path, beaudoin2022: Path, carmichael2017: Path) -> None:
    for folder, number in ((mulumbwa, 5), (beaudoin2022, 3), (carmichael2017, 5)):
        names = {path.stem for path in folder.glob("figure_*.svg")}
        assert len(names) == number
        assert names == {path.stem for path in folder.glob("figure_*.png")}


def test_the_page_holds_every_claim_and_every_figure_and_needs_no_other_file(
    mulumbwa: Path, beaudoin2022: Path, carmichael2017: Path
) -> None:
    for folder in (mulumbwa, beaudoin2022, carmichael2017):
        page = (folder / page_name(folder.name)).read_text(encoding="utf-8")
        assert all(escape(claim) in page for claim in verdicts(folder)["claim"])
        assert page.count("<figure>") == len(list(folder.glob("figure_*.svg")))
        assert not re.findall(r"(?:src|href)=\"(?!#)", page)


def test_simulated_people_are_named_on_the_page_and_in_every_figure_of_theirs(carmichael2017: Path) -> None:
    assert "3 simulated people: nothing here is evidence about people" in (
        carmichael2017 / "carmichael2017.html"
    ).read_text(encoding="utf-8")
    for figure in carmichael2017.glob("figure_*.svg"):
        if "eq_1_2" not in figure.name:
            assert "simulated people, not those of the paper" in figure.read_text(encoding="utf-8")


def test_progress_is_told_to_the_end(
    mulumbwa_run: Ran, beaudoin2022_run: Ran, carmichael2017_run: Ran
) -> None:
    for told in (mulumbwa_run.told, beaudoin2022_run.told, carmichael2017_run.told):
        assert len(told) > 10
        assert told == sorted(told)
        assert told[-1][0] == told[-1][1]


def test_the_folder_of_another_document_is_refused_before_any_work(mulumbwa: Path) -> None:
    before = sorted(mulumbwa.iterdir())
    with pytest.raises(InputError, match="holds no earlier result"):
        reproduce("beaudoin2022", mulumbwa)
    assert sorted(mulumbwa.iterdir()) == before


def test_an_unknown_document_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="beaudoin2022, carmichael2017, mulumbwa"):
        reproduce("nakamura1986", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_the_command_names_exactly_the_documents_there_are() -> None:
    assert {document.value for document in Document} == set(EXPERIMENTS)
