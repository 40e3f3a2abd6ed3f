"""A source document's experiment as a folder: tables, figures, verdicts, and a page of them all."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.reproduction_figures import drawings
from app.reproduction_page import reproduction_page
from data.errors import InputError
from data.locations import check_folder, writing_folder
from sim_trials.reproductions.verdict import Judgement, Progress, Reproduction, Verdict, verdict_table

VERDICTS = "verdicts.csv"


@dataclass(frozen=True)
class Written:
    """What was written, and what to say about it."""

    paths: tuple[Path, ...]
    summary: str


def reproduce(document: str, out: Path, n_jobs: int = 1, progress: Progress | None = None) -> Written:
    """Run one document's experiment and write verdicts, tables, figures and a page of them into a folder.

    Parameters
    ----------
    document : str
    out : Path
        New, empty, or an earlier result of the same document.
    n_jobs : int
        Processes; the result does not depend on it.
    progress : callable, optional
        Called as ``progress(done, total, what)``.

    Raises
    ------
    InputError
        If there is no such document, or the folder holds something else.
    """
    work = _experiment(document)
    page = page_name(document)
    check_folder(out, page)
    done = work(n_jobs, progress)
    drawn = drawings(done)
    with writing_folder(out, marker=page, owns=()) as folder:
        for name, table in done.tables.items():
            table.to_csv(folder / f"{name}.csv", index=False)
        for drawing in drawn:
            drawing.write(folder)
        verdict_table(done.verdicts).to_csv(folder / VERDICTS, index=False)
        (folder / page).write_text(reproduction_page(done, drawn), encoding="utf-8", newline="\n")
        names = sorted(path.name for path in folder.iterdir())
    return Written(tuple(out / name for name in names), _summary(done))


def page_name(document: str) -> str:
    """The page that stands for a whole result, and tells whose it is."""
    return f"{document}.html"


Experiment = Callable[[int, Progress | None], Reproduction]


def _beaudoin2022(n_jobs: int, progress: Progress | None) -> Reproduction:
    from sim_trials.reproductions.beaudoin2022.experiment import reproduce

    return reproduce(progress)


def _carmichael2017(n_jobs: int, progress: Progress | None) -> Reproduction:
    from app.carmichael2017.experiment import reproduce

    return reproduce(n_jobs, progress)


def _mulumbwa(n_jobs: int, progress: Progress | None) -> Reproduction:
    from sim_trials.reproductions.mulumbwa.experiment import reproduce

    return reproduce(progress)


EXPERIMENTS: dict[str, Experiment] = {
    "beaudoin2022": _beaudoin2022,
    "carmichael2017": _carmichael2017,
    "mulumbwa": _mulumbwa,
}


def _experiment(document: str) -> Experiment:
    if document not in EXPERIMENTS:
        raise InputError(f"{document!r} is no source document; valid: {', '.join(sorted(EXPERIMENTS))}")
    return EXPERIMENTS[document]


def _summary(done: Reproduction) -> str:
    counted = Counter(verdict.judgement for verdict in done.verdicts)
    said = ", ".join(f"{counted[j]} {j.value}" for j in Judgement if counted[j])
    about = [done.source, done.simulated] if done.simulated else [done.source]
    return "\n".join([*about, f"{len(done.verdicts)} claims: {said}", *_lines(done.verdicts)])


def _lines(verdicts: Sequence[Verdict]) -> list[str]:
    return [f"  {v.judgement.value:<27} {v.claim}" for v in verdicts]
