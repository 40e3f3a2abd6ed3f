"""How many participants a study needs: simulated answers from planted worths, fitted as a report would.

For each number of participants the study's own schedule is filled with answers of people who differ, the
hierarchical model is fitted to them, and it is counted how often it comes to the right conclusion. The
planted numbers are assumptions about people; what follows from them is no finding about anyone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.special import betaincinv

from analysis.fit import fit
from analysis.results import HDI_PROBABILITY, FitSettings
from data.answers import SCALES
from data.errors import InputError
from data.locations import writing_folder
from data.responses import QuestionScale, ResponseTable
from data.schedule import plan_session
from data.study import Study

Progress = Callable[[int, int, str], None]

POWER_TABLE = "power.csv"
"""The table; it also tells an earlier result's folder, which may be replaced."""
FILES = (POWER_TABLE, "power.svg", "power.png")


@dataclass(frozen=True)
class Scenario:
    """What is assumed of the people and the question.

    Attributes
    ----------
    worth : tuple of float
        Planted worth of each mode of the study, in its order; any positive numbers, their ratios count.
    levels : int
        Levels of the question's scale: 2, 3 or 5.
    cuts : tuple of float
        Cut-points of the cumulative model [logit], increasing: none, one or two.
    subject_sd : float
        Spread of the participants' own abilities [logit].
    side_effect : float
        Preference for what is shown as A [logit].
    confidence : float
        P(best) from which a mode is concluded to be the best.
    """

    worth: tuple[float, ...]
    levels: int = 3
    cuts: tuple[float, ...] = (0.5,)
    subject_sd: float = 0.7
    side_effect: float = 0.1
    confidence: float = 0.95

    @property
    def sentence(self) -> str:
        """The assumptions in a line."""
        worth = " : ".join(f"{w:g}" for w in self.worth)
        cuts = f", cut-points {', '.join(f'{c:g}' for c in self.cuts)}" if self.cuts else ""
        return (
            f"Worths {worth}, {self.levels} levels{cuts}, subject sd {self.subject_sd:g}, side effect "
            f"{self.side_effect:g}, concluded from P(best) = {self.confidence:g}"
        )

    @property
    def ability(self) -> np.ndarray:
        """The abilities that have these worths, shape (modes,); they sum to 0 [logit]."""
        logs = np.log(np.array(self.worth))
        return logs - logs.mean()


@dataclass(frozen=True)
class PowerPoint:
    """What came of the simulated studies of one size.

    Attributes
    ----------
    right, wrong : int
        Studies that concluded on the planted best mode, and on another one.
    right_share, low, high : float
        Share of right conclusions, with the equal-tailed 94 % interval of a Beta(1, 1) posterior.
    """

    participants: int
    comparisons: int
    replicates: int
    right: int
    wrong: int
    right_share: float
    low: float
    high: float


@dataclass(frozen=True)
class Power:
    """The curve over sizes, and what it rests on."""

    scenario: Scenario
    points: tuple[PowerPoint, ...]

    @property
    def table(self) -> pd.DataFrame:
        """One row a size."""
        return pd.DataFrame([vars(point) for point in self.points])

    def enough(self, wanted: float) -> int | None:
        """The smallest size tried whose share of right conclusions reaches ``wanted``; None if none does."""
        return next((p.participants for p in self.points if p.right_share >= wanted), None)


def power(
    study: Study,
    scenario: Scenario,
    sizes: Sequence[int],
    *,
    replicates: int,
    seed: int,
    n_jobs: int,
    progress: Progress | None = None,
) -> Power:
    """Simulate and fit ``replicates`` studies of each size; the result does not depend on ``n_jobs``.

    Raises
    ------
    InputError
        If the scenario does not fit the study; nothing has been simulated then.
    """
    check_scenario(study, scenario)
    from joblib import Parallel, delayed

    jobs = [(size, k) for size in sorted(set(sizes)) for k in range(replicates)]
    conclude = delayed(conclusion)
    # The largest first would balance better, but people like to see the small sizes done.
    results = Parallel(n_jobs=n_jobs, return_as="generator")(
        conclude(study, scenario, size, (seed, size, k)) for size, k in jobs
    )
    found: dict[int, list[str | None]] = {}
    for done, ((size, _), concluded) in enumerate(zip(jobs, results, strict=True), start=1):
        found.setdefault(size, []).append(concluded)
        if progress:
            progress(done, len(jobs), f"{size} participants")
    best = study.mode_names[int(np.argmax(scenario.worth))]
    per_person = sum(not planned.check for planned in plan_session(study, 1))
    return Power(scenario, tuple(_point(size, per_person, best, found[size]) for size in found))


