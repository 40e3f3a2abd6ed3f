"""What the report says and draws, section by section."""

from collections.abc import Sequence
from dataclasses import replace

from analysis.closer_look import CloserLook
from analysis.data_quality import DataQuality
from analysis.diagnostics import ESS_ABOVE, RHAT_BELOW
from analysis.figures.answers import MOST_PAIRS, STANDING_FOR_ALL, draw_answers
from analysis.figures.chains import draw_chains
from analysis.figures.grid import IN_ORDER_UP_TO
from analysis.figures.labels import one_line
from analysis.figures.own_modes import draw_by_modes
from analysis.figures.pairwise import draw_pairwise
from analysis.figures.parameters import draw_parameters
from analysis.figures.ranks import draw_ranks
from analysis.figures.worth import draw_worth
from analysis.refits import Refits
from analysis.report import page as pages
from analysis.report.cautions import unanswered
from analysis.report.findings import Finding, findings, first_sentence, lead, listed
from analysis.report.methods import methods
from analysis.report.page import Page, Part, Section
from analysis.report.pairs import equivalence_section, strength_section
from analysis.report.people import agreement_section, consistency_section
from analysis.report.physics import physics_section
from analysis.report.predictions import predictive_section
from analysis.report.quality import checks_section, delay_section, exclusion_section
from analysis.report.references import cited
from analysis.report.refitted import metric_sections, people_sections, refit_sections
from analysis.report.straight_lines import straight_section
from analysis.report.stuck import contrasts_section, likely_difference, stuck_section
from analysis.report.summary import known_comparisons
from analysis.results import Fit
from analysis.straight_lining import StraightLining
from analysis.stuck import StuckRate
from analysis.stuck_contrasts import StuckContrast
from data.responses import ResponseTable
from data.study import Study

_OTHER_SCALES = {"lapse": "“careless”", "scale_sd": "“own widths”"}
"""Parameters that are not in logits, by the names of their panels."""
_MARKERS = ("circle", "square", "diamond", "triangle")
"""Of the cut-points in their order, in the figure of the parameters."""
_ERRORS = " In the numbers, ± is the Monte Carlo standard error: by how much another seed changes a value."


def simulated_tag(table: ResponseTable) -> str:
    """``simulated data``, ``partly simulated data`` or nothing."""
    if not table.is_simulated:
        return ""
    return "simulated data" if (table.rows["source"] == "simulated").all() else "partly simulated data"


def compose(
    table: ResponseTable,
    fit: Fit,
    look: CloserLook,
    rates: Sequence[StuckRate],
    contrasts: Sequence[StuckContrast],
    quality: DataQuality,
    refitted: Refits | None,
    study: Study | None,
    cautions: Sequence[str],
    versions: dict[str, str],
    lines: StraightLining | None = None,
) -> Page:
    """Everything the page prints, drawings included."""
    tag = simulated_tag(table)
    found = findings(fit)
    said = methods(fit, look, rates, refitted, study, versions, lines or StraightLining())
    names = unanswered(fit, study)
    silent = [(q.name, q.short) for q in study.questions if q.name in names] if study is not None else []
    worth, *parts = _numbered(
        [
            Part("", _known(_worth(fit, look, tag))),
            Part(
                "The modes",
                _known(
                    _pairwise(fit, look, tag),
                    equivalence_section(look, fit, tag),
                    _ranks(fit, tag),
                    _answers(fit, look, tag),
                    strength_section(look),
                ),
            ),
            Part(
                "The participants",
                _known(
                    agreement_section(look, fit, tag),
                    consistency_section(look),
                    *people_sections(refitted, fit, tag),
                    straight_section(lines or StraightLining()),
                    checks_section(quality.checks),
                ),
            ),
            Part(
                "The robot",
                _known(
                    stuck_section(rates, contrasts, tag),
                    contrasts_section(contrasts, rates),
                    physics_section(look, fit, tag, table.is_simulated, refitted is not None),
                    *metric_sections(refitted, fit, tag),
                    delay_section(quality.delays),
                    exclusion_section(quality.excluded),
                ),
            ),
            Part(
                "The model",
                _known(
                    _parameters(fit, look, tag),
                    predictive_section(look, fit, tag),
                    *refit_sections(refitted),
                    _diagnostics(fit, tag),
                ),
            ),
        ]
    )
    return Page(
        title=_title(table, study),
        subtitle=_subtitle(table, fit, study),
        tag=tag,
        lead=lead(
            found,
            rates,
            tag,
            [short or name for name, short in silent],
            likely_difference(contrasts, rates),
            look.equality,
        ),
        worth=worth.sections[0],
        findings=found,
        about_findings=_about_findings(found, look),
        unranked=tuple(q for q in fit.questions if not q.ranked),
        unanswered=tuple(f"{name} {short}".strip() for name, short in silent),
        cautions=tuple(cautions),
        parts=tuple(part for part in parts if part.sections),
        methods=said,
        references=cited(" ".join(paragraph.text for paragraph in said)),
        provenance=_provenance(table, fit, study, versions),
        footer_left=f"Elbowroom, engine {fit.settings.engine}, Bradley-Terry, seed {fit.settings.seed}",
        footer_right=f"data {table.sha256[:4]} {table.sha256[4:8]}",
    )


