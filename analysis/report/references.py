"""The sources that a report's methods may cite."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Reference:
    """A source the methods rest on.

    Attributes
    ----------
    authors : str
        As the text names them.
    year : int
    text : str
        As the list of references prints it.
    """

    authors: str
    year: int
    text: str

    def is_cited_in(self, text: str) -> bool:
        """True if a text names the authors with the year, in brackets or not."""
        return re.search(rf"{re.escape(self.authors)} \(?{self.year}\b", text) is not None


SOURCES = (
    Reference(
        "Abril-Pla et al.",
        2023,
        "Abril-Pla, O., Andreani, V., Carroll, C., Dong, L., Fonnesbeck, C. J., Kochurov, M., Kumar, R., "
        "Lao, J., Luhmann, C. C., Martin, O. A., Osthege, M., Vieira, R., Wiecki, T. and Zinkov, R. (2023). "
        "PyMC: a modern, and comprehensive probabilistic programming framework in Python. PeerJ Computer "
        "Science 9, e1516.",
    ),
    Reference(
        "Agresti",
        1992,
        "Agresti, A. (1992). Analysis of ordinal paired comparison data. Applied Statistics 41(2), 287–297.",
    ),
    Reference(
        "Basu",
        1980,
        "Basu, D. (1980). Randomization analysis of experimental data: the Fisher randomization test. "
        "Journal of the American Statistical Association 75(371), 575–582.",
    ),
    Reference(
        "Bayarri & Castellanos",
        2007,
        "Bayarri, M. J. and Castellanos, M. E. (2007). Bayesian checking of the second levels of "
        "hierarchical models. Statistical Science 22(3), 322–343.",
    ),
    Reference(
        "Bradley & Terry",
        1952,
        "Bradley, R. A. and Terry, M. E. (1952). Rank analysis of incomplete block designs: I. The method of "
        "paired comparisons. Biometrika 39(3/4), 324–345.",
    ),
    Reference(
        "Carmichael et al.",
        2017,
        "Carmichael, M. G., Aldini, S. and Liu, D. (2017). Human user impressions of damping methods for "
        "singularity handling in human-robot collaboration. Australasian Conference on Robotics and "
        "Automation.",
    ),
    Reference(
        "Caron & Doucet",
        2012,
        "Caron, F. and Doucet, A. (2012). Efficient Bayesian inference for generalized Bradley-Terry models. "
        "Journal of Computational and Graphical Statistics 21(1), 174–196.",
    ),
    Reference(
        "Davidson",
        1970,
        "Davidson, R. R. (1970). On extending the Bradley-Terry model to accommodate ties in paired "
        "comparison experiments. Journal of the American Statistical Association 65(329), 317–328.",
    ),
    Reference(
        "Fisher",
        1935,
        "Fisher, R. A. (1935). The logic of inductive inference. Journal of the Royal Statistical Society "
        "98(1), 39–82.",
    ),
    Reference(
        "Gelman et al.",
        1996,
        "Gelman, A., Meng, X.-L. and Stern, H. (1996). Posterior predictive assessment of model fitness via "
        "realized discrepancies. Statistica Sinica 6(4), 733–760.",
    ),
    Reference(
        "Hoffman & Gelman",
        2014,
        "Hoffman, M. D. and Gelman, A. (2014). The No-U-Turn sampler: adaptively setting path lengths in "
        "Hamiltonian Monte Carlo. Journal of Machine Learning Research 15(47), 1593–1623.",
    ),
    Reference(
        "Holm",
        1979,
        "Holm, S. (1979). A simple sequentially rejective multiple test procedure. Scandinavian Journal of "
        "Statistics 6(2), 65–70.",
    ),
    Reference(
        "Johnson",
        2005,
        "Johnson, J. A. (2005). Ascertaining the validity of individual protocols from web-based personality "
        "inventories. Journal of Research in Personality 39(1), 103–129.",
    ),
    Reference(
        "Johnson",
        2003,
        "Johnson, T. R. (2003). On the use of heterogeneous thresholds ordinal regression models to account "
        "for individual differences in response style. Psychometrika 68(4), 563–583.",
    ),
    Reference(
        "Johnson",
        2007,
        "Johnson, V. E. (2007). Bayesian model assessment using pivotal quantities. Bayesian Analysis 2(4), "
        "719–733.",
    ),
    Reference(
        "Kendall & Babington Smith",
        1940,
        "Kendall, M. G. and Babington Smith, B. (1940). On the method of paired comparisons. Biometrika "
        "31(3/4), 324–345.",
    ),
    Reference(
        "Kruschke",
        2018,
        "Kruschke, J. K. (2018). Rejecting or accepting parameter values in Bayesian estimation. Advances in "
        "Methods and Practices in Psychological Science 1(2), 270–280.",
    ),
    Reference(
        "Meade & Craig",
        2012,
        "Meade, A. W. and Craig, S. B. (2012). Identifying careless responses in survey data. Psychological "
        "Methods 17(3), 437–455.",
    ),
    Reference(
        "Mehta et al.",
        1985,
        "Mehta, C. R., Patel, N. R. and Gray, R. (1985). Computing an exact confidence interval for the "
        "common odds ratio in several 2 × 2 contingency tables. Journal of the American Statistical "
        "Association 80(392), 969–973.",
    ),
    Reference(
        "Merkle et al.",
        2019,
        "Merkle, E. C., Furr, D. and Rabe-Hesketh, S. (2019). Bayesian comparison of latent variable models: "
        "conditional versus marginal likelihoods. Psychometrika 84(3), 802–829.",
    ),
    Reference(
        "Miller",
        1974,
        "Miller, R. G. (1974). The jackknife – a review. Biometrika 61(1), 1–15.",
    ),
    Reference(
        "Papaspiliopoulos et al.",
        2007,
        "Papaspiliopoulos, O., Roberts, G. O. and Sköld, M. (2007). A general framework for the "
        "parametrization of hierarchical models. Statistical Science 22(1), 59–73.",
    ),
    Reference(
        "Rao",
        1948,
        "Rao, C. R. (1948). Large sample tests of statistical hypotheses concerning several parameters with "
        "applications to problems of estimation. Proceedings of the Cambridge Philosophical Society 44(1), "
        "50–57.",
    ),
    Reference(
        "Rao & Kupper",
        1967,
        "Rao, P. V. and Kupper, L. L. (1967). Ties in paired-comparison experiments: a generalization of the "
        "Bradley-Terry model. Journal of the American Statistical Association 62(317), 194–204.",
    ),
    Reference(
        "Robins et al.",
        2000,
        "Robins, J. M., van der Vaart, A. and Ventura, V. (2000). Asymptotic distribution of p values in "
        "composite null models. Journal of the American Statistical Association 95(452), 1143–1156.",
    ),
    Reference(
        "Romano & Wolf",
        2005,
        "Romano, J. P. and Wolf, M. (2005). Exact and approximate stepdown methods for multiple hypothesis "
        "testing. Journal of the American Statistical Association 100(469), 94–108.",
    ),
    Reference(
        "Trefethen & Weideman",
        2014,
        "Trefethen, L. N. and Weideman, J. A. C. (2014). The exponentially convergent trapezoidal rule. SIAM "
        "Review 56(3), 385–458.",
    ),
    Reference(
        "Vehtari et al.",
        2017,
        "Vehtari, A., Gelman, A. and Gabry, J. (2017). Practical Bayesian model evaluation using "
        "leave-one-out cross-validation and WAIC. Statistics and Computing 27(5), 1413–1432.",
    ),
    Reference(
        "Vehtari et al.",
        2021,
        "Vehtari, A., Gelman, A., Simpson, D., Carpenter, B. and Bürkner, P.-C. (2021). Rank-normalization, "
        "folding, and localization: an improved R̂ for assessing convergence of MCMC. Bayesian Analysis "
        "16(2), 667–718.",
    ),
    Reference(
        "Vehtari et al.",
        2024,
        "Vehtari, A., Simpson, D., Gelman, A., Yao, Y. and Gabry, J. (2024). Pareto smoothed importance "
        "sampling. Journal of Machine Learning Research 25(72), 1–58.",
    ),
    Reference(
        "Westfall & Young",
        1993,
        "Westfall, P. H. and Young, S. S. (1993). Resampling-based multiple testing: examples and methods "
        "for p-value adjustment. Wiley, New York.",
    ),
    Reference(
        "Wichmann & Hill",
        2001,
        "Wichmann, F. A. and Hill, N. J. (2001). The psychometric function: I. Fitting, sampling, and "
        "goodness of fit. Perception & Psychophysics 63(8), 1293–1313.",
    ),
    Reference(
        "Wood et al.",
        2017,
        "Wood, D., Harms, P. D., Lowman, G. H. and DeSimone, J. A. (2017). Response speed and response "
        "consistency as mutually validating indicators of data quality in online samples. Social "
        "Psychological and Personality Science 8(4), 454–464.",
    ),
)
"""In the order of a list of references."""


def cited(text: str) -> tuple[Reference, ...]:
    """The sources that a text names, in the order of a list of references."""
    return tuple(source for source in SOURCES if source.is_cited_in(text))
