"""Runs the command line in this process."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from fewer_sheets import CHARTS, SENSITIVITY, keep_few_trials, leave_out, leave_out_fits, leave_out_shapes

from xlmc.cli import main

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Outcome:
    code: int
    out: str
    err: str


@pytest.fixture
def xlmc(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Callable[..., Outcome]:
    """`xlmc("check", path)` as typed in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: object) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["xlmc", *map(str, arguments)])
        with pytest.raises(SystemExit) as stopped:
            main()
        captured = capsys.readouterr()
        return Outcome(int(stopped.value.code or 0), captured.out, captured.err)

    return run


@pytest.fixture
def case_study() -> Path:
    return ROOT / "examples" / "intersection.xlsx"


@pytest.fixture
def whole_book() -> None:
    """What a test takes that wants the charts and the sheets on sensitivity, too."""


@pytest.fixture
def short_books(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results without what takes longest, unless the test takes `whole_book`: charts, sensitivity, trials, fits…"""
    if "whole_book" not in request.fixturenames:
        leave_out(monkeypatch, *CHARTS, *SENSITIVITY)
        keep_few_trials(monkeypatch)
        leave_out_fits(monkeypatch)
        leave_out_shapes(monkeypatch)
