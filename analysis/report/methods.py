"""The methods paragraphs of a report, said from the settings of its fit, fit to go into a paper."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp, isnan, sqrt

from markupsafe import Markup

from analysis.closer_look import CloserLook
from analysis.diagnostics import ESS_ABOVE, RHAT_BELOW, ess_in_words, rhat_in_words
from analysis.equivalence import EQUIVALENT_BELOW, EQUIVALENT_CHANCE
from analysis.event_rate import LOG_RATE_SD, MEDIAN_RATE, SPREAD_SCALE, UNKNOWN_MIN
from analysis.figures.labels import LIKELY, isolated
from analysis.fit import LONGER
from analysis.persons import points_of
from analysis.refits import Refits
from analysis.report.findings import listed
from analysis.report.line_methods import methods_of_lines
from analysis.results import Fit
from analysis.straight_lining import StraightLining
from analysis.stuck import StuckRate
from data.study import Study

_QUANTILE = 1.8808
"""Of the normal distribution: 94 % lie within so many standard deviations."""
_SYMBOLS = {
    "ability": "a",
    "side_effect": "b",
    "cut_1": "c₁",
    "cut_2": "c₂",
    "log_nu": "log ν",
    "subject_sd": "τ",
    "z": "z",
    "worth": "w",
    "theta": "θ",
}
"""What the formulas call the parameters that the fit's priors are named by."""


@dataclass(frozen=True)
class Paragraph:
    """Some sentences, or a formula that stands by itself."""

    text: str
    is_formula: bool = False


def methods(
    fit: Fit,
    look: CloserLook | None = None,
    rates: Sequence[StuckRate] = (),
    refitted: Refits | None = None,
    study: Study | None = None,
    versions: Mapping[str, str] | None = None,
    lines: StraightLining | None = None,
) -> tuple[Paragraph, ...]:
    """Paragraphs that let someone repeat the analysis.

    Parameters
    ----------
    study : Study or None
        Where the study is that of 2017, the paper is named whose figure shows worths.
    versions : mapping of str to str
        Of the software behind the numbers, by name.
    """
    more = [_closer(look), methods_of_lines(lines), _stuck(rates), _refits(refitted)]
    return (
        *_model(fit),
        Paragraph(_priors(fit)),
        Paragraph(_reported(fit, study)),
        Paragraph(_sampling(fit, versions or {})),
        *(Paragraph(text) for text in more if text),
    )


def _formula(html: str) -> Paragraph:
    return Paragraph(Markup(html), is_formula=True)


def _model(fit: Fit) -> list[Paragraph]:
    what = "Each question was analysed on its own" if len(fit.questions) > 1 else "The answers were analysed"
    start = f"{what} with a Bayesian Bradley-Terry model (Bradley & Terry 1952)"
    levels = {q.question.levels for q in fit.questions}
    if fit.settings.engine == "gibbs":
        return _gibbs_model(start, levels)
    hierarchical = any(q.hierarchical for q in fit.questions)
    terms = ["<i>η</i> = <i>a</i><sub>A</sub> − <i>a</i><sub>B</sub>"]
    explained = []
    sided = [q for q in fit.questions if q.draws is not None and "side_effect" in q.draws.parameters]
    sampled = [q for q in fit.questions if q.draws is not None]
    has_side = fit.settings.side_effect and (bool(sided) or not sampled)
    if has_side:
        terms.append("<i>b</i>")
        explained.append("b is a side effect, a liking for whatever was shown as A")
    if hierarchical:
        terms.append("<i>τ</i> (<i>z</i><sub>A</sub> − <i>z</i><sub>B</sub>)")
        explained.append(
            "z are the participant's own deviations from the group, which add up to 0 over the modes, and τ "
            "is their standard deviation, so that several answers of one person do not count as independent"
        )
    missing = []
    if not has_side:
        missing.append("There is no side effect in this model.")
    elif len(sided) < len(sampled):
        names = [isolated(q.question.name) for q in sampled if q not in sided]
        missing.append(f"All answers to {listed(names)} are for one side: there it has no side effect.")
    if not hierarchical:
        missing.append(
            "Participants have no deviations of their own in this model (pooled): their answers count as "
            "independent."
        )
    where = f"Here {'; '.join(explained)}. " if explained else ""
    return [
        Paragraph(
            f"{start}. Every mode has an ability a; the abilities of a question add up to 0. An answer to A "
            "against B depends on the lead of A, on the logit scale:"
        ),
        _formula(" + ".join(terms)),
        *_answers(fit, levels, " ".join([where.strip(), *missing]).strip()),
    ]


