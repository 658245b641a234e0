"""Workbooks with other numbers, sessions that are settled, and what talks to a server: for tests of the live window."""

from __future__ import annotations

import http.client
import json
import time
from contextlib import contextmanager

import openpyxl
from committed_books import EXAMPLES
from openpyxl.utils import range_boundaries
from websockets.sync.client import connect

from xlmc.live.protocol import Said
from xlmc.run.loading import load

CASE = EXAMPLES["intersection"]
SIMPLE = EXAMPLES["skid-100-ft"]


def edited(source, target, changes, settings=None):
    """A copy of a workbook with other numbers in its tables: {(row's name, heading): value}."""
    model, book = load(source), openpyxl.load_workbook(source)
    rows = {each.name: each.row for each in (*model.assumptions, *model.filters)}
    for (name, heading), value in changes.items():
        sheet, row = book[rows[name].sheet], rows[name].row
        sheet.cell(row, _headings_above(sheet, row)[heading]).value = value
    for sheet in book:
        for row in sheet.iter_rows():
            for cell in row:
                if cell.value in (settings or {}):
                    sheet.cell(cell.row, cell.column + 1).value = settings[cell.value]
    book.save(target)
    return target


def _headings_above(sheet, row):
    """Heading -> column, of the table that holds a row."""
    for table in sheet.tables.values():
        first, top, last, bottom = range_boundaries(table.ref)
        if top < row <= bottom:
            return {sheet.cell(top, column).value: column for column in range(first, last + 1)}
    raise AssertionError(row)


def change(name, key, value, *, of="assumption", held=False, seq=1):
    return Said("set", {"of": of, "name": name, "key": key, "value": value, "held": held, "seq": seq})


def settle(session, clock=lambda: 0.0):
    """Do all that a session asks for; what it told meanwhile."""
    told = []
    while (job := session.job()) is not None:
        told += session.finish(job, job.run(lambda: True, lambda share: None, clock))
    return told


class Running:
    """A server in a thread, and what talks to it."""

    def __init__(self, server, library):
        self.server, self.library, self.port = server, library, server.port
        self.host = f"127.0.0.1:{server.port}"

    def ask(self, path, method="GET", body=None, host=None, **headers):
        """Status, headers and body of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        try:
            connection.putrequest(method, path, skip_host=True)
            for name, value in {"Host": host or self.host, **headers}.items():
                connection.putheader(name.replace("_", "-"), value)
            connection.endheaders(body)
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read().decode()
        finally:
            connection.close()

    @property
    def cookie(self):
        return f"{self.server.guard.cookie}={self.server.guard.secret}"

    @property
    def own(self):
        """The headers of a page of this server."""
        return {"Cookie": self.cookie, "Origin": f"http://{self.host}", "X-Xlmc-Page": self.server.guard.page}

    @contextmanager
    def window(self, key, hello=True, **headers):
        """A connected WebSocket; `next(kind)` waits for a message."""
        given = {"Cookie": self.cookie, "Origin": f"http://{self.host}", **headers}
        origin = given.pop("Origin")
        given = {name: value for name, value in given.items() if value is not None}
        with connect(
            f"ws://{self.host}/live/{key}", origin=origin, additional_headers=given, max_size=None, proxy=None
        ) as socket:
            if hello:
                socket.send(json.dumps({"kind": "hello", "page": self.server.guard.page}))
            yield Spoken(socket)


class Spoken:
    def __init__(self, socket):
        self.socket, self.heard = socket, []

    def say(self, kind, **fields):
        self.socket.send(json.dumps({"kind": kind, **fields}))

    def heard_last(self, kind):
        return next(each for each in reversed(self.heard) if each["kind"] == kind)

    def next(self, kind, fits=lambda message: True, seconds=120.0):
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            message = json.loads(self.socket.recv(timeout=left))
            self.heard.append(message)
            if message["kind"] == kind and fits(message):
                return message
        raise TimeoutError(kind)
