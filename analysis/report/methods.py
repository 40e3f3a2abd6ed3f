"""The methods paragraph and the references of a report, said from the settings of its fit."""

from collections.abc import Sequence
from dataclasses import dataclass

from analysis.closer_look import CloserLook
from analysis.equivalence import EQUIVALENT_BELOW, EQUIVALENT_CHANCE
from analysis.refits import Refits
from analysis.results import Fit
from analysis.stuck import StuckRate


@dataclass(frozen=True)
class Reference:
    """A source the methods rest on."""

    key: str
    text: str


BRADLEY_TERRY = Reference(
    "Bradley & Terry 1952",
    "Bradley, R. A. and Terry, M. E. (1952). Rank analysis of incomplete block designs: I. The method of "
    "paired comparisons. Biometrika 39(3/4), 324-345.",
)
RAO_KUPPER = Reference(
    "Rao & Kupper 1967",
    "Rao, P. V. and Kupper, L. L. (1967). Ties in paired-comparison experiments: a generalization of the "
    "Bradley-Terry model. Journal of the American Statistical Association 62(317), 194-204.",
)
DAVIDSON = Reference(
    "Davidson 1970",
    "Davidson, R. R. (1970). On extending the Bradley-Terry model to accommodate ties in paired comparison "
    "experiments. Journal of the American Statistical Association 65(329), 317-328.",
)
AGRESTI = Reference(
    "Agresti 1992",
    "Agresti, A. (1992). Analysis of ordinal paired comparison data. Applied Statistics 41(2), 287-297.",
)
CARON_DOUCET = Reference(
    "Caron & Doucet 2012",
    "Caron, F. and Doucet, A. (2012). Efficient Bayesian inference for generalized Bradley-Terry models. "
    "Journal of Computational and Graphical Statistics 21(1), 174-196.",
)
CARMICHAEL = Reference(
    "Carmichael et al. 2017",
    "Carmichael, M. G., Aldini, S. and Liu, D. (2017). Human user impressions of damping methods for "
    "singularity handling in human-robot collaboration. Australasian Conference on Robotics and Automation.",
)
HOFFMAN_GELMAN = Reference(
    "Hoffman & Gelman 2014",
    "Hoffman, M. D. and Gelman, A. (2014). The No-U-Turn sampler: adaptively setting path lengths in "
    "Hamiltonian Monte Carlo. Journal of Machine Learning Research 15, 1593-1623.",
)
VEHTARI = Reference(
    "Vehtari et al. 2021",
    "Vehtari, A., Gelman, A., Simpson, D., Carpenter, B. and Bürkner, P.-C. (2021). Rank-normalization, "
    "folding, and localization: an improved R-hat for assessing convergence of MCMC. Bayesian Analysis "
    "16(2), 667-718.",
)


KRUSCHKE = Reference(
    "Kruschke 2018",
    "Kruschke, J. K. (2018). Rejecting or accepting parameter values in Bayesian estimation. Advances in "
    "Methods "
    "and Practices in Psychological Science 1(2), 270-280.",
)
GELMAN = Reference(
    "Gelman et al. 1996",
    "Gelman, A., Meng, X.-L. and Stern, H. (1996). Posterior predictive assessment of model fitness via "
    "realized "
    "discrepancies. Statistica Sinica 6(4), 733-760.",
)
KENDALL = Reference(
    "Kendall & Babington Smith 1940",
    "Kendall, M. G. and Babington Smith, B. (1940). On the method of paired comparisons. Biometrika 31(3/4), "
    "324-345.",
)
RUBIN = Reference(
    "Rubin 1981", "Rubin, D. B. (1981). The Bayesian bootstrap. The Annals of Statistics 9(1), 130-134."
)
FISHER = Reference(
    "Fisher 1935",
    "Fisher, R. A. (1935). The logic of inductive inference. Journal of the Royal Statistical Society "
    "98(1), 39-82.",
)
MEHTA = Reference(
    "Mehta et al. 1985",
    "Mehta, C. R., Patel, N. R. and Gray, R. (1985). Computing an exact confidence interval for the common "
    "odds "
    "ratio in several 2 x 2 contingency tables. Journal of the American Statistical Association 80(392), "
    "969-973.",
)
VEHTARI_LOO = Reference(
    "Vehtari et al. 2017",
    "Vehtari, A., Gelman, A. and Gabry, J. (2017). Practical Bayesian model evaluation using leave-one-out "
    "cross-validation and WAIC. Statistics and Computing 27(5), 1413-1432.",
)


def methods(
    fit: Fit,
    look: CloserLook | None = None,
    rates: Sequence[StuckRate] = (),
    refitted: Refits | None = None,
) -> tuple[str, ...]:
    """Paragraphs that let someone repeat the analysis."""
    more = [_closer(look), _stuck(rates), _refits(refitted)]
    return (_model(fit), _worth(fit), _sampling(fit), *(text for text in more if text))


