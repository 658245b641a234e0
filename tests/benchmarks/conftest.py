from __future__ import annotations

import sys
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


@pytest.fixture(scope="module")
def at_hand(request):
    """`compare.main` builds no C of its own, if there is a compiler, and looks a moment only at what else runs.

    Its pictures are not laid out.
    """
    import hand_c
    import machine

    with pytest.MonkeyPatch.context() as patch:
        if hand_c.compiler() is not None:
            library = request.getfixturevalue("library")
            patch.setattr(hand_c, "build", lambda _: library)
        leave_out_layout(patch)
        patch.setattr(machine, "sleep", lambda _: sleep(0.05))
        yield