def _answers(fit: Fit, levels: set[int], before: str) -> list[Paragraph]:
    """How a lead becomes an answer."""
    if fit.settings.link == "adjacent":
        return [
            Paragraph(f"{before} The odds of the three answers are those of Davidson (1970):".strip()),
            _formula(
                "<i>P</i>(A) : <i>P</i>(about the same) : <i>P</i>(B) = e<sup><i>η</i>/2</sup> : <i>ν</i> : "
                "e<sup>−<i>η</i>/2</sup>"
            ),
        ]
    if levels == {2}:
        return [
            Paragraph(f"{before} The chance that A is preferred is".strip()),
            _formula("<i>P</i>(A) = 1 / (1 + e<sup>−<i>η</i></sup>)"),
        ]
    points = []
    if 5 in levels:
        points.append("(−c₂, −c₁, c₁, c₂) with five levels (Agresti 1992)")
    if 3 in levels:
        points.append("(−c₁, c₁) with three levels, which is the model of Rao & Kupper (1967)")
    if 2 in levels:
        points.append("0 with two levels, which is Bradley-Terry itself")
    return [
        Paragraph(
            f"{before} Answers are ordered from B to A and cut from one latent logistic scale:".strip()
        ),
        _formula(
            "<i>P</i>(answer ≤ <i>k</i>) = 1 / (1 + e<sup>−(<i>θ<sub>k</sub></i> − <i>η</i>)</sup>)",
        ),
        Paragraph(
            f"The cut-points θ lie symmetrically, so that A and B weigh the same: {listed(points)}. The "
            "larger a cut-point, the more answers fall into the middle."
        ),
    ]


def _gibbs_model(start: str, levels: set[int]) -> list[Paragraph]:
    pooled = (
        "Answers of all participants count as independent (pooled), and there is no side effect. The "
        "posterior was sampled as in Caron & Doucet (2012)."
    )
    if levels == {2}:
        formula = (
            "<i>P</i>(<i>i</i> over <i>j</i>) = <i>w<sub>i</sub></i> / (<i>w<sub>i</sub></i> + "
            "<i>w<sub>j</sub></i>)"
        )
        return [
            Paragraph(f"{start}. Every mode has a worth w:"),
            _formula(formula),
            Paragraph(pooled),
        ]
    formula = (
        "<i>P</i>(<i>i</i> over <i>j</i>) = <i>w<sub>i</sub></i> / (<i>w<sub>i</sub></i> + "
        "<i>θw<sub>j</sub></i>), <i>P</i>(about the same) = (<i>θ</i>² − 1) "
        "<i>w<sub>i</sub>w<sub>j</sub></i> / ((<i>w<sub>i</sub></i> + <i>θw<sub>j</sub></i>) "
        "(<i>θw<sub>i</sub></i> + <i>w<sub>j</sub></i>))"
    )
    much = " An answer “much more” was taken as “more”." if 5 in levels else ""
    return [
        Paragraph(
            f"{start} with the ties of Rao & Kupper (1967). Every mode has a worth w, and ties have θ ≥ 1:"
        ),
        _formula(formula),
        Paragraph(pooled + much),
    ]


def _priors(fit: Fit) -> str:
    """The priors and what they mean."""
    stated = [
        f"{_SYMBOLS[name]} {'' if prior.startswith('flat') else '~ '}{_in_symbols(prior)}"
        for name, prior in fit.priors.items()
    ]
    if fit.settings.engine == "gibbs":
        return (
            f"Priors: {'; '.join(stated)}. The Dirichlet is flat over all worths that add up to 1; abilities "
            "are the logarithms of the worths, less their mean."
        )
    reach = _QUANTILE * sqrt(2.0) * fit.settings.prior_sd
    return (
        f"Priors: {'; '.join(stated)}. The last number of each is its standard deviation or scale; a "
        "ZeroSumNormal is a normal distribution whose values are made to add up to 0. So before any answer "
        f"94 % of the differences between two modes lie within {reach:.1f} logits, odds of {_odds(reach)} to "
        "1. The worth of a mode is e to the power of its ability, divided by the sum of these over all modes."
    )