def _known(*sections: Section | None) -> tuple[Section, ...]:
    return tuple(section for section in sections if section is not None)


def _numbered(parts: Sequence[Part]) -> list[Part]:
    """The same with the figures that there are counted from 1, and the drawings' names with the number."""
    numbered, number = [], 0
    for part in parts:
        sections = []
        for section in part.sections:
            if section.drawings:
                number += 1
                named = tuple(replace(d, name=f"figure_{number}_{d.name}") for d in section.drawings)
                section = replace(section, drawings=named, caption_start=f"Figure {number}.")
            sections.append(section)
        numbered.append(replace(part, sections=tuple(sections)))
    return numbered


def _title(table: ResponseTable, study: Study | None) -> str:
    one = _participants(table) == 1
    if simulated_tag(table) == "simulated data":
        who = "does one simulated participant" if one else "do simulated participants"
        return f"{'Which mode' if study is not None else 'What'} {who} prefer?"
    who = "does one participant" if one else "do people"
    return f"{'Which control mode' if study is not None else 'What'} {who} prefer?"


def _participants(table: ResponseTable) -> int:
    """How many people the answers name; 0 if they name none."""
    rows = table.rows[~table.rows["check"].astype(bool) & (table.rows["participant"] != "")]
    return int(rows["participant"].nunique()) if table.has_participants else 0


def _subtitle(table: ResponseTable, fit: Fit, study: Study | None) -> str:
    rows = table.rows[~table.rows["check"].astype(bool)]
    title = one_line(study.title if study is not None else table.title)
    version = f", version {one_line(study.version)}" if study is not None else ""
    people = _participants(table)
    shown = known_comparisons(rows)
    counts = [
        *([_counted(people, "participant")] if people else []),
        *([_counted(shown, "comparison")] if shown else []),
        _counted(int(rows["count"].sum()), "answer"),
        _counted(len(fit.modes), "mode"),
    ]
    return f"{title}{version}. {', '.join(counts)}."


def _counted(n: int, noun: str) -> str:
    return f"{n:,} {noun}{'' if n == 1 else 's'}"


