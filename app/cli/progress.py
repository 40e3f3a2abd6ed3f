"""Progress of long work on the terminal: a bar where there is a screen, plain lines where not."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

Report = Callable[[int, int, str], None]
"""Called with what is done, what there is in all, and a word on what is under way."""


@contextmanager
def progress(title: str) -> Iterator[Report]:
    """Show the progress of one piece of work on stderr.

    Where stderr is no terminal (a log, CI), a line is printed at every tenth instead of a moving bar.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield _lines(title)
        return
    columns = (
        TextColumn("{task.description}", justify="left"),
        BarColumn(bar_width=30),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[now]}", style="dim"),
    )
    with Progress(*columns, console=console) as bar:
        task = bar.add_task(f"{title:<22}", total=None, now="")

        def report(done: int, total: int, now: str = "") -> None:
            bar.update(task, completed=done, total=total, now=now)

        yield report
        bar.update(task, now="")


def _lines(title: str) -> Report:
    said = -1

    def report(done: int, total: int, now: str = "") -> None:
        nonlocal said
        tenth = 10 * done // max(total, 1)
        if tenth > said:
            said = tenth
            print(f"{title}: {done}/{total}", file=sys.stderr, flush=True)

    return report
