"""How soon the live window answers beside long work: a workbook of 300 uniforms and 60 forecasts, every tab in turn.

    python benchmarks/live_long_work.py [MOVES]

The server runs as it does behind a browser; a client speaks its protocol. One number after another is moved and let go,
while each tab in turn is open, so that a run at rest or the contents of a tab are being computed when the next move
comes. What is measured is the time from a move to its first answer, and to the one from 50,000 trials; then the time
from a save by a rename, as Excel does it, to the first answer of the new workbook. Beside the time stands what all
threads computed meanwhile, which other work on the machine changes little. No browser is needed.
"""

from __future__ import annotations

import asyncio
import json
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import openpyxl
from openpyxl.worksheet.table import Table

from xlmc.outputs.live.library import Library
from xlmc.outputs.live.open_book import OpenBook, Window
from xlmc.outputs.live.protocol import Message, PageMessage, read_message, written
from xlmc.outputs.live.stored_scenarios import Keeper

MOVES = 200
UNIFORMS, FORECASTS = 300, 60
TABS = ("charts", "matters", "pairs", "tables", "scenarios", "studies")
SAVES = 5
WAIT = 0.3
"""Seconds from an answer to the next move: long work has begun again by then."""


def long_book(path: Path, uniforms: int = UNIFORMS, forecasts: int = FORECASTS, first: float = 1.5) -> Path:
    """Write a workbook whose forecasts depend on all of its uniforms; `first` is the upper end of the first one."""
    book = openpyxl.Workbook()
    inputs, answers = book.active, book.create_sheet("Answers")
    inputs.title = "Inputs"
    inputs.append(["Name", "Value", "Distribution", "Low", "High", "Units", "Source"])
    for number in range(uniforms):
        inputs.append([f"Input {number + 1}", 1.0, "Uniform", 0.5, 1.5 if number else first, "m", "Generated"])
    inputs["I1"], inputs["I2"] = "Sum of all", f"=SUM(B2:B{uniforms + 1})"
    answers.append(["Name", "Value", "Units"])
    for number in range(forecasts):
        answers.append([f"Answer {number + 1}", f"=Inputs!I2+{number + 1}*Inputs!B{number + 2}", "m"])
    for sheet, name, area in (
        (inputs, "xlmc_assumptions", f"A1:G{uniforms + 1}"),
        (answers, "xlmc_forecasts", f"A1:C{forecasts + 1}"),
    ):
        sheet.add_table(Table(displayName=name, ref=area))
    book.save(path)
    return path


async def measure(folder: Path, moves: int) -> None:
    """Move, save, and print."""
    book = long_book(folder / "book.xlsx")
    other = long_book(folder / "other.xlsx", first=1.6)
    opened = OpenBook(book, Library(Keeper(folder / "state"), book=book), offer=lambda page: "")
    opened.start()
    window = opened.join()
    await _next(window, lambda message: message["kind"] == "rest")
    firsts, wholes, computed = [], [], []
    for move in range(moves):
        tab = TABS[move % len(TABS)]
        names = ["Answer 1", "Answer 2", "Answer 3"]
        view = {"kind": "view", "forecasts": names, "chosen": names, "tab": tab, "first": names[0], "second": names[1]}
        _say(opened, window, {**view, "trial": 0, "fits": False})
        await _drain(window, WAIT)
        began, before = time.perf_counter(), time.process_time()
        number = {"of": "assumption", "name": f"Input {1 + move % 60}", "key": "high", "value": 1.6 + move / 1000}
        _say(opened, window, {"kind": "set", **number, "held": False, "seq": move + 1})
        first = await _next(window, partial(_answers, seq=move + 1))
        firsts.append(time.perf_counter() - began)
        computed.append(time.process_time() - before)
        if first["trials"] < 50_000:
            await _next(window, partial(_answers, seq=move + 1, trials=50_000))
        wholes.append(time.perf_counter() - began)
    saves = [await _saved(window, other if turn % 2 else book, book, folder) for turn in range(SAVES)]
    await opened.close()
    print(f"{UNIFORMS} uniforms, {FORECASTS} forecasts, {moves} moves, tabs in turn: {', '.join(TABS)}")
    for messages, seconds in (
        ("first answer", firsts),
        ("computed for it, by all threads", computed),
        ("answer of 50,000 trials", wholes),
        ("save to first answer", saves),
    ):
        high = sorted(seconds)[int(0.95 * (len(seconds) - 1))]
        print(f"{messages}: median {1e3 * statistics.median(seconds):.0f} ms, 95th percentile {1e3 * high:.0f} ms")
    print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


async def _saved(window: Window, source: Path, book: Path, folder: Path) -> float:
    """Seconds from the rename to the first answer of the workbook that was saved."""
    waiting = folder / "waiting.tmp"
    waiting.write_bytes(source.read_bytes())
    await _drain(window, WAIT)
    began = time.perf_counter()
    os.replace(waiting, book)
    await _next(window, lambda message: message["kind"] == "news")
    await _next(window, lambda messages: messages["kind"] == "frame")
    return time.perf_counter() - began


def _say(opened: OpenBook, window: Window, messages: Message) -> None:
    message: PageMessage = read_message(written(messages))
    opened.hear(window, message)


def _answers(message: Message, seq: int, trials: int = 0) -> bool:
    """Whether it is the answer to a change, from so many trials at least."""
    return message["kind"] == "frame" and message["seq"] == seq and message["trials"] >= trials


async def _next(window: Window, fits: Callable[[Message], bool]) -> Message:
    while True:
        message: Message = json.loads(await window.next())
        if fits(message):
            return message


async def _drain(window: Window, seconds: float) -> None:
    """Take what is said for a while."""
    end = time.perf_counter() + seconds
    while (left := end - time.perf_counter()) > 0:
        try:
            await asyncio.wait_for(window.next(), left)
        except TimeoutError:
            return


def main() -> None:
    """Measure and print."""
    moves = int(sys.argv[1]) if len(sys.argv) > 1 else MOVES
    with tempfile.TemporaryDirectory() as folder:
        asyncio.run(measure(Path(folder), moves))


if __name__ == "__main__":
    main()
