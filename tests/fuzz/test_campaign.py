"""Children that die, hang or take all memory are findings, and the campaign goes on."""

from __future__ import annotations

import os
import signal

import pytest

INPUTS = 3
"""Of both sizes, odd and even."""


def kind_of(run):
    from fuzzing.inputs import Input, Kind

    return Kind(lambda rng: Input("x", b"x" * rng.randint(1, 9), "said"), run)


def summary(run, monkeypatch, longest):
    """Only processor time counts: on a busy machine, a child may wait for minutes."""
    from fuzzing import campaign as module

    monkeypatch.setattr(module, "LONGEST", longest)
    monkeypatch.setattr(module, "_WAITS", 1000.0)
    return module.campaign("any", kind_of(run), 1, range(INPUTS))


def once(what):
    """Does it for one of the inputs: those whose files have an odd size."""

    def run(given, folder):
        from fuzzing.inputs import Reached

        if len(given.data) % 2:
            what()
        return Reached.RAN

    return run


def hang():
    while True:
        pass


@pytest.mark.parametrize(
    ("what", "longest", "key"),
    [
        (lambda: os.kill(os.getpid(), signal.SIGKILL), 30.0, "the process died with -9"),
        (hang, 0.1, "the process takes too long"),
        (lambda: bytearray(3 << 30), 30.0, "MemoryError at outside xlmc"),
        (lambda: 1 / 0, 30.0, "ZeroDivisionError at outside xlmc"),
    ],
)
def test_what_breaks_a_child_is_a_finding(what, longest, key, monkeypatch):
    from fuzzing.inputs import Reached

    result = summary(once(what), monkeypatch, longest)
    assert result.inputs == INPUTS
    assert set(result.faults) == {key}
    assert 0 < result.faults[key].count < INPUTS
    assert result.faults[key].count + result.reached[Reached.RAN] == INPUTS


def test_memory_that_was_given_back_is_counted(monkeypatch):
    result = summary(once(lambda: len(b"x" * (64 << 20))), monkeypatch, 30.0)
    assert not result.faults
    assert result.largest[0] > 48 << 20


def test_the_folder_of_a_killed_child_is_removed_at_the_next_start(monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    def run(given, folder):
        from fuzzing.inputs import Reached

        (folder / "left.txt").write_text("x", encoding="utf-8")
        return Reached.RAN

    def kill():
        os.kill(os.getpid(), signal.SIGKILL)

    summary(lambda given, folder: (run(given, folder), kill()), monkeypatch, 30.0)
    folders = list(tmp_path.iterdir())
    assert len(folders) == 1  # of the last child; those of the others were removed when it started
    summary(run, monkeypatch, 30.0)
    assert list(tmp_path.iterdir()) == []
