"""A source document's experiment as a folder: tables, figures, verdicts."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.reproduction_figures import drawings
from data.errors import InputError
from data.locations import check_folder, writing_folder
from sim_trials.reproductions.verdict import Judgement, Reproduction, Verdict, verdict_table

MARKER = "verdicts.csv"


@dataclass(frozen=True)
class Written:
    """What was written, and what to say about it."""

    paths: tuple[Path, ...]
    summary: str


def reproduce(document: str, out: Path) -> Written:
    """Run one document's experiment and write ``verdicts.csv``, its tables and its figures into a folder.

    Raises
    ------
    InputError
        If there is no such document, or the folder holds something else.
    """
    work = _experiment(document)
    check_folder(out, MARKER)
    done = work()
    with writing_folder(out, marker=MARKER, owns=()) as folder:
        for name, table in done.tables.items():
            table.to_csv(folder / f"{name}.csv", index=False)
        for drawing in drawings(done):
            drawing.write(folder)
        verdict_table(done.verdicts).to_csv(folder / MARKER, index=False)
        names = sorted(path.name for path in folder.iterdir())
    return Written(tuple(out / name for name in names), _summary(done))


def _experiment(document: str) -> Callable[[], Reproduction]:
    from sim_trials.reproductions.beaudoin2022 import experiment as beaudoin2022
    from sim_trials.reproductions.mulumbwa import experiment as mulumbwa

    known = {
        "mulumbwa": mulumbwa.reproduce,
        "beaudoin2022": beaudoin2022.reproduce,
    }
    if document not in known:
        raise InputError(f"{document!r} is no source document; valid: {', '.join(sorted(known))}")
    return known[document]


def _summary(done: Reproduction) -> str:
    counted = Counter(verdict.judgement for verdict in done.verdicts)
    said = ", ".join(f"{counted[j]} {j.value}" for j in Judgement if counted[j])
    return "\n".join([done.source, f"{len(done.verdicts)} claims: {said}", *_lines(done.verdicts)])


def _lines(verdicts: Sequence[Verdict]) -> list[str]:
    return [f"  {v.judgement.value:<27} {v.claim}" for v in verdicts]