def _worth(fit: Fit, look: CloserLook, tag: str) -> Section:
    sizes = {len(q.mode_names) for q in fit.questions if q.ranked} or {len(fit.modes)}
    worth = 1 / min(sizes)
    shown = f"{worth:.2f}" if worth >= 0.095 else f"{worth:.3f}"
    equal = f"{shown} (dotted)" if len(sizes) == 1 else "1 over the number of its modes (dotted)"
    many = max(sizes) > IN_ORDER_UP_TO
    lower = [q.question for q in fit.questions if q.question.polarity == "lower_is_better" and q.ranked]
    caption = (
        f"Worth of each mode: they add up to 1 in each question, and {equal} is no preference. Thin "
        "lines are 94 % credible intervals, thick lines 50 %. “First %” is the chance that the mode ranks "
        "first, bold from 80 on."
        f"{_ERRORS if look.errors else ''}"
    )
    if many:
        caption += " Modes are sorted by worth."
    for question in lower[:3]:
        name, short = one_line(question.name), one_line(question.short)
        caption += f" In {name} a high worth means “{short}”, which isn't better."
    heading = "Preference by question"
    if not any(q.ranked for q in fit.questions):
        words = "No question is ranked, so there are no worths to draw: the reasons stand above."
        return Section(heading, (), "", "", None, words=(words,))
    drawings = draw_by_modes(fit.questions, lambda some, modes: draw_worth(some, modes, tag))
    return Section(heading, drawings, "", caption, pages.worth_table(fit, look.errors), "appended")


def _about_findings(found: Sequence[Finding], look: CloserLook) -> tuple[str, ...]:
    """What the likely first places are worth together, and how sure the sampler is of their chances."""
    said = [sentence] if (sentence := first_sentence(found)) else []
    named = {(f.question.question.name, f.first) for f in found if f.first}
    errors = [e.mcse for e in look.errors if e.quantity == "p_best" and (e.question, e.mode_i) in named]
    if errors:
        what = "this chance by" if len(errors) == 1 else "these chances by up to"
        said.append(
            f"Another seed of the sampler changes {what} {100 * max(errors):.1f} percentage points (Monte "
            "Carlo standard error)."
        )
    return tuple(said)


def _pairwise(fit: Fit, look: CloserLook, tag: str) -> Section | None:
    ranked = [q for q in fit.questions if q.ranked]
    if not ranked:
        return None
    caption = "Chance, in per cent, that the row's mode ranks above the column's; darker is more likely."
    if max(len(q.modes) for q in ranked) <= IN_ORDER_UP_TO:
        caption += " Below it the answers behind it: for the row's mode, ties, for the column's."
        if any(p.n == 0 for q in ranked for p in q.pairs):
            caption += " Where they are 0, the pair was never shown: its chance follows from other pairs."
    else:
        caption += " Modes are sorted by their mean rank."
    drawings = draw_by_modes(ranked, lambda some, modes: draw_pairwise(some, modes, tag))
    return Section("Pair by pair", drawings, "", caption, pages.pairwise_table(fit, look.errors))


def _ranks(fit: Fit, tag: str) -> Section | None:
    ranked = [q for q in fit.questions if q.ranked and len(q.modes) > 2]
    if not ranked:
        # Who is first of two is who is above the other: the figure before says it.
        return None
    caption = "Chance, in per cent, that a mode (row) holds a rank (column); rank 1 is the highest worth."
    if max(len(q.modes) for q in ranked) > IN_ORDER_UP_TO:
        caption += " Modes are sorted by their mean rank."
    drawings = draw_by_modes(ranked, lambda some, modes: draw_ranks(some, modes, tag))
    return Section("Possible ranks", drawings, "", caption, pages.ranks_table(fit))


def _answers(fit: Fit, look: CloserLook, tag: str) -> Section:
    shares = look.shares
    caption = (
        "Answers to each pair, as shares to both sides of the middle: to the left those for the mode on the "
        "left, to the right those for the other; a whole bar is 100 %. The number is how many answers there "
        "are."
    )
    if any(pair.expected for pairs in shares for pair in pairs):
        caption += (
            " The marks below a bar are the shares that the fitted model expects from new people; where they "
            "lie far from the bar, the model does not describe the answers well, or the answers are few."
        )
    if any(len(pairs) > MOST_PAIRS for pairs in shares):
        caption += f" Of many pairs the {STANDING_FOR_ALL} most compared are shown."
    drawings = draw_answers([q.question for q in fit.questions], shares, fit.modes, tag)
    return Section("The answers", drawings, "", caption, pages.answers_table(fit, shares), "here")


