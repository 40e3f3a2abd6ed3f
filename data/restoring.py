"""Rebuilding a study in a store from its export, without loss."""

import json
from datetime import datetime
from hashlib import sha256
from pathlib import Path

from sqlalchemy import Table

from data.errors import ElbowroomError, InputError
from data.export import FORMAT, MARKER
from data.locations import atomic_write
from data.store import Store
from data.store.snapshot import TABLES, Snapshot, restore_snapshot
from data.store.tables import Real, UtcTime, external_runs
from data.study_file import parse_study, with_trial_source


def import_export(folder: Path, store: Store) -> int:
    """Rebuild a study in a store from the folder that ``export_study`` wrote.

    Every file is compared with its hash first. Recordings are put in their place before the rows
    that name them; all rows are written in one transaction.

    Returns
    -------
    int
        Rows that the store did not have yet.

    Raises
    ------
    InputError
        If the folder is no export, or a file in it is missing or was changed.
    ElbowroomError
        If the store has other data in the same place; it then stays as it was.
    """
    folder = Path(folder)
    paths, export_format = _verified_files(folder)
    snapshot: Snapshot = {}
    for table in TABLES:
        name = f"raw/{table.name}.jsonl"
        if name not in paths:
            if export_format == 1 and table is external_runs:
                snapshot[table.name] = []
                continue
            raise InputError(f"{folder}: is no whole export: {name} is missing")
        lines = (folder / name).read_text(encoding="utf-8").split("\n")
        snapshot[table.name] = [_row(table, json.loads(line)) for line in lines if line]
    if len(snapshot["studies"]) != 1:
        raise InputError(f"{folder}: raw/studies.jsonl: one study is needed")
    study = snapshot["studies"][0]
    parse_study(str(study["toml"]), where=f"{folder}: study.toml")
    if export_format == 1:
        study["toml"] = with_trial_source(str(study["toml"]))
    for trial in snapshot["trials"]:
        if trial["recording"]:
            source = folder / "recordings" / str(trial["recording"])
            target = store.recordings_folder / str(trial["recording"])
            content = source.read_bytes()
            if target.exists() and target.read_bytes() != content:
                raise ElbowroomError(f"{target}: another recording is there; import into a new store")
            if not target.exists():
                atomic_write(target, content)
    return restore_snapshot(store, snapshot)


def _verified_files(folder: Path) -> tuple[set[str], int]:
    """The paths of an export's files, all of them there and with the right contents, and its format."""
    try:
        package = json.loads((folder / MARKER).read_text(encoding="utf-8"))
        resources = {str(item["path"]): str(item["hash"]) for item in package["resources"]}
        export_format = int(package["elbowroom"]["format"])
    except FileNotFoundError:
        raise InputError(f"{folder}: is no export: {MARKER} is missing") from None
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(f"{folder / MARKER}: is not the data package of an export") from None
    if export_format > FORMAT:
        raise InputError(
            f"{folder}: was written by a newer Elbowroom (format {export_format}, this one knows {FORMAT})"
        )
    for name, expected in resources.items():
        path = folder / name
        if ".." in Path(name).parts or Path(name).is_absolute() or not path.is_file():
            raise InputError(f"{path}: the file is missing")
        if f"sha256:{sha256(path.read_bytes()).hexdigest()}" != expected:
            raise InputError(f"{path}: was changed after the export")
    return set(resources), export_format


def _row(table: Table, given: dict[str, object]) -> dict[str, object]:
    """A row as the store's columns take it, from its JSON."""
    row = dict(given)
    for column in table.columns:
        if column.nullable:
            row.setdefault(column.name, None)
        value = row.get(column.name)
        if isinstance(column.type, UtcTime) and isinstance(value, str):
            row[column.name] = datetime.fromisoformat(value)
        elif isinstance(column.type, Real) and value is not None:
            row[column.name] = float(str(value))
        elif column.name == "metrics" and isinstance(value, dict):
            row[column.name] = {name: float(number) for name, number in value.items()}
    return row
