"""`--functions`: functions in Python that stand in for those of VBA, in every command, with words for bad ones."""

from __future__ import annotations

import json
import pickle

import pytest
from beam_books import beam
from fewer_sheets import SHORT, keep_few_trials, keep_sheets

import xlmc as library
from xlmc.engine import calculate
from xlmc.errors import ErrorCode, FormulaError, WorkbookError
from xlmc.excel import load as load_book
from xlmc.excel.own_functions import load_functions

MOMENT = {"Model!B2": "=BeamMoment(load,span)"}
"""The bending moment of the beam by code of the workbook, where the plain one has a formula."""

FUNCTIONS = """
import numpy as np
from xlmc import scalar

def BeamMoment(load, span):
    return _quarter(load * span)

def _quarter(x):
    return x / 4

@scalar
def Steps(load, step=10.0):
    count = 0
    while load > step:
        load, count = load - step, count + 1
    return count

def Peak(values):
    return values.max(axis=(1, 2))

def Grade(stress, limit=200.0):
    return np.where(stress > limit, "too much", "fine")

def Is_Safe(stress):
    return stress < 200

@scalar
def Label(name, value):
    return f"{name}: {value:.0f}"
"""


@pytest.fixture(autouse=True)
def _short(tmp_path, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    keep_few_trials(monkeypatch)
    (tmp_path / "my_functions.py").write_text(FUNCTIONS, encoding="utf-8")


@pytest.fixture
def book(tmp_path):
    """`book(…)`: the beam whose moment a function computes, with other contents in some cells."""
    return lambda **changes: beam(tmp_path / "beam.xlsx", MOMENT | {f"Model!{key}": v for key, v in changes.items()})


def written(path, text):
    path.write_text(text, encoding="utf-8")
    return path


WAYS = {
    "one thread": {},
    "two threads": {"jobs": 2, "scheduler": "threads"},
    "two processes": {"jobs": 2, "scheduler": "processes"},
    "native code": {"engine": "jit"},
    "native code in two processes": {"engine": "jit", "jobs": 2, "scheduler": "processes"},
}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_a_function_gives_the_bits_of_the_formula_however_it_is_run(book, tmp_path, way):
    if "engine" in way:
        pytest.importorskip("llvmlite")
    own = library.load(book(), functions=tmp_path / "my_functions.py").simulate(40_000, seed=3, **way)
    plain = library.load(beam(tmp_path / "plain.xlsx", {})).simulate(40_000, seed=3)
    assert own.frame().equals(plain.frame())
    assert own.accepted > 30_000


def test_dask_gives_the_same_bits(book, tmp_path):
    distributed = pytest.importorskip("distributed")
    model = library.load(book(), functions=tmp_path / "my_functions.py")
    one = model.simulate(70_000, seed=3)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        many = model.simulate(70_000, seed=3, jobs=2, scheduler=cluster.scheduler_address)
    assert many.frame().equals(one.frame())


def test_arguments_and_results_of_every_kind(book, tmp_path):
    result = calculate(
        load_book(
            book(
                B5="=load",
                B6="=span",
                C1="=PEAK(B5:B7)",
                C2='=grade(B3)&"!"',
                C3="=Grade(B3,1000)",
                C4="=Is.Safe(B3)",
                C5="=Steps(load)",
                C6="=Steps(load,5)",
                C7='=Label("moment",B2)',
                C8="=Label(A9,1/0)",
                C9="=Peak(B5:C8)",
                C10="=IF(Is_Safe(B3),1,2)",
                C11="=BeamMoment(A9,span)",
            ),
            functions=tmp_path / "my_functions.py",
        )
    )
    values = [result[f"Model!C{row}"] for row in range(1, 12)]
    assert values[:8] == [40.0, "fine!", "fine", True, 3.0, 7.0, "moment: 60", ErrorCode.DIV0]
    assert values[8:] == [ErrorCode.DIV0, 1.0, 0.0]
    assert result["Model!B2"] == 60.0


def test_a_number_that_is_none_is_an_error_of_that_trial(book, tmp_path):
    text = "import numpy as np\ndef BeamMoment(load, span):\n    return np.where(load > 40, np.nan, load * span / 4)\n"
    path = written(tmp_path / "nan.py", text)
    run = library.load(book(), functions=path).simulate(4_000, seed=3)
    plain = library.load(beam(tmp_path / "plain.xlsx", {})).simulate(4_000, seed=3)
    kept = plain.frame()[plain.frame()["load"] <= 40]
    assert run.frame().equals(kept)


def test_every_command_takes_them(xlmc, book, tmp_path):
    given = ("--functions", "my_functions.py")
    book()
    for command in (
        ("check", "beam.xlsx"),
        ("verify", "beam.xlsx"),
        ("calculate", "beam.xlsx", "-o", "calculated.xlsx"),
        ("simulate", "beam.xlsx", "-n", 2_000, "-o", "r.xlsx", "-o", "r.json", "-o", "r.xlmcrun", "-o", "r.html"),
        ("screen", "beam.xlsx", "-n", 1_000),
        ("stability", "beam.xlsx", "-n", 1_000),
        ("compare", "beam.xlsx", "beam.xlsx", "-n", 1_000),
        ("replay", "r.xlsx"),
        ("replay", "r.xlmcrun"),
        ("report", "r.xlmcrun", "-o", "again.json"),
    ):
        done = xlmc(*command, *given)
        assert done.code == 0, (command, done)
        alone = xlmc(*command[:2])
        assert alone.code != 0 or command[0] == "verify", command
        assert "Traceback" not in alone.err
    assert load_book("calculated.xlsx")["Model!B2"] == 60.0


def test_a_run_records_the_file_and_is_repeated_with_the_same_file_alone(xlmc, book, tmp_path):
    book()
    functions = load_functions(tmp_path / "my_functions.py")
    done = xlmc(
        "simulate", "beam.xlsx", "--functions", "my_functions.py", "-o", "r.json", "-o", "r.xlsx", "-o", "r.xlmcrun"
    )
    assert done.code == 0
    record = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))["record"]
    assert record["functions"] == {"name": "my_functions.py", "sha256": functions.sha256}
    assert record["run"]["repeat"].endswith("--functions my_functions.py")
    written(tmp_path / "other.py", FUNCTIONS + "# another\n")
    for path in ("r.xlsx", "r.xlmcrun"):
        asked = xlmc("replay", path)
        assert (asked.code, asked.err.count("\n")) == (2, 1)
        assert "call functions of 'my_functions.py', which it does not hold" in asked.err
        assert "--functions FOLDER/my_functions.py" in asked.err
        other = xlmc("replay", path, "--functions", "other.py")
        assert (other.code, f"its SHA-256 is not {functions.sha256}" in other.err) == (2, True)
        same = xlmc("replay", path, "--functions", "my_functions.py")
        assert (same.code, "to the last bit" in same.out) == (0, True)
    opened = library.open_run("r.xlmcrun", functions="my_functions.py")
    assert opened["stress"].mean.value == pytest.approx(record["forecasts"]["rows"][0]["mean"]) or opened.accepted
    with pytest.raises(WorkbookError, match="call functions of"):
        library.open_run("r.xlmcrun")
    assert library.replay("r.xlsx", functions="my_functions.py").identical