def check_scenario(study: Study, scenario: Scenario) -> None:
    """Refuse assumptions that make no study; see `power`."""
    modes, worth = study.mode_names, scenario.worth
    if len(worth) != len(modes):
        raise InputError(f"--worth: {len(worth)} numbers for {len(modes)} modes: {', '.join(modes)}")
    if not all(np.isfinite(w) and w > 0 for w in worth):
        raise InputError("--worth: every worth must be a positive number")
    if sorted(worth)[-1] == sorted(worth)[-2]:
        raise InputError("--worth: two modes share the highest worth, so there is no right conclusion")
    if scenario.levels not in SCALES:
        raise InputError(f"--levels: {scenario.levels} is not one of: 2, 3, 5")
    needed = (scenario.levels - 1) // 2
    cuts = scenario.cuts
    if len(cuts) != needed or list(cuts) != sorted(set(cuts)) or not all(0 < c < np.inf for c in cuts):
        raise InputError(
            f"--cuts: {scenario.levels} levels need {needed} increasing positive numbers, not "
            f"{', '.join(f'{c:g}' for c in cuts) or 'none'}"
        )


def conclusion(study: Study, scenario: Scenario, participants: int, seed: tuple[int, ...]) -> str | None:
    """The mode that one simulated study concludes to be best, or None if it leaves that open."""
    table = simulate_answers(study, scenario, participants, np.random.default_rng(seed))
    question = fit(table, FitSettings(seed=seed[-1])).questions[0]
    return next((m.mode for m in question.modes if m.p_best >= scenario.confidence), None)


def simulate_answers(
    study: Study, scenario: Scenario, participants: int, rng: np.random.Generator
) -> ResponseTable:
    """Answers to one question by simulated people, on the study's own schedule.

    A person feels ability_A - ability_B + side effect + own deviations + logistic noise, and the
    cut-points turn that into an answer: the model of a report, drawn without any of its formulas.
    """
    modes, ability = study.mode_names, scenario.ability
    scale = SCALES[scenario.levels]
    edges = np.array([*(-c for c in reversed(scenario.cuts)), *(scenario.cuts or (0.0,))])
    rows = []
    for person in range(1, participants + 1):
        deviation = rng.normal(size=len(modes))
        own = dict(zip(modes, ability + scenario.subject_sd * (deviation - deviation.mean()), strict=True))
        for planned in plan_session(study, person):
            felt = own[planned.mode_a] - own[planned.mode_b] + scenario.side_effect + rng.logistic()
            answer = scale[len(edges) - int(np.searchsorted(edges, felt))]
            if not planned.check:
                rows.append((f"p{person}", planned.mode_a, planned.mode_b, answer, planned.position))
    frame = pd.DataFrame(rows, columns=["participant", "mode_a", "mode_b", "response", "repetition"])
    frame = frame.assign(question="planted", count=1, comparison="", source="simulated", check=False)
    question = QuestionScale("planted", "planted", "planted", scenario.levels)
    return ResponseTable(frame, modes, (question,), True, True, "", "simulated for planning")


def write_power(result: Power, wanted: float, out: Path) -> tuple[Path, ...]:
    """Write the table and the curve as SVG and PNG; the paths are returned."""
    from analysis.figures.power import draw_power

    with writing_folder(out, marker=POWER_TABLE, owns=FILES) as folder:
        draw_power(result, wanted).write(folder)
        result.table.to_csv(folder / POWER_TABLE, index=False)
    return tuple(out / name for name in FILES)


def _point(size: int, per_person: int, best: str, concluded: Sequence[str | None]) -> PowerPoint:
    n = len(concluded)
    right = sum(mode == best for mode in concluded)
    wrong = sum(mode is not None and mode != best for mode in concluded)
    tail = (1.0 - HDI_PROBABILITY) / 2.0
    low, high = betaincinv(right + 1, n - right + 1, [tail, 1.0 - tail])
    return PowerPoint(size, size * per_person, n, right, wrong, right / n, float(low), float(high))
