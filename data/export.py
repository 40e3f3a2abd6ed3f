"""A study's data as a folder that needs no Elbowroom: tidy CSV, a codebook, a data package, recordings.

The CSV files are for people and spreadsheets. ``raw/`` holds the same rows as the store's tables have
them, so that the store can be rebuilt (``data.importing.import_export``). The same data give the
same bytes.
"""

import hashlib
import io
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from data.codebook import Field, Sheet, codebook, column_names, sheets_of
from data.data_package import data_package
from data.dataset_description import dataset_description
from data.errors import ElbowroomError
from data.locations import writing_folder
from data.store import Store, StoredStudy, tables
from data.store.snapshot import Row, Snapshot, take_snapshot

Progress = Callable[[int, int, str], None]

FORMAT = 2
"""Counts the formats of an export. Format 1 had only observed laps, and no ``external_runs``."""
MARKER = "datapackage.json"
"""The file that tells an export from any other folder."""
SHEETS = ("participants", "comparisons", "responses", "trials", "stuck_events", "switches", "audit")
OWNS = (
    *(f"{name}.csv" for name in SHEETS),
    "codebook.json",
    "dataset_description.json",
    "study.toml",
    "recordings",
    "raw",
    MARKER,
)

FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r", "\n", "＝", "＋", "－", "＠")
"""First characters that make a spreadsheet run a text as a formula."""


@dataclass(frozen=True)
class ExportResult:
    """What an export holds."""

    folder: Path
    participants: int
    comparisons: int
    responses: int
    trials: int
    recordings: int


def export_study(
    store: Store,
    study: StoredStudy,
    out: Path,
    include_simulated: bool = False,
    progress: Progress | None = None,
) -> ExportResult:
    """Write a study's data to a folder; an earlier export there is replaced.

    Parameters
    ----------
    out : Path
        A new or empty folder, or an earlier export.
    include_simulated : bool
        Whether simulated participants are exported too.

    Raises
    ------
    InputError
        If the folder holds something else, or the study has simulated participants only and they
        are not asked for.
    ElbowroomError
        If the folder cannot be written, or a recording is missing or not as it was stored.
    """
    snapshot = take_snapshot(store, study, include_simulated)
    names = [str(trial["recording"]) for trial in snapshot["trials"] if trial["recording"]]
    steps = len(names) + 2
    report = progress or (lambda done, total, now: None)
    with writing_folder(Path(out), marker=MARKER, owns=OWNS) as folder:
        report(0, steps, "tables")
        sheets, rows = sheets_and_rows(study, snapshot)
        for sheet in sheets:
            write_csv(folder / sheet.file, sheet.fields, rows[sheet.name])
        (folder / "study.toml").write_text(study.toml, encoding="utf-8", newline="")
        write_json(folder / "codebook.json", codebook(study.study, sheets))
        write_json(folder / "dataset_description.json", dataset_description(study.study, sheets))
        (folder / "recordings").mkdir()
        for done, trial in enumerate((t for t in snapshot["trials"] if t["recording"]), start=1):
            report(done, steps, str(trial["recording"]))
            _copy_recording(store, folder / "recordings", trial)
        (folder / "raw").mkdir()
        for table, stored in snapshot.items():
            _write_raw(folder / "raw" / f"{table}.jsonl", stored)
        report(steps - 1, steps, MARKER)
        about = {
            "name": study.name.lower(),
            "title": study.study.title,
            "description": study.study.description,
            "version": study.version,
        }
        elbowroom = {
            "format": FORMAT,
            "study_revision": study.revision,
            "study_sha256": study.sha256,
            "includes_simulated": include_simulated,
            "rows": {table: len(stored) for table, stored in snapshot.items()},
        }
        write_json(folder / MARKER, data_package(folder, sheets, about, elbowroom))
        report(steps, steps, "")
    return ExportResult(
        Path(out),
        len(snapshot["participants"]),
        len(snapshot["comparisons"]),
        len(snapshot["responses"]),
        len(snapshot["trials"]),
        len(names),
    )


def sheets_and_rows(study: StoredStudy, snapshot: Snapshot) -> tuple[tuple[Sheet, ...], dict[str, list[Row]]]:
    """The tables that people read, and the rows of each by its name."""
    metrics = sorted({name for trial in snapshot["trials"] for name in _mapping(trial["metrics"])})
    background = sorted({name for who in snapshot["participants"] for name in _mapping(who["background"])})
    pooled = any(who["pooled"] for who in snapshot["participants"])
    columns = {
        "background": column_names("background", background, tables.participants),
        "metrics": column_names("metric", metrics, tables.trials),
    }
    sheets = sheets_of(study.study, columns["metrics"], columns["background"], pooled)
    return sheets, _tidy(snapshot, [question.name for question in study.study.questions], columns)


