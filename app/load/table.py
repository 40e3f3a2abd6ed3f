"""A load test's result as a table for the terminal."""

from collections.abc import Mapping

from rich.table import Table

from app.load.crowd import Load

GOOD_SKIPPED_SHARE = 0.03
"""Up to this share of skipped control ticks nobody feels anything: the robot is 3 % slower."""


def load_table(measured: Mapping[str, Load]) -> Table:
    """One column for each measurement, by its name."""
    first = next(iter(measured.values()))
    table = Table(
        title=f"{first.participants} people at the robot for {first.seconds:.0f} s", title_justify="left"
    )
    table.add_column("")
    for name in measured:
        table.add_column(name, justify="right")
    loads = list(measured.values())
    table.add_row("control ticks skipped", *(_share(load.skipped_share) for load in loads))
    table.add_row("input to state, median", *(f"{load.latency_median_ms:.1f} ms" for load in loads))
    table.add_row("input to state, 95 %", *(f"{load.latency_p95_ms:.1f} ms" for load in loads))
    table.add_row("states received", *(f"{load.states_per_s:.1f} /s" for load in loads))
    table.add_row("laps ended", *(f"{load.laps}" for load in loads))
    table.add_row(
        "CPU of each live worker",
        *(_cpu(load.cpu.workers / max(load.cpu.number, 1) if load.cpu else None) for load in loads),
    )
    table.add_row("CPU of the web process", *(_cpu(load.cpu.web if load.cpu else None) for load in loads))
    table.add_row("CPU of all participants", *(_cpu(load.client_cpu) for load in loads))
    return table


def _share(share: float) -> str:
    style = "green" if share <= GOOD_SKIPPED_SHARE else "red"
    return f"[{style}]{100 * max(share, 0.0):.2f} %[/{style}]"


def _cpu(share: float | None) -> str:
    return "not known" if share is None else f"{100 * share:.0f} % of a core"
