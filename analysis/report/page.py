"""``report.html``: one self-contained page, from the template beside it."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isnan
from typing import Literal

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from analysis.answer_shares import PairShares
from analysis.diagnostics import shown_ess, shown_rhat
from analysis.figures.labels import one_line, percent
from analysis.figures.style import Drawing
from analysis.monte_carlo import MonteCarloError
from analysis.report.findings import Finding, Phrase
from analysis.report.methods import Paragraph
from analysis.report.references import Reference
from analysis.results import Fit, QuestionFit
from analysis.wording import wording

MOST_ROWS = 400
"""A longer table stays in its CSV file: the page says which."""
_OPEN_ROWS = 12
"""A longer table that stands by itself is folded."""
_SHOWN_DRAWINGS = 2
"""Of a section with more drawings the others are folded, so that one with many modes stays readable."""
_PRINTED_ROWS = 40
_NAMED_IN_A_REASON = 6
_BELOW_THE_TITLE_PX = 640


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

    @property
    def filled(self) -> "Table":
        """The same without columns that are empty in every row."""
        kept = [k for k in range(len(self.columns)) if any(row[k] for row in self.rows)]
        return Table(
            tuple(self.columns[k] for k in kept),
            tuple(self.numeric[k] for k in kept),
            tuple(tuple(row[k] for k in kept) for row in self.rows),
            self.source,
        )


@dataclass(frozen=True)
class Section:
    """A heading with a figure, its caption and the table behind it; or with words and a table alone.

    On a screen every table opens below its figure. On paper a short one can stand there (``here``),
    a long one at the end (``appended``), and one whose numbers the figure already prints need not (``no``).
    A drawing that is there to check something and not to be read can be folded too (``is_folded``).
    """

    heading: str
    drawings: tuple[Drawing, ...]
    caption_start: str
    caption: str
    table: Table | None
    paper: Literal["here", "appended", "no"] = "no"
    words: tuple[str, ...] = ()
    is_folded: bool = False

    @property
    def anchor(self) -> str:
        """What the list of contents points to."""
        return re.sub(r"[^a-z0-9]+", "-", self.heading.lower()).strip("-")

    @property
    def is_open(self) -> bool:
        """True if the table stands by itself, not behind a figure, and is short."""
        alone = bool(self.words) and (self.is_folded or not self.drawings)
        return alone and self.table is not None and len(self.table.rows) <= _OPEN_ROWS

    @property
    def shown(self) -> tuple[Drawing, ...]:
        """The drawings that stand open on the page."""
        if self.is_folded:
            return ()
        return self.drawings if len(self.drawings) <= _SHOWN_DRAWINGS else self.drawings[:1]

    @property
    def folded(self) -> tuple[Drawing, ...]:
        """The drawings that open on demand."""
        return self.drawings[len(self.shown) :]

    @property
    def captioned(self) -> Drawing:
        """The drawing that the caption stands below: the last that is open."""
        return (self.shown or self.folded)[-1]

    @property
    def folded_title(self) -> str:
        """What opens them."""
        return "The figure" if self.is_folded else "The other questions"

    @property
    def is_printed(self) -> bool:
        """True if paper shows the table below its figure, as it is short."""
        return self.paper == "here" and self.table is not None and len(self.table.rows) <= _PRINTED_ROWS

    @property
    def is_appended(self) -> bool:
        """True if paper shows the table at the end."""
        return self.paper == "appended" and self.table is not None and 0 < len(self.table.rows) <= MOST_ROWS


@dataclass(frozen=True)
class Part:
    """Sections about one thing, under a title of their own."""

    title: str
    sections: tuple[Section, ...]


@dataclass(frozen=True)
class Page:
    """Everything the template prints.

    Attributes
    ----------
    worth : Section
        The first figure, which stands before all parts.
    about_findings : tuple of str
        What is said below the table of first places: what the likely ones are worth together.
    unanswered : tuple of str
        Questions of the study that nobody answered, as they are called in a sentence.
    """

    title: str
    subtitle: str
    tag: str
    lead: tuple[Phrase, ...]
    worth: Section
    findings: tuple[Finding, ...]
    about_findings: tuple[str, ...]
    unranked: tuple[QuestionFit, ...]
    unanswered: tuple[str, ...]
    cautions: tuple[str, ...]
    parts: tuple[Part, ...]
    methods: tuple[Paragraph, ...]
    references: tuple[Reference, ...]
    provenance: tuple[tuple[str, str], ...]
    footer_left: str
    footer_right: str

    @property
    def sections(self) -> tuple[Section, ...]:
        """All sections in the order of the page, the first figure's first."""
        return (self.worth, *(section for part in self.parts for section in part.sections))

    @property
    def opens_with_words(self) -> bool:
        """True if the first figure is too tall to stand below the title, and follows the table instead."""
        return not self.worth.drawings or self.worth.drawings[0].height_px > _BELOW_THE_TITLE_PX


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
    drawn = {d.name: Markup(d.svg) for s in page.sections for d in s.drawings}
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


_ErrorOf = Mapping[tuple[str, str, str, str], float]


