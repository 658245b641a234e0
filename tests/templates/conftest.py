from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
import zipfile
from functools import cache
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from committed_books import BOOKS
from needed_programs import missing

from xlmc.address import parse_address
from xlmc.evaluation.engine import Target
from xlmc.evaluation.engines import ENGINES
from xlmc.evaluation.graph.lower import Lowering, lower_until_complete
from xlmc.formula import Resolver, build_graph
from xlmc.workbook.reader import read_workbook

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))

_CACHED = re.compile(r"(<f>[^<]*</f>)<v>[^<]*</v>")
_CHARTS = re.compile(r"<drawing r:id=[^>]*/>")


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
    from templates.editions import Edition, edition

    build = builders["templates"]
    editions = {
        build.file_name(name, units).removesuffix(".xlsx"): edition(template, units)
        for name, template in build.TEMPLATES.items()
        for units in Edition
    }
    return editions | builders["examples"].EXAMPLES


@pytest.fixture(scope="session")
def book_path():
    """Name -> the committed workbook."""
    return BOOKS


@pytest.fixture(scope="session")
def opened():
    """`opened(path)`: the workbook, to look at and not to change; with `data_only=True`, its values."""
    return cache(openpyxl.load_workbook)


@pytest.fixture(scope="session")
def shown(book_path, opened):
    """`shown(name)`: symbol -> the value that the committed workbook shows."""

    @cache
    def read(name):
        book = opened(book_path[name], data_only=True)
        places = {symbol: next(iter(named.destinations)) for symbol, named in book.defined_names.items()}
        return {symbol: book[sheet][place].value for symbol, (sheet, place) in places.items()}

    return read


@pytest.fixture(scope="session")
def cells(book_path):
    """`cells(name, inputs, wanted)`: a workbook as a function of any input cells, by symbol; NaN for an error.

    What is not given keeps the value of its cell. Inputs and results are `(n,)`, or numbers where n is 1.
    """
    books = {}

    def compute(name, inputs, wanted):
        if name not in books:
            books[name] = read_workbook(book_path[name])
        workbook = books[name]
        at = {each.name: _named_cell(each) for each in workbook.names if not each.name.startswith("_xlnm")}
        live = {at[symbol]: symbol for symbol in inputs}
        resolver = Resolver(workbook, list(live))
        targets = [Target(at[symbol], at[symbol]) for symbol in wanted]
        places = [target.cell for target in targets]

        def lower(more):
            return Lowering(build_graph(resolver, places, frozenset(live), more=more), live, {})

        n = max(np.size(values) for values in inputs.values())
        full = {s: np.ascontiguousarray(np.broadcast_to(np.asarray(v, float), (n,))) for s, v in inputs.items()}
        program = ENGINES["numpy"].load()(lower_until_complete(lower), targets, [], frozenset(inputs))
        columns = program.evaluator(n).filters(full, n)
        return {symbol: column.as_floats().copy() for symbol, column in zip(wanted, columns, strict=True)}

    return compute


def _named_cell(name):
    sheet, _, place = name.text.removeprefix("=").rpartition("!")
    return parse_address(place, sheet.strip("'"))


@pytest.fixture(scope="session")
def recalculated(book_path, tmp_path_factory):
    """Name -> the workbook as LibreOffice computes it from formulas alone: the cached values are removed first.

    So are the charts, which no cell depends on, and which it takes a tenth of the time to convert.
    """
    if reason := missing("soffice"):
        pytest.skip(reason)
    folder = tmp_path_factory.mktemp("libreoffice")
    bare = [_without_cached_values(path, folder) for path in book_path.values()]
    profile = f"-env:UserInstallation={(folder / 'profile').as_uri()}"
    target = ["--convert-to", "xlsx", "--outdir", str(folder / "out")]
    command = ["soffice", "--headless", profile, *target, *map(str, bare)]
    subprocess.run(command, check=True, capture_output=True, timeout=600)
    return {name: folder / "out" / path.name for name, path in book_path.items()}


def _without_cached_values(path, folder):
    target = folder / path.name
    with zipfile.ZipFile(path) as book, zipfile.ZipFile(target, "w") as bare:
        for name in book.namelist():
            part = book.read(name)
            if name.startswith("xl/worksheets/sheet"):
                part = _CHARTS.sub("", _CACHED.sub(r"\1", part.decode())).encode()
            bare.writestr(name, part)
    return target