def _in_symbols(prior: str) -> str:
    for name, symbol in _SYMBOLS.items():
        prior = prior.replace(f"{name} +", f"{symbol} +")
    return prior


def _odds(logits: float) -> str:
    return f"{exp(logits):,.0f}" if logits < 12 else "more than 100,000"


def _reported(fit: Fit, study: Study | None) -> str:
    paper = study is not None and study.name.startswith("carmichael2017")
    like = ", as in Figure 5 of Carmichael et al. (2017)" if paper else ""
    several = (
        " Questions are analysed one by one; of several claims, the expected number of wrong ones is the sum "
        "of their chances to be wrong, and as questions share nothing the chance that all are right is the "
        "product of those of the questions."
        if len(fit.questions) > 1
        else ""
    )
    if any(q.mode_names != fit.modes for q in fit.questions):
        several += " Each question ranks the modes that its own comparisons connect, and no others."
    return (
        f"Worths lie between 0 and 1 and add up to 1{like}; on a scale of two levels, and for someone who is "
        "like the group, the odds that one mode is chosen over another are the ratio of their worths. "
        "Reported are posterior means with 94 % highest-density credible intervals (and 50 % ones, where "
        "thick lines are drawn). The chance that a mode ranks first, holds a rank or stands above another is "
        "the share of posterior draws in which it does; a first place is called likely from "
        f"{100 * LIKELY:.0f} % on.{several}"
    )


def _acceptance(fit: Fit) -> float:
    """Acceptance rate that NUTS adapted to; the engine fast lowers it in many dimensions."""
    if fit.settings.engine != "fast":
        return fit.settings.target_accept
    sizes = [
        len(q.parameters) + (len(q.mode_names) - 1) * (1 + (q.n_participants if q.hierarchical else 0))
        for q in fit.questions
    ]
    return fit.settings.acceptance(max(sizes, default=0))


def _sampling(fit: Fit, versions: Mapping[str, str]) -> str:
    settings = fit.settings
    how = {
        "fast": "the No-U-Turn sampler (Hoffman & Gelman 2014) of nutpie",
        "pymc": "the No-U-Turn sampler (Hoffman & Gelman 2014) of PyMC (Abril-Pla et al. 2023)",
        "gibbs": "the Gibbs sampler",
    }[settings.engine]
    if settings.engine == "fast" and any(q.hierarchical for q in fit.questions):
        how += ", each participant centred by how much their answers say (Papaspiliopoulos et al. 2007)"
    accept = "" if settings.engine == "gibbs" else f", target acceptance {_acceptance(fit):.2g}"
    software = f" Elbowroom {versions['elbowroom']}" if "elbowroom" in versions else " Elbowroom"
    used = [f"{n} {versions[n]}" for n in ("nutpie", "pymc") if n in versions and settings.engine != "gibbs"]
    said = (
        f"Of each question{software} (engine “{settings.engine}”{''.join(f', {u}' for u in used)}) drew "
        f"{settings.chains} chains of {settings.draws:,} draws after {settings.tune:,} of warm-up with "
        f"{how}{accept}, seed {settings.seed}. A question counts as converged if the abilities, worths, "
        f"ranks, differences and parameters all have a rank-normalised split R-hat below {RHAT_BELOW} and "
        f"bulk and tail effective sample sizes above {ESS_ABOVE:.0f} (Vehtari et al. 2021; tail: of the 5 % "
        "and 95 % quantiles); if not, up to "
        f"{max(LONGER)} times as many draws were taken before it went unranked."
    )
    if isnan(fit.rhat_max):
        return said
    divergent = f"{fit.divergences:,} divergent draw{'' if fit.divergences == 1 else 's'}"
    diverged = (
        "" if settings.engine == "gibbs" else f", with {divergent if fit.divergences else 'none divergent'}"
    )
    return (
        f"{said} In this report the largest R-hat is {rhat_in_words(fit.rhat_max)} and the smallest "
        f"effective sample size {ess_in_words(fit.ess_min)}{diverged}."
    )


def _closer(look: CloserLook | None) -> str:
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


def _stuck(rates: Sequence[StuckRate]) -> str:
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


def _refits(refitted: Refits | None) -> str:
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
