"""Reproductions as folders: tables, figures and verdicts, as the command writes them."""

from collections import Counter
from pathlib import Path

import pandas as pd
import pytest

from app.reproducing import reproduce
from data.errors import InputError

COLUMNS = ["claim", "published", "ours", "assumption", "verdict"]


def verdicts(folder: Path) -> pd.DataFrame:
    return pd.read_csv(folder / "verdicts.csv", keep_default_na=False)


@pytest.fixture(scope="module")
def mulumbwa(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("reproductions") / "mulumbwa"
    reproduce("mulumbwa", out)
    return out


@pytest.fixture(scope="module")
def beaudoin2022(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("reproductions") / "beaudoin2022"
    reproduce("beaudoin2022", out)
    return out


def judged(folder: Path, words: str) -> str:
    table = verdicts(folder)
    found = table[table["claim"].str.contains(words, regex=False)]
    assert len(found) == 1
    return str(found["verdict"].iloc[0])


def test_every_claim_has_a_verdict_and_what_it_rests_on(mulumbwa: Path, beaudoin2022: Path) -> None:
    for folder, least in ((mulumbwa, 12), (beaudoin2022, 6)):
        table = verdicts(folder)
        assert list(table) == COLUMNS
        assert len(table) >= least
        assert table["claim"].is_unique
        assert (table[["published", "ours"]] != "").all(axis=None)
        assumed = table[table["verdict"] == "reproduced under assumption"]
        assert (assumed["assumption"] != "").all()


def test_the_verdicts_of_the_thesis(mulumbwa: Path) -> None:
    assert judged(mulumbwa, "iterations of SVF+SDLS, within") == "reproduced under assumption"
    for claim in ("iterations of JP, within", "iterations of DLS, within", "takes about 10 %"):
        assert judged(mulumbwa, claim) == "contradicted"
    assert judged(mulumbwa, "Table 2: the sets") == "reproduced"
    assert judged(mulumbwa, "the arm meets no singularity") == "contradicted"
    assert judged(mulumbwa, "the joints of the spherical wrist") == "not determinable"
    assert Counter(verdicts(mulumbwa)["verdict"]) == {
        "reproduced": 5,
        "reproduced under assumption": 9,
        "contradicted": 10,
        "not determinable": 1,
    }


def test_the_verdicts_of_the_shell_paper(beaudoin2022: Path) -> None:
    assert judged(beaudoin2022, "psi in the initial configuration") == "reproduced"
    assert judged(beaudoin2022, "Eq. (29) as printed") == "contradicted"
    assert judged(beaudoin2022, "Fig. 6 (trajectory 2)") == "reproduced under assumption"
    assert judged(beaudoin2022, "A user would feel") == "not determinable"


def test_figures_are_written_as_png_and_svg(mulumbwa: Path, beaudoin2022: Path) -> None:
    assert len(list(mulumbwa.glob("figure_*.svg"))) == len(list(mulumbwa.glob("figure_*.png"))) == 5
    assert len(list(beaudoin2022.glob("figure_*.svg"))) == len(list(beaudoin2022.glob("figure_*.png"))) == 3


def test_an_unknown_document_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="beaudoin2022, mulumbwa"):
        reproduce("nakamura1986", tmp_path / "out")
    assert not (tmp_path / "out").exists()
