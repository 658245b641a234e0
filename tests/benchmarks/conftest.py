from __future__ import annotations

import importlib
import json
import sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from time import sleep

import pytest
from pictures import leave_out_layout

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT), str(ROOT / "benchmarks")]


@pytest.fixture(scope="session")
def hand_written():
    import hand_written

    return hand_written


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    """The hand-written C, built once."""
    import hand_c

    if hand_c.compiler() is None:
        pytest.skip("no C compiler is installed (apt-get install gcc)")
    return hand_c.build(tmp_path_factory.mktemp("hand"))


def answer_here(script, given):
    """What a script prints last that reads this task, run in this process."""
    printed = StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(printed):
        patch.setattr("sys.stdin", StringIO(json.dumps(given) + "\n"))
        importlib.import_module(script.removesuffix(".py")).main()
    return json.loads(printed.getvalue().splitlines()[-1])


@pytest.fixture(scope="module")
def at_hand():
    """`compare.main` builds no C, which no contestant of these tests needs, and looks a moment only at what else runs.

    Its pictures are not laid out. The scripts measure in this process; that of the scaling starts itself as its other
    process.
    """
    import growth
    import hand_c
    import machine
    import processes
    import scaling

    from xlmc.montecarlo.loop.scheduling.processes import idle_pool

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hand_c, "build", lambda folder: folder / "hand.so")
        leave_out_layout(patch)
        patch.setattr(machine, "sleep", lambda _: sleep(0.05))
        for module in (processes, scaling, growth):
            patch.setattr(module, "answer_of", lambda python, script, given, limit: answer_here(script, given))
        yield
        idle_pool.end()
