"""`elbowroom convert`: the forms that people have, to the response CSV."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from data.errors import InputError

Texts = list[str]


def _several(option: str, metavar: str, text: str) -> typer.models.OptionInfo:
    return typer.Option(option, metavar=metavar, help=text)


def convert(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Exported files of one form.")],
    form: Annotated[
        str | None,
        typer.Option("--from", metavar="FORM", help="Form of the files; look: say what a file seems to be."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.csv", help="Response CSV to write.")
    ] = None,
    map_: Annotated[
        Path | None, typer.Option("--map", metavar="MAP.toml", help="What the columns mean, written before.")
    ] = None,
    write_map: Annotated[
        Path | None,
        typer.Option("--write-map", metavar="MAP.toml", help="Keep what was said, to use again."),
    ] = None,
    participant: Annotated[
        str | None,
        typer.Option("--participant", metavar="COLUMN", help="Who answered; none: the file names nobody."),
    ] = None,
    answer: Annotated[
        Texts, _several("--answer", "COLUMN[=QUESTION]", "An answer; * in it is a whole number. Repeatable.")
    ] = [],  # noqa: B006
    question: Annotated[str | None, typer.Option("--question", metavar="NAME", help="Its name.")] = None,
    question_column: Annotated[
        str | None,
        typer.Option("--question-column", metavar="COLUMN", help="Column with the question."),
    ] = None,
    left: Annotated[
        str | None,
        typer.Option("--left", metavar="COLUMN", help="Mode shown as A; * is what it is in --answer."),
    ] = None,
    right: Annotated[str | None, typer.Option("--right", metavar="COLUMN", help="Mode shown as B.")] = None,
    pair: Annotated[
        Texts, _several("--pair", "NAME=LEFT,RIGHT", "Modes of an answer column, number or pair. Repeatable.")
    ] = [],  # noqa: B006
    mode: Annotated[Texts, _several("--mode", "TEXT=NAME", "Another name of a mode. Repeatable.")] = [],  # noqa: B006
    word: Annotated[
        Texts,
        _several("--word", "TEXT=ANSWER", "ANSWER: A (left), B, equal, none or such as A>>B. Repeatable."),
    ] = [],  # noqa: B006
    only: Annotated[
        Texts, _several("--only", "COLUMN=VALUE", "Rows that count. Several of a column: any. Repeatable.")
    ] = [],  # noqa: B006
    without: Annotated[Texts, _several("--without", "COLUMN=VALUE", "Rows to leave out.")] = [],  # noqa: B006
    ranking: Annotated[
        Texts,
        _several("--ranking", "COLUMNS[=QUESTION]", "Columns of a ranking, such as 'rank[*]'."),
    ] = [],  # noqa: B006
    winner: Annotated[
        Literal["rows", "columns"] | None, typer.Option("--winner", help="Who won in a matrix of counts.")
    ] = None,
    levels: Annotated[
        int | None, typer.Option("--levels", min=2, max=9, help="Levels of a scale of numbers around 0.")
    ] = None,
    positive: Annotated[
        Literal["A", "B"] | None, typer.Option("--positive", help="Side that numbers above 0 prefer.")
    ] = None,
    order: Annotated[
        str | None,
        typer.Option("--order", metavar="COLUMN=AS_NAMED,EXCHANGED", help="Column that says who was left."),
    ] = None,
    answer_is: Annotated[
        Literal["button", "item"] | None,
        typer.Option("--answer-is", help="What an answer names, if sides changed."),
    ] = None,
    leave_out: Annotated[
        Texts,
        _several(
            "--leave-out", "LINE|KIND", "A line; contradictions, off-scale, repeated, same-mode. Repeatable."
        ),
    ] = [],  # noqa: B006
    keep: Annotated[Texts, _several("--keep", "COLUMN", "A further column to keep.")] = [],  # noqa: B006
    sheet: Annotated[str | None, typer.Option("--sheet", metavar="NAME", help="Of a spreadsheet.")] = None,
) -> None:
    """Convert answers in the form in which they were exported to the response CSV.

    Nothing is guessed: what a file cannot say has to be told. How each column was read, and which rows were
    left out, is printed. Forms, with an example each: data/convert/README.md.

    Example: elbowroom convert survey.csv --from limesurvey --pair pair1=M1,M2 --answer pair1 --word A1=A
    --word A2=B --out responses.csv
    """
    from data.convert import convert as converted
    from data.convert import find_form, map_text, merged, read_map, response_csv
    from data.convert.table import counted
    from data.convert.telling import Told, with_told
    from data.locations import atomic_write

    if form == "look":
        _look(files, sheet)
        return
    content = read_map(map_) if map_ else {}
    name = form or str(content.get("form", ""))
    if not name:
        raise InputError("say the form of the file by --from FORM; --from look says what it seems to be")
    preset = find_form(name)
    if content.get("form", name) != name:
        raise InputError(f"{map_}: is for the form {content['form']}, not for {name}")
    if out is None:
        raise InputError("say where to write the responses: --out FILE.csv")
    base = merged(preset.defaults, content, str(map_)) if map_ else preset.defaults
    told = Told(
        participant=participant,
        answer=answer,
        question=question,
        question_column=question_column,
        left=left,
        right=right,
        pair=pair,
        mode=mode,
        word=word,
        only=only,
        without=without,
        ranking=ranking,
        winner=winner,
        levels=levels,
        positive=positive,
        order=order,
        answer_is=answer_is,
        leave_out=leave_out,
        keep=keep,
        sheet=sheet,
    )
    wanted = with_told(preset, base, told)
    _check_places(files, [place for place in (out, write_map) if place])
    result = converted(files, preset, wanted)
    text = response_csv(result)
    if write_map:
        atomic_write(write_map, map_text(wanted, preset.defaults).encode())
    atomic_write(out, text.encode())
    print(f"{result.table.path}: {preset.title}")
    for line in result.account.lines([response.preference for response in result.responses]):
        print(f"  {_printable(line)}")
    print(f"{out}: {counted(len(result.responses), 'response')}")


def _printable(line: str) -> str:
    """A line without what could control a terminal: texts in it are from the file."""
    return "".join(
        character if character.isprintable() else "\N{REPLACEMENT CHARACTER}" for character in line
    )


def _check_places(files: list[Path], places: list[Path]) -> None:
    """Refuse to write over a file that is read."""
    for place in places:
        if any(place.exists() and file.exists() and place.samefile(file) for file in files):
            raise InputError(f"{place}: is the file to be converted; write somewhere else")
        if place.is_dir():
            raise InputError(f"{place}: is a folder, not a file")


def _look(files: list[Path], sheet: str | None) -> None:
    """Say what each file seems to be, and what has to be told about it."""
    from data.convert import forms, look
    from data.convert.table import listed

    for file in files:
        fits, table = look(file, sheet or "")
        names = listed(name for name in table.names if name and not name.startswith("@"))
        if not fits:
            print(f"{file}: not known by its columns ({names}): convert it by --from table")
            print(f"  forms: {', '.join(forms())}")
        for form in fits:
            print(f"{file}: seems to be {form.title} (--from {form.name}); columns: {names}")
            if form.refusal:
                print(f"  {form.refusal}")
            elif form.tell:
                print(f"  to be told: {form.tell}")
