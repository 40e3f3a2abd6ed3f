"""A JATOS results archive: a zip with a folder for each study result, described by ``metadata.json``.

Layout as in JATOS 3.8 and later: ``study_result_N/comp-result_M/data.txt``, and in the metadata
``data[].studyResults[].componentResults[].path``.
"""

import io
import json
import zipfile
import zlib
from collections.abc import Iterator

from data.convert.json_records import JsonRecord, json_records
from data.errors import InputError

RESULT, WORKER, URL = "@study_result", "@worker_type", "@url"
"""Columns: number of the study result, type of its worker, JSON of the study link's URL parameters."""
_BROKEN = (zipfile.BadZipFile, zlib.error, OSError, EOFError, RuntimeError)
"""What a damaged, encrypted or unusual archive raises; ``NotImplementedError`` is a ``RuntimeError``."""
_LARGEST = 2**31
"""Most bytes that an unpacked file may have."""


def archive_names(content: bytes) -> tuple[str, ...]:
    """The names of the files in a zip; none if it is damaged."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return tuple(archive.namelist())
    except (ValueError, *_BROKEN):
        return ()


def is_results_archive(content: bytes) -> bool:
    """Whether a zip holds JATOS results."""
    return "metadata.json" in archive_names(content)


def archive_records(path: str, content: bytes) -> list[JsonRecord]:
    """The records of all component results, each with the columns that say where it comes from.

    Raises
    ------
    InputError
        If the metadata are not those of results, or a file is not JSON.
    """
    records: list[JsonRecord] = []
    arrays = 0
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        for result, member in _members(path, archive):
            text = _read(path, archive, member)
            if not text.strip():
                continue
            inside = json_records(f"{path}/{member}", text)
            origin: dict[str, object] = {
                RESULT: str(result.get("id", "")),
                WORKER: str(result.get("workerType", "")),
                URL: result.get("urlQueryParameters") or {},
            }
            for record in inside:
                array = record.array + arrays if record.array else 0
                records.append(
                    JsonRecord(record.line, array, {**record.fields, **origin}, f"{path}/{member}")
                )
            arrays += max((record.array for record in inside), default=0)
    if not records:
        raise InputError(f"{path}: no component result has data")
    return records


def _members(path: str, archive: zipfile.ZipFile) -> Iterator[tuple[dict[str, object], str]]:
    """Each component result: its study result in the metadata, and its data file, in the archive's order."""
    try:
        metadata = json.loads(archive.read("metadata.json"))
        results = [result for study in metadata["data"] for result in study["studyResults"]]
        parts = [
            (result, f"{part['path'].strip('/')}/data.txt")
            for result in results
            for part in result["componentResults"]
        ]
    except _BROKEN as error:
        raise InputError(f"{path}: metadata.json cannot be unpacked: {error}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{path}: metadata.json is not that of JATOS results: {error!r}") from None
    yield from parts


def _read(path: str, archive: zipfile.ZipFile, member: str) -> str:
    """A data file's text; a component result without data has none."""
    if member not in archive.namelist():
        return ""
    if archive.getinfo(member).file_size > _LARGEST:
        raise InputError(f"{path}/{member}: larger than {_LARGEST} bytes")
    try:
        return archive.read(member).decode("utf-8-sig")
    except (ValueError, *_BROKEN) as error:
        raise InputError(f"{path}/{member}: cannot be read: {error}") from None
