"""A function is added by one file: what a person writes there runs in every engine, and nothing else is touched."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from openpyxl.worksheet.table import Table
from simulated import simulated

import xlmc.excel.functions
from xlmc.analysis.studies.derivatives import derivatives
from xlmc.cli import xlmc as command
from xlmc.errors import FormulaError
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.registry import Function, Kind, Number
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.sheets import book

ROOT = Path(__file__).resolve().parents[3]
ENGINES = ["numpy", *(["jit"] if importlib.util.find_spec("llvmlite") else [])]

FILE = '''
"""Functions that Excel does not have."""

import numpy as np

from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.registry import Anything, Kind, Number, Numbers, excel
from xlmc.excel.functions.values import NUM, Value


@excel("MADEUP.CURVE", Number, Number(default=2.0))
def curve(x, y):
    """x² + y/3; `#NUM!` of x below 1."""
    return np.where(x < 1, NUM, x * x + y / 3)


@excel("MADEUP.PARTS", Anything, returns=Kind.ANY, facts=Facts(spills=True))
def parts(x):
    """The whole and the rest of a number, side by side: (n,) -> (n, 1, 2)."""
    numbers, errors = x.to_numbers()
    both = np.stack([np.trunc(numbers), numbers - np.trunc(numbers)], axis=-1)[:, None, :]
    return Value.of_numbers(both, np.broadcast_to(errors[:, None, None], both.shape))


@excel("MADEUP.SIZE", Numbers)
def size(x, counts):
    """Sum of the sizes: (n, k) and which of them count -> (n,)."""
    return np.where(counts, np.abs(x), 0.0).sum(axis=1)


@excel("MADEUP.FORGOT", Number)
def forgot(x):
    """The same, without a word of it in the row."""
    return np.stack([np.trunc(x), x - np.trunc(x)], axis=-1)[:, None, :]
'''

NAMES = ["MADEUP.CURVE", "MADEUP.PARTS", "MADEUP.SIZE", "MADEUP.FORGOT"]

FORECASTS = {
    "curve": "MADEUP.CURVE(A1,A1)",
    "with a default": "MADEUP.CURVE(A1+1)",
    "in a branch": "IF(A1>1.5,MADEUP.CURVE(A1),0)",
    "rescued": "IFERROR(MADEUP.CURVE(A1-0.5),-1)",
    "sum": "SUM(MADEUP.PARTS(A1*3))",
    "rest": "INDEX(MADEUP.PARTS(A1*3),1,2)",
    "of products": "SUMPRODUCT(MADEUP.PARTS(A1)*{1,10})",
    "first": "MADEUP.PARTS(A1*3)",
    "size": "MADEUP.SIZE(A1:A3,-A1,-2)",
}


def _expected(x):
    whole = np.trunc(x * 3)
    return {
        "curve": x * x + x / 3,
        "with a default": (x + 1) ** 2 + 2 / 3,
        "in a branch": np.where(x > 1.5, x * x + 2 / 3, 0),
        "rescued": np.where(x < 1.5, -1, (x - 0.5) ** 2 + 2 / 3),
        "sum": x * 3,
        "rest": x * 3 - whole,
        "of products": 1 + 10 * (x - 1),
        "first": whole,
        "size": 2 * x + 2,
    }


@pytest.fixture(scope="module")
def door(tmp_path_factory):
    """The folder of the file, as one of those of `xlmc.excel.functions` while these tests run."""
    folder = tmp_path_factory.mktemp("functions")
    (folder / "made_up.py").write_text(FILE, encoding="utf-8")
    xlmc.excel.functions.__path__.append(str(folder))
    importlib.import_module("xlmc.excel.functions.made_up")
    yield folder
    xlmc.excel.functions.__path__.remove(str(folder))
    del sys.modules["xlmc.excel.functions.made_up"]
    for name in NAMES:
        del REGISTRY[name]


def _saved(path, forecasts):
    """A book of one assumption, x between 1 and 2, that is the cell A1 of these formulas."""
    made = openpyxl.Workbook()
    sheet, inputs, outputs = made.active, made.create_sheet("Inputs"), made.create_sheet("Outputs")
    sheet.title, sheet["A1"] = "S", "=Inputs!B2"
    for row in (["Name", "Value", "Low", "High"], ["x", 1.25, 1.0, 2.0]):
        inputs.append(row)
    inputs.add_table(Table(displayName="xlmc_assumptions", ref="A1:D2"))
    outputs.append(["Name", "Value"])
    for row, (name, formula) in enumerate(forecasts.items(), start=1):
        sheet[f"B{row}"] = f"={formula}"
        outputs.append([name, f"=S!B{row}"])
    outputs.add_table(Table(displayName="xlmc_forecasts", ref=f"A1:B{len(forecasts) + 1}"))
    made.save(path)
    return path


@pytest.fixture(scope="module")
def path(door, tmp_path_factory):
    return _saved(tmp_path_factory.mktemp("books") / "book.xlsx", FORECASTS)


@pytest.fixture(scope="module")
def frames(path):
    return {engine: simulated(load(path), trials=2_000, seed=5, engine=engine).frame() for engine in ENGINES}


@pytest.mark.parametrize("engine", ENGINES)
def test_every_engine_gives_what_the_body_gives(frames, engine):
    frame = frames[engine]
    for name, expected in _expected(frame["x"].to_numpy()).items():
        assert np.allclose(frame[name], expected, rtol=1e-14, atol=1e-15), name


def test_the_engines_agree_to_the_last_bit(frames):
    assert all(frame.equals(frames["numpy"]) for frame in frames.values())


def _simulate(source, engine, folder):
    arguments = ["-n", "500", "--seed", "5", "--engine", engine, "--quiet", "--json", folder / f"{engine}.json"]
    given = ["simulate", source, *arguments, "-o", folder / f"{engine}.xlsx"]
    return CliRunner().invoke(command, [str(argument) for argument in given], catch_exceptions=False)


def test_the_command_gives_the_same_results_with_every_engine(path, tmp_path, monkeypatch):
    monkeypatch.setattr(book, "SHEETS", [sheet for sheet in book.SHEETS if sheet.name in ("Results", "Record")])
    results = []
    for engine in ENGINES:
        done = _simulate(path, engine, tmp_path)
        assert done.exit_code == 0, done.output
        results.append(json.loads((tmp_path / f"{engine}.json").read_text(encoding="utf-8"))["forecasts"])
    assert len(results[0]) == len(FORECASTS)
    assert all(result == results[0] for result in results)


def _refusal(formula, engine, folder):
    with pytest.raises(FormulaError) as refused:
        _simulate(_saved(folder / "book.xlsx", {"f": formula}), engine, folder)
    assert refused.value.where == "S!B1"
    return str(refused.value)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("formula", ["MADEUP.FORGOT(A1)", "SUM(MADEUP.FORGOT(IF(A1>0,A1)))"])
def test_a_row_that_does_not_say_that_it_spills_is_refused_with_the_cell(door, tmp_path, formula, engine):
    message = _refusal(formula, engine, tmp_path)
    assert "MADEUP.FORGOT gives many cells, which its row in the registry does not say" in message
    assert "facts=Facts(spills=True)" in message


@pytest.mark.parametrize("formula", ["MADEUP.CURVE(A1)", "SUM(MADEUP.PARTS(A1))"])
def test_the_engine_of_the_package_formulas_refuses_it_with_the_cell(door, tmp_path, formula):
    assert "The engine `formulas` cannot compute this" in _refusal(formula, "formulas", tmp_path)


@pytest.mark.parametrize("formula", ["MADEUP.SIZE(A:A)", "MADEUP.SIZE((A:A>1)*1)"])
def test_a_whole_column_is_refused_by_name(door, tmp_path, formula):
    assert "MADEUP.SIZE is given a whole column or row" in _refusal(f"SUMPRODUCT({formula})", "numpy", tmp_path)


def test_what_nobody_said_of_it_is_taken_with_care(path):
    model = load(path)
    result = derivatives(model, {"x": np.array([1.25, 1.75])})
    reported = {one.function for one in result.numerical}
    assert reported == {"MADEUP.CURVE", "MADEUP.PARTS", "MADEUP.SIZE"}


def test_the_list_of_functions_names_it(door):
    spec = importlib.util.spec_from_file_location("list_functions", ROOT / "docs" / "list_functions.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    assert set(NAMES) <= set(script.names())
    assert "`MADEUP.CURVE`" in script.page()


def test_its_file_is_found_by_lying_there(door):
    code = (
        "import sys, xlmc.excel.functions; xlmc.excel.functions.__path__.append(sys.argv[1])\n"
        "from xlmc.excel.functions.families import function_named\n"
        "print(*(function_named(name).home for name in sys.argv[2:]))"
    )
    done = subprocess.run([sys.executable, "-c", code, str(door), *NAMES], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["xlmc.excel.functions.made_up"] * len(NAMES)


def test_what_spills_must_see_its_values():
    for parameters, ufunc in (((Number,), None), ((Number,), np.negative)):
        with pytest.raises(
            ValueError, match="MADEUP spills: it takes `Anything`, `Cells` or `Arrays`, and has no ufunc"
        ):
            Function("MADEUP", parameters, np.negative, Kind.ANY, ufunc, facts=Facts(spills=True))
    with pytest.raises(ValueError, match="a function whose numbers decide on its size spills"):
        Facts(sized_by_numbers=True)
