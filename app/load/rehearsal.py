"""A load test from beginning to end."""

import asyncio
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path

import numpy as np
import tomli_w

from app.load.crowd import Crowd, Load
from app.load.served import served
from app.studies import OpenedStudy
from data.schedule import plan_session
from data.study import Study
from data.study_file import parse_study

ALONE, WHILE_FITTING = "alone", "while reports are fitted"
_RATERS = 20

Progress = Callable[[int, int, str], None]


def rehearse(
    opened: OpenedStudy,
    *,
    participants: int,
    seconds: float,
    workers: int | None,
    with_report: bool,
    progress: Progress,
) -> dict[str, Load]:
    """Measure a server under load, alone and, if wanted, while reports are fitted on the same machine.

    Parameters
    ----------
    opened : OpenedStudy
        Guided, whatever its file says.
    seconds : float
        Time of each measurement [s].
    workers : int, optional
        Live workers; by default one per core.

    Raises
    ------
    ElbowroomError
        If the server doesn't start, or closes a socket.
    """
    text = guided_text(opened.text)
    study = parse_study(text, where=opened.study.name)
    names = (ALONE, WHILE_FITTING) if with_report else (ALONE,)

    async def measure(crowd: Crowd, folder: Path) -> dict[str, Load]:
        measured = {}
        whole = round(seconds) * len(names)
        progress(0, whole, "the workers compile")
        try:
            await crowd.start()
            for number, name in enumerate(names):
                said = partial(_say, progress, number * round(seconds), whole, name)
                with fitting(folder, study) if name == WHILE_FITTING else nullcontext():
                    measured[name] = await crowd.measure(seconds, said)
            progress(whole, whole, "")
        finally:
            await crowd.stop()
        return measured

    with tempfile.TemporaryDirectory(prefix="elbowroom-load-") as name:
        folder = Path(name)
        with served(folder, text, workers) as server:
            return asyncio.run(measure(Crowd(server, study, participants), folder))


def guided_text(text: str) -> str:
    """The study file for people who guide the robot themselves."""
    content = tomllib.loads(text)
    content["protocol"] = {**content.get("protocol", {}), "trial_source": "guided"}
    return tomli_w.dumps(content)


def _say(progress: Progress, before: int, whole: int, name: str, passed: float) -> None:
    progress(before + round(passed), whole, name)


@contextmanager
def fitting(folder: Path, study: Study) -> Iterator[None]:
    """Reports on drawn answers are fitted, one after the other, in a process of their own."""
    answers = folder / "answers.csv"
    answers.write_text(drawn_answers(study), encoding="utf-8")
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "app.load.reports",
            str(answers),
            str(folder / "study.toml"),
            str(folder / "out"),
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield
    finally:
        process.kill()
        process.wait()


def drawn_answers(study: Study) -> str:
    """A response CSV of as many answers as a small study has; they mean nothing."""
    rng = np.random.default_rng(study.seed)
    rows = ["participant,question,mode_a,mode_b,response"]
    for number in range(1, _RATERS + 1):
        for planned in plan_session(study, number):
            if planned.check:
                continue
            rows += [
                f"p{number},{question.name},{planned.mode_a},{planned.mode_b},{rng.choice(question.scale)}"
                for question in study.questions
            ]
    return "\n".join(rows) + "\n"
