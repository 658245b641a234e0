"""Random use of the live window: three clients, a workbook that changes under them, and a server that is started again.

    python tests/session/random_use.py MINUTES [SEED]

Whatever is done in whatever order, the window answers, keeps every scenario, and shows what the edited workbook gives.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import time

import openpyxl
from openpyxl.worksheet.table import Table
from websockets.exceptions import ConnectionClosed

from xlmc.errors import XlmcError
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.loading import build_model, load
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.outputs.live.hand_over import edited_state
from xlmc.outputs.live.stored_scenarios import Keeper

TOO_LATE = 4408
"""Why a connection is closed whose page did not say in time who it is."""

PATIENCE = 120.0
"""Seconds after which a window counts as stuck."""

TABS = ("charts", "matters", "pairs", "tables", "step", "scenarios", "studies")
KINDS = (
    "move move move hold numbers freeze band limit limit reading state use tie decide solve run type reset keep keep"
    " drop show undo variants compare view view pin stop print save book book reload restart restore burst"
)
"""What a client does next; twice what is done more often."""

DISTRIBUTIONS = ("Uniform", "Triangular", "Normal")
HEADINGS = (
    "Name",
    "Cell",
    "Distribution",
    "Low",
    "High",
    "Likeliest",
    "Mean",
    "Std dev",
    "Lower cutoff",
    "Upper cutoff",
    "Frozen",
    "Location",
)


class Book:
    """A workbook that is changed at random.

    It has five assumptions of which some are correlated, three answers, two filters, two rows of evidence, a decision,
    and, if it `solves`, a cell that is solved for.
    """

    def __init__(self, path, dice, solves):
        self.path, self.dice, self.names, self.solves = path, dice, iter(range(1, 10**9)), solves
        self.rows = [self.row(cell) for cell in range(1, 6)]
        self.filters = [["possible", "=M!B1", 1.0, None, None], ["slow", "=M!B2", 0.0, 80.0, None]]
        self.evidence = [
            ["camera", "=M!B1", 30.0, "Uniform", 25.0, None, None],
            ["witness", "=M!B2", 40.0, "Normal", None, 25.0, None],
        ]
        self.ties = {(1, 2): 0.5, (3, 4): -0.3}
        self.decided, self.target = 1.0, 20.0
        self.write()

    def row(self, cell):
        return {"name": f"input {next(self.names)}", "cell": cell, "kind": self.dice.choice(DISTRIBUTIONS), "low": 5.0}

    def data(self):
        book = openpyxl.Workbook()
        model, sheet = book.active, book.create_sheet("T")
        model.title = "M"
        for cell in range(1, 6):
            model.cell(cell, 1, 6.0)
        model["B1"], model["B2"], model["B3"] = "=A1+A2*A3/6+A4", "=A4*A5*C1", "=A1+2*C2"
        model["C1"], model["C2"] = self.decided, 7.0
        rows = [HEADINGS]
        for each in self.rows:
            low, high = each["low"], each["low"] + 2.0
            numbers = {
                "Uniform": (low, high, None, None, None, None, None),
                "Triangular": (low, high, low + 1.0, None, None, None, None),
                "Normal": (None, None, None, low + 1.0, 0.5, low, low + 2.5),
            }[each["kind"]]
            rows.append([each["name"], f"=M!A{each['cell']}", each.get("typed", each["kind"]), *numbers, None])
        tables = {
            "xlmc_assumptions": rows,
            "xlmc_forecasts": [
                ["Name", "Cell", "Threshold", "Range %"],
                ["sum", "=M!B1", None, None],
                ["product", "=M!B2", 40.0, 90.0],
                ["needed", "=M!C2", None, None],
            ],
            "xlmc_filters": [["Name", "Cell", "At least", "At most", "Use"], *self.filters],
            "xlmc_evidence": [
                ["Name", "Cell", "Reading", "Error", "Plus or minus", "Std dev", "Use"],
                *self.evidence,
            ],
            "xlmc_decisions": [["Name", "Cell", "Low", "High", "Step"], ["factor", "=M!C1", 0.8, 1.2, 0.1]],
            "xlmc_solve": [
                ["Name", "Cell", "To", "By", "Low", "High"],
                ["goal", "=M!B3", self.target, "=M!C2", 0.0, 20.0],
            ],
            "xlmc_settings": [["Setting", "Value"], ["Trials", 1_000]],
        }
        if not self.solves:
            del tables["xlmc_solve"]
        names = {each["cell"]: each["name"] for each in self.rows}
        tied = [[names[a], names[b], value] for (a, b), value in self.ties.items() if {a, b} <= names.keys()]
        if tied:
            tables["xlmc_correlations"] = [["First", "Second", "Correlation"], *tied]
        top = 1
        for name, lines in tables.items():
            for number, line in enumerate(lines):
                for column, value in enumerate(line, start=1):
                    sheet.cell(top + number, column, value)
            bottom = top + len(lines) - 1
            sheet.add_table(Table(displayName=name, ref=f"A{top}:{chr(64 + len(lines[0]))}{bottom}"))
            top = bottom + 2
        waiting = self.path.with_name("waiting.tmp")
        book.save(waiting)
        return waiting.read_bytes()

    def write(self):
        data = self.data()
        os.replace(self.path.with_name("waiting.tmp"), self.path)
        return data

    def edit(self):
        """Change one thing of it, as a person or a program does; in the end the file is whole and good."""
        dice, row = self.dice, self.dice.choice(self.rows)
        match dice.choice(
            (
                *(
                    "rename",
                    "remove",
                    "kind",
                    "range",
                    "filter",
                    "reading",
                    "half",
                    "wrong",
                    "gone",
                    "lock",
                    "junk",
                    "use",
                ),
                *("tie", "decide", "solve"),
            )
        ):
            case "rename":
                row["name"] = f"input {next(self.names)}"
            case "remove" if len(self.rows) > 2:
                self.rows.remove(row)
            case "kind":
                row["kind"] = dice.choice(DISTRIBUTIONS)
            case "range":
                row["low"] = round(dice.uniform(2.0, 9.0), 2)
            case "filter":
                self.filters[0][2] = round(dice.uniform(0.0, 15.0), 1)
            case "reading":
                dice.choice(self.evidence)[2] = round(dice.uniform(20.0, 50.0), 1)
            case "tie":
                self.ties[dice.choice([*self.ties])] = round(dice.uniform(-0.9, 0.9), 2)
            case "decide":
                self.decided = round(dice.uniform(0.8, 1.2), 2)
            case "solve":
                self.target = round(dice.uniform(10.0, 30.0), 1)
            case "use":
                each = dice.choice([*self.filters, *self.evidence])
                each[-1] = dice.choice((None, "no", True))
            case "half":
                data = self.data()
                self.path.write_bytes(data[: len(data) // 2])
                time.sleep(dice.uniform(0.0, 0.5))
            case "junk":
                self.path.write_bytes(b"not a workbook")
                time.sleep(dice.uniform(0.0, 0.5))
            case "wrong":
                row["typed"] = "Uniforn"
                self.write()
                time.sleep(dice.uniform(0.0, 0.5))
                del row["typed"]
            case "gone":
                self.path.unlink()
                time.sleep(dice.uniform(0.0, 0.3))
            case "lock":
                lock = self.path.with_name(f"~${self.path.name}")
                if lock.exists():
                    lock.unlink()
                else:
                    lock.write_bytes(b"a person")
            case _:
                free = {1, 2, 3, 4, 5} - {each["cell"] for each in self.rows}
                self.rows += [self.row(cell) for cell in sorted(free)[:1]]
        self.write()


READING = {"reading": (20.0, 50.0), "plus_minus": (-0.5, 30.0), "std_dev": (5.0, 30.0)}
"""Key of a number of evidence -> where it is moved to."""


def _handles(state):
    """Kind of row, row and number of all that a state has handles for on the left."""
    for row in state["assumptions"]:
        yield from (("assumption", row, number) for number in row["numbers"])
    for row in state["filters"]:
        yield from (("filter", row, number) for number in row["limits"])


class Use:
    """Three clients of a server that uses a folder; `start(book)` starts it.

    Args:
        start: gives a `Running` server of a workbook, whose scenarios lie in `state`.
        folder: for the workbook.
        state: of the scenarios.
        seed: of all that is random; with an odd one no cell is solved for, so that the decision moves as a number does.
    """

    def __init__(self, start, folder, state, seed):
        self.dice, self.start, self.state = random.Random(seed), start, state
        self.book = Book(folder / "book.xlsx", self.dice, solves=seed % 2 == 0)
        self.server = start(book=self.book.path)
        self.kept, self.number, self.seq, self.done = set(), 0, 0, []
        self.clients = [self._client() for _ in range(3)]
        self.compared = 0

    def _client(self):
        """Open a window; as a page does, try again where this machine was too busy to say hello in time."""
        stack = contextlib.ExitStack()
        for left in range(3, -1, -1):
            try:
                window = stack.enter_context(self.server.window(self.server.library.only))
                break
            except ConnectionClosed as closed:
                if not left or closed.rcvd is None or closed.rcvd.code != TOO_LATE:
                    raise
        window.stack = stack
        window.next("state")
        return window

    @property
    def open_book(self):
        return self.server.server._open_books[self.server.library.only]

    def close(self):
        for each in self.clients:
            each.stack.close()

    def step(self):
        """Do one thing."""
        dice, place = self.dice, self.dice.randrange(3)
        client = self.clients[place]
        drain(client)
        state = client.heard_last("state")
        what = dice.choice(KINDS.split())
        self.done.append((place, what))
        row = dice.choice(state["assumptions"])
        numbers = [each for each in row["numbers"] if each["value"] is not None]
        goes = [(of, r["name"], n["key"]) for of, r, n in _handles(state) if n["goes"]]
        if what in ("move", "hold", "burst") and numbers:
            number = dice.choice(numbers)
            value = round(number["value"] + dice.uniform(-0.7, 0.7), 3)
            for _ in range(20 if what == "burst" else 1):
                value = round(value + 0.001, 3)
                self._set(client, "assumption", row["name"], number["key"], value, held=what == "hold")
            if what == "hold" and dice.random() < 0.6:
                self._set(client, "assumption", row["name"], number["key"], value)
            elif what == "hold":  # the page goes while a handle is held
                client.stack.close()
                self.clients[place] = self._client()
        elif what == "numbers" and {"low", "high"} <= {each["key"] for each in numbers}:
            values = {"low": round(dice.uniform(3, 6), 2), "high": round(dice.uniform(5.5, 9), 2)}
            self.seq += 1
            client.say("numbers", of="assumption", name=row["name"], values=values, seq=self.seq)
        elif what == "freeze":
            self._set(client, "assumption", row["name"], "frozen", not row["frozen"])
        elif what == "band" and row["band"]:
            self._set(
                client,
                "assumption",
                row["name"],
                dice.choice(["band_low", "band_high"]),
                dice.choice([0.0, 20.0, 70.0, 100.0]),
            )
        elif what in ("limit", "use") and state["filters"]:
            filter_ = dice.choice(state["filters"])
            if what == "use":
                self._set(client, "filter", filter_["name"], "used", not filter_["used"])
            elif filter_["limits"]:
                limit = dice.choice(filter_["limits"])
                self._set(client, "filter", filter_["name"], limit["key"], round(dice.uniform(0, 90), 1))
                if goes and dice.random() < 0.5:
                    self._set(client, *dice.choice(goes), "none")
        elif what == "reading":
            readings = [(of, r["name"], n["key"]) for of, r, n in _handles(state) if n["key"] in READING]
            of, name, key = dice.choice(readings)
            self._set(client, of, name, key, round(dice.uniform(*READING[key]), 2))
        elif what == "state":
            name = dice.choice(["sum", "product"])
            key, values = dice.choice([("threshold", ["none", 0.0, 25.0, None]), ("central", [80.0, 100.0, None])])
            self._set(client, "forecast", name, key, dice.choice(values))
        elif what == "tie" and state["correlations"]:
            name = dice.choice(state["correlations"])["name"]
            self._set(
                client, "correlation", name, "correlation", dice.choice([round(dice.uniform(-1.0, 1.0), 2), None])
            )
        elif what == "decide":
            values = [None, *(round(dice.uniform(0.7, 1.3), 3) for _ in range(5))]
            self._drag(client, "decision", "factor", "value", dice.sample(values, dice.randint(1, 3)))
        elif what == "solve":
            key, least, most = dice.choice([("to", 10.0, 30.0), ("low", 0.0, 6.0), ("high", 8.0, 30.0)])
            self._set(client, "solve", "goal", key, dice.choice([round(dice.uniform(least, most), 2), None]))
        elif what == "type":
            client.say(
                "set",
                of="assumption",
                name=row["name"],
                key="kind",
                held=False,
                seq=self.seq,
                value=dice.choice([None, "Uniform", "Normal", "Lognormal"]),
            )
        elif what == "run":
            client.say("run", trials=dice.choice([None, 500, 2_000]), seed=dice.choice([None, None, 7]))
        elif what == "reset":
            client.say("reset", of="assumption", name=dice.choice(["", row["name"]]))
        elif what == "keep":
            self.number += 1
            name = f"state {self.number} <b>&'\""
            client.say("keep", name=name)
            self.kept.add(name)
        elif what == "drop" and self.kept:
            name = dice.choice(sorted(self.kept))
            client.say("drop", name=name)
            self.kept.discard(name)
        elif what == "show" and state["scenarios"]:
            client.say("show", name=dice.choice(state["scenarios"])["name"])
        elif what == "undo":
            self._undo_and_redo(client)
        elif what == "variants":
            self.still()  # a scenario may just have been dropped, and is there again after this
            before = {each["name"] for each in client.heard_last("state")["scenarios"]}
            client.say("variants")
            self.still()
            self.kept |= {each["name"] for each in client.heard_last("state")["scenarios"]} - before
        elif what == "view":
            names = dice.sample(["sum", "product"], dice.randint(0, 2))
            view = {
                "forecasts": names,
                "chosen": names,
                "tab": dice.choice(TABS),
                "first": "sum",
                "second": dice.choice([row["name"], "needed"]),
                "trial": dice.randrange(5_000),
            }
            client.say("view", **view, fits=dice.random() < 0.2)
        elif what in ("pin", "stop", "compare", "print"):
            client.say(what)
        elif what == "restore":
            client.say("restore", take=dice.random() < 0.5)
        elif what == "save":
            client.say("save", what=dice.choice(["json", "page", "copy"]))
        elif what == "book":
            self.book.edit()
        elif what == "reload":
            client.stack.close()
            self.clients[place] = self._client()
        elif what == "restart":
            self.settle()
            self.close()
            self.server.server.end()
            self.server.ended()
            self.server = self.start(book=self.book.path)
            self.clients = [self._client() for _ in range(3)]

    def _set(self, client, of, name, key, value, held=False):
        self.seq += 1
        client.say("set", of=of, name=name, key=key, value=value, held=held, seq=self.seq)

    def _drag(self, client, of, name, key, values):
        """Drag a handle from one value to the next, and let it go."""
        for left, value in enumerate(values, start=1 - len(values)):
            self._set(client, of, name, key, value, held=left < 0)

    def _undo_and_redo(self, client):
        """Go back some moments, and forth again: then all is as it was."""
        self.settle()
        before = self._moment()
        times = self.dice.randint(1, 4)
        back = 0
        for _ in range(times):
            if not client.heard_last("state")["undo"]:
                break
            client.say("undo")
            client.next("state")
            back += 1
        for _ in range(back):
            client.say("redo")
            client.next("state")
        self.settle()
        assert self._moment() == before, (back, self.done[-10:])

    def _moment(self):
        session = self.open_book.session
        return session.adjustments, dict(session.stored), session.asked

    def still(self):
        """Wait until nothing is done any more, and every client has heard of it."""
        end = time.monotonic() + PATIENCE
        for client in self.clients:  # what is said is heard in order: when this is refused, all before it was done
            self.number += 1
            name = f"no state {self.number}"
            client.say("show", name=name)
            client.next("trouble", lambda message, name=name: name in message["text"], PATIENCE)
        while not self._quiet():
            assert time.monotonic() < end, ("stuck", self._standing(), self.done[-12:])
            time.sleep(0.01)
        session = self.open_book.session
        for client in self.clients:
            wanted = "trouble" if session._is_faulty else "rest"
            while not self._has_heard(client, wanted):
                assert time.monotonic() < end, ("not told", wanted, self.done[-12:])
                drain(client)
            texts = json.dumps(client.heard)
            assert "xlmc has failed" not in texts, texts
            del client.heard[:-200]

    def settle(self):
        """Be still, and look whether every scenario is there."""
        self.still()
        session = self.open_book.session
        assert set(session.stored) == self.kept, (set(session.stored) ^ self.kept, self.done[-12:])
        assert Keeper(self.state).scenarios(self.book.path)[0] == session.stored

    def _standing(self):
        """What is known of a window that is stuck."""
        open_book = self.open_book
        session = open_book.session
        kept = ("version", "_done", "_stopped_at", "_problem", "_dragged", "_current", "_stopped")
        same = session is not None and session.own.workbook.sha256 == read_workbook(self.book.path).sha256
        result = {name: getattr(session, name, None) for name in kept}
        ended = [(task, task.done()) for task in open_book._tasks]
        return {"same file": same, "stamp": open_book._stamp, "trouble": open_book._trouble, "ended": ended, **result}

    def _quiet(self):
        open_book = self.server.server._open_books.get(self.server.library.only)
        session = None if open_book is None else open_book.session
        if session is None:
            return False
        if session.own.workbook.sha256 != read_workbook(self.book.path).sha256:
            return False
        return session._is_at_rest or session._is_faulty or session._stopped_at == session.version

    def _has_heard(self, client, wanted):
        session = self.open_book.session
        result = {each["kind"]: each for each in client.heard}
        if result.get("state", {}).get("version") != session.version:
            return False
        if session._stopped_at == session.version and not session._is_at_rest:
            return True
        if wanted == "trouble":
            return any(each["kind"] == "trouble" and each["text"] for each in client.heard)
        return all(result.get(kind, {}).get("version") == session.version for kind in ("rest", "frame"))

    def check(self):
        """Compare what is shown with what the edited workbook gives."""
        self.settle()
        session = self.open_book.session
        version = session.version
        stopped = session._stopped_at == session.version  # its run may have ended all the same, and be told later
        if not session._is_at_rest or session._is_faulty or stopped:
            return
        own = load(self.book.path)
        assert [each.name for each in own.assumptions] == [each.name for each in session.own.assumptions]
        result, expected = session.rest, own
        if session.adjustments:
            try:
                edited = edited_state(own, session.adjustments, "")
            except XlmcError as error:
                raise AssertionError((session.adjustments, self.done[-12:])) from error
            expected = build_model(read_workbook(edited.data, "book.xlsx"), self.book.path)
        expected = simulate(expected, evidence=None, trials=session.asked.trials, seed=session.asked.seed)
        same = result.trial_index.tobytes() == expected.trial_index.tobytes()
        assert same, (session.adjustments, session.asked, self.done[-12:])
        for name, values in expected.forecasts.items():
            assert result.forecasts[name].tobytes() == values.tobytes(), (name, self.done[-12:])
        if session.version != version:
            self.check()  # the workbook was read once more meanwhile, and pages are told of it a moment later
            return
        for client in self.clients:
            frame = client.heard_last("frame")
            messages = (frame["version"], frame["accepted"])
            assert messages == (session.version, expected.accepted), (
                messages,
                session.version,
                frame["stage"],
                self.done[-12:],
            )
        self.compared += 1


def drain(client):
    with contextlib.suppress(TimeoutError):
        while True:
            client.heard.append(json.loads(client.socket.recv(timeout=0.02)))


def main():
    import sys
    import tempfile
    from pathlib import Path

    here = Path(__file__).resolve().parent
    sys.path[:0] = [str(here.parent / "outputs" / "live"), str(here)]
    from conftest import _servers

    minutes, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with tempfile.TemporaryDirectory() as folder, _servers(Path(folder) / "state") as start:
        use = Use(start, Path(folder), Path(folder) / "state", seed)
        end = time.monotonic() + 60.0 * minutes
        steps = 0
        while time.monotonic() < end:
            for _ in range(use.dice.randint(1, 8)):
                use.step()
                steps += 1
            use.check()
        print(f"{steps} steps, {use.compared} states equal to the edited workbook, {len(use.kept)} scenarios kept")
        use.close()


if __name__ == "__main__":
    main()
