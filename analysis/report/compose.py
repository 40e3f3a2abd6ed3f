"""What the report says and draws, section by section."""

from collections.abc import Sequence
from dataclasses import replace

from analysis.closer_look import CloserLook
from analysis.data_quality import DataQuality
from analysis.figures.answers import MOST_PAIRS, draw_answers
from analysis.figures.chains import draw_chains
from analysis.figures.labels import isolated, one_line, percent_in_words
from analysis.figures.pairwise import draw_pairwise
from analysis.figures.parameters import draw_parameters
from analysis.figures.ranks import draw_ranks, highest_chance
from analysis.figures.stuck import draw_stuck
from analysis.figures.worth import draw_worth
from analysis.refits import Refits
from analysis.report import page as pages
from analysis.report.closer import (
    agreement_section,
    consistency_section,
    equivalence_section,
    predictive_section,
    strength_section,
)
from analysis.report.findings import findings, lead, listed
from analysis.report.methods import methods, references
from analysis.report.page import Page, Section
from analysis.report.physics import physics_section
from analysis.report.quality import checks_section, delay_section, exclusion_section
from analysis.report.refitted import refit_sections
from analysis.report.summary import known_comparisons
from analysis.results import Fit
from analysis.stuck import StuckRate
from analysis.stuck_contrasts import StuckContrast
from data.responses import ResponseTable
from data.study import Study

_ONE_PAGE_OF_MODES = 8


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
) -> Page:
    """Everything the page prints, drawings included."""
    tag = simulated_tag(table)
    found = findings(fit)
    worth, *sections = _numbered(
        [
            _worth(fit, tag),
            _pairwise(fit, tag),
            equivalence_section(look, fit, tag),
            _ranks(fit, tag),
            _answers(fit, look, tag),
            strength_section(look),
            agreement_section(look, fit, tag),
            consistency_section(look),
            _stuck(rates, contrasts, tag),
            pages.contrasts_section(contrasts),
            physics_section(look, fit, tag, table.is_simulated),
            delay_section(quality.delays),
            exclusion_section(quality.excluded),
            checks_section(quality.checks),
            _parameters(fit, tag),
            predictive_section(look, fit, tag),
            _diagnostics(fit, tag),
            *refit_sections(refitted),
        ]
    )
    return Page(
        title=_title(table, study),
        subtitle=_subtitle(table, fit, study),
        tag=tag,
        lead=lead(found, rates, table.is_simulated),
        worth=worth,
        findings=found,
        unranked=tuple(q for q in fit.questions if not q.ranked),
        cautions=tuple(cautions),
        sections=tuple(sections),
        methods=methods(fit, look, rates, refitted),
        references=references(fit, look, rates, refitted),
        provenance=_provenance(table, fit, study, versions),
        footer_left=f"Elbowroom, engine {fit.settings.engine}, Bradley-Terry, seed {fit.settings.seed}",
        footer_right=f"data {table.sha256[:4]} {table.sha256[4:8]}",
    )


def _numbered(sections: Sequence[Section | None]) -> list[Section]:
    """The sections that there are, their figures counted from 1, and the drawings' names with the number."""
    kept, number = [], 0
    for section in sections:
        if section is None:
            continue
        if section.drawings:
            number += 1
            named = tuple(replace(d, name=f"figure_{number}_{d.name}") for d in section.drawings)
            section = replace(section, drawings=named, caption_start=f"Figure {number}.")
        kept.append(section)
    return kept


def _title(table: ResponseTable, study: Study | None) -> str:
    if simulated_tag(table) == "simulated data":
        return f"{'Which mode' if study is not None else 'What'} do simulated participants prefer?"
    return f"{'Which control mode' if study is not None else 'What'} do people prefer?"


def _subtitle(table: ResponseTable, fit: Fit, study: Study | None) -> str:
    rows = table.rows[~table.rows["check"].astype(bool)]
    title = one_line(study.title if study is not None else table.title)
    version = f", version {one_line(study.version)}" if study is not None else ""
    people = rows.loc[rows["participant"] != "", "participant"].nunique()
    shown = known_comparisons(rows)
    counts = [
        *([_counted(people, "participant")] if table.has_participants and people else []),
        *([_counted(shown, "comparison")] if shown else []),
        _counted(int(rows["count"].sum()), "answer"),
        _counted(len(fit.modes), "mode"),
    ]
    return f"{title}{version}. {', '.join(counts)}."


def _counted(n: int, noun: str) -> str:
    return f"{n:,} {noun}{'' if n == 1 else 's'}"


