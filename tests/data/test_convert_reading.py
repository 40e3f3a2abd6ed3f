"""Files are read in every dialect and container, and a line number is that of the file."""

import csv
import io
import json
import zipfile
from pathlib import Path
from xml.sax.saxutils import escape

import pytest
from hypothesis import given
from hypothesis import strategies as st

from data.convert.reading import Layout, read_table, read_tables
from data.errors import InputError

TEXTS = st.text(st.characters(exclude_categories=["Cs", "Cc"], include_characters="\n\t"), max_size=12)
TABLES = st.lists(st.tuples(TEXTS, TEXTS, TEXTS), min_size=1, max_size=6)


def cells_of(path: Path) -> list[tuple[str, ...]]:
    table = read_table(path, Layout())
    return [tuple(cell or "" for cell in row.cells[:-1]) for row in table.rows]


def written(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


@given(
    rows=TABLES,
    separator=st.sampled_from(",;\t|"),
    end=st.sampled_from(["\n", "\r\n", "\r\r\n"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
    quoting=st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL, csv.QUOTE_NONNUMERIC]),
    trailing=st.sampled_from(["", "\n", "\r\n\r\n"]),
)
def test_a_table_reads_the_same_in_every_dialect(
    tmp_path_factory: pytest.TempPathFactory,
    rows: list[tuple[str, str, str]],
    separator: str,
    end: str,
    encoding: str,
    quoting: int,
    trailing: str,
) -> None:
    text = io.StringIO()
    writer = csv.writer(text, delimiter=separator, lineterminator=end, quoting=quoting)  # type: ignore[arg-type]
    writer.writerows([("first", "second", "third"), *rows])
    path = written(
        tmp_path_factory.mktemp("dialect") / "file.csv", (text.getvalue() + trailing).encode(encoding)
    )
    filled = [row for row in rows if any(row)]
    assert cells_of(path) == filled


@given(
    rows=st.lists(st.dictionaries(st.sampled_from(["left", "right", "why"]), TEXTS, min_size=1), min_size=1)
)
def test_json_reads_the_same_as_one_array_as_lines_and_as_arrays_end_to_end(
    tmp_path_factory: pytest.TempPathFactory, rows: list[dict[str, str]]
) -> None:
    folder = tmp_path_factory.mktemp("json")
    texts = [
        json.dumps(rows),
        json.dumps(rows, indent=2),
        "\n".join(map(json.dumps, rows)),
        "".join(json.dumps([row]) for row in rows),
    ]
    tables = [read_table(written(folder / f"{k}.json", text), Layout()) for k, text in enumerate(texts)]
    named = [
        [
            {name: cell for name, cell in zip(table.names, row.cells, strict=True) if name[0] != "@"}
            for row in table.rows
        ]
        for table in tables
    ]
    assert all(other == named[0] for other in named)
    assert [{name: cell for name, cell in row.items() if cell is not None} for row in named[0]] == rows


def test_a_line_number_counts_the_line_breaks_inside_of_cells(tmp_path: Path) -> None:
    path = written(tmp_path / "file.csv", 'a,b\r\n"1\r\n2","x\n\ny"\r\n\r\n3,4\r\n5,6,7\r\n')
    with pytest.raises(InputError, match="line 8: 3 cells, but the header has 2 columns"):
        read_table(path, Layout())
    path = written(path, 'a,b\r\n"1\r\n2","x\n\ny"\r\n\r\n3,4\r\n')
    assert [row.line for row in read_table(path, Layout()).rows] == [2, 7]


def test_numbers_formulas_and_none_stay_text(tmp_path: Path) -> None:
    path = written(tmp_path / "file.csv", "a,b\n12,=1+1\n+,None\n007,1e5\nTRUE,NaN\n")
    assert cells_of(path) == [("12", "=1+1"), ("+", "None"), ("007", "1e5"), ("TRUE", "NaN")]
    path = written(tmp_path / "file.json", '[{"a": 12, "b": 1.50, "c": true, "d": null, "e": 1e5}]')
    assert cells_of(path) == [("12", "1.50", "true", "", "1e5", "1")]


def test_an_empty_cell_is_not_the_same_as_one_with_two_quotation_marks(tmp_path: Path) -> None:
    path = written(tmp_path / "file.csv", 'a;b;c\n"1";;""\n')
    assert read_table(path, Layout()).rows[0].cells[:3] == ("1", None, "")


def test_a_quotation_mark_that_is_not_doubled_shifts_nothing(tmp_path: Path) -> None:
    path = written(tmp_path / "file.csv", 'a,b\nSay "better",1\n')
    assert cells_of(path) == [('Say "better"', "1")]
    for text, message in (
        ('a,b\n"it"s",1\n', "line 2: text behind a closing quotation mark"),
        ('a,b\n"it"s, so",1\n', "line 2: 3 cells"),
        ('a,b\n1,2\n"open,1\n', "line 3: a quotation mark is opened and never closed"),
    ):
        with pytest.raises(InputError, match=message):
            read_table(written(path, text), Layout())


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('[{"a": 1}, {"a": }]', "line 1: not valid JSON"),
        ('[\n{"a": 1}\n{"a": 2}]', "line 3: not valid JSON: neither a comma nor a closing bracket"),
        ("[\n1]", "line 2: not valid JSON: 1 where an object is needed"),
        ("[]", "JSON without records"),
        ("a,b\n\xff,1\n".encode("latin-1"), "line 2: not UTF-8 text"),
        ("a,b\n\0,1\n", "line 2: not text: a NUL byte"),
        (b"\xef\xbb\xbf \n", "the file is empty"),
    ],
)
def test_what_cannot_be_read_is_said_with_its_line(
    tmp_path: Path, content: str | bytes, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        read_table(written(tmp_path / "file", content), Layout())


def test_a_file_without_a_column_that_another_has_is_empty_there(tmp_path: Path) -> None:
    first = written(tmp_path / "1.csv", "a,b\n1,2\n")
    second = written(tmp_path / "2.csv", "b,c\n3,4\n")
    table = read_tables([first, second], Layout())
    assert table.names == ("a", "b", "@file", "c")
    assert [row.cells for row in table.rows] == [("1", "2", "1.csv", None), (None, "3", "2.csv", "4")]
    assert [(row.path, row.line) for row in table.rows] == [(str(first), 2), (str(second), 2)]


def spreadsheet(sheets: dict[str, list[list[str | float]]]) -> bytes:
    """A minimal .xlsx: numbers as numbers, texts inline."""
    content = io.BytesIO()
    relation = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    with zipfile.ZipFile(content, "w") as archive:
        listed, related = "", ""
        for number, (name, rows) in enumerate(sheets.items(), 1):
            listed += f'<sheet name="{name}" sheetId="{number}" r:id="r{number}"/>'
            related += (
                f'<Relationship Id="r{number}" Type="{relation}/worksheet" '
                f'Target="worksheets/sheet{number}.xml"/>'
            )
            body = ""
            for row in rows:
                cells = (
                    f'<c t="inlineStr"><is><t>{escape(cell)}</t></is></c>'
                    if isinstance(cell, str)
                    else f"<c><v>{cell}</v></c>"
                    for cell in row
                )
                body += f"<row>{''.join(cells)}</row>"
            sheet = f'<worksheet xmlns="{main}"><sheetData>{body}</sheetData></worksheet>'
            archive.writestr(f"xl/worksheets/sheet{number}.xml", sheet)
        archive.writestr(
            "xl/workbook.xml",
            f'<workbook xmlns="{main}" xmlns:r="{relation}"><sheets>{listed}</sheets></workbook>',
        )
        archive.writestr(
            "xl/_rels/workbook.xml.rels",
            '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
            f"{related}</Relationships>",
        )
        archive.writestr(
            "_rels/.rels",
            '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
            f'<Relationship Id="r1" Type="{relation}/officeDocument" Target="xl/workbook.xml"/>'
            "</Relationships>",
        )
        archive.writestr(
            "[Content_Types].xml",
            '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
            '<Override PartName="/xl/workbook.xml" ContentType="application/vnd.openxmlformats-officedocument'
            '.spreadsheetml.sheet.main+xml"/></Types>',
        )
    return content.getvalue()


def test_a_spreadsheet_is_read_as_text_and_a_number_as_it_is_shown(tmp_path: Path) -> None:
    rows: list[list[str | float]] = [["a", "b", "c"], ["12", 12.0, 0.5], ["=1+1", 1e15, "+"]]
    path = written(tmp_path / "file.xlsx", spreadsheet({"Answers": rows}))
    assert cells_of(path) == [("12", "12", "0.5"), ("=1+1", "1000000000000000", "+")]


def test_of_several_sheets_one_has_to_be_named(tmp_path: Path) -> None:
    rows: list[list[str | float]] = [["a"], ["1"]]
    path = written(tmp_path / "file.xlsx", spreadsheet({"Answers": rows, "Notes": [["b"], ["2"]]}))
    with pytest.raises(InputError, match="has several sheets: Answers, Notes; name one by --sheet"):
        read_table(path, Layout())
    assert read_table(path, Layout(), "Notes").names == ("b", "@file")
    with pytest.raises(InputError, match="'Answer' is not one of: Answers, Notes"):
        read_table(path, Layout(), "Answer")


def test_other_archives_are_refused_with_what_to_do(tmp_path: Path) -> None:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("answers.csv", "a,b\n1,2\n")
    with pytest.raises(InputError, match="unpack it"):
        read_table(written(tmp_path / "file.zip", content.getvalue()), Layout())
    with pytest.raises(InputError, match="save it as CSV"):
        read_table(written(tmp_path / "file.xls", b"\xd0\xcf\x11\xe0 not a spreadsheet"), Layout())