def test_no_file_is_ever_loaded_unasked(xlmc, book, tmp_path):
    book()
    for name in ("my_functions.py", "beam.py", "functions.py", "xlmc_functions.py"):
        written(tmp_path / name, f"open({str(tmp_path / 'ran')!r}, 'w').close()\n{FUNCTIONS}")
    assert "not known to xlmc" in xlmc("simulate", "beam.xlsx").err
    assert not (tmp_path / "ran").exists()


def test_the_file_is_never_replaced(book, tmp_path):
    run = library.load(book(), functions=tmp_path / "my_functions.py").simulate(500)
    (tmp_path / "link.json").hardlink_to(tmp_path / "my_functions.py")
    with pytest.raises(WorkbookError, match="This is the file that is read"):
        run.save_json(tmp_path / "link.json", overwrite=True)


STUDIES = {
    "seek": ("--cell", "Model!B2", "--to", 50, "--by", "Model!B1"),
    "stability": ("-n", 200),
    "stress": ("-n", 200),
    "screen": ("-n", 200),
    "methods": ("-n", 2_000),
    "verify": (),
    "decide": (),
    "optimise": ("--maximise", "stress"),
    "uncertainty": (),
    "compare": ("beam.xlsx",),
    "calculate": ("--cells", "Model!B2"),
}


@pytest.mark.parametrize(("command", "more"), STUDIES.items(), ids=STUDIES)
def test_no_study_replaces_the_file(xlmc, book, tmp_path, command, more):
    book()
    (tmp_path / "link.json").hardlink_to(tmp_path / "my_functions.py")
    refused = xlmc(command, "beam.xlsx", *more, "--functions", "my_functions.py", "-o", "link.json", "--overwrite")
    assert (refused.code, refused.err) == (2, "xlmc: link.json: This is the file that is read. Name another file.\n")
    assert (tmp_path / "my_functions.py").read_text(encoding="utf-8") == FUNCTIONS


def test_a_body_goes_to_another_process_without_the_file(tmp_path):
    functions = load_functions(written(tmp_path / "gone.py", FUNCTIONS))
    packed = pickle.dumps(functions)
    (tmp_path / "gone.py").unlink()
    row = pickle.loads(packed).named("STEPS", 1)
    assert row.name == "STEPS"
    assert row.arity() == (1, 2)


