from __future__ import annotations

import asyncio
import threading
import time

import pytest
from live_window import Running

from xlmc.live.kept_scenarios import Keeper
from xlmc.live.library import Library
from xlmc.live.server import LiveServer, bound_socket


@pytest.fixture
def running(tmp_path):
    """`running(book=…)`, `running(folder=…)`: a server that listens."""
    started = []

    def run(idle=600.0, **given):
        library = Library(Keeper(tmp_path / "state"), **given)
        server = LiveServer(bound_socket(0), library, idle=idle)
        thread = threading.Thread(target=lambda: asyncio.run(server.serve()))
        thread.start()
        started.append((server, thread))
        found = Running(server, library)
        end = time.monotonic() + 20
        while not server._server.started and time.monotonic() < end:
            time.sleep(0.01)
        return found

    yield run
    for server, thread in started:
        server.end()
        thread.join(20)
        assert not thread.is_alive()
