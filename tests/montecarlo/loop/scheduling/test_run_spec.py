from __future__ import annotations

import pickle

import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.scheduling.run_spec import RunSpec, check_software, model_runner, software, unpack


@pytest.mark.parametrize(("engine", "size"), [("numpy", 100), ("formulas", 10)])
def test_a_run_spec_makes_the_same_blocks(model, engine, size):
    spec = unpack(RunSpec.of(model, engine, 7, size).pack())
    again = spec.model()
    task = Task(3 * size, size - 2, True)
    mine = model_runner(model, model.program(engine), engine, 7, size).run(task)
    theirs = model_runner(again, again.program(spec.engine), spec.engine, spec.seed, spec.block).run(task)
    assert pickle.dumps(theirs) == pickle.dumps(mine)
    assert mine.accepted.size


def test_a_run_spec_leaves_the_file_out(model):
    assert not RunSpec.of(model, "numpy", 7, 100).workbook.parts


def test_the_same_run_has_the_same_run_spec(model):
    packed = RunSpec.of(model, "numpy", 7, 100).pack()
    assert packed == RunSpec.of(model, "numpy", 7, 100).pack()
    assert packed != RunSpec.of(model, "numpy", 8, 100).pack()


@pytest.mark.parametrize("name", ["xlmc", "numpy", "scipy", "formulas", "Python", "processor"])
def test_other_software_is_refused(model, monkeypatch, name):
    packed = RunSpec.of(model, "numpy", 7, 100).pack()
    monkeypatch.setattr("xlmc.montecarlo.loop.scheduling.run_spec.software", lambda: software() | {name: "0.0.1"})
    with pytest.raises(
        SimulationError, match=f"this worker: The software differs: {name} is 0.0.1 there and "
    ) as caught:
        unpack(packed)
    assert "same software" in caught.value.hint


def test_missing_software_is_refused():
    with pytest.raises(SimulationError, match="worker 3: The software differs: numpy is missing there and 2 here"):
        check_software({"numpy": "2"}, {}, "worker 3")
