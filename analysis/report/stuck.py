"""The report's sections on how often the robot got stuck: rates, and modes against each other.

What speaks of these people and comparisons and what speaks of people in general stand apart, each under its
name.
"""

from collections.abc import Sequence
from math import isnan

from analysis.claims import Claim, expected_wrong
from analysis.figures.labels import LIKELY, isolated, one_line, percent, percent_in_words
from analysis.figures.stuck import draw_stuck
from analysis.report.findings import listed
from analysis.report.page import Section, Table
from analysis.results import Quantity
from analysis.stuck import StuckRate
from analysis.stuck_contrasts import StuckContrast

_MOST_NAMED = 3
_MOST_CLAIMED = 2
_HEADING = "How often the robot got stuck"


def stuck_section(rates: Sequence[StuckRate], contrasts: Sequence[StuckContrast], tag: str) -> Section | None:
    """Rates per comparison and per minute: of these people and comparisons, and of people in general."""
    if not rates:
        return None
    timed = any(rate.per_minute is not None for rate in rates)
    over_people = any(rate.between is not None for rate in rates)
    caption = (
        "Share of a mode's comparisons in which the robot got stuck at least once under that mode"
        + (", and how often it got stuck per minute under the mode" if timed else "")
        + ", with 94 % credible intervals. Marked by a point: these people and comparisons, comparisons "
        "taken as independent."
        + (
            " Pale below it: people in general, each with a rate of their own; per comparison the mean over "
            "people, per minute the median person."
            if over_people
            else ""
        )
        + " On the right: comparisons stuck, of how many. Rates hold for this task and no other."
    )
    words = [_rates_in_words(rates)]
    if contrasts and any(rate.stuck for rate in rates):
        words.append(_contrasts_in_words(contrasts, rates))
    return Section(
        _HEADING,
        (draw_stuck(rates, tag),),
        "",
        caption,
        stuck_table(rates),
        "here",
        tuple(text for text in words if text),
    )


def stuck_claims(contrasts: Sequence[StuckContrast], rates: Sequence[StuckRate]) -> tuple[Claim, ...]:
    """The differences in stuck rates that the report calls likely in people in general, surest first."""
    claims = []
    for contrast in _surest(contrasts, rates)[:_MOST_CLAIMED]:
        high, low, chance = _in_order(contrast)
        if chance >= LIKELY:
            text = f"In people in general the robot gets stuck more often under {high} than under {low}."
            claims.append(Claim(_HEADING, text, chance))
    return tuple(claims)


def likely_difference(contrasts: Sequence[StuckContrast], rates: Sequence[StuckRate]) -> str | None:
    """The surest difference in people in general, for the middle of a sentence.

    Empty if none is likely; None if no two modes can be compared in people in general.
    """
    if not _surest(contrasts, rates):
        return None
    for contrast in _surest(contrasts, rates)[:1]:
        high, low, chance = _in_order(contrast)
        if chance >= LIKELY:
            return (
                f"{isolated(high)}'s rate is likely above {isolated(low)}'s (a chance of "
                f"{percent_in_words(chance)})"
            )
    return ""


def _surest(contrasts: Sequence[StuckContrast], rates: Sequence[StuckRate]) -> list[StuckContrast]:
    """Contrasts over people, surest first, of modes of which at least one got stuck."""
    stuck = {rate.mode: rate.stuck for rate in rates}
    over_people = [
        c for c in contrasts if stuck[c.mode_i] + stuck[c.mode_j] and not isnan(c.p_i_above_j_people)
    ]
    return sorted(over_people, key=lambda c: -abs(c.p_i_above_j_people - 0.5))


def _in_order(contrast: StuckContrast) -> tuple[str, str, float]:
    """The mode with the higher rate in people in general, the other, and the chance of that."""
    chance = contrast.p_i_above_j_people
    if chance < 0.5:
        return contrast.mode_j, contrast.mode_i, 1.0 - chance
    return contrast.mode_i, contrast.mode_j, chance


