"""A study's data as catalogues and Psych-DS read it: a schema.org ``Dataset`` in JSON-LD.

References
----------
schema.org/Dataset and schema.org/PropertyValue; Psych-DS, psychds-docs.readthedocs.io.
"""

from collections.abc import Sequence

from data.codebook import Field, Sheet
from data.study import Study

_CONTEXT = "https://schema.org/"
_TECHNIQUE = "blinded comparison of two robot control modes at a time"


def dataset_description(study: Study, sheets: Sequence[Sheet]) -> dict[str, object]:
    """The content of ``dataset_description.json``.

    Who made the data, under which licence and with whose money is not known to a study file: it is left out,
    not invented.
    """
    return {
        "@context": _CONTEXT,
        "@type": "Dataset",
        "name": study.title or study.name,
        "description": study.description or f"Answers, trials and events of the study {study.name}",
        "version": study.version,
        "keywords": ["paired comparison", "human-robot interaction", "robot control modes"],
        "measurementTechnique": _TECHNIQUE,
        "variableMeasured": variables(sheets),
    }


def variables(sheets: Sequence[Sheet]) -> list[dict[str, object]]:
    """Every column of some tables, each name once; what it means in each table, where that differs."""
    by_name: dict[str, list[tuple[Sheet, Field]]] = {}
    for sheet in sheets:
        for field in sheet.fields:
            by_name.setdefault(field.name, []).append((sheet, field))
    return [_variable(name, uses) for name, uses in by_name.items()]


def _variable(name: str, uses: Sequence[tuple[Sheet, Field]]) -> dict[str, object]:
    meanings = [(sheet.name, _described(field)) for sheet, field in uses]
    if len({meaning for _, meaning in meanings}) == 1:
        description = meanings[0][1]
    else:
        description = "; ".join(f"in {table}: {meaning}" for table, meaning in meanings)
    described: dict[str, object] = {"@type": "PropertyValue", "name": name, "description": description}
    units = {field.unit for _, field in uses}
    if len(units) == 1 and "" not in units:
        described["unitText"] = units.pop()
    return described


def _described(field: Field) -> str:
    closed = f" (one of: {', '.join(field.valid)})" if field.valid else ""
    return f"{field.meaning}{closed}"