def _tidy(
    snapshot: Snapshot, questions: Sequence[str], columns: Mapping[str, Mapping[str, str]]
) -> dict[str, list[Row]]:
    """The rows of the CSV files, with what each needs from other tables."""
    participants = {row["id"]: row for row in snapshot["participants"]}
    comparisons = {row["id"]: row for row in snapshot["comparisons"]}
    trials = {row["id"]: row for row in snapshot["trials"]}
    places = {comparison: place for place, comparison in enumerate(comparisons)}
    responses: list[Row] = []
    for row in snapshot["responses"]:
        comparison = comparisons[row["comparison"]]
        source = participants[comparison["participant"]]["source"]
        responses.append({**comparison, **row, "response": row["answer"], "count": 1, "source": source})
    responses.sort(key=lambda row: (places[row["comparison"]], questions.index(str(row["question"]))))
    events: list[Row] = []
    for row in snapshot["stuck_events"]:
        trial = trials[row["trial"]]
        participant = comparisons[trial["comparison"]]["participant"]
        events.append(
            {**row, "comparison": trial["comparison"], "mode": trial["mode"], "participant": participant}
        )
    return {
        "participants": [_spread(row, "background", columns) for row in snapshot["participants"]],
        "comparisons": snapshot["comparisons"],
        "responses": responses,
        "trials": [_spread(row, "metrics", columns) for row in snapshot["trials"]],
        "stuck_events": events,
        "switches": snapshot["switches"],
        "audit": [
            {**row, "detail": json.dumps(row["detail"], sort_keys=True, ensure_ascii=False)}
            for row in snapshot["audit"]
        ],
    }


def _mapping(value: object) -> Mapping[str, object]:
    assert isinstance(value, Mapping)
    return value


def _spread(row: Row, part: str, columns: Mapping[str, Mapping[str, str]]) -> Row:
    """A row with a column for each value that one of its cells names."""
    return {**row, **{columns[part][name]: value for name, value in _mapping(row[part]).items()}}


def write_csv(path: Path, fields: Sequence[Field], rows: Iterable[Row]) -> None:
    """Write a table with a header; each cell as `cell` makes it."""
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join(field.name for field in fields) + "\n")
        for row in rows:
            file.write(",".join(_quoted(cell(row.get(field.name))) for field in fields) + "\n")


def cell(value: object) -> str:
    """A value as it stands in a CSV file: no formula, times in UTC, an unknown number empty."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, datetime):
        return utc_text(value)
    if isinstance(value, float) and math.isinf(value):
        return "INF" if value > 0 else "-INF"
    if isinstance(value, int | float):
        return repr(value)
    text = str(value)
    return f"'{text}" if text.startswith(FORMULA_STARTS) else text


def _quoted(text: str) -> str:
    """A cell by RFC 4180. (Python's own writer leaves a lone carriage return bare, which ends a row.)"""
    if any(mark in text for mark in ',"\r\n'):
        return '"' + text.replace('"', '""') + '"'
    return text


def utc_text(time: datetime) -> str:
    """A time as text, to the microsecond, so that texts sort as times do."""
    return time.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")


def _copy_recording(store: Store, folder: Path, trial: Row) -> None:
    source = store.recordings_folder / str(trial["recording"])
    try:
        content = source.read_bytes()
    except FileNotFoundError:
        raise ElbowroomError(f"{source}: the recording of trial {trial['id']} is missing") from None
    if hashlib.sha256(content).hexdigest() != trial["recording_sha256"]:
        raise ElbowroomError(
            f"{source}: the recording of trial {trial['id']} was changed after it was stored"
        )
    (folder / source.name).write_bytes(content)


def _write_raw(path: Path, rows: Iterable[Row]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        for row in rows:
            plain = {name: _plain(value) for name, value in row.items()}
            file.write(json.dumps(plain, ensure_ascii=False, separators=(",", ":")) + "\n")


def _plain(value: object) -> object:
    """A value as JSON has it; NaN, which JSON lacks, stays distinct from null by its text."""
    if isinstance(value, datetime):
        return utc_text(value)
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, Mapping):
        return {name: _plain(part) for name, part in sorted(value.items())}
    return value


def write_json(path: Path, content: Mapping[str, object]) -> None:
    """Write an object with its keys in the order they have."""
    text = io.StringIO()
    json.dump(content, text, indent=2, ensure_ascii=False)
    path.write_text(text.getvalue() + "\n", encoding="utf-8", newline="")
