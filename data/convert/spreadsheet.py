"""Spreadsheets (.xlsx, .xls, .ods): the values that are stored in the cells; no formula is computed."""

import datetime as dt
import io

from data.convert.delimited import Record
from data.convert.table import Cell, listed
from data.errors import InputError


def spreadsheet_records(path: str, content: bytes, sheet: str = "") -> list[Record]:
    """The rows of a sheet; a number without decimals is written without them.

    Raises
    ------
    InputError
        If the file is not a spreadsheet, or has several sheets with content and none is named.
    """
    from python_calamine import CalamineError, CalamineWorkbook

    try:
        workbook = CalamineWorkbook.from_filelike(io.BytesIO(content))
        sheets = {
            name: workbook.get_sheet_by_name(name).to_python(skip_empty_area=False)
            for name in workbook.sheet_names
        }
    except (CalamineError, OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{path}: cannot be read as a spreadsheet ({reason}): save it as CSV") from None
    filled = [name for name, rows in sheets.items() if rows]
    if sheet and sheet not in sheets:
        raise InputError(f"{path}: --sheet: {sheet!r} is not one of: {listed(sheets)}")
    if not filled:
        raise InputError(f"{path}: the spreadsheet is empty")
    if not sheet and len(filled) > 1:
        raise InputError(f"{path}: has several sheets: {listed(filled)}; name one by --sheet")
    records = [
        Record(line, tuple(map(_text, cells))) for line, cells in enumerate(sheets[sheet or filled[0]], 1)
    ]
    return [record for record in records if any(record.cells)]


def _text(value: object) -> Cell:
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, float) and value.is_integer():
        return str(int(value))
    if isinstance(value, dt.datetime | dt.date | dt.time):
        return value.isoformat(" ") if isinstance(value, dt.datetime) else value.isoformat()
    return str(value) if value != "" else None
