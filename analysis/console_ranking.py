"""The ranking in a terminal: worths, intervals as bars, chances and plain words."""

import math
from collections.abc import Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from analysis.diagnostics import ess_in_words, rhat_in_words
from analysis.equality_reach import reach_of
from analysis.figures.labels import LIKELY, one_line, percent, shortened
from analysis.report.findings import Finding, findings, first_sentence
from analysis.results import Fit, ModeResult

_BAR_CELLS = 30
_MOST_MODES = 12
_FEW_SHOWN = 10
_PLAIN = str.maketrans({"“": '"', "”": '"', "…": "~", "’": "'"})
_BLOCKS, _ASCII = "░▓█┊", "-=O:"
"""Signs for the 94 % interval, the 50 % interval, the mean, and no preference."""


def print_ranking(fit: Fit, console: Console, *, is_simulated: bool = False) -> None:
    """Print every question's modes with their worth, its interval and the chance to rank first.

    Fits 80 columns and needs no colour. More than twelve modes are cut to the ten of highest worth.

    Parameters
    ----------
    fit : Fit
    console : rich.console.Console
    is_simulated : bool
        True if any answer was simulated: the heading then says so.
    """
    signs = _BLOCKS if _can_print(_BLOCKS, console) else _ASCII
    heading = Text("Worth by question", style="bold")
    if is_simulated:
        heading.append("  SIMULATED DATA: these are not answers of people", style="bold yellow")
    console.print(heading)
    top = _scale_top(fit)
    width = max((len(one_line(mode)) for mode in fit.modes), default=4)
    for found in findings(fit):
        console.print()
        _print_question(found, console, signs, top, min(22, width))
    console.print()
    said = _about_the_sampler(fit)
    if any(question.ranked for question in fit.questions):
        key = f"{signs[0] * 3} 94 %, {signs[1] * 3} 50 %, {signs[2]} mean, {signs[3]} no preference"
        equal = {f"{1 / len(q.modes):.2f}" for q in fit.questions if q.ranked}
        key += f" ({equal.pop()})" if len(equal) == 1 else ""
        first = f"“First” is the chance to rank first; from {100 * LIKELY:.0f} % on it is called likely."
        every, reach = findings(fit), reach_of(fit)
        if reach is not None and any(f.reading == "open" for f in every) and reach.about_open:
            said = [reach.about_open, *said]
        if joint := first_sentence(every):
            said = [joint, *said]
        said = [f"{key}; bars from 0 to {top:.2g}", first, *said]
    for sentence in said:
        console.print(Text(_printable(sentence, console), style="dim"))


def _print_question(found: Finding, console: Console, signs: str, top: float, name_cells: int) -> None:
    question = found.question
    name, short = (
        _printable(shortened(text, 40), console) for text in (question.question.name, question.question.short)
    )
    heading = Text(name, style="bold")
    if question.question.short and short != name:
        heading.append(f"  {short}", style="not bold")
    heading.append(f"  {_printable(_reading(found), console)}", style="not bold")
    console.print(heading)
    if not question.ranked:
        console.print(Text(f"  {_printable(question.reason, console)}"))
        return
    table = Table(box=None, padding=(0, 1), pad_edge=False, header_style="dim")
    table.add_column("", width=1)
    table.add_column(
        "mode", width=max(4, name_cells), no_wrap=True, overflow="ellipsis" if signs == _BLOCKS else "crop"
    )
    table.add_column("worth", justify="right", no_wrap=True)
    table.add_column("", width=_BAR_CELLS, no_wrap=True)
    table.add_column("first", justify="right", no_wrap=True)
    for mode in _shown(question.modes):
        weight = "bold" if mode.p_best >= LIKELY else ""
        table.add_row(
            "",
            Text(_printable(one_line(mode.mode), console)),
            f"{mode.worth_mean:.2f}",
            _bar(mode, 1 / len(question.modes), top, signs),
            Text(f"{percent(mode.p_best)} %", style=weight),
        )
    console.print(table)
    if len(question.modes) > _MOST_MODES:
        console.print(Text(f"  and {len(question.modes) - _FEW_SHOWN} more of lower worth", style="dim"))


def _shown(modes: Sequence[ModeResult]) -> Sequence[ModeResult]:
    if len(modes) <= _MOST_MODES:
        return modes
    return sorted(modes, key=lambda m: -m.worth_mean)[:_FEW_SHOWN]


def _reading(found: Finding) -> str:
    if found.reading == "not ranked":
        return "(not ranked)"
    first = shortened(found.first, 24)
    not_good = ", which isn't better" if found.question.question.polarity == "lower_is_better" else ""
    if found.reading == "likely":
        return f"({first} likely first{not_good})"
    return f"(open; most often first: {first})"


def _bar(mode: ModeResult, no_preference: float, top: float, signs: str) -> Text:
    def cell(worth: float) -> int:
        return min(_BAR_CELLS - 1, int(worth / top * _BAR_CELLS))

    bar = [" "] * _BAR_CELLS
    bar[cell(no_preference)] = signs[3]
    for low, high, sign in (
        (mode.worth_hdi_low, mode.worth_hdi_high, signs[0]),
        (mode.worth_50_low, mode.worth_50_high, signs[1]),
        (mode.worth_mean, mode.worth_mean, signs[2]),
    ):
        for k in range(cell(low), cell(high) + 1):
            bar[k] = sign
    return Text("".join(bar))


def _scale_top(fit: Fit) -> float:
    highest = max((m.worth_hdi_high for q in fit.questions for m in q.modes), default=1.0)
    return next(top for top in (0.1, 0.2, 0.4, 0.6, 0.8, 1.0) if highest <= top or top == 1.0)


def _printable(text: str, console: Console) -> str:
    """What a terminal of few signs can print of a text, instead of failing at a quotation mark."""
    plain = text if _can_print(text, console) else text.translate(_PLAIN)
    return plain.encode(console.encoding, errors="replace").decode(console.encoding)


def _can_print(text: str, console: Console) -> bool:
    try:
        text.encode(console.encoding)
    except UnicodeEncodeError:
        return False
    return True


def _about_the_sampler(fit: Fit) -> list[str]:
    if math.isnan(fit.rhat_max):
        return []
    state = "converged" if fit.converged else "NOT converged"
    return [
        f"Engine {fit.settings.engine}, seed {fit.settings.seed}, {state}: R-hat "
        f"{rhat_in_words(fit.rhat_max)}, ESS {ess_in_words(fit.ess_min)}, divergences {fit.divergences:,}."
    ]
