"""`elbowroom convert`: the forms that people have, to the response CSV."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from data.errors import InputError

Texts = list[str] | None
"""What may be repeated."""


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
        Path | None,
        typer.Option("--map", metavar="MAP.toml", help="What the columns mean, as written by --write-map."),
    ] = None,
    write_map: Annotated[
        Path | None,
        typer.Option("--write-map", metavar="MAP.toml", help="Write all that these options say, for --map."),
    ] = None,
    participant: Annotated[
        str | None,
        typer.Option("--participant", metavar="COLUMN", help="Who answered; none: the file names nobody."),
    ] = None,
    answer: Annotated[
        Texts,
        typer.Option(
            "--answer",
            metavar="COLUMN[=QUESTION]",
            help="A column of answers; * in its name is a whole number. Can be repeated.",
        ),
    ] = None,
    question: Annotated[
        str | None, typer.Option("--question", metavar="NAME", help="What the question is called.")
    ] = None,
    question_column: Annotated[
        str | None,
        typer.Option("--question-column", metavar="COLUMN", help="Column that names the question."),
    ] = None,
    left: Annotated[
        str | None,
        typer.Option(
            "--left",
            metavar="COLUMN",
            help="Column with the mode shown as A; * in it is the number in --answer, or that column's name.",
        ),
    ] = None,
    right: Annotated[
        str | None, typer.Option("--right", metavar="COLUMN", help="Column with the mode shown as B.")
    ] = None,
    pair: Annotated[
        Texts,
        typer.Option(
            "--pair",
            metavar="NAME=LEFT,RIGHT",
            help="The two modes behind an answer column, its number or the name of a pair. Can be repeated.",
        ),
    ] = None,
    mode: Annotated[
        Texts, typer.Option("--mode", metavar="TEXT=NAME", help="What a mode is called. Can be repeated.")
    ] = None,
    word: Annotated[
        Texts,
        typer.Option(
            "--word",
            metavar="TEXT=ANSWER",
            help="What a word or code means: A (left preferred), B, equal, none, or an answer such as A>>B. "
            "Can be repeated.",
        ),
    ] = None,
    only: Annotated[
        Texts,
        typer.Option(
            "--only",
            metavar="COLUMN=VALUE",
            help="Rows that count; several values of one column are alternatives. Can be repeated.",
        ),
    ] = None,
    without: Annotated[
        Texts, typer.Option("--without", metavar="COLUMN=VALUE", help="Rows to leave out. Can be repeated.")
    ] = None,
    ranking: Annotated[
        Texts,
        typer.Option(
            "--ranking",
            metavar="COLUMNS[=QUESTION]",
            help="Columns of a ranking, such as 'rank[*]'. Can be repeated.",
        ),
    ] = None,
    winner: Annotated[
        Literal["rows", "columns"] | None,
        typer.Option("--winner", help="Who was preferred in the cells of a matrix of counts."),
    ] = None,
    levels: Annotated[
        int | None,
        typer.Option("--levels", min=2, max=9, help="Levels of a scale of numbers around 0: 7 for -3 to 3."),
    ] = None,
    positive: Annotated[
        Literal["A", "B"] | None, typer.Option("--positive", help="Which side a number above 0 prefers.")
    ] = None,
    order: Annotated[
        str | None,
        typer.Option(
            "--order",
            metavar="COLUMN=AS_NAMED,EXCHANGED",
            help="Column that says whether left and right were exchanged, and its two values.",
        ),
    ] = None,
    answer_is: Annotated[
        Literal["button", "item"] | None,
        typer.Option("--answer-is", help="What an answer names where left and right were exchanged."),
    ] = None,
    leave_out: Annotated[
        Texts,
        typer.Option(
            "--leave-out",
            metavar="LINE|KIND",
            help="A line, or what is refused otherwise: contradictions, off-scale, repeated, same-mode. "
            "Can be repeated.",
        ),
    ] = None,
    keep: Annotated[
        Texts, typer.Option("--keep", metavar="COLUMN", help="A further column to keep. Can be repeated.")
    ] = None,
    sheet: Annotated[
        str | None, typer.Option("--sheet", metavar="NAME", help="Which sheet of a spreadsheet.")
    ] = None,
) -> None:
    """Convert exported answers to the response CSV.

    Nothing is guessed: what a file does not say has to be told. How each column was read, and which rows were
    left out and why, is printed. All forms, with an example each: data/convert/README.md.

    Example: elbowroom convert survey.csv --from limesurvey --answer pair1 --pair pair1=M1,M2 --word A1=A
    --word A2=B --out responses.csv
    """
    from data.convert import (
        ConvertOptions,
        convert_files,
        find_form,
        map_text,
        merged,
        read_map,
        response_csv,
        with_options,
    )
    from data.convert.table import counted
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
    _check_places([*files, *([map_] if map_ else [])], [place for place in (out, write_map) if place])
    base = merged(preset.defaults, content, str(map_)) if map_ else preset.defaults
    options = ConvertOptions(
        participant=participant,
        answer=answer or (),
        question=question,
        question_column=question_column,
        left=left,
        right=right,
        pair=pair or (),
        mode=mode or (),
        word=word or (),
        only=only or (),
        without=without or (),
        ranking=ranking or (),
        winner=winner,
        levels=levels,
        positive=positive,
        order=order,
        answer_is=answer_is,
        leave_out=leave_out or (),
        keep=keep or (),
        sheet=sheet,
    )
    mapping = with_options(preset, base, options)
    conversion = convert_files(files, preset, mapping)
    text = response_csv(conversion)
    if out is None:
        raise InputError(
            f"{conversion.table.path}: all is told, and {counted(len(conversion.responses), 'response')} can "
            "be written; say where by --out FILE.csv"
        )
    if write_map:
        atomic_write(write_map, map_text(mapping, preset.defaults).encode())
    atomic_write(out, text.encode())
    print(f"{conversion.table.path}: {preset.title}")
    for line in conversion.account.lines([response.preference for response in conversion.responses]):
        print(f"  {_printable(line)}")
    print(f"{out}: {counted(len(conversion.responses), 'response')}")


def _printable(line: str) -> str:
    """A line without what could control a terminal: texts in it are from the file."""
    return "".join(letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in line)


def _check_places(files: list[Path], places: list[Path]) -> None:
    """Refuse to write over a file that is read, over a folder, or two results into one file."""
    if len({place.absolute() for place in places}) < len(places):
        raise InputError(f"{places[0]}: --out and --write-map are the same file")
    for place in places:
        if any(place.exists() and file.exists() and place.samefile(file) for file in files):
            raise InputError(f"{place}: is a file to be read; write somewhere else")
        if place.is_dir():
            raise InputError(f"{place}: is a folder, not a file")


def _look(files: list[Path], sheet: str | None) -> None:
    """Say what each file seems to be, and what has to be told about it."""
    from data.convert import forms, look

    for file in files:
        fits, table = look(file, sheet or "")
        columns = _printable(table.labels)
        if not fits:
            print(f"{file}: not known by its columns ({columns}): convert it by --from table")
            print(f"  forms: {', '.join(forms())}")
        for form in fits:
            print(f"{file}: seems to be {form.title} (--from {form.name}); columns: {columns}")
            if form.refusal:
                print(f"  {form.refusal}")
            else:
                print(f"  to be told: {form.tell}")
