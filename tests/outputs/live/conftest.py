from __future__ import annotations

import asyncio
import threading
import time
from contextlib import contextmanager

import pytest
from chromium_browser import Browser
from live_books import Running
from needed_programs import missing

from xlmc.outputs.live.library import Library
from xlmc.outputs.live.server import LiveServer, bound_socket
from xlmc.outputs.live.stored_scenarios import Keeper


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Gives a browser that answers."""
    pytest.importorskip("selenium.webdriver")
    if reason := missing("chromium", "chromedriver"):
        pytest.skip(reason)
    result = Browser(tmp_path_factory, requests=False)
    yield result
    result.quit()


@pytest.fixture
def chromium(browser):
    """A browser that answers, or a skipped test where there is none; what it complained of is an error.

    Afterwards it shows nothing: a window whose server has ended would ask for it until the session ends.
    """
    result = browser()
    result.get_log("browser")
    yield result
    complaints = [entry["message"] for entry in result.get_log("browser")]
    result.get("about:blank")
    assert complaints == []


@contextmanager
def _servers(state):
    """`run(book=…)`, `run(folder=…)`: a server that listens; all end at the end."""
    started = []

    def run(clock=time.monotonic, idle=600.0, **given):
        library = Library(Keeper(state), **given)
        server = LiveServer(bound_socket(0), library, idle=idle, clock=clock)
        thread = threading.Thread(target=lambda: asyncio.run(server.serve()))
        thread.start()
        result = Running(server, library, thread)
        started.append(result)
        end = time.monotonic() + 120
        while not server._server.started:
            assert time.monotonic() < end
            time.sleep(0.01)
        return result

    yield run
    for results in started:
        results.server.end()
    for results in started:
        results.ended()


@pytest.fixture
def running(tmp_path):
    """`running(book=…)`, `running(folder=…)`: a server that listens."""
    with _servers(tmp_path / "state") as run:
        yield run


@pytest.fixture(scope="module")
def running_on(tmp_path_factory):
    """As `running`, and it listens until the last test of the file."""
    with _servers(tmp_path_factory.mktemp("state")) as run:
        yield run