def _rates_in_words(rates: Sequence[StuckRate]) -> str:
    some = sorted((r for r in rates if r.stuck), key=lambda r: -r.stuck / r.comparisons)
    if not some:
        alone = percent_in_words(max(r.rate_hdi_high for r in rates))
        general = [r.between.hdi_high for r in rates if r.between is not None]
        people = f", and of up to {percent_in_words(max(general))} in people in general" if general else ""
        return (
            "The robot never got stuck under any mode. That does not make a rate 0: with so many comparisons "
            f"rates of up to {alone} of the comparisons go with it, if comparisons are independent{people}."
        )
    sentences = []
    for r in some[:_MOST_NAMED]:
        people = f" and with {r.participants_stuck:,} of {r.participants:,} people" if r.participants else ""
        sentence = (
            f"{isolated(r.mode)}: stuck in {r.stuck:,} of {r.comparisons:,} comparisons{people}. For these "
            f"people and comparisons that is a share of {_interval(r)}"
        )
        if r.between is not None:
            sentence += f"; for people in general, of {_share(r.between)}"
            if r.per_minute_between is not None:
                sentence += f", and {_rate(r.per_minute_between)} a minute for the median person"
            if r.per_minute_between is not None and r.stuck == r.comparisons:
                sentence += (
                    ", of which only the lower end comes from the comparisons: where each gets stuck, the "
                    "rate may be any higher one"
                )
        sentences.append(sentence)
    left = len(some) - _MOST_NAMED
    more = f" {left} more {'mode' if left == 1 else 'modes'} had no higher rate." if left > 0 else ""
    unknown = (
        " Who took part is not known, so nothing follows for people in general."
        if all(r.between is None for r in rates)
        else ""
    )
    return f"{'. '.join(sentences)}. In brackets stand 94 % credible intervals.{more}{unknown}"


def _contrasts_in_words(contrasts: Sequence[StuckContrast], rates: Sequence[StuckRate]) -> str:
    """What is likely in people in general, then the same of these people and comparisons."""
    surest = _surest(contrasts, rates)
    if not surest:
        return ""
    claims = stuck_claims(contrasts, rates)
    named = surest[: max(1, len(claims))]
    parts, alone = [], []
    for contrast in named:
        high, low, chance = _in_order(contrast)
        own, more, fewer = contrast.p_i_above_j, contrast.people_i_higher, contrast.people_j_higher
        if high == contrast.mode_j:
            own, more, fewer = 1.0 - own, fewer, more
        parts.append(
            f"{isolated(high)}'s rate is above {isolated(low)}'s: {percent_in_words(chance)}, and {more:,} "
            f"people got stuck more often under {isolated(high)}, {fewer:,} under {isolated(low)} (exact "
            f"test by people: p {_p_in_words(contrast.p_by_people)})"
        )
        alone.append(percent_in_words(own))
    start = "In people in general no difference between two modes is likely. The surest: "
    wrong = ""
    if claims:
        several = len(claims) > 1
        which = (
            "these differences are likely, each with its chance" if several else "one difference is likely"
        )
        start = f"In people in general {which}: "
        of = f"these {len(claims)} statements" if several else "this 1 statement"
        wrong = f" Of {of} {_expected(expected_wrong(claims))} are expected to be wrong."
    number = max(rate.participants for rate in rates)
    people = "this 1 person" if number == 1 else f"these {number:,} people"
    own_chances = listed(alone) if len(set(alone)) > 1 else alone[0] + " each" * (len(alone) > 1)
    return (
        f"{start}{'; '.join(parts)}.{wrong} For {people} and their comparisons alone, taken as independent, "
        f"the chance is {own_chances}; that says nothing about other people."
    )


def _expected(number: float) -> str:
    return "fewer than 0.01" if number < 0.005 else f"{number:.2f}"


