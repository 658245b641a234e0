"""What the campaigns hold against the command line."""

from __future__ import annotations

import sys

import pytest
from fewer_sheets import SHORT, keep_sheets

from xlmc.cli import main


def commanded(monkeypatch, path, prints):
    """What the harness says of a command line that prints this and ends with that code."""
    from fuzzing.commands import commanded

    def ends():
        out, err, code = prints
        sys.stdout.write(out)
        sys.stderr.write(err)
        raise SystemExit(code)

    monkeypatch.setattr("xlmc.cli.main", ends)
    return commanded(path, ("check",))


@pytest.mark.parametrize(
    ("prints", "key"),
    [
        (("", "", 3), "exit code"),
        (("", "no prefix", 2), "no message"),
        (("", "xlmc: ", 2), "no message"),
        (("", "xlmc: x\nTraceback (most recent call last):", 1), "a traceback"),
        (("a\x1b[2J", "", 0), "a control character"),
        (("", "xlmc: S!A1\r is hidden", 2), "a control character"),
        (("a\x9bb", "", 0), "a control character"),
    ],
)
def test_what_the_command_line_must_not_do_is_a_finding(prints, key, monkeypatch, tmp_path):
    from fuzzing.inputs import Disagreement

    with pytest.raises(Disagreement, match=f"xlmc check, {key}"):
        commanded(monkeypatch, tmp_path / "book.xlsx", prints)


def test_what_it_may_do_is_none(monkeypatch, tmp_path):
    from fuzzing.inputs import Reached

    assert commanded(monkeypatch, tmp_path / "b.xlsx", ("a\nb", "problem: S!A1: Low is blank.", 2)) is Reached.REFUSED
    assert commanded(monkeypatch, tmp_path / "b.xlsx", ("No problem found.\n", "", 0)) is Reached.RAN


def test_the_real_one_runs_a_book_and_refuses_another(tmp_path, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    from fuzzing.commands import commanded
    from fuzzing.formulas import book_of
    from fuzzing.inputs import Reached

    assert main is sys.modules["xlmc.cli"].main
    path = tmp_path / "book.xlsx"
    path.write_bytes(book_of("A1*A2"))
    assert commanded(path, ("check", "simulate")) is Reached.RAN
    assert (tmp_path / "out-of-command.xlsx").exists()
    path.write_bytes(b"PK\x03\x04")
    assert commanded(path, ("check",)) is Reached.REFUSED
