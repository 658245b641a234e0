"""Runs the command line in this process."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import sys
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import IO, NoReturn

import pytest
from command_line import Outcome, xlmc
from fewer_sheets import SHORT, keep_few_trials, keep_sheets, leave_out_fits, leave_out_shapes
from workbook_files import workbook_of

from xlmc.analysis.studies import fitting
from xlmc.cli import main
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["xlmc"]

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def on_a_screen(xlmc: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Outcome]:
    """A command with a terminal of 150 columns at stderr, and what that is sent as `err`."""
    pty = pytest.importorskip("pty")

    def run(*arguments: object, encoding: str = "utf-8") -> Outcome:
        leader, follower = pty.openpty()
        with ThreadPoolExecutor(1) as pool, monkeypatch.context() as patch:
            shown = pool.submit(_all_of, leader)
            with open(follower, "w", encoding=encoding) as screen:
                patch.setenv("TERM", "xterm")
                patch.setenv("COLUMNS", "150")
                patch.setattr(sys, "stderr", screen)
                outcome = xlmc(*arguments)
            return replace(outcome, err=shown.result().decode(encoding))

    return run


@dataclass
class Started:
    """A command that runs in a process of its own.

    Attributes:
        number: of the process, and of its group.
        out, err: what it prints.
    """

    number: int
    out: IO[str]
    err: IO[str]

    def ended(self) -> Outcome:
        """Wait for its end, and take what it has not been asked for yet."""
        with self.out, self.err, ThreadPoolExecutor(1) as pool:
            err = pool.submit(self.err.read)
            out = self.out.read()
            status = os.waitpid(self.number, 0)[1]
            return Outcome(os.waitstatus_to_exitcode(status), out, err.result())


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Callable[..., Started]]:
    """`started("open", path)`: as typed in an empty folder of a terminal of its own; forked, which is soon done."""
    monkeypatch.chdir(tmp_path)
    numbers = []

    def start(*arguments: object) -> Started:
        (out, expected), (err, message) = os.pipe(), os.pipe()
        if not (number := os.fork()):
            _run_command(expected, message, arguments)
        numbers.append(number)
        os.close(expected)
        os.close(message)
        return Started(number, open(out, encoding="utf-8"), open(err, encoding="utf-8"))

    yield start
    for number in numbers:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(number, signal.SIGKILL)


def _run_command(out: int, err: int, arguments: tuple[object, ...]) -> NoReturn:
    """In a forked process, which nothing of the tests may go on in."""
    code = 1
    try:
        os.setsid()
        os.dup2(out, 1)
        os.dup2(err, 2)
        sys.stdout, sys.stderr = (os.fdopen(number, "w", encoding="utf-8") for number in (1, 2))
        signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's background ignores
        sys.argv = ["xlmc", *map(str, arguments)]
        main()
    except SystemExit as ended:
        code = int(ended.code or 0)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _all_of(leader: int) -> bytes:
    """What a pseudo terminal is sent until its other end is closed."""
    pieces = []
    while True:
        try:
            pieces.append(os.read(leader, 65_536))
        except OSError:  # how Linux says that the other end is closed
            break
        if not pieces[-1]:
            break
    os.close(leader)
    return b"".join(pieces)


PLAIN = {
    "Inputs": [
        ["Name", "Value", "Low", "High", "Units", "Distribution"],
        ["a", 0.5, 0, 1, "mph", "Uniform"],
        ["b", 0.25, 0, 2, "mph", "Uniform"],
        ["c", 0.005, 0, 0.01, "mph", "Uniform"],
    ],
    "Model": [["=SUM(Inputs!B2:B4)", "=A1*2"]],
    "Wanted": [
        ["Name", "Cell", "Units", "Threshold"],
        ["Speed", "=Model!A1", "mph", 2.0],
        ["Double", "=Model!B1", "mph", None],
        [],
        ["Name", "Cell", "Above", "Because"],
        ["fast", "=Inputs!B2", 0.4, "seen"],
        [],
        ["Setting", "Value"],
        ["Trials", 2000],
        ["Seed", 7],
    ],
}
"""One assumption matters little, the filter keeps six trials of ten, and no cell is an error."""


@pytest.fixture(scope="session")
def plain_original(tmp_path_factory: pytest.TempPathFactory) -> Path:
    tables = {
        "xlmc_assumptions": "Inputs!A1:F4",
        "xlmc_forecasts": "Wanted!A1:D3",
        "xlmc_filters": "Wanted!A5:D6",
        "xlmc_settings": "Wanted!A8:B10",
    }
    path = tmp_path_factory.mktemp("plain") / "case.xlsx"
    workbook_of(PLAIN, tables).save(path)
    return path


@pytest.fixture
def plain_book(plain_original: Path, tmp_path: Path) -> Path:
    """`case.xlsx`, the book `PLAIN`: what does not depend on the model takes a third of the time with it."""
    return Path(shutil.copy(plain_original, tmp_path / "case.xlsx"))


@pytest.fixture(scope="module")
def studies_made() -> dict[tuple[object, ...], object]:
    """What was asked for -> what was found."""
    return {}


@pytest.fixture
def made_once(studies_made: dict[tuple[object, ...], object], monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """`made_once(module, name)`: a study is made once and told in several forms; what is asked again is known."""

    def patch(module: ModuleType, name: str) -> None:
        study = getattr(module, name)

        def once(model: CompiledModel, *given: object, tell: object = None, **asked: object) -> object:
            key = name, model.path, model.workbook.sha256, *given, *asked.items()
            if key not in studies_made:
                studies_made[key] = study(model, *given, tell=tell, **asked)
            return studies_made[key]

        monkeypatch.setattr(module, name, once)

    return patch


@pytest.fixture
def fitted_once(studies_made: dict[tuple[object, ...], object], monkeypatch: pytest.MonkeyPatch) -> None:
    """Equal values are fitted once, and without what no test here looks at: the standard errors of the triangular
    distribution, which take most of a fit.
    """
    monkeypatch.setattr("xlmc.analysis.studies.fitting.solved_forms._BOOTSTRAP_SAMPLES", 6)
    fit = fitting.fit

    def once(values: list[float], **asked: object) -> object:
        key = "fit", *values, *sorted(asked.items())
        if key not in studies_made:
            studies_made[key] = fit(values, **asked)
        return studies_made[key]

    monkeypatch.setattr(fitting, "fit", once)


@pytest.fixture
def simulated(
    xlmc: Callable[..., Outcome], studies_made: dict[tuple[object, ...], object], tmp_path: Path
) -> Callable[..., None]:
    """`simulated(book, *options)`: the folder as after `xlmc simulate BOOK OPTIONS`, which is run once."""

    def write(book: Path, *options: object) -> None:
        key = "simulate", book.name, book.read_bytes(), *options
        if key not in studies_made:
            before = {*tmp_path.iterdir()}
            assert xlmc("simulate", book, *options).code in (0, 1)
            studies_made[key] = {path.name: path.read_bytes() for path in {*tmp_path.iterdir()} - before}
        for name, data in studies_made[key].items():
            (tmp_path / name).write_bytes(data)

    return write


@pytest.fixture
def case_study() -> Path:
    return ROOT / "examples" / "intersection.xlsx"


@pytest.fixture
def whole_book() -> None:
    """What a test takes that wants all the sheets."""


@pytest.fixture
def short_books(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results without what takes longest, unless the test takes `whole_book`: most sheets, trials, fits…"""
    if "whole_book" not in request.fixturenames:
        keep_sheets(monkeypatch, *SHORT)
        keep_few_trials(monkeypatch)
        leave_out_fits(monkeypatch)
        leave_out_shapes(monkeypatch)
