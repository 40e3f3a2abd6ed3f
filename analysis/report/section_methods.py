"""How the sections beyond the ranking were computed, for the methods of a paper."""

from collections.abc import Sequence

from analysis.closer_look import CloserLook
from analysis.equivalence import EQUIVALENT_BELOW, EQUIVALENT_CHANCE
from analysis.event_rate import LOG_RATE_SD, MEDIAN_RATE, SPREAD_SCALE, UNKNOWN_MIN
from analysis.persons import points_of
from analysis.refits import Refits
from analysis.stuck import StuckRate


def methods_of_sections(look: CloserLook | None) -> str:
    """What needs no refit: equality in practice, people's own worths, checks, raters, metrics."""
    if look is None:
        return ""
    said = []
    if look.equivalences:
        said.append(
            "Two modes count as practically equal where their abilities differ by at most "
            f"{EQUIVALENT_BELOW:.2f} logits, a preference of {100 * EQUIVALENT_CHANCE:.0f} in 100 where one "
            "has to choose; the posterior probability of that region is given (Kruschke 2018)."
        )
    people = max((len({p.participant for p in a.people}) for a in look.agreements), default=0)
    if people:
        said.append(
            "Participants' own abilities were drawn given draws of the group's parameters: one of "
            f"{points_of(people)} points spread about a participant's own posterior, by their importance "
            "weights."
        )
    if look.checks.checks:
        said.append(
            "Predictive checks (Gelman et al. 1996) compared the answers with those of new participants who "
            "have the same schedule (Bayarri & Castellanos 2007), drawn at one posterior draw of the "
            "parameters (Johnson 2007). Every quantity was cleared of the scores of the model's own "
            "parameters (Robins et al. 2000): shares of answers, and the scores along what the model leaves "
            "out (Rao 1948). The p of the most extreme of all checks is that of Westfall & Young (1993)."
        )
    if any(c.participant == "all" for c in look.consistencies):
        said.append(
            "Circular triads, the coefficient of consistence zeta and the coefficient of agreement u follow "
            "Kendall & Babington Smith (1940), a tie counting as half a preference for either; the chance "
            "of u under coin tosses is exact, by convolution over the pairs, ties as they are."
        )
    if look.associations:
        said.append(
            "Metrics were averaged over the laps of a comparison, then over each participant's comparisons; "
            "the interval of a mode's mean is Student's over these means of participants, on the log scale "
            "for what cannot be negative. Answers were correlated with metrics within participants, both as "
            "ranks about 0 less the participant's own mean, with an interval from Fisher's z by leaving out "
            "participants one by one (Miller 1974). All questions and metrics were tested together on the "
            "participants' own correlations by flipping the signs of whole participants and stepping down "
            "by the largest left (Romano & Wolf 2005), at 5 % for the list."
        )
    return " ".join(said)


def methods_of_stuck(rates: Sequence[StuckRate]) -> str:
    """Rates of being stuck and their contrasts; empty where no trials are known."""
    if not rates:
        return ""
    minutes = [rate.per_minute is not None for rate in rates]
    over_people = any(rate.between is not None for rate in rates)
    sentences = [
        "The share of a mode's comparisons in which the robot got stuck has a uniform prior, with "
        "comparisons independent: it speaks of these people and comparisons."
    ]
    if over_people or any(minutes):
        sentences.append(
            "In a comparison with t minutes under a mode the robot gets stuck at least once with probability "
            f"1 − exp(−rate · t). The logarithm of the rate has a normal prior around log {MEDIAN_RATE:g} a "
            f"minute with standard deviation {LOG_RATE_SD:g}."
        )
    if over_people:
        sentences.append(
            "For people in general, each participant has a rate of their own, log-normal around the median "
            "person's, and the standard deviation of its logarithm has a half-normal prior of scale "
            f"{SPREAD_SCALE:g}; reported are the median person's rate and the mean share of a new person's "
            "comparisons, each as long as the mode's median comparison. For these people and comparisons, "
            "all rates per minute are the same."
        )
        if not all(minutes):
            sentences.append(
                "A comparison of unknown length counts as the median of the known ones, or as "
                f"{UNKNOWN_MIN:g} minutes."
            )
    if over_people or any(minutes):
        sentences.append(
            "These posteriors are sums over grids (Trefethen & Weideman 2014), and highest-density intervals "
            "are the shortest on the scale that is printed."
        )
    if len(rates) > 1 and any(rate.stuck for rate in rates):
        sentences.append(
            "Two modes are compared, for these people and comparisons, by their posteriors and by two-sided "
            "exact tests: Fisher's (Fisher 1935), and one conditional on how often each participant got "
            "stuck (Mehta et al. 1985)."
        )
        if over_people:
            sentences.append(
                "For people in general they are compared by the posteriors over people, the modes modelled "
                "apart, and by the two-sided exact test that exchanges the modes within people (Basu 1980)."
            )
        sentences.append("Nothing is corrected for several pairs.")
    return " ".join(sentences)


def methods_of_refits(refitted: Refits | None) -> str:
    """What a full report fits again; empty without it."""
    if refitted is None:
        return ""
    said = []
    if refitted.scores:
        said.append(
            "Models were compared by the log predictive density of participants left out, a participant's "
            "own deviations integrated out (Merkle et al. 2019): from draws weighted by Pareto-smoothed "
            "importance sampling (Vehtari et al. 2024), or, where its k-hat exceeds 0.7, from a fit without "
            "the participant, which has to converge as the report's own has; standard errors are over "
            "participants (Vehtari et al. 2017)."
        )
    if refitted.shifts:
        said.append(
            "Sensitivity to the priors was checked with half and twice the scale of the prior on abilities, "
            "fitted again, and on the differences between people, by importance weights without a new fit."
        )
    if refitted.effects:
        said.append(
            "Abilities were regressed on one metric at a time, standardised over the modes, with a residual "
            "for each mode, on the normal approximation of what the answers say of the abilities; slopes "
            "were told apart from 0 by their posterior, corrected for their number (Holm 1979); a slope is "
            "an association."
        )
    if refitted.moderation.differences:
        said.append(
            "Groups of people were compared by fitting the report's model to each group by itself, with "
            "the same priors and nothing shared."
        )
    return " ".join(said)
