"""The blinding door: all that a participant's pages are told of a study and a comparison is made here.

What goes out says A and B. No mode, method, parameter, allocation, seed or title leaves through it; a test
reads everything a participant's browser receives and looks for them.
"""

import hashlib
from collections import Counter

from app.participant.progress import SLOTS, Progress
from app.participant.texts import filled, texts, texts_with_parts
from app.participant.watching import counting_trials, was_whole, watched_s
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
    words = texts()["picture"]
    hand = words["your_hand" if study.protocol.trial_source == "guided" else "hand"]
    return {**stage_data(study), "texts": {**words, "hand": hand}}


def guide_data(study: Study, store: Store, progress: Progress, comparison: Comparison) -> dict[str, object]:
    """For the page of a comparison on which the participant guides the robot."""
    counting = counting_trials(store, comparison)
    laps = Counter(trial.slot for trial in counting if trial.outcome == "completed")
    return {
        **_place(progress, comparison),
        **stage_data(study),
        **_in_hand(progress),
        "texts": {**texts_with_parts("guide"), **_titled("guide", progress, comparison)},
        "required_s": study.protocol.minimum_exposure_s,
        "exposure": watched_s(store, comparison),
        "laps": {slot: laps[slot] for slot in SLOTS},
        "practice": False,
    }


def practice_data(study: Study, progress: Progress) -> dict[str, object]:
    """For the same page before the first comparison, on the rectangle that is practised on."""
    of = len(progress.comparisons)
    words = filled(texts()["guide"], done=progress.answered, of=of)
    return {
        "comparison": 0,
        "comparisons": of,
        **stage_data(study.practice_study),
        **_in_hand(progress),
        "texts": {**texts_with_parts("guide"), "title": words["practice_title"], "done": words["done"]},
        "required_s": 0.0,
        "exposure": dict.fromkeys(SLOTS, 0.0),
        "laps": dict.fromkeys(SLOTS, 0),
        "practice": True,
    }


def watch_data(study: Study, store: Store, progress: Progress, comparison: Comparison) -> dict[str, object]:
    """For the page of a comparison on which the robot is watched."""
    runs = Counter(trial.slot for trial in store.trials(comparison=comparison.id))
    seen: dict[str, list[int]] = {slot: [] for slot in SLOTS}
    for trial in counting_trials(store, comparison):
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
        "draft_key": _draft_key(comparison),
        "answers_address": "/answers",
    }


def _draft_key(comparison: Comparison) -> str:
    """What answers not yet submitted are kept under: an id begins with the study's hash, so none goes out.

    A comparison begun anew has another one: its answers are for what is seen now.
    """
    begun = f"{comparison.id} {comparison.restarted_at}" if comparison.restarted_at else comparison.id
    return hashlib.sha256(begun.encode()).hexdigest()[:16]


def _in_hand(progress: Progress) -> dict[str, object]:
    return {"device": progress.participant.device or "mouse", "live_address": "/live"}


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
