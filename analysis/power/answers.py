"""Answers of people to whom a scenario applies, on a study's own schedule."""

import numpy as np
import pandas as pd

from analysis.model import thresholds
from analysis.power.scenario import Scenario
from data.answers import SCALES
from data.responses import QuestionScale, ResponseTable
from data.schedule import plan_session
from data.study import Study


def draw_answers(
    study: Study, scenario: Scenario, participants: int, rng: np.random.Generator
) -> ResponseTable:
    """Answers to one question by simulated people, on the study's own schedule.

    A person feels ability_A - ability_B + side effect + own deviations + logistic noise, and the
    cut-points turn that into an answer: the model of a report, drawn without any of its formulas.
    """
    modes, ability = study.mode_names, scenario.ability
    scale = SCALES[scenario.levels]
    edges = thresholds(np.array(scenario.cuts), scenario.levels)
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
