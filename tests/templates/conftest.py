from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
import zipfile
from functools import cache
from pathlib import Path

import openpyxl
import pytest
import typed_cells
from committed_books import BOOKS
from needed_programs import missing
from recalculated_books import RECALCULATED
from simulated import simulated
from typed_cells import named_cells, with_typed

from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))

_CACHED = re.compile(r"(<f>[^<]*</f>)<v>[^<]*</v>")
_STYLE = re.compile(r'(<c r="[A-Z]+\d+") s="\d+"')
_CHARTS = re.compile(r"<drawing r:id=[^>]*/>")
_EACH_SHEET = "csv:Text - txt - csv (StarCalc):44,34,76,1,,0,true,true,false,false,false,-1"
"""A file in UTF-8 for each sheet; texts are in quotes, numbers as shown: with 15 digits where they have no style."""
_FIELD = re.compile(r'(?:"((?:[^"]|"")*)"|([^,\n]*))(,|\n|$)')


def _script(path):
    spec = importlib.util.spec_from_file_location(f"{path.parent.name}_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def builders():
    """Folder -> its build script, loaded."""
    return {folder: _script(ROOT / folder / "build.py") for folder in ("templates", "examples")}


@pytest.fixture(scope="session")
def described(builders):
    """File name without its ending -> what the workbook was built from, in its own units."""
    build = builders["templates"]
    editions = {
        build.file_name(name, units).removesuffix(".xlsx"): template
        for name, both in build.TEMPLATES.items()
        for units, template in build.editions(both).items()
    }
    return editions | builders["examples"].EXAMPLES


@pytest.fixture(scope="session")
def book_path():
    """Name -> the committed workbook."""
    return BOOKS


@pytest.fixture(scope="session")
def opened():
    """`opened(path)`: the workbook as openpyxl reads it, to look at and not to change."""
    return cache(openpyxl.load_workbook)


@pytest.fixture(scope="session")
def read(book_path):
    """`read(name)`: a committed workbook as xlmc reads it, with the values that its cells show."""
    return cache(lambda name: read_workbook(book_path[name]))


@pytest.fixture(scope="session")
def model_of(book_path):
    """`model_of(name)`: the model of a committed workbook."""
    return cache(lambda name: load(book_path[name]))


@pytest.fixture(scope="session")
def typed(read):
    """`typed(name, {"f_1": 75})`: the model of a committed workbook with other values in its cells."""
    return lambda name, values: typed_cells.model_of(with_typed(read(name), values))


@pytest.fixture(scope="session")
def run_of(model_of):
    """`run_of(name)`: 20,000 trials of a committed workbook."""
    return cache(lambda name: simulated(model_of(name), 20_000))


@pytest.fixture(scope="session")
def shown(read):
    """`shown(name)`: symbol -> the value that the committed workbook shows."""

    @cache
    def values(name):
        book = read(name)
        return {symbol: book.content(cell).value for symbol, cell in named_cells(book).items()}

    return values


@pytest.fixture(scope="session")
def cells(read):
    """`cells(name, inputs, wanted)`: a workbook as a function of any input cells; see `typed_cells.computed_at`."""
    return lambda name, inputs, wanted: typed_cells.computed_at(read(name), inputs, wanted)


@pytest.fixture(scope="session")
def recalculated(book_path, tmp_path_factory):
    """`recalculated(name, sheet)`: (row, column) -> the value that LibreOffice computes from formulas alone.

    Of one of `recalculated_books.RECALCULATED`.

    The cached values are removed first. So are the charts, which no cell depends on, and which it takes a tenth of the
    time to convert.
    """
    if reason := missing("soffice"):
        pytest.skip(reason)
    folder = tmp_path_factory.mktemp("libreoffice")
    bare = [_without_cached_values(path, folder) for path in map(book_path.get, RECALCULATED)]
    profile = f"-env:UserInstallation={(folder / 'profile').as_uri()}"
    target = ["--convert-to", _EACH_SHEET, "--outdir", str(folder / "out")]
    command = ["soffice", "--headless", profile, *target, *map(str, bare)]
    subprocess.run(command, check=True, capture_output=True, timeout=600)
    return lambda name, sheet: _values((folder / "out" / f"{name}-{sheet}.csv").read_text("utf-8"))


def _values(text):
    """(row, column) -> what a file of LibreOffice says, a text where it is in quotes."""
    result, row, column = {}, 1, 1
    for quoted, plain, end in _FIELD.findall(text):
        if quoted or plain:
            result[row, column] = quoted.replace('""', '"') or _value(plain)
        row, column = (row + 1, 1) if end == "\n" else (row, column + 1)
    return result


def _value(plain):
    if plain in ("TRUE", "FALSE"):
        return plain == "TRUE"
    try:
        return float(plain)
    except ValueError:
        return f"neither a number nor a text: {plain}"


def _without_cached_values(path, folder):
    target = folder / path.name
    with zipfile.ZipFile(path) as book, zipfile.ZipFile(target, "w") as bare:
        for name in book.namelist():
            part = book.read(name)
            if name.startswith("xl/worksheets/sheet"):
                part = _CHARTS.sub("", _STYLE.sub(r"\1", _CACHED.sub(r"\1", part.decode()))).encode()
            bare.writestr(name, part)
    return target
