"""Workbooks with other numbers, sessions that are settled, and what talks to a server: for tests of the live window."""

from __future__ import annotations

import http.client
import json
import time
from contextlib import contextmanager

import openpyxl
from committed_books import EXAMPLES
from openpyxl.utils import range_boundaries
from openpyxl.worksheet.table import Table
from websockets.sync.client import connect
from workbook_files import add_tables

from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.guard import SECRET, proof
from xlmc.outputs.live.protocol import PageMessage

CASE = EXAMPLES["intersection"]
SIMPLE = EXAMPLES["skid-100-ft"]


def simple(path):
    """The simple example at this path, as Excel saved it, with 5,000 trials, which take a quarter of the time."""
    return _with_fewer_trials(SIMPLE, path)


def _with_fewer_trials(source, path):
    many, few, changed = b"<v>200000</v>", b"<v>5000</v>", 0
    parts = read_parts(source.read_bytes())
    for name, data in parts.items():
        if many in data:
            changed += data.count(many)
            parts[name] = data.replace(many, few)
    assert changed == 1
    path.write_bytes(package_bytes(parts))
    return path


def short_case(path):
    """The case study at this path, with 5,000 trials."""
    return _with_fewer_trials(CASE, path)


def small(path):
    """A workbook with three assumptions and one answer, which is loaded and run in a fifth of the simple one's time."""
    return wide_book(path, assumptions=3, forecasts=1)


def edited(source, target, changes):
    """A copy of a workbook with other numbers in its tables: {(row's name, heading): value}."""
    book = openpyxl.load_workbook(source)
    type_in(book, rows_of(load(source)), changes)
    book.save(target)
    return target


def rows_of(model):
    """Name -> a cell of its row in a table."""
    rows = (*model.assumptions, *model.forecasts, *model.definitions.evidence, *model.filters)
    return {each.name: each.row for each in rows}


def type_in(book, rows, changes):
    """Other numbers in the tables of an open workbook; the cells and what they held before."""
    before = []
    for (name, heading), value in changes.items():
        sheet, row = book[rows[name].sheet], rows[name].row
        cell = sheet.cell(row, _headings_above(sheet, row)[heading])
        before.append((cell, cell.value))
        cell.value = value
    return before


def wide_book(path, assumptions=60, forecasts=12, most=60.0):
    """A workbook with many assumptions of three kinds, many answers, and filters; its runs are short.

    Args:
        most: the largest answers that the filters keep. Nothing is rejected by default; 19 rejects half of Answer 1.
    """
    book = openpyxl.Workbook()
    inputs, wanted = book.active, book.create_sheet("Wanted")
    inputs.title = "Inputs"
    parameters = ("Low", "High", "Likeliest", "Mean", "Std dev")
    inputs.append(["Name", "Value", "Distribution", *parameters, "Units", "Source", "Frozen", "Lower cutoff"])
    kinds = (
        ("friction on wet asphalt", 0.7, "Uniform", 0.6, 0.8, None, None, None, "g", "Measured; report, page 12"),
        ("approach speed", 30.0, "Normal", None, None, None, 30.0, 2.0, "mph", "A witness"),
        ("post-impact travel distance to rest", 50.0, "Triangular", 40.0, 60.0, 50.0, None, None, "ft", ""),
    )
    for number in range(assumptions):
        what, *rest = kinds[number % 3]
        inputs.append([f"Vehicle {number // 3 + 1} {what}", *rest])
    wanted.append(["Name", "Value", "Units", "Threshold"])
    for number in range(forecasts):
        first = 2 + 5 * number
        terms = "+".join(f"Inputs!B{first + part}*{part + 1}" for part in range(5))
        wanted.append([f"Answer {number + 1}: speed at the beginning", f"=SQRT({terms})", "mph", 15.0])
    below = forecasts + 3
    for column, heading in enumerate(("Name", "Value", "At least", "At most", "Because"), start=1):
        wanted.cell(below, column, heading)
        for row in (1, 2):
            filter_ = (f"Plausible {row}", f"=B{min(row, forecasts) + 1}", 5.0, most, "Seen")
            wanted.cell(below + row, column, filter_[column - 1])
    for row, setting in enumerate((("Setting", "Value"), ("Trials", 5_000)), start=below + 4):
        wanted.cell(row, 1, setting[0])
        wanted.cell(row, 2, setting[1])
    for sheet, name, area in (
        (inputs, "xlmc_assumptions", f"A1:L{assumptions + 1}"),
        (wanted, "xlmc_forecasts", f"A1:D{forecasts + 1}"),
        (wanted, "xlmc_filters", f"A{below}:E{below + 2}"),
        (wanted, "xlmc_settings", f"A{below + 4}:B{below + 5}"),
    ):
        sheet.add_table(Table(displayName=name, ref=area))
    book.save(path)
    return path