BAD = {
    "an exception": (
        "def BeamMoment(a, b): return a / 'x'",
        "failed: TypeError",
        "(line 1)",
        "arrays of the shape (1,)",
    ),
    "an if": (
        "def BeamMoment(a, b): return a if a > 1 else b",
        "failed: ValueError",
        "ambiguous",
        "Correct the function",
    ),
    "nothing": ("def BeamMoment(a, b): a * b", "gives nothing", "End it with return", ""),
    "a shape": (
        "def BeamMoment(a, b): return a[:, None] * b[None, :] * [[1, 2]]",
        "gives the shape (1, 2) for 1",
        "",
        "",
    ),
    "a sum over trials": ("def BeamMoment(a, b): return (a * b).sum()", "with fewer trials", "alone", ""),
    "random numbers": (
        "import numpy\ndef BeamMoment(a, b): return a * numpy.random.rand(a.size)",
        "for the same values",
        "draw nothing at random",
        "",
    ),
    "complex numbers": ("def BeamMoment(a, b): return a + 1j", "gives complex numbers", "Give an array of numbers", ""),
    "masked numbers": (
        "import numpy\ndef BeamMoment(a, b): return numpy.ma.masked_less(a, 30)",
        "gives a masked array",
        "",
        "",
    ),
    "objects": ("def BeamMoment(a, b): return {1: a}", "gives objects", "", ""),
    "one trial at a time, none": (
        "from xlmc import scalar\n@scalar\ndef BeamMoment(a, b): return None",
        "gives nothing",
        "Give one number",
        "",
    ),
    "one trial at a time, many": (
        "from xlmc import scalar\n@scalar\ndef BeamMoment(a, b): return [a, b]",
        "gives a list",
        "Give one number",
        "",
    ),
    "one trial at a time, an exception": (
        "from xlmc import scalar\n@scalar\ndef BeamMoment(a, b):\n    return 1 / (a - a)",
        "failed: ZeroDivisionError",
        "(line 4)",
        "one trial at a time: 40.0, 6.0",
    ),
}


@pytest.mark.parametrize("words", BAD.values(), ids=BAD)
def test_a_bad_function_is_told_with_its_cell_and_name(xlmc, book, tmp_path, words):
    text, message, *more = words
    book()
    written(tmp_path / "bad.py", text)
    done = xlmc("simulate", "beam.xlsx", "--functions", "bad.py")
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert done.err.startswith(f"xlmc: Model!B2: The function BeamMoment of bad.py {message}") or message in done.err
    assert "Model!B2: The function BeamMoment of bad.py" in done.err
    assert all(each in done.err for each in more), done.err


FILES = {
    "no file": (None, "The file cannot be read"),
    "no Python": ("def BeamMoment(a, b) return a", "The file is not Python: expected ':' (line 1)"),
    "a module that is missing": (
        "import nothing_such\n",
        "ModuleNotFoundError: No module named 'nothing_such' (line 1)",
    ),
    "no function": ("x = 3\n", "The file defines no function"),
    "a function of Excel": ("def Sum(a): return a\n", "The function Sum has the name of one of Excel"),
    "another function of Excel": (
        "def Norm_Dist(a): return a\n",
        "The function Norm_Dist has the name of one of Excel",
    ),
    "one name twice": ("def Ab(a): return a\ndef AB(a): return a\n", "The functions Ab and AB have one name in Excel"),
    "a list of what is none": ("__all__ = ['x']\nx = 3\n", "__all__ lists 'x', which is no function"),
    "another name": ("def BeamMomant(a, b): return a\n", "bad.py does not define it. Did you mean BeamMomant?"),
    "too few arguments": ("def BeamMoment(a): return a\n", "he function BeamMoment is given 2 arguments, and takes 1"),
}


@pytest.mark.parametrize(("text", "message"), FILES.values(), ids=FILES)
def test_a_bad_file_is_told(xlmc, book, tmp_path, text, message):
    book()
    if text is not None:
        written(tmp_path / "bad.py", text)
    done = xlmc("check" if text and "Beam" not in text else "simulate", "beam.xlsx", "--functions", "bad.py")
    assert done.code == 2
    assert message in done.err
    assert done.err.count("\n") <= 3


def test_only_listed_functions_count_where_the_file_lists_them(tmp_path):
    text = "import numpy as np\n"
    text += (
        "__all__ = ['Root', 'BeamMoment']\nRoot = np.sqrt\ndef BeamMoment(a, b): return a\ndef average(a): return a\n"
    )
    assert load_functions(written(tmp_path / "listed.py", text)).names == ("Root", "BeamMoment")


def test_studies_and_scenarios_of_such_a_model(book, tmp_path):
    model = library.load(book(), functions=tmp_path / "my_functions.py")
    changed = model.with_(load=library.Uniform(30, 50))
    plain = library.load(beam(tmp_path / "plain.xlsx", {})).with_(load=library.Uniform(30, 50))
    result, expected = changed.simulate(5_000, seed=1), plain.simulate(5_000, seed=1)
    assert result.frame().equals(expected.frame())
    result.save(tmp_path / "changed-results.xlsx")
    sobol = library.sensitivities(result), library.sensitivities(expected)
    assert str(sobol[0]) == str(sobol[1])


def test_unknown_functions_point_to_the_option(xlmc, book):
    book()
    with pytest.raises(FormulaError, match="The function BEAMMOMENT is not known to xlmc"):
        library.load("beam.xlsx")
    assert "--functions my_functions.py" in xlmc("check", "beam.xlsx").err
