"""Dataclasses of plain numbers, as compiled code reads them: NumPy records with the same field names.

A compiled function is annotated with the dataclass and is given its record; `wall.left_y_m` means the
same in Python and in machine code, and no number is ever found by an index.
"""

from dataclasses import fields
from typing import TypeVar, cast

import numpy as np

Fields = TypeVar("Fields")

_TYPES = {"float": np.float64, "int": np.int64, "bool": np.bool_}


def dtype_of(cls: type) -> np.dtype:
    """The record type of a dataclass whose fields are all float, int or bool."""
    columns = []
    for field in fields(cls):
        name = field.type if isinstance(field.type, str) else field.type.__name__
        columns.append((field.name, _TYPES[name]))
    return np.dtype(columns, align=True)


def record_of(instance: Fields) -> Fields:
    """The record (``np.void``) that holds a dataclass instance's numbers.

    It is typed as the dataclass, since that is how compiled code reads it.
    """
    row = np.zeros(1, dtype_of(type(instance)))
    for name in row.dtype.names or ():
        row[name] = getattr(instance, name)
    return cast(Fields, row[0])