READINGS = {
    "at 40 ft": ["=M!B1", 31.0, "Uniform", 3.0, None, None, None, None],
    "laser": ["=M!B1", 30.0, "Instrument", None, None, 12.0, 0.5, None],
    "witness": ["=M!B2", 62.0, "Normal", None, 9.0, None, None, None],
    "marks": ["=M!B2", 60.0, "Lognormal", None, None, 20.0, None, None],
    "camera": ["=M!B1", 22.0, "At least", 1.0, None, None, None, None],
    "doubtful": ["=M!B2", 55.0, "Normal", None, 8.0, None, None, "no"],
}
"""Name -> the other cells of a row of evidence, of each kind of error; the last one is not used."""


def book_of_readings(path, readings=READINGS, trials=4_000):
    """A workbook of two assumptions with cutoffs, two answers, a filter with two limits, and rows of evidence."""
    book = openpyxl.Workbook()
    model, sheet = book.active, book.create_sheet("T")
    model.title = "M"
    model["A1"], model["A2"], model["B1"], model["B2"] = 30.0, 2.0, "=A1", "=A1*A2"
    tables = {
        "xlmc_assumptions": [
            ["Name", "Cell", "Distribution", "Mean", "Std dev", "Low", "High", "Lower cutoff", "Upper cutoff"],
            ["v", "=M!A1", "Normal", 30.0, 4.0, None, None, 20.0, 38.0],
            ["t", "=M!A2", "Uniform", None, None, 1.5, 2.5, None, None],
        ],
        "xlmc_forecasts": [
            ["Name", "Cell", "Units", "Threshold", "Range %"],
            ["speed", "=M!B1", "mph", 35.0, None],
            ["distance", "=M!B2", "ft", None, 90.0],
        ],
        "xlmc_filters": [["Name", "Cell", "At least", "At most", "Use"], ["possible", "=M!B2", 0.0, 80.0, None]],
        "xlmc_evidence": [
            ["Name", "Cell", "Reading", "Error", "±", "Std dev", "Percent", "Resolution", "Use"],
            *([name, *cells] for name, cells in readings.items()),
        ],
        "xlmc_settings": [["Setting", "Value"], ["Trials", trials]],
    }
    add_tables(sheet, tables)
    book.save(path)
    return path


def book_of_decisions(path, trials=2_000):
    """A workbook of two decisions, one of which a parameter reads, a solved cell, three answers and a filter."""
    book = openpyxl.Workbook()
    model, sheet = book.active, book.create_sheet("T")
    model.title = "M"
    cells = {"A1": 1.5, "A2": 0.7, "A3": 50.0, "A4": 10.0, "A5": 40.0, "C1": 2.0}
    cells |= {"B1": "=A4*A1+A4*A4/(2*9.81*A2)", "B2": '=A3-B1-A1*(D1="wet")', "B3": "=A3/3.6*A1", "D1": "dry"}
    for cell, value in cells.items():
        model[cell] = value
    tables = {
        "xlmc_assumptions": [
            ["Name", "Cell", "Distribution", "Low", "High", "Units", "Frozen"],
            ["reaction", "=M!A1", "Uniform", 1.0, 2.0, "s", None],
            ["friction", "=M!A2", "Uniform", 0.6, "=M!C1*0.4", None, None],
        ],
        "xlmc_forecasts": [
            ["Name", "Cell", "Units"],
            ["margin", "=M!B2", "m"],
            ["way", "=M!B3", "m"],
            ["speed", "=M!A4", "m/s"],
        ],
        "xlmc_filters": [["Name", "Cell", "At least", "At most", "Use"], ["possible", "=M!B3", 5.0, 25.0, None]],
        "xlmc_decisions": [
            ["Name", "Cell", "Low", "High", "Step", "Values", "Units"],
            ["limit", "=M!A3", 30.0, 70.0, 10.0, None, "km/h"],
            ["grip", "=M!C1", None, None, None, "1.9; 2; 2.5", None],
            ["road", "=M!D1", None, None, None, "dry; wet; ice", None],
        ],
        "xlmc_solve": [
            ["Name", "Cell", "To", "By", "Low", "High", "Root"],
            ["stops", "=M!B1", 40.0, "=M!A4", 0.0, "=M!A5", "last"],
        ],
        "xlmc_settings": [["Setting", "Value"], ["Trials", trials]],
    }
    add_tables(sheet, tables)
    book.save(path)
    return path