def _error_of(errors: Sequence[MonteCarloError]) -> _ErrorOf:
    """Monte Carlo errors by question, mode or pair, and quantity."""
    return {(e.question, e.mode_i, e.mode_j, e.quantity): e.mcse for e in errors}


def _mean(text: str, error: float | None, digits: int) -> str:
    """A mean with its Monte Carlo error where that is known."""
    return text if error is None else f"{text} ± {_never_zero(error, digits)}"


def _never_zero(error: float, digits: int) -> str:
    """An error in so many digits after the point, or below the least of them: it is never 0."""
    least = 10.0**-digits
    return f"<{least:.{digits}f}" if error < least / 2 else f"{error:.{digits}f}"


def _chance(probability: float, error: float | None) -> str:
    """A chance in per cent with its Monte Carlo error, where that is known and the chance is not a limit."""
    shown = percent(probability)
    return f"{shown} %" if error is None or shown[0] in "<>" else f"{shown} ± {_never_zero(100 * error, 1)} %"


def worth_table(fit: Fit, errors: Sequence[MonteCarloError]) -> Table:
    """Worth, abilities and ranks of every ranked question, with Monte Carlo errors."""
    of = _error_of(errors)
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(m.mode),
            _mean(f"{m.worth_mean:.3f}", of.get((q.question.name, m.mode, "", "worth_mean")), 3),
            f"{m.worth_hdi_low:.3f} to {m.worth_hdi_high:.3f}",
            _signed(f"{m.ability_mean:+.2f}"),
            f"{m.ability_sd:.2f}",
            _chance(m.p_best, of.get((q.question.name, m.mode, "", "p_best"))),
            f"{m.rank_mean:.2f}",
        )
        for q in fit.questions
        if q.ranked
        for m in q.modes
    )
    columns = ("Question", "Mode", "Worth", "94 % interval", "Ability", "sd", "First", "Mean rank")
    return Table(columns, (False, False, *([True] * 6)), rows, "worth.csv")


def pairwise_table(fit: Fit, errors: Sequence[MonteCarloError]) -> Table:
    """Every pair that was asked, with its answers and the Monte Carlo error of its chance."""
    of = _error_of(errors)
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(p.mode_i),
            one_line(p.mode_j),
            _chance(p.p_i_above_j, of.get((q.question.name, p.mode_i, p.mode_j, "p_i_above_j")))
            if q.ranked
            else "",
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
    width = min(max((len(q.modes) for q in ranked), default=0), 8)
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(m.mode),
            *(f"{percent(p)} %" for p in m.rank_probabilities[:width]),
            *([""] * (width - len(m.rank_probabilities))),
            f"{m.rank_mean:.2f}",
        )
        for q in ranked
        for m in q.modes
    )
    columns = ("Question", "Mode", *(f"Rank {k + 1}" for k in range(width)), "Mean")
    return Table(columns, (False, False, *([True] * (width + 1))), rows, "posterior.nc")


def parameters_table(fit: Fit, errors: Sequence[MonteCarloError]) -> Table:
    """Side effect, cut-points and subject sd, with Monte Carlo errors."""
    of = _error_of(errors)
    rows = tuple(
        (
            one_line(q.question.name),
            one_line(wording(p.name).table),
            _mean(_signed(f"{p.mean:.3f}"), of.get((q.question.name, "", "", p.name)), 3),
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
    most = max(2, *(question.question.levels // 2 for question in fit.questions))
    rows = []
    for question, pairs in zip(fit.questions, shares, strict=True):
        for p in pairs:
            cells = [f"{n:,}" for n in p.counts]
            half = len(cells) // 2
            outside = [""] * (most - half)
            middle = cells[half : half + len(cells) % 2] or [""]
            spread = [*outside, *cells[:half], *middle, *cells[-half:], *outside]
            rows.append((one_line(question.question.name), one_line(p.mode_i), one_line(p.mode_j), *spread))
    much = ["much", ""] if most == 2 else [">" * (k + 1) for k in reversed(range(most))]
    strengths = [f"{{}} {name}".strip() for name in much]
    for_i, for_j = ([name.format(side) for name in strengths] for side in ("i", "j"))
    columns = ("Question", "Mode i", "Mode j", *for_i, "Same", *reversed(for_j))
    has_much = any(question.question.levels > 3 for question in fit.questions)
    source = "pairwise.csv and strength.csv" if has_much else "pairwise.csv"
    is_number = (False, False, False, *([True] * (2 * most + 1)))
    return Table(columns, is_number, tuple(rows), source).filled


def diagnostics_table(fit: Fit) -> Table:
    """Convergence of every question."""
    rows = tuple(
        (
            one_line(q.question.name),
            str(q.question.levels),
            f"{q.n:,}",
            f"{q.n_participants:,}" if q.n_participants else "",
            "" if isnan(q.rhat_max) else shown_rhat(q.rhat_max),
            "" if isnan(q.ess_min) else shown_ess(q.ess_min),
            f"{q.divergences:,}",
            "ranked" if q.ranked else "not ranked",
        )
        for q in fit.questions
    )
    columns = ("Question", "Levels", "Answers", "People", "R-hat", "ESS", "Divergences", "Result")
    return Table(columns, (False, True, True, True, True, True, True, False), rows, "summary.json")
