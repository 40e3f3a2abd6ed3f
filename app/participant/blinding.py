"""The blinding door: all that a participant's pages are told of a study and a comparison is made here.

What goes out says A and B. No mode, method, parameter, allocation, seed or title leaves through it; a test
reads everything a participant's browser receives and looks for them.
"""

import hashlib
from collections import Counter

from app.participant.progress import SLOTS, Progress
from app.participant.texts import filled, texts
from app.participant.watching import was_whole, watched_s
from data.records import Comparison
from data.store import Store
from data.study import Question, Study


def stage_data(study: Study) -> dict[str, object]:
    """What drawing the wall needs: the maze, and how tilt and speed are shown."""
    maze, feedback = study.maze, study.feedback
    return {
        "maze": {
            "left": maze.left_y_m,
            "right": maze.right_y_m,
            "top": maze.top_z_m,
            "bottom": maze.bottom_z_m,
        },
        "wall_x": maze.wall_x_m,
        "path": {"solidUpTo": feedback.path_solid_up_to_m_s, "faintFrom": feedback.path_faint_from_m_s},
        "tilt": {
            "greenBelow": feedback.tilt_green_below_deg,
            "redFrom": feedback.tilt_red_from_deg,
            "fullEllipse": feedback.tilt_full_ellipse_deg,
        },
    }


def picture_data(study: Study) -> dict[str, object]:
    """For the picture of the instructions."""
    return {**stage_data(study), "texts": texts()["instructions"]}


def watch_data(study: Study, store: Store, progress: Progress, comparison: Comparison) -> dict[str, object]:
    """For the robot page of a comparison."""
    trials = store.trials(comparison=comparison.id)
    runs = Counter(trial.slot for trial in trials)
    seen: dict[str, list[int]] = {slot: [] for slot in SLOTS}
    for trial in trials:
        lap = int(trial.metrics.get("lap", 0))
        if was_whole(trial) and lap not in seen[trial.slot]:
            seen[trial.slot].append(lap)
    return {
        **_place(progress, comparison),
        **stage_data(study),
        "texts": {**_titled("watch", progress, comparison), "unlock": texts()["watch.unlock"]},
        "laps": study.protocol.laps_per_condition,
        "required_s": study.protocol.minimum_exposure_s,
        "watched": watched_s(store, comparison),
        "seen": seen,
        "runs": {slot: runs[slot] for slot in SLOTS},
        "switches": len(store.switches(comparison.id)),
        "laps_address": "/laps",
        "watched_address": "/watched",
    }


def questions_data(study: Study, progress: Progress, comparison: Comparison) -> dict[str, object]:
    """For the questions of a comparison, in the study file's own words."""
    return {
        **_place(progress, comparison),
        "texts": _titled("questions", progress, comparison),
        "questions": [_question(question) for question in study.questions],
        # An id begins with the study's hash.
        "draft_key": hashlib.sha256(comparison.id.encode()).hexdigest()[:16],
        "answers_address": "/answers",
    }


def _place(progress: Progress, comparison: Comparison) -> dict[str, object]:
    return {"comparison": comparison.position, "comparisons": len(progress.comparisons)}


def _titled(page: str, progress: Progress, comparison: Comparison) -> dict[str, str]:
    words = texts()[page]
    of, done = len(progress.comparisons), progress.answered
    own = {name: words[name] for name in ("title", "done")}
    return {**words, **filled(own, comparison=comparison.position, of=of, done=done)}


def _question(question: Question) -> dict[str, object]:
    options = [
        {
            "value": answer,
            "label": label,
            "side": "same" if answer == "A=B" else answer[0].lower(),
            "much": ">>" in answer,
        }
        for answer, label in zip(question.scale, question.labels, strict=True)
    ]
    return {
        "name": question.name,
        "wording": question.wording,
        "emphasis": question.emphasis,
        "options": options,
    }
