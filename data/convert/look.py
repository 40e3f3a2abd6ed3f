"""What a file seems to be."""

from pathlib import Path

from data.convert.form import Form
from data.convert.forms import forms
from data.convert.reading import read_head
from data.convert.table import Table


def look(path: Path, sheet: str = "") -> tuple[list[Form], Table]:
    """The forms that a file may have, the most typical one first, and its first rows.

    Raises
    ------
    InputError
        If the file is neither a table nor JSON.
    """
    table = read_head(path, sheet)
    likeness = {name: _likeness(form, table) for name, form in forms().items()}
    fits = [form for name, form in forms().items() if likeness[name]]
    return sorted(fits, key=lambda form: -likeness[form.name]), table


def _likeness(form: Form, table: Table) -> int:
    """How many typical columns a file has, if it has all of them; 0: it is not of this form."""
    if form.recognise is not None:
        return len(table.names) if form.recognise(table) else 0
    has_all = all(name in table.names or table.matches(name) for name in form.columns)
    return len(form.columns) if has_all else 0
