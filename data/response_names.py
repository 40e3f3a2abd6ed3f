"""The names in a response CSV: those that a reader cannot tell apart are not two names."""

from data.csv_file import CsvFile
from data.errors import InputError
from data.labels import LookAlike, listed_names, look_alikes, quoted
from data.study import Study


def check_names(file: CsvFile, study: Study | None) -> list[str]:
    """Refuse names that look alike and are spelled in two ways.

    Capital letters tell participants and comparisons apart, since their names are often random letters. Where
    a study is given it says which modes and questions there are.

    Returns
    -------
    list of str
        Sentences on names that may well be two and look much alike.

    Raises
    ------
    InputError
        At the later of the two spellings, with the line of the earlier.
    """
    notes = []
    for columns, what, case_counts in (
        (("mode_a", "mode_b"), "mode", False),
        (("question",), "question", False),
        (("participant",), "participant", True),
        (("comparison",), "comparison", True),
    ):
        if study is not None and not case_counts:
            continue
        present = [file.columns[name] for name in columns if name in file.columns]
        names = dict.fromkeys(text for column in present for text in column.values)
        for pair in look_alikes(names, case_counts=case_counts)[:1]:
            raise _alike(file, columns, what, pair)
        if what == "participant" and (pairs := look_alikes(names)):
            notes.append(
                "Participants whose names differ by capital letters alone are taken as different people: "
                f"{listed_names([name for pair in pairs for name in (pair.earlier, pair.later)])}."
            )
    return notes


def _alike(file: CsvFile, columns: tuple[str, ...], what: str, pair: LookAlike) -> InputError:
    """The error for two names that look alike, at the later one."""
    places = {}
    for name in (pair.earlier, pair.later):
        places[name] = min(
            (column.first_row(column.values.index(name)), place)
            for place, column in enumerate(file.columns[c] for c in columns if c in file.columns)
            if name in column.values
        )
    (row, name), (other, earlier) = (
        max((p, n) for n, p in places.items()),
        min((p, n) for n, p in places.items()),
    )
    return file.error(
        row[0],
        columns[row[1]],
        f"the {what} {quoted(name)} looks like {quoted(earlier)} (line {file.line(other[0])}) and is spelled "
        "otherwise: if they are one, spell them alike; if they are two, name them so that a reader sees it",
    )