def references(
    fit: Fit,
    look: CloserLook | None = None,
    rates: Sequence[StuckRate] = (),
    refitted: Refits | None = None,
) -> tuple[Reference, ...]:
    """The sources of the model, the sampler and the checks that this report used."""
    levels = {q.question.levels for q in fit.questions}
    used = [BRADLEY_TERRY]
    if fit.settings.link == "adjacent":
        used.append(DAVIDSON)
    elif levels & {3, 5}:
        used.append(RAO_KUPPER)
    if 5 in levels and fit.settings.engine != "gibbs":
        used.append(AGRESTI)
    used.append(CARON_DOUCET)
    used.append(CARMICHAEL)
    if fit.settings.engine != "gibbs":
        used.append(HOFFMAN_GELMAN)
    used.append(VEHTARI)
    if look is not None:
        used += [KRUSCHKE] if look.equivalences else []
        used += [GELMAN] if look.checks else []
        used += [KENDALL] if look.consistencies else []
        used += [RUBIN] if look.associations else []
    used += [FISHER, MEHTA] if len(rates) > 1 else []
    used += [VEHTARI_LOO] if refitted is not None and refitted.scores else []
    return tuple(used)


def _closer(look: CloserLook | None) -> str:
    if look is None:
        return ""
    said = []
    if look.equivalences:
        said.append(
            f"Two modes are practically equal where their abilities differ by at most "
            f"{EQUIVALENT_BELOW:.2f} logits, a "
            f"preference of {100 * EQUIVALENT_CHANCE:.0f} in 100; the posterior probability of that region "
            f"is given "
            "(Kruschke 2018)."
        )
    if any(a.people for a in look.agreements):
        said.append(
            "Participants' own abilities are drawn given the group's parameters by importance weights on "
            "quasi-random points of their prior."
        )
    if look.checks:
        said.append(
            "Posterior predictive checks (Gelman et al. 1996) draw new participants with the same "
            "schedule; Bayesian "
            "p-values count half of the predictions equal to what was observed."
        )
    if look.consistencies:
        said.append(
            "Circular triads, the coefficient of consistence and Kendall's u follow Kendall & Babington "
            "Smith (1940), a "
            "tie counting as half a preference each; u is compared with 1,000 sets of coin tosses."
        )
    if look.associations:
        said.append(
            "Metrics are averaged over the laps of a comparison, then over each participant's comparisons; "
            "intervals "
            "are those of the Bayesian bootstrap over participants (Rubin 1981)."
        )
    return " ".join(said)


def _stuck(rates: Sequence[StuckRate]) -> str:
    if not rates:
        return ""
    return (
        "Stuck rates are shares of a mode's comparisons, with a uniform prior. Over people, each "
        "participant's rate is "
        "Beta distributed with uniform mean and intraclass correlation, and, per minute of exposure, Gamma "
        "distributed "
        "with Poisson counts. Rates are compared by their posteriors, and beside it by Fisher's exact test "
        "(1935) and "
        "the exact conditional test within participants (Mehta et al. 1985)."
    )


def _refits(refitted: Refits | None) -> str:
    if refitted is None or not refitted.scores:
        return ""
    return (
        "Models were compared by the log predictive density of participants left out, each model fitted "
        "anew without "
        "them, a participant's own deviations integrated out; standard errors are over participants "
        "(Vehtari et al. "
        "2017)."
    )


def _model(fit: Fit) -> str:
    settings = fit.settings
    said = [
        "Every question was analysed on its own with a Bradley-Terry model (Bradley & Terry 1952): each mode "
        "has an ability, and the answer to a comparison depends on the difference of the two abilities.",
        fit.model if fit.model.endswith(".") else f"{fit.model}.",
    ]
    if settings.engine == "gibbs":
        said.append("It was sampled as in Caron & Doucet (2012), pooled and without a side effect.")
    elif settings.link == "adjacent":
        said.append("Ties follow Davidson (1970).")
    else:
        said.append(
            "Answers are ordered categories cut from one latent scale at points that are symmetrical between "
            "A and B; with two levels this is Bradley-Terry itself, with three it is the model of Rao & "
            "Kupper (1967), and with five it keeps “much more” apart from “more” (Agresti 1992)."
        )
    if any(q.hierarchical for q in fit.questions):
        said.append(
            "Each participant may deviate from the group, so that several answers of one person don't count "
            "as independent."
        )
    elif settings.engine != "gibbs":
        said.append("Participants have no deviations of their own in this fit (pooled).")
    if settings.side_effect and settings.engine != "gibbs":
        said.append("A side effect takes up a liking for whatever was shown as A.")
    return " ".join(said)


def _worth(fit: Fit) -> str:
    priors = "; ".join(f"{name} ~ {prior}" for name, prior in fit.priors.items())
    return (
        "Worths are the abilities put through a softmax, draw by draw: they lie between 0 and 1 and add up "
        "to 1, as in Figure 5 of Carmichael et al. (2017). Dots are posterior means and intervals are "
        "highest-density intervals; the chance to rank first is the share of draws in which a mode is "
        "highest." + (f" Priors: {priors}." if priors else "")
    )


def _sampling(fit: Fit) -> str:
    settings = fit.settings
    if settings.engine == "gibbs":
        how = "the Gibbs sampler with gamma-distributed skills"
    else:
        how = f"the No-U-Turn sampler (Hoffman & Gelman 2014; target acceptance {settings.target_accept:g})"
    return (
        f"Engine “{settings.engine}” drew {settings.chains} chains of {settings.draws:,} with {how} after "
        f"{settings.tune:,} draws of warm-up each, seed {settings.seed}; a question that did not pass the "
        "convergence gate (rank-normalised split R-hat and effective sample size, Vehtari et al. 2021) is "
        "not ranked."
    )
