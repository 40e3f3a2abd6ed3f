"""What a power analysis leaves behind: the table and the curve."""

from pathlib import Path

from analysis.power.outcome import Power
from data.locations import writing_folder

POWER_TABLE = "power.csv"
"""The table; it also tells an earlier result's folder, which may be replaced."""
FILES = (POWER_TABLE, "power.svg", "power.png")


def write_power(result: Power, out: Path) -> tuple[Path, ...]:
    """Write the table and the curve as SVG and PNG; the paths are returned."""
    from analysis.figures.power import draw_power

    with writing_folder(out, marker=POWER_TABLE, owns=FILES) as folder:
        draw_power(result).write(folder)
        (folder / POWER_TABLE).write_text(table_csv(result), encoding="utf-8", newline="\n")
    return tuple(out / name for name in FILES)


def table_csv(result: Power) -> str:
    """The table with the assumptions in every row, so that it stands for itself."""
    plan, scenario = result.plan, result.plan.scenario
    table = result.table.assign(
        study=plan.study.name,
        conclusion=plan.conclusion.sentence(plan.study.mode_names),
        assumed=scenario.sentence,
        seed=plan.seed,
    )
    return table.to_csv(index=False, lineterminator="\n")
