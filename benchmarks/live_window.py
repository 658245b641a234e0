"""How fast the live window is, in headless Chromium: from the event of a move to the frame that shows its answer.

    python benchmarks/live_window.py [BOOK] [MOVES]

A handle is dragged by events of the browser's own; all visible charts are drawn anew from at least 50,000 trials (of a
large book from fewer, first). Beside the time stands the processor time of the server for a move, from Linux's /proc,
which other programs on the machine do not add to. Then
the workbook is saved by a rename, as Excel does it, and what is measured is how long the page takes to show its answer.
Selenium, Chromium and its driver are needed.
"""

from __future__ import annotations

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.common.by import By

ROOT = Path(__file__).resolve().parents[1]
MOVES = 200
LONGEST = 5.0
"""Seconds that an answer may take at most."""

CHROMIUM = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--window-size=1400,1000",
)


def main() -> None:
    """Measure and print."""
    source = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "examples" / "intersection.xlsx"
    moves = int(sys.argv[2]) if len(sys.argv) > 2 else MOVES
    with tempfile.TemporaryDirectory() as folder:
        book = Path(shutil.copy(source, Path(folder) / "book.xlsx"))
        command = [sys.executable, "-m", "xlmc", "open", str(book), "--no-browser"]
        given = os.environ | {"XDG_STATE_HOME": folder}
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=given) as server:
            assert server.stdout is not None
            link = re.search(r"http\S+", server.stdout.readline())
            assert link is not None
            browser = _browser(folder)
            try:
                browser.get(link[0])
                _measure(browser, book, moves, server.pid)
            finally:
                browser.quit()
                server.terminate()


def _browser(folder: str) -> webdriver.Chrome:
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or ""
    for argument in (*CHROMIUM, f"--user-data-dir={folder}/profile"):
        options.add_argument(argument)
    return webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))


def _measure(browser: webdriver.Chrome, book: Path, moves: int, server: int) -> None:
    _until(browser, "document.body?.dataset.stage === 'rest'", 600.0)
    time.sleep(1.0)
    knob = browser.find_elements(By.CSS_SELECTOR, ".card .knob.upper")[5]
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", knob)
    place = knob.rect
    x, y = place["x"] + 20 - browser.execute_script("return scrollX"), place["y"] + 8
    y = browser.execute_script("return arguments[0].getBoundingClientRect().top", knob) + 8
    _mouse(browser, "mousePressed", x, y)
    began = _processor_seconds(server)
    for move in range(moves):
        # To and fro over a third of the axis, a pixel or two at a time.
        away = abs((2 * move) % 120 - 60) - 30
        before = browser.execute_script("return Live.latencies.length + Live.firsts.length")
        _mouse(browser, "mouseMoved", x + away, y)
        answered = f"Live.latencies.length + Live.firsts.length > {before}"
        _until(browser, f"{answered} || Live.moves.size === 0", LONGEST)
    spent = _processor_seconds(server) - began
    result, firsts = browser.execute_script("return [Live.latencies, Live.firsts]")
    charts = browser.execute_script("return Live.right.seen.size")
    _mouse(browser, "mouseReleased", x, y)
    print(f"{book.stem}: {moves} moves, {charts} charts in sight")
    _say("from 50,000 trials or more", result)
    _say("from fewer, first", firsts)
    print(f"processor time of the server: {1e3 * spent / moves:.0f} ms a move")
    time.sleep(1.0)
    seconds = [_saved(browser, book) for _ in range(5)]
    print(f"saved by a rename: new answer after {statistics.median(seconds):.2f} s, {max(seconds):.2f} s at most, of 5")
    print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


def _say(what: str, milliseconds: list[float]) -> None:
    if milliseconds:
        last = sorted(milliseconds)[int(0.95 * len(milliseconds))]
        middle = statistics.median(milliseconds)
        print(f"{what}: {len(milliseconds)} answers, median {middle:.0f} ms, 95th percentile {last:.0f} ms")


def _processor_seconds(process: int) -> float:
    """What a process has taken so far, its threads together; NaN where there is no /proc."""
    path = Path(f"/proc/{process}/stat")
    if not path.exists():
        return float("nan")
    ticks = path.read_text("utf-8").rpartition(")")[2].split()[11:13]
    return sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")


def _saved(browser: webdriver.Chrome, book: Path) -> float:
    """Seconds from the rename to the answer of the workbook's own settings on the page."""
    waiting = book.with_suffix(".tmp")
    shutil.copy(book, waiting)
    before = browser.execute_script("return Number(document.body.dataset.version)")
    began = time.perf_counter()
    os.replace(waiting, book)
    _until(
        browser, f"Number(document.body.dataset.version) > {before} && document.body.dataset.stage === 'rest'", 600.0
    )
    return time.perf_counter() - began


def _mouse(browser: webdriver.Chrome, kind: str, x: float, y: float) -> None:
    what: dict[str, Any] = {"type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1}
    browser.execute_cdp_cmd("Input.dispatchMouseEvent", what)


def _until(browser: webdriver.Chrome, condition: str, seconds: float) -> None:
    end = time.monotonic() + seconds
    while not browser.execute_script(f"return {condition}"):
        if time.monotonic() > end:
            raise TimeoutError(condition)
        time.sleep(0.005)


if __name__ == "__main__":
    main()
