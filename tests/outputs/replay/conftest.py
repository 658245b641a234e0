from __future__ import annotations

import openpyxl
import pytest
from fewer_sheets import CHARTS, SENSITIVITY, keep_few_trials, leave_out, leave_out_drawings, leave_out_shapes
from simulated import simulated

from xlmc.api import Simulation
from xlmc.excel.workbook.injection.cell_edit import with_contents
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.sheets import book as result_sheets

_WHOLE = result_sheets.SHEETS


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """What takes longest to write and to read, and no test here looks at: charts, shapes, sensitivity, many trials.

    `tests/cli/test_replay.py` has whole books.
    """
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *CHARTS, *SENSITIVITY)
        keep_few_trials(patch)
        leave_out_shapes(patch)
        yield


@pytest.fixture(scope="module")
def run(small_book):
    return simulated(load(small_book))


@pytest.fixture(scope="module")
def results(run, tmp_path_factory):
    """A result workbook as xlmc wrote it."""
    return Simulation(run).save(tmp_path_factory.mktemp("results") / "small-results.xlsx")


@pytest.fixture
def typed(results, tmp_path):
    """`typed({(sheet, row, column): content})`: the result workbook with other contents of cells without formulas.

    Nothing else in the file is changed, which takes a tenth of the time of `edited`.
    """

    def type_in(contents):
        parts, sheets = read_parts(results.read_bytes()), read_workbook(results).sheets
        for sheet in {sheet for sheet, *_ in contents}:
            part = sheets[sheet].part
            own = {tuple(at): content for (name, *at), content in contents.items() if name == sheet}
            parts[part] = with_contents(parts[part], part, sheet, own)
        path = tmp_path / "typed.xlsx"
        path.write_bytes(package_bytes(parts))
        return path

    return type_in


@pytest.fixture(scope="module")
def in_record(results):
    """`in_record(key)`: the row of the sheet Record that has it."""
    cells = read_workbook(results).sheets["Record"].cells
    keys = {cell.value: row for (row, column), cell in reversed(cells.items()) if column == 1}
    return keys.__getitem__


@pytest.fixture
def drawn(run, tmp_path, monkeypatch):
    """As `results`, with the curves that are written for charts; the charts themselves are not looked at."""
    monkeypatch.setattr(result_sheets, "SHEETS", _WHOLE)
    leave_out(monkeypatch, *SENSITIVITY)
    leave_out_drawings(monkeypatch)
    return Simulation(run).save(tmp_path / "small-results.xlsx")


@pytest.fixture
def edited(results, tmp_path):
    """`edited(change)`: the result workbook after a person's change to it, saved by another program."""

    def edit(change, source=results):
        book = openpyxl.load_workbook(source)
        change(book)
        path = tmp_path / "edited.xlsx"
        book.save(path)
        return path

    return edit
