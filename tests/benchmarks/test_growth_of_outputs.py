"""The study of what outputs cost: its book is what it says, a point has every step, and the table shows it."""

from __future__ import annotations

import argparse
import os
import signal

import growth_of_outputs as growth
import pytest

import xlmc


@pytest.mark.parametrize("rejected", [1, 10])
def test_the_book_has_what_was_asked_for(tmp_path, rejected):
    growth.write_book(tmp_path / "book.xlsx", assumptions=7, forecasts=3, cells=40, rejected=rejected)
    model = xlmc.load(tmp_path / "book.xlsx")
    assert (len(model.live), len(model.forecasts), len(model.filters)) == (7, 3, int(rejected > 1))
    formulas = sum(
        content.formula is not None
        for sheet in ("Model", "Answers")
        for content in model.workbook.sheets[sheet].cells.values()
    )
    assert formulas - int(rejected > 1) == 40
    run = model.simulate(4_000, seed=1)
    assert run.accepted / run.trials == pytest.approx(1.0 / rejected, rel=0.2)


def test_a_point_has_every_step(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(growth, "MIDDLE", {"assumptions": 3, "forecasts": 1, "cells": 10, "trials": 200, "rejected": 1})
    steps = [step for step in growth.STEPS if step != "report"]
    result = growth.measure({"trials": [200], "cells": [10]}, tmp_path, 300.0, steps=steps)
    [point] = result["trials"]
    assert "report" not in point
    assert all(point[step]["seconds"] >= 0.0 for step in steps)
    assert point["accepted"] == point["trials"] == 200
    assert {**result["cells"][0], "size": 200} == point  # the middle point is measured once
    assert not list(tmp_path.iterdir())
    lines = growth.table(result).splitlines()
    assert lines[0].startswith("| trials | load | check |")
    assert lines[2].startswith("| 200 |")


def test_the_slope_is_of_the_last_decade():
    points = [{"size": size, "run": {"seconds": size**2 / 1e4, "megabytes": 1.0}} for size in (10, 100, 1_000)]
    assert "| 2.00 |" in growth.table({"cells": points}).splitlines()[-1]
    assert "no answer" in growth.table({"cells": [{"size": 3, "absent": "no answer within 1 s"}]})


def test_a_point_is_one_book_and_its_default_outputs_are_a_multiple_of_the_run(tmp_path, capsys):
    about = growth.point_of("assumptions=4,forecasts=2,trials=200,cells=1")
    assert about == {"assumptions": 4, "forecasts": 2, "cells": 7, "trials": 200, "rejected": 1}
    growth.main(["--point", "assumptions=4,forecasts=2,trials=200", "--steps", "statistics", "sheets"])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[:4]] == ["load", "run", "statistics", "sheets"]
    assert lines[4].startswith("statistics, sheets: ")
    assert lines[4].endswith(" times the run")
    point = {step: {"seconds": seconds, "megabytes": 1.0} for step, seconds in (("run", 2.0), ("sheets", 3.0))}
    assert growth.summary(point).endswith("1.50 times the run")


@pytest.mark.parametrize("text", ["cells", "rows=3", "trials=0", "trials=1e6", "assumptions=3,"])
def test_a_point_of_other_words_is_refused(text):
    with pytest.raises(argparse.ArgumentTypeError, match="write one of assumptions, forecasts"):
        growth.point_of(text)


@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system kills no process by a signal")
def test_workers_of_which_one_is_killed_give_the_same_bits_with_a_thousand_assumptions(tmp_path):
    """The largest row of the table by assumptions, on a Dask cluster of processes of this machine."""
    distributed = pytest.importorskip("distributed")
    about = {key: growth.MIDDLE[key] for key in ("forecasts", "cells", "rejected")}
    growth.write_book(tmp_path / "book.xlsx", assumptions=1_000, **about)
    model, killed = xlmc.load(tmp_path / "book.xlsx"), []
    trials = 4 * growth.MIDDLE["trials"]
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster:

        def kill(standing):
            if not killed:
                killed.append(cluster.workers[0].pid)
                os.kill(killed[0], signal.SIGKILL)

        run = model.simulate(trials, seed=1, scheduler=cluster.scheduler_address, progress=kill)
    alone = model.simulate(trials, seed=1)
    assert len(killed) == 1
    assert run.trials == alone.trials == trials
    for kind in ("forecasts", "inputs"):
        one, other = getattr(run._run, kind), getattr(alone._run, kind)
        assert [*one] == [*other]
        assert all(one[name].tobytes() == other[name].tobytes() for name in one)
