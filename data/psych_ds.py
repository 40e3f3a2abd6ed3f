"""A study's tables as a Psych-DS data set: a folder whose names and metadata other tools can rely on.

The CSV files are those of the export, byte for byte, under names made of keywords. Each has a metadata file
beside it, since one column name may mean different things in two tables; ``dataset_description.json`` has all
columns.

References
----------
Psych-DS, rules and conventions: psychds-docs.readthedocs.io.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from data.codebook import Sheet, codebook
from data.dataset_description import dataset_description, variables
from data.export import sheets_and_rows, write_csv, write_json
from data.locations import writing_folder
from data.store import Store, StoredStudy
from data.store.snapshot import Row, take_snapshot

MARKER = "documentation/codebook.json"
"""The file that tells such a folder, written by Elbowroom, from any other."""
OWNS = (
    "CHANGES.md",
    "README.md",
    "data",
    "dataset_description.json",
    "documentation",
    "materials",
)


@dataclass(frozen=True)
class PsychDataset:
    """What a Psych-DS data set holds: its folder, and the number of rows by table."""

    folder: Path
    rows: dict[str, int]


def export_psych_ds(
    store: Store, study: StoredStudy, out: Path, include_simulated: bool = False
) -> PsychDataset:
    """Write a study's tables as a Psych-DS data set; an earlier one there is replaced.

    Parameters
    ----------
    out : Path
        A new or empty folder, or an earlier data set of this kind.
    include_simulated : bool
        Whether simulated participants are exported too.

    Raises
    ------
    InputError
        If the folder holds something else, or the study has simulated participants only and they
        are not asked for.
    ElbowroomError
        If the folder cannot be written.
    """
    snapshot = take_snapshot(store, study, include_simulated)
    sheets, rows = sheets_and_rows(study, snapshot)
    with writing_folder(Path(out), marker=MARKER, owns=OWNS) as folder:
        for part in ("data", "documentation", "materials"):
            (folder / part).mkdir()
        for sheet in sheets:
            name = table_file(study.name, sheet)
            write_csv(folder / "data" / name, sheet.fields, rows[sheet.name])
            write_json(
                folder / "data" / Path(name).with_suffix(".json"), {"variableMeasured": variables([sheet])}
            )
        write_json(folder / "dataset_description.json", dataset_description(study.study, sheets))
        write_json(folder / MARKER, codebook(study.study, sheets))
        _write(folder / "materials" / "study.toml", study.toml)
        _write(folder / "README.md", _readme(study, sheets, rows, include_simulated))
        _write(folder / "CHANGES.md", _changes(study))
    return PsychDataset(Path(out), {name: len(content) for name, content in rows.items()})


def table_file(study: str, sheet: Sheet) -> str:
    """A table's file: keyword and value by a hyphen, pairs by underscores, values of letters and digits."""
    return f"study-{_value(study)}_table-{_value(sheet.name)}_data.csv"


def _value(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9]", "", text)


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="")


def _readme(
    study: StoredStudy, sheets: Sequence[Sheet], rows: dict[str, list[Row]], include_simulated: bool
) -> str:
    lines = [
        f"# {study.study.title}",
        "",
        *([study.study.description.strip(), ""] if study.study.description.strip() else []),
        f"Study {study.name}, version {study.version}, revision {study.revision}. A Psych-DS data set.",
        *(["Simulated participants are included (column `source`)."] if include_simulated else []),
        "",
        "| file in data/ | rows | a row is identified by | what it holds |",
        "|---|---|---|---|",
        *(
            f"| `{table_file(study.name, sheet)}` | {len(rows[sheet.name])} | {', '.join(sheet.keys)} "
            f"| {sheet.meaning} |"
            for sheet in sheets
        ),
        "",
        "File names have the keywords `study` (the study's name) and `table` (which table it is).",
        "What each column means, its unit and its values: `dataset_description.json`, the `.json` file",
        "beside each table, and `documentation/codebook.json`. The study file with modes, questions and",
        "protocol: `materials/study.toml`.",
        "An empty cell is not known or not applicable; times are in UTC. A text that a spreadsheet could run",
        "as a formula has an apostrophe before it.",
        "Recordings of the trials and the tables without loss are not part of this data set; they are in",
        "Elbowroom's own export.",
        "",
        "Before you publish it, add `author`, `license` and `funder` to `dataset_description.json`.",
        "",
    ]
    return "\n".join(lines)


def _changes(study: StoredStudy) -> str:
    return f"# Changes\n\n- Version {study.version} of the study, revision {study.revision}.\n"