def _parameters(fit: Fit, look: CloserLook, tag: str) -> Section | None:
    drawing = draw_parameters(fit.questions, tag)
    if drawing is None:
        return None
    names = {p.name for q in fit.questions for p in q.parameters}
    said, about = [], []
    if "side_effect" in names:
        about.append("side effect")
        said.append("Side effect: above 0, what is shown as A is favoured.")
    if "cut_1" in names:
        about.append("ties")
        said.append(_cut_points_in_words(fit))
    if "lapse" in names:
        about.append("careless answers")
        said.append("Careless: share of the answers that do not depend on the modes.")
    if "side_drift" in names:
        about.append("position")
        said.append(
            "Side drift: how much the side effect changes from a participant's first comparison to the last. "
            "What each mode gained by being used (learning) stands in the numbers."
        )
    if "log_nu" in names:
        about.append("ties")
        said.append("Ties: the higher, the more answers see no difference.")
    if "subject_sd" in names:
        about.append("people")
        said.append("Between people: spread of the participants' own abilities around the group's.")
    if "side_sd" in names:
        said.append("Own sides: spread of the participants' own side effects.")
    if "scale_sd" in names:
        said.append("Own widths: spread of the logarithm of how wide each participant uses the scale.")
    others = [shown for name, shown in _OTHER_SCALES.items() if name in names]
    apart = f", except {listed(others)}" if others else ""
    caption = f"{' '.join(said)} On the logit scale{apart}, with 94 % credible intervals.{_ERRORS}"
    return Section(
        f"{listed(about).capitalize()}",
        (drawing,),
        "",
        caption,
        pages.parameters_table(fit, look.errors),
        "appended",
    )


def _cut_points_in_words(fit: Fit) -> str:
    levels = {q.question.levels for q in fit.questions if q.parameters}
    most = max(levels)
    if most <= 3:
        return "Cut-points: how large a difference must feel to be noticed."
    if most > 5:
        markers = listed(_MARKERS[: (most - 1) // 2])
        return (
            "Cut-points: how large a difference must feel for each stronger answer, in their order "
            f"{markers}."
        )
    if most == 4:
        return "Cut-point: how large a difference must feel to be called “much more”."
    return (
        "Cut-points: how large a difference must feel to be called “more” (circle) and “much more” (square)."
    )


def _diagnostics(fit: Fit, tag: str) -> Section:
    drawing = draw_chains(fit.questions, tag)
    caption = (
        "Ranks of the draws of a quantity that is mostly the hardest to sample, chain by chain: flat within "
        "the band of chance (grey) means that the chains agree."
        if drawing
        else ""
    )
    drawings = (drawing,) if drawing else ()
    words = (
        "R-hat compares the chains with each other (1: they agree), ESS is how many independent draws they "
        "are worth: the smaller of that for the bulk and that for the tails, which is of the 5 % and 95 % "
        f"quantiles. A question is ranked if the largest R-hat is below {RHAT_BELOW} and the smallest ESS "
        f"above {ESS_ABOVE:.0f}.",
    )
    table = pages.diagnostics_table(fit)
    return Section(
        "Can the sampler be trusted?", drawings, "", caption, table, "here", words, is_folded=bool(drawings)
    )


def _provenance(
    table: ResponseTable, fit: Fit, study: Study | None, versions: dict[str, str]
) -> tuple[tuple[str, str], ...]:
    rows = [
        ("Data, SHA-256", table.sha256),
        *([("Study", f"{study.name}, version {study.version}, {study.sha256}")] if study is not None else []),
        ("Source", simulated_tag(table) or "people, as far as the data say"),
        ("Engine and seed", f"{fit.settings.engine}, {fit.settings.seed}"),
        ("Versions", listed([f"{name} {number}" for name, number in versions.items()])),
        ("Beside this page", "CSV files of all tables, summary.json, posterior.nc, figures"),
    ]
    return tuple(rows)
