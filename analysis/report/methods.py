"""The methods paragraph and the references of a report, said from the settings of its fit."""

from dataclasses import dataclass

from analysis.results import Fit


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


def methods(fit: Fit) -> tuple[str, ...]:
    """Paragraphs that let someone repeat the analysis."""
    return (_model(fit), _worth(fit), _sampling(fit))


def references(fit: Fit) -> tuple[Reference, ...]:
    """The sources of the model, the sampler and the checks that this fit used."""
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
    return tuple(used)


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
