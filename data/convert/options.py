"""The options of ``elbowroom convert``, as keys of a map."""

from collections.abc import Sequence
from dataclasses import dataclass

from data.answers import ANSWERS
from data.convert.form import Form
from data.convert.map import LEAVE_OUT, ConversionMap, known_word
from data.convert.map_file import checked_map
from data.errors import InputError

_WRITTEN = {
    "--word": f"TEXT=ANSWER, an answer being one of: A, B, equal, none, {', '.join(ANSWERS)}",
    "--mode": "TEXT=NAME",
    "--pair": "NAME=LEFT,RIGHT",
    "--order": "COLUMN=AS_NAMED,EXCHANGED",
}
NOBODY = "none"
"""The value of ``--participant`` where a file names nobody."""


@dataclass(frozen=True)
class ConvertOptions:
    """Options of ``elbowroom convert`` as they were written; empty where one is not there."""

    participant: str | None = None
    answer: Sequence[str] = ()
    question: str | None = None
    question_column: str | None = None
    left: str | None = None
    right: str | None = None
    pair: Sequence[str] = ()
    mode: Sequence[str] = ()
    word: Sequence[str] = ()
    only: Sequence[str] = ()
    without: Sequence[str] = ()
    ranking: Sequence[str] = ()
    winner: str | None = None
    levels: int | None = None
    positive: str | None = None
    order: str | None = None
    answer_is: str | None = None
    leave_out: Sequence[str] = ()
    keep: Sequence[str] = ()
    sheet: str | None = None


def with_options(form: Form, base: ConversionMap, options: ConvertOptions) -> ConversionMap:
    """A form's map, or one from a file, with what the command line says instead or in addition.

    Raises
    ------
    InputError
        One line with the option and how it is written.
    """
    for option, name in (("--participant", options.participant), ("--question", options.question)):
        if name is not None and not name.strip():
            raise InputError(f"{option}: is empty")
    content: dict[str, object] = base.model_dump(mode="json", exclude_none=True)
    content["form"] = form.name
    if options.participant is not None:
        content["participant"] = "" if options.participant == NOBODY else options.participant
    for name in ("sheet", "winner"):
        if (value := getattr(options, name)) is not None:
            content[name] = value
    content["words"] = {**base.words, **_words(options.word)}
    content["modes"] = {**base.modes, **_equations("--mode", options.mode)}
    content["pairs"] = {
        **base.pairs,
        **{k: _two("--pair", k, v) for k, v in _equations("--pair", options.pair).items()},
    }
    content["rows"] = [*_list(content["rows"]), *_rules(options)]
    content["keep"] = list(dict.fromkeys([*base.keep, *options.keep]))
    content["leave_out"] = [*base.leave_out, *options.leave_out]
    _check_leave_out(options.leave_out)
    if options.levels is not None or options.positive is not None:
        scale = base.scale.model_dump() if base.scale else {}
        scale |= {"levels": options.levels} if options.levels is not None else {}
        scale |= {"positive": options.positive} if options.positive is not None else {}
        if "levels" not in scale:
            raise InputError(
                "--positive: needs --levels, the number of levels of the scale, such as 7 for -3 to 3"
            )
        content["scale"] = scale
    rankings = [_ranking(form, text) for text in options.ranking]
    if rankings:
        content["rankings"] = rankings
    answers = _answers(form, base, options, only_rankings=bool(rankings))
    content["answers"] = answers
    return checked_map(content, "options")


def _answers(
    form: Form, base: ConversionMap, options: ConvertOptions, only_rankings: bool
) -> list[dict[str, object]]:
    """The answer columns: those named, or else those of the form or map; the sides are for all."""
    answers = [
        answer.model_dump(mode="json", exclude_none=True, exclude_defaults=True) for answer in base.answers
    ]
    if options.answer:
        answers = [_answer(form, text) for text in options.answer]
    elif only_rankings:
        answers = []
    changes: dict[str, object] = {}
    for name in ("question", "question_column", "left", "right", "answer_is"):
        if (value := getattr(options, name)) is not None:
            changes[name] = value
    if options.question is not None and options.question_column is None:
        changes["question_column"] = ""
    if options.order is not None:
        column, values = next(iter(_equations("--order", [options.order]).items()))
        as_named, exchanged = _two("--order", column, values)
        changes["order"] = {"column": column, "as_named": [as_named], "exchanged": [exchanged]}
    return [{**answer, **changes} for answer in answers]


def _answer(form: Form, text: str) -> dict[str, object]:
    """An answer column, with the sides of the form's own if it has one."""
    column, _, question = text.rpartition("=") if "=" in text else (text, "", "")
    own = form.defaults.answers[:1]
    answer = own[0].model_dump(mode="json", exclude_defaults=True) if own else {}
    for name in ("always", "one_of", *(["question_column"] if question else [])):
        answer.pop(name, None)
    return answer | {"column": column} | ({"question": question} if question else {})


def _ranking(form: Form, text: str) -> dict[str, object]:
    columns, _, question = text.rpartition("=") if "=" in text else (text, "", "")
    if not form.ranking_cells:
        raise InputError(
            f"--ranking: the form {form.name} does not say whether the cells of {columns} are modes or "
            "ranks; write [[rankings]] in a map, with columns and cells"
        )
    names = [name.strip() for name in columns.split(",")] if not columns.endswith("...") else [columns]
    ranking: dict[str, object] = {"columns": names, "cells": form.ranking_cells}
    return ranking | ({"question": question} if question else {})


def _rules(options: ConvertOptions) -> list[dict[str, object]]:
    """Rules of rows: several values of one column are alternatives."""
    rules: dict[tuple[str, str], list[str]] = {}
    for key, texts in (("only", options.only), ("without", options.without)):
        for text in texts:
            column, equal, value = text.partition("=")
            if not equal:
                raise InputError(f"--{key}: {text!r} is not COLUMN=VALUE")
            rules.setdefault((column, key), []).append(value)
    return [{"column": column, key: values} for (column, key), values in rules.items()]


def _equations(option: str, texts: Sequence[str]) -> dict[str, str]:
    """``TEXT=VALUE`` at the last sign, so that a text may hold one; the answer A=B holds one itself."""
    equations: dict[str, str] = {}
    for text in texts:
        name, equal, value = text.rpartition("=")
        if option == "--word" and text.endswith("=A=B"):
            name, value = text[: -len("=A=B")], "A=B"
        if not equal or not name or not value:
            raise InputError(f"{option}: {text!r} is not {_WRITTEN[option]}")
        if equations.get(name, value) != value:
            raise InputError(f"{option}: {name!r} is told twice: {equations[name]!r} and {value!r}")
        equations[name] = value
    return equations


def _words(texts: Sequence[str]) -> dict[str, str]:
    words = _equations("--word", texts)
    try:
        return {text: known_word(meaning) for text, meaning in words.items()}
    except ValueError as error:
        raise InputError(f"--word: {error}") from None


def _two(option: str, name: str, text: str) -> tuple[str, str]:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 2 or not all(parts):
        raise InputError(f"{option}: {name}={text} does not have two parts with a comma between them")
    return parts[0], parts[1]


def _check_leave_out(texts: Sequence[str]) -> None:
    for text in texts:
        if text not in LEAVE_OUT and not text.rpartition(":")[2].isdigit():
            raise InputError(
                f"--leave-out: {text!r} is neither a line (7, or FILE:7) nor one of: {', '.join(LEAVE_OUT)}"
            )


def _list(value: object) -> list[object]:
    assert isinstance(value, list)
    return value
