"""All that a report claims in words, gathered from its sections, and what the claims are worth together.

A claim says that something is so, with the posterior probability that it is. What only describes the answers,
or gives an estimate with its interval, claims nothing.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from analysis.claims import Claim, all_right, joint_sentence
from analysis.closer_look import CloserLook
from analysis.equivalence import EQUIVALENT_BELOW, Equivalence
from analysis.figures.labels import isolated
from analysis.moderation import Moderation
from analysis.refits import Refits
from analysis.report.findings import Finding, first_claims
from analysis.report.tables import write_csv
from analysis.results import Fit

DIFFERENCES = "Which differences matter"
SIDES = "Before you quote this"
GROUPS = "Does it depend on who is asked?"
FINDINGS_TABLE = "findings.csv"


def report_claims(
    fit: Fit,
    found: Sequence[Finding],
    look: CloserLook,
    refitted: Refits | None,
    more: Sequence[Claim] = (),
) -> tuple[Claim, ...]:
    """Every claim of a report, in the order of its sections.

    Parameters
    ----------
    more : sequence of Claim
        Those of sections that need more than the fit: on stuck rates, and on metrics of the laps.
    """
    return (
        *first_claims(found),
        *side_claims(fit),
        *difference_claims(look.equivalences),
        *more,
        *(group_claims(refitted.moderation) if refitted is not None else ()),
    )


def difference_claims(found: Sequence[Equivalence]) -> tuple[Claim, ...]:
    """The pairs that are called different, or equal in practice."""
    return tuple(_pair_claim(e) for e in found if e.reading != "open")


def _pair_claim(e: Equivalence) -> Claim:
    i, j, name = isolated(e.mode_i), isolated(e.mode_j), isolated(e.question)
    if e.reading == "equal in practice":
        text, chance = f"{i} and {j} are equal in practice on {name}.", e.p_equal
    else:
        above, below = (i, j) if e.p_i_above > e.p_j_above else (j, i)
        text = f"{above} is above {below} on {name} by more than {EQUIVALENT_BELOW:.2f} logits."
        chance = max(e.p_i_above, e.p_j_above)
    return Claim(DIFFERENCES, text, chance, e.question)


def difference_sentence(found: Sequence[Equivalence]) -> str:
    """What the readings of the pairs are worth together; empty if all are open."""
    return joint_sentence(difference_claims(found), "likely reading", "likely readings of pairs")


def side_claims(fit: Fit) -> tuple[Claim, ...]:
    """The questions on which one side is said to be favoured.

    There the interval of the side effect leaves out 0, and pairs were shown with their sides exchanged.
    """
    claims = []
    for question in fit.questions:
        effect = next((p for p in question.parameters if p.name == "side_effect"), None)
        if effect is None or question.draws is None or not question.is_side_told_apart:
            continue
        if effect.hdi_low <= 0 <= effect.hdi_high:
            continue
        draws, name = question.draws.parameters["side_effect"], question.question.name
        side, chance = ("A", np.mean(draws > 0)) if effect.mean > 0 else ("B", np.mean(draws < 0))
        text = f"Whatever was shown as {side} was favoured on {isolated(name)}."
        claims.append(Claim(SIDES, text, float(chance), name))
    return tuple(claims)


def group_claims(found: Moderation) -> tuple[Claim, ...]:
    """The differences between groups of people whose interval leaves out 0."""
    return tuple(
        Claim(
            GROUPS,
            f"The worth of {isolated(d.mode)} on {isolated(d.question)} is "
            f"{'higher' if d.p_positive > 0.5 else 'lower'} among {isolated(d.second)} than among "
            f"{isolated(d.first)} ({isolated(d.background)}).",
            max(d.p_positive, 1.0 - d.p_positive),
            d.question,
        )
        for d in found.differences
        if d.is_clear
    )


def write_findings(claims: Sequence[Claim], folder: Path) -> None:
    """Write ``findings.csv``: every claim, and the chance that all claims of its section are right.

    That chance is a lower limit where several claims of a section are about one question.
    """
    sections: dict[str, list[Claim]] = {}
    for claim in claims:
        sections.setdefault(claim.section, []).append(claim)
    joint = {section: all_right(own) for section, own in sections.items()}
    write_csv(
        folder / FINDINGS_TABLE,
        ("section", "claim", "probability", "joint"),
        ((c.section, c.text, c.probability, joint[c.section]) for c in claims),
    )
