"""Names of the answers: words up to two strengths, arrows beyond."""

from analysis.figures.answers import _colours
from analysis.level_names import level_names, strength_names
from analysis.strength import strengths
from data.answers import SCALES


def test_short_scales_are_named_in_words():
    assert level_names(2) == ("A", "B")
    assert level_names(3) == ("A", "about the same", "B")
    assert level_names(4) == ("much A", "A", "B", "much B")
    assert level_names(5) == ("much A", "A", "about the same", "B", "much B")


def test_long_scales_are_named_by_their_arrows():
    assert level_names(7) == ("A>>>B", "A>>B", "A>B", "about the same", "B>A", "B>>A", "B>>>A")
    assert strength_names(3) == (">", ">>", ">>>")


def test_every_scale_has_as_many_names_and_colours_as_answers():
    for levels, scale in SCALES.items():
        assert len(level_names(levels)) == len(_colours(levels, 4)) == len(scale)
        colours = _colours(levels, levels // 2)
        assert colours == colours[::-1], "a strength has one colour on both sides"
        assert len(set(colours)) == levels // 2 + levels % 2


def test_a_strength_has_the_same_colour_on_every_scale_of_a_figure():
    assert _colours(3, 4)[0] == _colours(9, 4)[3]


def test_scales_without_a_stronger_answer_have_no_strength(simulated):
    from analysis.answer_shares import answer_shares
    from analysis.fit import fit
    from analysis.results import FitSettings

    table = simulated(3, participants=3)
    fitted = fit(table, FitSettings(draws=200, tune=200, chains=2, pooled=True))
    assert strengths(fitted, answer_shares(table, fitted)) == ()
