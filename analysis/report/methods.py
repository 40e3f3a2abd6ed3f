"""The methods paragraphs of a report, said from the settings of its fit, fit to go into a paper."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp, isnan, sqrt

from markupsafe import Markup

from analysis.closer_look import CloserLook
from analysis.diagnostics import ESS_ABOVE, RHAT_BELOW, ess_in_words, rhat_in_words
from analysis.figures.labels import LIKELY, isolated
from analysis.fit import LONGER
from analysis.model import model_of
from analysis.refits import Refits
from analysis.report.findings import listed
from analysis.report.line_methods import methods_of_lines
from analysis.report.section_methods import methods_of_refits, methods_of_sections, methods_of_stuck
from analysis.results import Fit, FitSettings
from analysis.straight_lining import StraightLining
from analysis.stuck import StuckRate
from analysis.wording import wording
from data.study import Study

_QUANTILE = 1.8808
"""Of the normal distribution: 94 % lie within so many standard deviations."""


_NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


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
    more = [
        methods_of_sections(look),
        methods_of_lines(lines),
        methods_of_stuck(rates),
        methods_of_refits(refitted),
    ]
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
    terms += _option_terms(fit.settings)
    explained += _options_explained(fit.settings)
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
        *_careless(fit.settings),
    ]


def _option_terms(settings: FitSettings) -> list[str]:
    """What the options add to the lead."""
    terms = []
    if settings.person_side:
        terms.append("<i>σs</i>")
    if settings.position:
        terms += [
            "<i>dt</i>",
            "<i>g</i><sub>A</sub><i>x</i><sub>A</sub> − <i>g</i><sub>B</sub><i>x</i><sub>B</sub>",
        ]
    return terms


def _options_explained(settings: FitSettings) -> list[str]:
    explained = []
    if settings.person_side:
        explained.append(
            "s is the participant's own side, normal with standard deviation 1, so that σ is the spread of "
            "side effects between participants"
        )
    if settings.position:
        explained.append(
            "t is the place of the comparison among the participant's comparisons of the question, in the "
            "order in which they were made (of a store) or in which the rows stand (of a file), from −0.5 "
            "for the first to 0.5 for the last of whoever made most, and d is how much the side effect "
            "changes over them; x is how often the participant had had the mode before, scaled alike, and g "
            "is what the mode gains by it, which adds up to 0 over the modes: the abilities are those in the "
            "middle"
        )
    return explained


def _careless(settings: FitSettings) -> list[Paragraph]:
    """How answers may be careless, after the sentences on how a lead becomes an answer."""
    if not settings.lapse:
        return []
    return [
        Paragraph(
            "An answer may be careless (a lapse: Wichmann & Hill 2001), and then every level is as likely:"
        ),
        _formula("<i>P</i>(answer) = (1 − <i>λ</i>) <i>P</i>(answer | <i>η</i>) + <i>λ</i> / levels"),
        Paragraph(
            "The prior on λ has the mean that surveys find of careless participants, 10 % (Meade & Craig "
            "2012). Worths and abilities are those of answers that are given with care."
        ),
    ]


def _answers(fit: Fit, levels: set[int], before: str) -> list[Paragraph]:
    """How a lead becomes an answer."""
    width = (
        "Each participant uses the scale in a width of their own (Johnson 2003): their {what} by e to the "
        "power of ωv, with v normal of standard deviation 1."
        if fit.settings.person_scale and levels != {2}
        else ""
    )
    if fit.settings.link == "adjacent":
        return [
            Paragraph(f"{before} The odds of the three answers are those of Davidson (1970):".strip()),
            _formula(
                "<i>P</i>(A) : <i>P</i>(about the same) : <i>P</i>(B) = e<sup><i>η</i>/2</sup> : <i>ν</i> : "
                "e<sup>−<i>η</i>/2</sup>"
            ),
            *([Paragraph(width.format(what="ν is multiplied"))] if width else []),
        ]
    if levels == {2}:
        return [
            Paragraph(f"{before} The chance that A is preferred is".strip()),
            _formula("<i>P</i>(A) = 1 / (1 + e<sup>−<i>η</i></sup>)"),
        ]
    points = [_points(n) for n in sorted(levels, reverse=True)]
    return [
        Paragraph(
            f"{before} Answers are ordered from B to A and cut from one latent logistic scale:".strip()
        ),
        _formula(
            "<i>P</i>(answer ≤ <i>k</i>) = 1 / (1 + e<sup>−(<i>θ<sub>k</sub></i> − <i>η</i>)</sup>)",
        ),
        Paragraph(
            f"The cut-points θ lie symmetrically, so that A and B weigh the same: {listed(points)}. The "
            "larger the cut-points, the more answers lie near the middle of the scale."
            + (f" {width}" if width else "").format(what="cut-points are multiplied")
        ),
    ]


def _points(levels: int) -> str:
    """The cut-points of a scale, and whose model that is."""
    above = [wording(f"cut_{k + 1}").symbol for k in range((levels - 1) // 2)]
    below = [f"−{symbol}" for symbol in reversed(above)]
    every = ", ".join([*below, *(["0"] if levels % 2 == 0 else []), *above])
    if levels == 2:
        return "0 with two levels, which is Bradley-Terry itself"
    if levels == 3:
        return f"({every}) with three levels, which is the model of Rao & Kupper (1967)"
    return f"({every}) with {_NUMBERS[levels]} levels (Agresti 1992)"


def _gibbs_model(start: str, levels: set[int]) -> list[Paragraph]:
    pooled = (
        "Answers of all participants count as independent (pooled), and there is no side effect. The "
        "posterior was sampled as in Caron & Doucet (2012)."
    )
    much = " Every stronger answer was taken as the weakest preference." if max(levels) > 3 else ""
    if not any(n % 2 for n in levels):
        formula = (
            "<i>P</i>(<i>i</i> over <i>j</i>) = <i>w<sub>i</sub></i> / (<i>w<sub>i</sub></i> + "
            "<i>w<sub>j</sub></i>)"
        )
        return [
            Paragraph(f"{start}. Every mode has a worth w:"),
            _formula(formula),
            Paragraph(pooled + much),
        ]
    formula = (
        "<i>P</i>(<i>i</i> over <i>j</i>) = <i>w<sub>i</sub></i> / (<i>w<sub>i</sub></i> + "
        "<i>θw<sub>j</sub></i>), <i>P</i>(about the same) = (<i>θ</i>² − 1) "
        "<i>w<sub>i</sub>w<sub>j</sub></i> / ((<i>w<sub>i</sub></i> + <i>θw<sub>j</sub></i>) "
        "(<i>θw<sub>i</sub></i> + <i>w<sub>j</sub></i>))"
    )
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
        f"{wording(name).symbol} {'' if prior.startswith('flat') else '~ '}{_in_symbols(prior)}"
        for name, prior in fit.priors.items()
    ]
    if fit.settings.engine == "gibbs":
        return (
            f"Priors: {'; '.join(stated)}. The Dirichlet is flat over all worths that add up to 1; abilities "
            "are the logarithms of the worths, less their mean."
        )
    but = " but the Beta" if fit.settings.lapse else ""
    reach = _QUANTILE * sqrt(2.0) * fit.settings.prior_sd
    return (
        f"Priors: {'; '.join(stated)}. The last number of each{but} is its standard deviation or scale; a "
        "ZeroSumNormal is a normal distribution whose values are made to add up to 0. So before any answer "
        f"94 % of the differences between two modes lie within {reach:.1f} logits, odds of {_odds(reach)} to "
        "1. The worth of a mode is e to the power of its ability, divided by the sum of these over all modes."
    )


def _in_symbols(prior: str) -> str:
    name, plus, rest = prior.partition(" + ")
    return f"{wording(name).symbol}{plus}{rest}" if plus else prior


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
    sizes = []
    for q in fit.questions:
        model = model_of(fit.settings, q.question.levels, q.hierarchical or fit.settings.position)
        free = len(q.mode_names) - 1
        own = (free + model.n_own) * q.n_participants if q.hierarchical else 0
        # What modes gain by use adds up to 0.
        sizes.append(free + len(q.parameters) - model.position + own)
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
