"""A reproduction as one page: what was claimed, what came out, and the figures."""

from collections import Counter
from collections.abc import Sequence
from html import escape

from analysis.figures.style import Drawing
from sim_trials.reproductions.verdict import Judgement, Reproduction, Verdict

_HEADS = ("Claim (section)", "Published", "Here", "Assumption", "Verdict")
_MEANINGS = {
    Judgement.REPRODUCED: "came out, and nothing had to be assumed",
    Judgement.UNDER_ASSUMPTION: "came out, but hangs on what the document leaves open",
    Judgement.CONTRADICTED: "did not come out under anything tried, or the document says otherwise elsewhere",
    Judgement.NOT_DETERMINABLE: "this experiment cannot tell",
}


def reproduction_page(done: Reproduction, drawings: Sequence[Drawing]) -> str:
    """One HTML page that needs no other file."""
    counted = Counter(verdict.judgement for verdict in done.verdicts)
    kinds = "".join(
        f"<li><b>{counted[j]} {escape(j.value)}</b>: {escape(meaning)}</li>"
        for j, meaning in _MEANINGS.items()
        if counted[j]
    )
    simulated = f"<p class=said>{escape(done.simulated)}.</p>" if done.simulated else ""
    figures = "".join(
        f"<figure>{drawing.svg}<figcaption>{escape(drawing.alt)} "
        f"<small>{escape(drawing.name)}.png, .svg</small></figcaption></figure>"
        for drawing in drawings
    )
    tables = ", ".join(f"<code>{escape(name)}.csv</code>" for name in done.tables)
    heads = "".join(f"<th>{head}</th>" for head in _HEADS)
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(done.name)}, run again</title><style>{_CSS}</style></head><body>
<h1>{escape(done.name)}, run again</h1><p>{escape(done.source)}</p>{simulated}
<h2>Verdicts</h2><ul>{kinds}</ul>
<table><thead><tr>{heads}</tr></thead>
<tbody>{"".join(_row(verdict) for verdict in done.verdicts)}</tbody></table>
<h2>Figures</h2>{figures}
<h2>Tables</h2><p>{tables}, <code>verdicts.csv</code></p>
</body></html>
"""


def _row(verdict: Verdict) -> str:
    cells = (verdict.claim, verdict.published, verdict.ours, verdict.assumption)
    said = "".join(f"<td>{escape(cell)}</td>" for cell in cells)
    return f"<tr>{said}<td class=verdict>{escape(verdict.judgement.value)}</td></tr>"


_CSS = """
body{font:15px/1.5 system-ui,sans-serif;color:#1D2930;background:#fff;
 max-width:1100px;margin:32px auto;padding:0 24px}
h1{font-size:25px;margin:0}h2{font-size:18px;margin:34px 0 8px}p{color:#4C5B65;max-width:76ch;margin:4px 0}
.said{color:#1D2930;font-weight:600}ul{color:#4C5B65;padding-left:20px;margin:4px 0 14px}li b{color:#1D2930}
table{border-collapse:collapse;font-size:13.5px;line-height:1.4;table-layout:fixed;width:100%}
th,td{text-align:left;vertical-align:top;padding:7px 12px 7px 0;border-bottom:1px solid #DDE1DE;
 overflow-wrap:break-word}
th{color:#66747D;font-weight:400}th:nth-child(1){width:24%}th:nth-child(2){width:12%}th:nth-child(3){width:31%}
th:nth-child(5){width:11%}.verdict{font-weight:600}tr{break-inside:avoid}
figure{margin:18px 0 30px;break-inside:avoid}figure svg{max-width:100%;height:auto}
figcaption{color:#4C5B65;font-size:14px;max-width:76ch}small{color:#66747D}
"""
