"""What goes to another process: a worker of the engine `numpy`, whole, and little is imported to unpack it."""

from __future__ import annotations

import io
import os
import pickle
import subprocess
import sys

import pytest
from committed_books import EXAMPLES

from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.scheduling.run_spec import model_runner
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

FORMULAS = {
    "date": "=YEAR(40000+A1)",
    "spill": "=SUM(SORT(CHOOSE({1,2,3},A1,A2,0.5)))",
    "lambda": "=LAMBDA(x,x*A1)(A2)",
    "text": '=LEN("a"&A1)',
    "choice": "=IF(A1>0.5,IFERROR(1/(A1-A2),0),A2)",
    "numbered": "=SUBTOTAL(1,A1:A2)",
    "toolpak": "=EDATE(40000+10*A1,1)",
    "foreign": "=A1+ISO.CEILING(A2)",
    "copies": "=SUM(A1:A2)+MAX(A1:A2,0.25)",
}
"""A way for a function to be in a program each."""


def written(block):
    """What is in a block, whichever of its texts are one object."""
    file = io.BytesIO()
    pickler = pickle.Pickler(file)
    pickler.fast = True
    pickler.dump(block)
    return file.getvalue()


def again(worker):
    return pickle.loads(pickle.dumps(worker))


def workers(model, method="mc", block=200):
    worker = model_runner(model, model.program("numpy"), "numpy", 3, block, SamplingPlan.of(method, 1000))
    return worker, again(worker)


@pytest.mark.parametrize("path", EXAMPLES.values(), ids=EXAMPLES)
def test_examples(path):
    mine, theirs = workers(load(path), block=1000)
    for task in (Task(0, 1000, True), Task(1000, 900, False)):
        assert written(theirs.run(task)) == written(mine.run(task))


@pytest.mark.parametrize("formula", FORMULAS.values(), ids=FORMULAS)
def test_functions_of_every_kind(book, formula):
    given = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "A2", "low": 0, "high": 1}}
    mine, theirs = workers(book({"A1": 0.5, "A2": 0.5, "B1": formula}, given, {"x": "B1"}))
    assert pickle.dumps(theirs.run(Task(0, 200, True))) == pickle.dumps(mine.run(Task(0, 200, True)))


@pytest.mark.parametrize("method", ["mc", "lhs", "sobol"])
def test_draws_of_every_kind(book, method):
    """Parameters that vary, cutoffs, correlations."""
    normal = {"cell": "A2", "distribution": "Normal", "mean": "A1", "std_dev": 1.0, "upper_cutoff": 1.5}
    given = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": normal, "c": {"cell": "A3", "low": 0, "high": 1}}
    made = book({"A1": 0.5, "A2": 0.5, "A3": 1}, given, {"x": "A2"}, {}, {("a", "c"): 0.5})
    mine, theirs = workers(made, method)
    assert pickle.dumps(theirs.run(Task(200, 200, True))) == pickle.dumps(mine.run(Task(200, 200, True)))


def test_little_is_imported(case_study, tmp_path):
    """Neither the parser nor the reader of workbooks: half of the time to start would be theirs."""
    model = load(case_study)
    file = tmp_path / "worker"
    file.write_bytes(pickle.dumps(model_runner(model, model.program("numpy"), "numpy", 1, 32_768)))
    unpack = f"import pickle, sys; pickle.load(open({str(file)!r}, 'rb')); print(' '.join(sys.modules))"
    where = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    result = subprocess.run([sys.executable, "-c", unpack], capture_output=True, text=True, check=True, env=where)
    modules = result.stdout.split()
    assert "xlmc.montecarlo.loop.blocks" in modules
    rooms = (
        "xlmc.excel.formula",
        "xlmc.montecarlo.definitions",
        "xlmc.excel.workbook",
        "xlmc.montecarlo.model.model",
        "xlmc.excel.functions.families",
        "formulas",
    )
    assert [name for name in modules if name.startswith(rooms)] == []


@pytest.mark.parametrize(
    "drawn",
    [
        "=_xll.RiskCumul(0,3,{1,2},{0.2,0.7})",
        "=_xll.RiskGeneral(0,3,{1,2},{1,2})",
        "=_xll.RiskHistogrm(0,3,{1,2,1})",
        "=_xll.RiskDiscrete({1,2},{1,2})",
        "=_xll.RiskNormalAlt(5%,10,95%,20)",
        "=_xll.RiskNormal(0,1,_xll.RiskTruncate(-1,2))",
    ],
)
def test_distributions_made_of_data_and_of_percentiles(book, drawn):
    mine, theirs = workers(book({"A1": drawn, "B1": '=_xll.RiskOutput("y")+A1*2'}))
    assert pickle.dumps(theirs.run(Task(200, 200, True))) == pickle.dumps(mine.run(Task(200, 200, True)))