def stuck_table(rates: Sequence[StuckRate]) -> Table:
    """Stuck rates with their counts; per minute where the time of exposure is known."""
    timed = any(rate.per_minute is not None for rate in rates)
    over_people = any(rate.between is not None for rate in rates)
    rows = tuple(
        (
            one_line(r.mode),
            f"{r.stuck:,} of {r.comparisons:,}",
            *((f"{r.participants_stuck:,} of {r.participants:,}",) if over_people else ()),
            f"{100 * r.rate_mean:.1f} % ({100 * r.rate_hdi_low:.1f} to {100 * r.rate_hdi_high:.1f})",
            *((_percentages(r.between),) if over_people else ()),
            *(_per_minute(r, over_people) if timed else ()),
        )
        for r in rates
    )
    columns = ["Mode", "Comparisons stuck"]
    columns += ["People"] if over_people else []
    columns += ["Rate, these (94 %)"]
    columns += ["Rate, people in general"] if over_people else []
    columns += ["Minutes", "Per minute, these"] if timed else []
    columns += ["Per minute, median person"] if timed and over_people else []
    return Table(
        tuple(columns), (False, *([True] * (len(columns) - 1))), rows, "stuck.csv and parameters.csv"
    )


def contrasts_section(contrasts: Sequence[StuckContrast], rates: Sequence[StuckRate]) -> Section | None:
    """Stuck rates against each other, where there are any: of these people, and of people in general."""
    if not contrasts or not any(rate.stuck for rate in rates):
        return None
    words = [
        "These people and comparisons: the chance that the rate of mode i is higher, with comparisons "
        "independent, and two-sided exact tests of equal rates. Fisher's takes all comparisons as "
        "independent; the one within people asks how often each person got stuck in all, so that a few "
        "people who are stuck in everything cannot make a difference between modes. None of the three speaks "
        "of other people: a single person with enough comparisons can make them as sure as one likes."
    ]
    over_people = any(not isnan(c.p_i_above_j_people) for c in contrasts)
    if over_people:
        words.append(
            "People in general: the chance that the rate of mode i is higher for a new person, people having "
            "rates of their own, and the two-sided exact test by people, in which each person counts once. "
            "Beside them stands in how many people the rate was higher under i and under j. No correction is "
            "made for several pairs."
        )
    else:
        words.append("Who took part is not known, so nothing follows for people in general.")
    rows = tuple(
        (
            one_line(c.mode_i),
            one_line(c.mode_j),
            f"{percent(c.p_i_above_j)} %",
            _p_value(c.p_fisher),
            _p_value(c.p_within_people),
            *(
                (
                    "" if isnan(c.p_i_above_j_people) else f"{percent(c.p_i_above_j_people)} %",
                    "" if isnan(c.p_by_people) else _p_value(c.p_by_people),
                    f"{c.people_i_higher} : {c.people_j_higher}",
                )
                if over_people
                else ()
            ),
        )
        for c in contrasts
    )
    columns = ["Mode i", "Mode j", "i higher, these", "p, Fisher, these", "p, within people, these"]
    columns += ["i higher, people", "p, by people", "people i : j"] if over_people else []
    table = Table(tuple(columns), (False, False, *([True] * (len(columns) - 2))), rows, "stuck_contrasts.csv")
    return Section("Do the stuck rates differ?", (), "", "", table, words=tuple(words))


def _p_value(p: float) -> str:
    return "<0.0001" if p < 0.0001 else f"{p:.3g}"


def _p_in_words(p: float) -> str:
    return "below 0.0001" if p < 0.0001 else f"= {p:.3g}"


def _interval(r: StuckRate) -> str:
    return f"{percent_in_words(r.rate_mean)} ({percent(r.rate_hdi_low)} to {percent(r.rate_hdi_high)} %)"


def _share(q: Quantity) -> str:
    return f"{percent_in_words(q.mean)} ({percent(q.hdi_low)} to {percent(q.hdi_high)} %)"


def _percentages(q: Quantity | None) -> str:
    return "" if q is None else f"{100 * q.mean:.1f} % ({100 * q.hdi_low:.1f} to {100 * q.hdi_high:.1f})"


def _rate(q: Quantity | None) -> str:
    return "" if q is None else f"{q.mean:.2f} ({q.hdi_low:.2f} to {q.hdi_high:.2f})"


def _per_minute(r: StuckRate, over_people: bool) -> tuple[str, ...]:
    minutes = f"{r.exposure_min:,.1f}" if r.exposure_min else ""
    return (minutes, _rate(r.per_minute), *((_rate(r.per_minute_between),) if over_people else ()))