def _worth(fit: Fit, tag: str) -> Section:
    worth = 1 / len(fit.modes)
    shown = f"{worth:.2f}" if worth >= 0.095 else f"{worth:.3f}"
    many = len(fit.modes) > _ONE_PAGE_OF_MODES
    lower = [q.question for q in fit.questions if q.question.polarity == "lower_is_better" and q.ranked]
    caption = (
        f"Worth of each mode: they add up to 1 in each question, and {shown} (dotted) is no preference. Thin "
        "lines are 94 % intervals, thick lines 50 %. “First %” is the chance that the mode ranks first, bold "
        "from 80 on."
    )
    if many:
        caption += " Modes are sorted by worth."
    for question in lower[:3]:
        name, short = one_line(question.name), one_line(question.short)
        caption += f" In {name} a high worth means “{short}”, which isn't better."
    drawings = draw_worth(fit.questions, fit.modes, tag)
    return Section("Preference by question", drawings, "", caption, pages.worth_table(fit), "appended")


def _pairwise(fit: Fit, tag: str) -> Section:
    caption = "Chance, in per cent, that the row's mode ranks above the column's; darker is more likely."
    if len(fit.modes) <= _ONE_PAGE_OF_MODES:
        caption += " Below it the answers behind it: for the row's mode, ties, for the column's."
    drawings = draw_pairwise(fit.questions, fit.modes, tag)
    return Section("Pair by pair", drawings, "", caption, pages.pairwise_table(fit))


def _ranks(fit: Fit, tag: str) -> Section:
    caption = "Chance, in per cent, that a mode (row) holds a rank (column); rank 1 is the highest worth."
    if len(fit.modes) > _ONE_PAGE_OF_MODES:
        caption += (
            " Modes are sorted by their mean rank; darker is more likely, the darkest "
            f"{percent_in_words(highest_chance(fit.questions))}."
        )
    drawings = draw_ranks(fit.questions, fit.modes, tag)
    return Section("Which rank a mode may hold", drawings, "", caption, pages.ranks_table(fit))


def _answers(fit: Fit, look: CloserLook, tag: str) -> Section:
    shares = look.shares
    caption = (
        "Answers to each pair, as shares to both sides of the middle: to the left those for the mode on the "
        "left, to the right those for the other. The number is how many answers there are."
    )
    if any(pair.expected for pairs in shares for pair in pairs):
        caption += (
            " The marks below a bar are the shares that the fitted model expects from new people; where they "
            "lie far from the bar, the model does not describe the answers well, or the answers are few."
        )
    if any(len(pairs) > MOST_PAIRS for pairs in shares):
        caption += f" Of many pairs the {MOST_PAIRS} most compared are shown."
    drawings = draw_answers([q.question for q in fit.questions], shares, fit.modes, tag)
    return Section("The answers themselves", drawings, "", caption, pages.answers_table(fit, shares), "here")


def _stuck(rates: Sequence[StuckRate], contrasts: Sequence[StuckContrast], tag: str) -> Section | None:
    if not rates:
        return None
    caption = (
        "Share of a mode's comparisons in which the robot got stuck at least once under that mode, with 94 % "
        "intervals (uniform prior)."
    )
    surest = sorted(contrasts, key=lambda c: -abs(c.p_i_above_j - 0.5))
    for contrast in surest[:2]:
        high, low, chance = contrast.mode_i, contrast.mode_j, contrast.p_i_above_j
        if chance < 0.5:
            high, low, chance = low, high, 1 - chance
        caption += (
            f" The chance that {isolated(high)} has a higher rate than {isolated(low)} is "
            f"{percent_in_words(chance)}."
        )
    caption += (
        " In the numbers “over people” allows each person a rate of their own, as events cluster in "
        "people; rates "
        "per minute are of exposure to the mode. Rates hold for this task and no other."
    )
    return Section(
        "How often the robot got stuck",
        (draw_stuck(rates, tag),),
        "",
        caption,
        pages.stuck_table(rates),
        "here",
    )


def _parameters(fit: Fit, tag: str) -> Section | None:
    drawing = draw_parameters(fit.questions, tag)
    if drawing is None:
        return None
    names = {p.name for q in fit.questions for p in q.parameters}
    said = []
    if "side_effect" in names:
        said.append("Side effect: above 0, what is shown as A is favoured.")
    if "cut_1" in names:
        said.append(
            "Cut-points: how large a difference must feel to be called “more” (circle) and “much more” "
            "(square)."
            if "cut_2" in names
            else "Cut-points: how large a difference must feel to be noticed."
        )
    if names & {"log_nu", "log_theta"}:
        said.append("Ties: the higher, the more answers see no difference.")
    if "subject_sd" in names:
        said.append(
            "Differences between people: spread of the participants' own abilities around the group's."
        )
    caption = f"{' '.join(said)} On the logit scale, with 94 % intervals."
    return Section(
        "What else the model learnt",
        (drawing,),
        "",
        caption,
        pages.parameters_table(fit),
        "appended",
    )


def _diagnostics(fit: Fit, tag: str) -> Section:
    drawing = draw_chains(fit.questions, tag)
    caption = (
        "Ranks of the draws of the quantity that is hardest to sample, chain by chain: flat within the band "
        "of chance (grey) means that the chains agree."
        if drawing
        else ""
    )
    drawings = (drawing,) if drawing else ()
    return Section("Can the sampler be trusted?", drawings, "", caption, pages.diagnostics_table(fit), "here")


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
