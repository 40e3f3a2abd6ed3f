"""The forms that can be converted: a module here with a ``FORM`` is one."""

import importlib
import pkgutil
from functools import cache

from data.convert.form import Form
from data.errors import one_of


@cache
def forms() -> dict[str, Form]:
    """All forms by name."""
    modules = (
        importlib.import_module(f"{__name__}.{module.name}") for module in pkgutil.iter_modules(__path__)
    )
    every = sorted((module.FORM for module in modules), key=lambda form: form.name)
    return {form.name: form for form in every}


def find_form(name: str) -> Form:
    """A form by its name.

    Raises
    ------
    InputError
        Listing the forms, if there is none of that name.
    """
    if name not in forms():
        raise one_of("form", name, ["look", *forms()])
    return forms()[name]
