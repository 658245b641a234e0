"""`xlmc.excel.load`: a workbook and the values that are saved in it, with nothing else of the package."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import openpyxl
import pytest
from openpyxl.workbook.defined_name import DefinedName

from xlmc import excel
from xlmc.errors import ErrorCode, WorkbookError

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "skid-100-ft.xlsx"


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    path = tmp_path_factory.mktemp("load") / "book.xlsx"
    made = openpyxl.Workbook()
    sheet = made.active
    sheet.title = "Some cells"
    for place, value in {"A1": 2.5, "A2": True, "A3": "text", "A4": "#DIV/0!", "B1": "=A1*2", "B2": 7}.items():
        sheet[place] = value
    sheet["A4"].data_type = "e"
    for name, text in {"Rate": "'Some cells'!$A$1", "Both": "'Some cells'!$A$1:$A$2", "Const": "3"}.items():
        made.defined_names[name] = DefinedName(name, attr_text=text)
    made.save(path)
    return excel.load(path)


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("'Some cells'!A1", 2.5),
        ("some cells!$a$2", True),
        ("Some cells!A3", "text"),
        ("Some cells!A4", ErrorCode.DIV0),
        ("Some cells!B1", None),
        ("Some cells!Z99", None),
        ("rate", 2.5),
    ],
)
def test_a_cell_has_the_value_that_is_saved(book, place, value):
    assert book[place] == value
    assert type(book[place]) is type(value)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("A1", "write Sheet!Cell"),
        ("Other!A1", "there is no sheet 'Other' in book.xlsx; there are Some cells"),
        ("Some cells!A1:A2", "is not one cell"),
        ("Both", "is not one cell"),
        ("Const", "stands for one cell"),
        ("Some cells!A0", "is no cell of book.xlsx"),
    ],
)
def test_what_is_no_cell_is_said(book, place, message):
    with pytest.raises(KeyError, match=message):
        book[place]


def test_a_file_that_is_no_workbook_is_refused(tmp_path):
    path = tmp_path / "text.xlsx"
    path.write_text("no workbook", encoding="utf-8")
    with pytest.raises(WorkbookError):
        excel.load(path)


@pytest.mark.parametrize(
    ("program", "layers"),
    [
        ("from xlmc import excel; excel.load({0!r})['Model!D10']", {"excel"}),
        ("from xlmc import engine, excel; engine.calculate(excel.load({0!r}))", {"excel", "engine"}),
    ],
    ids=["load", "calculate"],
)
def test_the_layers_above_are_not_needed(program, layers):
    text = (
        program.format(str(EXAMPLE))
        + "; import sys; print(*{n.split('.')[1] for n in sys.modules if n[:5] == 'xlmc.'})"
    )
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == layers | {"errors"}