def book_with_decisions(path, *, high=1.5, listed=False, more=()):
    """A workbook of two assumptions and two decisions, which formulas read, and of what else is given."""
    book = openpyxl.Workbook()
    model, sheet = book.active, book.create_sheet("T")
    model.title = "M"
    cells = {"A1": 1.0, "A2": 0.7, "A3": 50.0, "A4": 3, "B1": "=A3*A1+A4^2", "B2": "=IF(A3>55,A2*A3,A1/A4)"}
    for cell, content in {**cells, **dict(more)}.items():
        model[cell] = content
    tables = {
        "xlmc_assumptions": [
            ["Name", "Cell", "Distribution", "Low", "High", "Frozen"],
            ["u", "=M!A1", "Uniform", 0.5, high, None],
            ["v", "=M!A2", "Uniform", 0.6, 0.8, None],
        ],
        "xlmc_forecasts": [["Name", "Cell"], ["sum", "=M!B1"], ["way", "=M!B2"]],
        "xlmc_filters": [["Name", "Cell", "At most", "Use"], ["possible", "=M!B1", "=M!A3*1.3", None]],
        "xlmc_decisions": [
            ["Name", "Cell", "Low", "High", "Step", "Values"],
            ["limit", "=M!A3", 30.0, 70.0, 10.0, None],
            ["lanes", "=M!A4", None, None, None, "2; 3; 4"],
            *([["road", "=M!C1", None, None, None, "dry; wet"]] if listed else []),
        ],
    }
    add_tables(sheet, tables)
    book.save(path)
    return path


def book_of_dates(path):
    """A workbook of a date, a percentage and an amount of money, as cells, rows and answers show them."""
    book = openpyxl.Workbook()
    model, sheet = book.active, book.create_sheet("T")
    model.title = "M"
    day, share, money = "yyyy-mm-dd", "0.0%", '"$"#,##0'
    cells = {"A1": (46082.0, day), "A2": (0.35, share), "A3": (48_000.0, money), "A4": (2.0, "General")}
    cells |= {"B1": ("=A1+A4", day), "B2": ("=A3*(1-A2)", money)}
    for cell, (content, shown) in cells.items():
        model[cell], model[cell].number_format = content, shown
    tables = {
        "xlmc_assumptions": [
            ["Name", "Cell", "Distribution", "Low", "High", "Mean", "Std dev"],
            ["start", "=M!A1", "Uniform", 46054.0, 46113.0, None, None],
            ["discount", "=M!A2", "Uniform", 0.3, 0.4, None, None],
            ["price", "=M!A3", "Normal", None, None, 48_000.0, 3_000.0],
        ],
        "xlmc_forecasts": [["Name", "Cell"], ["end", "=M!B1"], ["net price", "=M!B2"]],
        "xlmc_filters": [["Name", "Cell", "At most"], ["early", "=M!B1", 46110.0]],
        "xlmc_decisions": [["Name", "Cell", "Low", "High", "Step"], ["days", "=M!A4", 1.0, 5.0, 1.0]],
        "xlmc_settings": [["Setting", "Value"], ["Trials", 2_000]],
    }
    add_tables(sheet, tables)
    book.save(path)
    return path


def with_column(path, target, heading):
    """The workbook with one more column in its table of assumptions."""
    book = openpyxl.load_workbook(path)
    sheet, table = next((s, t) for s in book for t in s.tables.values() if t.name == "xlmc_assumptions")
    first, top, last, bottom = range_boundaries(table.ref)
    sheet.cell(top, last + 1, heading)
    table.ref = f"{sheet.cell(top, first).coordinate}:{sheet.cell(bottom, last + 1).coordinate}"
    table.tableColumns = []
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
    return PageMessage("set", {"of": of, "name": name, "key": key, "value": value, "held": held, "seq": seq})


def settle(session, clock=lambda: 0.0):
    """Do all that a session asks for; what it told meanwhile."""
    messages = []
    while (job := session.job()) is not None:
        messages += session.finish(job, job.run(lambda: True, lambda share: None, clock))
    return messages


class Running:
    """A server in a thread, and what talks to it."""

    def __init__(self, server, library, thread):
        self.server, self.library, self.port, self._thread = server, library, server.port, thread
        self.host = f"127.0.0.1:{server.port}"

    def ended(self):
        """Wait until it listens no more."""
        self._thread.join(120)
        assert not self._thread.is_alive()

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
    def own(self):
        """The headers with which a page of this server sends one file."""
        return {"Origin": f"http://{self.host}", "X-Xlmc-Ticket": self.server.guard.new_ticket()}

    def window(self, key, entering=True, **headers):
        """A connected WebSocket on a workbook; `next(kind)` waits for a message."""
        return self.connected(f"/live/{key}", entering=entering, **headers)

    @contextmanager
    def connected(self, path, entering=True, **headers):
        """A connected WebSocket, on the start page's path or on a workbook's."""
        given = {"Origin": f"http://{self.host}", **headers}
        origin = given.pop("Origin")
        with connect(
            f"ws://{self.host}{path}", origin=origin, additional_headers=given, max_size=None, proxy=None
        ) as socket:
            spoken = Spoken(socket)
            if entering:
                spoken.enter(SECRET, self.server.guard.secret)
            yield spoken


class Spoken:
    def __init__(self, socket):
        self.socket, self.heard = socket, []

    def enter(self, name, key):
        """Do as a page does that knows the key; what the server gives for it."""
        nonce = "a page's"
        self.say("hello", name=name, nonce=nonce)
        theirs = self.next("proof")
        assert theirs["proof"] == proof(key, "server", nonce, theirs["nonce"])
        self.say("proof", proof=proof(key, "page", nonce, theirs["nonce"]))
        return self.next("welcome")["secret"]

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
