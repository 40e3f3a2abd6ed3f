"""Are several "likely" firsts worth together what a report says? python tests/benchmarks/joint_statement.py

Two kinds of simulated studies of six questions (three of five levels, three of three) on the schedule of
2017, each fitted as a report would fit it:

- nobody prefers any mode: in which share of studies is at least one first place called likely, and on one
  question in which share is a first place named with a chance of 95 % or more;
- true values drawn from the priors: how many named firsts are wrong, beside how many the report expects to be
  wrong, and in how many studies all are right, beside the stated chance that they are.
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.calibration.world import Design, Truth, draw_answers, draw_truth
from analysis.claims import all_right, expected_wrong
from analysis.fit import fit
from analysis.looks import LOOKS_GOOD
from analysis.model import Model
from analysis.report.findings import findings, first_claims
from analysis.results import Fit, FitSettings

LEVELS = (5, 5, 5, 3, 3, 3)
SUBJECT_SD = 0.7
"""Of people without any preference as a group [logit]; as `elbowroom power` assumes."""
CUTS = {3: {"cut_1": 0.5}, 5: {"cut_1": 0.5, "cut_2": 1.5}}


@dataclass(frozen=True)
class Study:
    """What a report says of one study, and what is true.

    Attributes
    ----------
    named, wrong : int
        First places that are called likely, and those of them that are not the true ones.
    expected, all_right : float
        How many of them are expected to be wrong, and the chance that none is.
    sure : int
        Questions on which the chance of a first place is at least ``LOOKS_GOOD``.
    """

    named: int
    wrong: int
    expected: float
    all_right: float
    sure: int


def simulated_study(participants: int, has_preference: bool, seed: int) -> Study:
    """One study of six questions."""
    rng = np.random.default_rng(seed)
    design = Design(participants)
    fits: list[Fit] = []
    best: dict[str, str] = {}
    for number, levels in enumerate(LEVELS, start=1):
        model = Model(levels, "cumulative", True, True, 1.0)
        truth = draw_truth(model, design.n_modes, rng) if has_preference else _alike(levels, design)
        table = draw_answers(model, truth, design, rng)
        name = f"Q{number}"
        question = replace(table.questions[0], name=name, short=name)
        table = replace(table, rows=table.rows.assign(question=name), questions=(question,))
        fits.append(fit(table, FitSettings(seed=seed)))
        best[name] = design.modes[int(truth.ability.argmax())]
    whole = replace(fits[0], questions=tuple(one.questions[0] for one in fits))
    found = findings(whole)
    claims = first_claims(found)
    likely = [f for f in found if f.reading == "likely"]
    return Study(
        len(claims),
        sum(f.first != best[f.question.question.name] for f in likely),
        expected_wrong(claims),
        all_right(claims),
        sum(f.chance >= LOOKS_GOOD for f in found),
    )


def _alike(levels: int, design: Design) -> Truth:
    return Truth(np.zeros(design.n_modes), {"side_effect": 0.1, "subject_sd": SUBJECT_SD} | CUTS[levels])


def mean_and_error(values: Sequence[float]) -> tuple[float, float]:
    """Mean over studies with its standard error."""
    return float(np.mean(values)), float(np.std(values, ddof=1) / np.sqrt(len(values)))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=200, help="of each size and kind")
    parser.add_argument("--participants", type=int, nargs="+", default=[7, 20])
    parser.add_argument("--only", choices=("alike", "prior"), help="one of the two kinds")
    asked = parser.parse_args()
    for participants in asked.participants:
        if asked.only != "prior":
            studies = [simulated_study(participants, False, 10_000 + k) for k in range(asked.studies)]
            share, error = mean_and_error([s.named > 0 for s in studies])
            sure, sure_error = mean_and_error([s.sure / len(LEVELS) for s in studies])
            print(
                f"{participants} people who prefer no mode, {asked.studies} studies: at least one likely "
                f"first in {100 * share:.1f} ± {100 * error:.1f} %; on one question a chance of "
                f"{100 * LOOKS_GOOD:.0f} % or more in {100 * sure:.1f} ± {100 * sure_error:.1f} %",
                flush=True,
            )
        if asked.only != "alike":
            studies = [simulated_study(participants, True, 20_000 + k) for k in range(asked.studies)]
            print(f"{participants} people, truth from the priors, {asked.studies} studies:", flush=True)
            for what, stated, actual in (
                ("wrong firsts", [s.expected for s in studies], [float(s.wrong) for s in studies]),
                ("all right", [s.all_right for s in studies], [float(s.wrong == 0) for s in studies]),
            ):
                (said, _), (true, _) = mean_and_error(stated), mean_and_error(actual)
                _, error = mean_and_error([a - s for a, s in zip(actual, stated, strict=True)])
                print(
                    f"  {what}: stated {said:.3f}, actual {true:.3f}, "
                    f"standard error of the difference {error:.3f}"
                )
            print(f"  named firsts a study: {np.mean([s.named for s in studies]):.2f}", flush=True)


if __name__ == "__main__":
    main()
