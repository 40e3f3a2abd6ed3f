"""``report.html``: one self-contained page, from the template beside it."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan
from typing import Literal

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from analysis.answer_shares import PairShares
from analysis.figures.labels import one_line, percent
from analysis.figures.style import Drawing
from analysis.report.findings import Finding, Phrase
from analysis.report.methods import Reference
from analysis.results import Fit, QuestionFit
from analysis.stuck import StuckRate
from analysis.stuck_contrasts import StuckContrast

MOST_ROWS = 400
"""A longer table stays in its CSV file: the page says which."""
_PRINTED_ROWS = 40
_NAMED_IN_A_REASON = 6
_BELOW_THE_TITLE_PX = 640
_PLAIN_NAMES = {
    "side_effect": "side effect",
    "cut_1": "cut-point 1",
    "cut_2": "cut-point 2",
    "log_nu": "log nu",
    "log_theta": "log theta",
    "subject_sd": "subject sd",
}


@dataclass(frozen=True)
class Table:
    """Numbers behind a figure, as text.

    Attributes
    ----------
    columns : tuple of str
    numeric : tuple of bool
        Which columns are set right.
    rows : tuple of tuples of str
    source : str
        The CSV file with the same numbers in full precision.
    """

    columns: tuple[str, ...]
    numeric: tuple[bool, ...]
    rows: tuple[tuple[str, ...], ...]
    source: str

    @property
    def fits(self) -> bool:
        """True if the page can hold it."""
        return len(self.rows) <= MOST_ROWS


@dataclass(frozen=True)
class Section:
    """A heading with a figure, its caption and the table behind it; or with words and a table alone.

    On a screen every table opens below its figure. On paper a short one can stand there (``here``),
    a long one at the end (``appended``), and one whose numbers the figure already prints need not (``no``).
    """

    heading: str
    drawings: tuple[Drawing, ...]
    caption_start: str
    caption: str
    table: Table | None
    paper: Literal["here", "appended", "no"] = "no"
    words: tuple[str, ...] = ()

    @property
    def is_open(self) -> bool:
        """True if the table stands by itself, not behind a figure."""
        return bool(self.words) and not self.drawings

    @property
    def is_printed(self) -> bool:
        """True if paper shows the table below its figure, as it is short."""
        return self.paper == "here" and self.table is not None and len(self.table.rows) <= _PRINTED_ROWS

    @property
    def is_appended(self) -> bool:
        """True if paper shows the table at the end."""
        return self.paper == "appended" and self.table is not None and 0 < len(self.table.rows) <= MOST_ROWS


@dataclass(frozen=True)
class Page:
    """Everything the template prints."""

    title: str
    subtitle: str
    tag: str
    lead: tuple[Phrase, ...]
    worth: Section
    findings: tuple[Finding, ...]
    unranked: tuple[QuestionFit, ...]
    cautions: tuple[str, ...]
    sections: tuple[Section, ...]
    methods: tuple[str, ...]
    references: tuple[Reference, ...]
    provenance: tuple[tuple[str, str], ...]
    footer_left: str
    footer_right: str

    @property
    def opens_with_words(self) -> bool:
        """True if the first figure is too tall to stand below the title, and follows the table instead."""
        return self.worth.drawings[0].height_px > _BELOW_THE_TITLE_PX


def render(page: Page) -> str:
    """The page as HTML. Everything from outside is escaped; only the drawings are markup."""
    environment = Environment(
        loader=PackageLoader("analysis.report", "template"),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_keep_together,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(percent=percent, one_line=one_line, missing=missing_comparisons)
    loader = environment.loader
    assert loader is not None
    css = loader.get_source(environment, "report.css")[0]
    drawn = {d.name: Markup(d.svg) for s in (page.worth, *page.sections) for d in s.drawings}
    return environment.get_template("report.html.j2").render(page=page, css=Markup(css), drawn=drawn)


def _keep_together(value: object) -> object:
    """No line ends between a number and its per cent sign."""
    if isinstance(value, str) and not isinstance(value, Markup):
        return value.replace(" %", "\u00a0%")
    return value


def missing_comparisons(question: QuestionFit) -> str:
    """All comparisons that a question lacks, where the reason itself names only the first of them."""
    pairs = [f"{one_line(i)} against {one_line(j)}" for i, j in question.missing_pairs]
    if len(pairs) <= _NAMED_IN_A_REASON:
        return ""
    more = f" and {len(pairs) - MOST_ROWS} more" if len(pairs) > MOST_ROWS else ""
    return f"All missing comparisons: {', '.join(pairs[:MOST_ROWS])}{more}."


def _signed(number: str) -> str:
    """A number with a true minus sign."""
    return number.replace("-", "\u2212")


def worth_table(fit: Fit) -> Table:
    """Worth, abilities and ranks of every ranked question."""
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(m.mode),
            f"{m.worth_mean:.3f}",
            f"{m.worth_hdi_low:.3f} to {m.worth_hdi_high:.3f}",
            _signed(f"{m.ability_mean:+.2f}"),
            f"{m.ability_sd:.2f}",
            f"{percent(m.p_best)} %",
            f"{m.rank_mean:.2f}",
        )
        for q in fit.questions
        if q.ranked
        for m in q.modes
    )
    columns = ("Question", "Mode", "Worth", "94 % interval", "Ability", "sd", "First", "Mean rank")
    return Table(columns, (False, False, *([True] * 6)), rows, "worth.csv")


def pairwise_table(fit: Fit) -> Table:
    """Every pair that was asked, with its answers."""
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(p.mode_i),
            one_line(p.mode_j),
            f"{percent(p.p_i_above_j)} %" if q.ranked else "",
            f"{p.n:,}",
            f"{p.wins_i:,}",
            f"{p.ties:,}",
            f"{p.wins_j:,}",
        )
        for q in fit.questions
        for p in q.pairs
    )
    columns = ("Question", "Mode i", "Mode j", "i above j", "Answers", "For i", "Ties", "For j")
    return Table(columns, (False, False, False, *([True] * 5)), rows, "pairwise.csv")


def ranks_table(fit: Fit) -> Table:
    """Chance of every rank, for as many modes as fit a page."""
    ranked = [q for q in fit.questions if q.ranked]
    width = min(len(fit.modes), 8)
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(m.mode),
            *(f"{percent(p)} %" for p in m.rank_probabilities[:width]),
            f"{m.rank_mean:.2f}",
        )
        for q in ranked
        for m in q.modes
    )
    columns = ("Question", "Mode", *(f"Rank {k + 1}" for k in range(width)), "Mean")
    return Table(columns, (False, False, *([True] * (width + 1))), rows, "posterior.nc")


def parameters_table(fit: Fit) -> Table:
    """Side effect, cut-points and subject sd."""
    rows = tuple(
        (
            one_line(q.question.name),
            _PLAIN_NAMES.get(p.name, p.name),
            _signed(f"{p.mean:.3f}"),
            f"{p.sd:.3f}",
            _signed(f"{p.hdi_low:.3f} to {p.hdi_high:.3f}"),
        )
        for q in fit.questions
        for p in q.parameters
    )
    columns = ("Question", "Parameter", "Mean", "sd", "94 % interval")
    return Table(columns, (False, False, True, True, True), rows, "parameters.csv")


def answers_table(fit: Fit, shares: Sequence[Sequence[PairShares]]) -> Table:
    """Counts of every answer, pair by pair; scales of different length are set around the ties."""
    rows = []
    for question, pairs in zip(fit.questions, shares, strict=True):
        for p in pairs:
            cells = [f"{n:,}" for n in p.counts]
            spread = {
                2: ["", cells[0], "", cells[-1], ""],
                3: ["", *cells, ""],
                5: cells,
            }[len(cells)]
            rows.append((one_line(question.question.name), one_line(p.mode_i), one_line(p.mode_j), *spread))
    columns = ("Question", "Mode i", "Mode j", "i much", "i", "Same", "j", "j much")
    return Table(columns, (False, False, False, *([True] * 5)), tuple(rows), "the responses")


def stuck_table(rates: Sequence[StuckRate]) -> Table:
    """Stuck rates with their counts; per minute where the time of exposure is known."""
    rows = tuple(
        (
            one_line(r.mode),
            f"{r.stuck:,} of {r.comparisons:,}",
            f"{100 * r.rate_mean:.1f} % ({100 * r.rate_hdi_low:.1f} to {100 * r.rate_hdi_high:.1f})",
            f"{100 * r.between.mean:.1f} % ({100 * r.between.hdi_low:.1f} to {100 * r.between.hdi_high:.1f})",
            "" if isnan(r.exposure_min) else f"{r.exposure_min:.1f}",
            ""
            if isnan(r.per_minute_mean)
            else f"{r.per_minute_mean:.2f} ({r.per_minute_hdi_low:.2f} to {r.per_minute_hdi_high:.2f})",
            ""
            if r.per_minute_between is None
            else f"{r.per_minute_between.mean:.2f} ({r.per_minute_between.hdi_low:.2f} to "
            f"{r.per_minute_between.hdi_high:.2f})",
        )
        for r in rates
    )
    columns = ("Mode", "Stuck", "Rate", "Over people", "Minutes", "Per minute", "Per minute over people")
    return Table(columns, (False, *([True] * 6)), rows, "stuck.csv and parameters.csv")


def contrasts_section(contrasts: Sequence[StuckContrast]) -> Section | None:
    """Stuck rates against each other: posterior, and exact tests beside it."""
    if not contrasts:
        return None
    words = (
        "The chance is posterior. Beside it exact tests of equal rates, two-sided: Fisher's takes "
        "comparisons as "
        "independent; the one within people conditions on how often each person got stuck, so that a few "
        "people "
        "who are stuck in everything can't make a difference between modes. No correction for several pairs.",
    )
    rows = tuple(
        (
            one_line(c.mode_i),
            one_line(c.mode_j),
            f"{percent(c.p_i_above_j)} %",
            f"{c.p_fisher:.2g}",
            f"{c.p_within_people:.2g}",
        )
        for c in contrasts
    )
    columns = ("Mode i", "Mode j", "i higher", "p, Fisher", "p, within people")
    table = Table(columns, (False, False, True, True, True), rows, "stuck_contrasts.csv")
    return Section("Do the stuck rates differ?", (), "", "", table, words=words)


def diagnostics_table(fit: Fit) -> Table:
    """Convergence of every question."""
    rows = tuple(
        (
            one_line(q.question.name),
            str(q.question.levels),
            f"{q.n:,}",
            f"{q.n_participants:,}" if q.n_participants else "",
            "" if isnan(q.rhat_max) else f"{q.rhat_max:.3f}",
            "" if isnan(q.ess_min) else f"{q.ess_min:,.0f}",
            f"{q.divergences:,}",
            "ranked" if q.ranked else "not ranked",
        )
        for q in fit.questions
    )
    columns = ("Question", "Levels", "Answers", "People", "R-hat", "ESS", "Divergences", "Result")
    return Table(columns, (False, True, True, True, True, True, True, False), rows, "summary.json")
