"""Who may talk to the window: everything else is refused."""

from __future__ import annotations

import asyncio
import json
import shutil
import socket
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from committed_books import TEMPLATES
from live_books import SIMPLE, change, small
from random_use import TOO_LATE
from websockets.exceptions import ConnectionClosed, InvalidStatus

from xlmc.errors import XlmcError
from xlmc.excel.workbook.writer import TakenError
from xlmc.outputs.live import server as live_server
from xlmc.outputs.live.guard import MOST_UPLOADED, SECRET, Guard, proof
from xlmc.outputs.live.library import Library, Sample
from xlmc.outputs.live.protocol import MOST_BYTES
from xlmc.outputs.live.server import SCRIPTS, STYLES, bound_socket
from xlmc.outputs.live.stored_scenarios import Keeper

ELSEWHERE = "http://evil.example"


@pytest.fixture
def book(tmp_path):
    return small(tmp_path / "<b>case & co.xlsx")


@pytest.fixture(scope="module")
def open_book(running_on, tmp_path_factory):
    """One server for all tests that leave it as it was: to start and to end one takes a fifth of a second."""
    return running_on(book=small(tmp_path_factory.mktemp("books") / "<b>case & co.xlsx"))


def code_of(server):
    """Name and key of the code that a new link carries."""
    return server.server.link.partition("#")[2].split(".")


def refused(open_book, name, *, proving):
    """Whether a connection is closed to a page that names this key and answers with what `proving(nonce)` gives."""
    with open_book.window(open_book.library.only, entering=False) as window:
        window.say("hello", name=name, nonce="a page's")
        try:
            window.say("proof", proof=proving(window.next("proof")["nonce"]))
            window.next("welcome")
        except ConnectionClosed:
            return True
    return False


def test_the_link_is_good_once_and_gives_the_secret(open_book):
    name, key = code_of(open_book)
    with open_book.window(open_book.library.only, entering=False) as window:
        assert window.enter(name, key) == open_book.server.guard.secret
        window.next("rest")
    assert refused(open_book, name, proving=lambda nonce: proof(key, "page", "a page's", nonce))
    with open_book.window(open_book.library.only, entering=False) as window:
        window.enter(SECRET, open_book.server.guard.secret)


def test_a_link_is_good_for_a_minute(running, book):
    now = [0.0]
    server = running(book=book, clock=lambda: now[0])
    (early, early_key), (late, late_key) = code_of(server), code_of(server)
    now[0] = 59.0
    assert not refused(server, early, proving=lambda nonce: proof(early_key, "page", "a page's", nonce))
    now[0] = 61.0
    assert refused(server, late, proving=lambda nonce: proof(late_key, "page", "a page's", nonce))


def test_a_page_that_cannot_prove_it_is_closed_and_the_code_stays_good(open_book):
    """Among the proofs: the server's own, sent back to it."""
    name, key = code_of(open_book)
    for wrong in (
        lambda nonce: proof("guess", "page", "a page's", nonce),
        lambda nonce: proof(key, "server", "a page's", nonce),
        lambda nonce: proof(key, "page", nonce, "a page's"),
        lambda nonce: proof(key, "page", "a page's", "another time's"),
        lambda nonce: "",
        lambda nonce: "\ud800é",
    ):
        assert refused(open_book, name, proving=wrong)
        assert refused(open_book, SECRET, proving=wrong)
    assert refused(open_book, "", proving=lambda nonce: proof("", "page", "a page's", nonce))
    assert refused(open_book, "no code", proving=lambda nonce: proof("", "page", "a page's", nonce))
    assert not refused(open_book, name, proving=lambda nonce: proof(key, "page", "a page's", nonce))


def test_no_page_holds_anything_of_a_workbook_or_of_the_secrets(open_book):
    for path in ("/", f"/book/{open_book.library.only}", "/book/nothing"):
        status, headers, body = open_book.ask(path)
        assert (status, headers["content-type"]) == (200, "text/html; charset=utf-8")
        assert "set-cookie" not in {name.lower() for name in headers}
        assert "case" not in body
        assert open_book.server.guard.secret not in body
        assert open_book.library.only not in body


def test_a_wrong_host_is_refused_everywhere(open_book):
    for host in ("evil.example", f"evil.example:{open_book.port}", "127.0.0.1", f"127.0.0.1:{open_book.port + 1}", ""):
        for path in ("/", f"/book/{open_book.library.only}", "/static/window.js"):
            assert open_book.ask(path, host=host or " ")[0] in (400, 421), (host, path)
    assert open_book.ask("/static/window.js", host=f"localhost:{open_book.port}")[0] == 200


def test_every_answer_has_a_strict_policy(open_book):
    for path in ("/", f"/book/{open_book.library.only}", "/static/live.css", "/static/no.js", "/nowhere"):
        _, headers, _ = open_book.ask(path)
        policy = headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self';" in policy
        assert "unsafe" not in policy
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
        assert headers["cache-control"] == "no-store"


def test_the_page_loads_only_what_is_here(open_book):
    _, _, body = open_book.ask(f"/book/{open_book.library.only}")
    assert "http" not in body
    for name in (*SCRIPTS, *STYLES):
        assert f"/static/{name}" in body
        assert open_book.ask(f"/static/{name}")[0] == 200
    for path in ("/static/..%2fwindow.html", "/static/../server.py", "/static/window.html"):
        assert open_book.ask(path)[0] == 404


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": ELSEWHERE},
        {"Origin": "null"},
        {"Origin": None},
        {"Host": "evil.example"},
    ],
)
def test_a_websocket_from_elsewhere_is_refused(open_book, headers):
    for path in ("/start", f"/live/{open_book.library.only}"):
        with pytest.raises(InvalidStatus) as refusal, open_book.connected(path, **headers):
            pass
        assert refusal.value.response.status_code in (400, 403)


@pytest.mark.parametrize(
    "first",
    [
        json.dumps({"kind": "proof", "proof": ""}),
        json.dumps({"kind": "stop"}),
        json.dumps({"kind": "hello"}),
        "no json",
        b"\x00",
        "x" * (MOST_BYTES + 1),
    ],
    ids=["proof", "no hello", "no nonce", "no json", "bytes", "too long"],
)
def test_a_websocket_must_first_say_hello(open_book, first):
    with open_book.window(open_book.library.only, entering=False) as window:
        window.socket.send(first)
        with pytest.raises(ConnectionClosed):
            window.socket.recv(timeout=120)


def test_a_page_that_is_late_may_try_again(open_book, monkeypatch):
    """Its machine slept, or is busy: it is not told what a page is told that this server does not know."""
    monkeypatch.setattr(live_server, "_HELLO_SECONDS", 0.05)
    late = open_book.window(open_book.library.only, entering=False)
    with late as window, pytest.raises(ConnectionClosed) as closed:
        window.socket.recv(timeout=120)
    assert closed.value.rcvd.code == TOO_LATE


def test_what_no_page_says_ends_the_connection_and_nothing_else(open_book):
    with open_book.window(open_book.library.only) as window, open_book.window(open_book.library.only) as other:
        window.next("rest")
        window.socket.send('{"kind": "set"}')
        with pytest.raises(ConnectionClosed):
            window.next("never")
        assert other.next("rest")["sentences"]


@pytest.mark.parametrize("missing", ["Origin", "X-Xlmc-Ticket"])
def test_a_file_needs_origin_and_ticket(open_book, missing):
    for wrong in ({}, {missing: ELSEWHERE}):
        headers = {name: value for name, value in open_book.own.items() if name != missing} | wrong
        status, _, _ = open_book.ask("/drop?name=a.xlsx", "POST", b"PK", Content_Length="2", **headers)
        assert status == 403
    assert not list(open_book.library.keeper.dropped.parent.glob("dropped/*"))


def test_a_page_to_be_printed_is_handed_over_once_within_a_minute_and_runs_its_own_scripts_alone(running, book):
    now = [0.0]
    server = running(book=book, clock=lambda: now[0])
    with server.window(server.library.only) as window:
        window.next("rest")
        window.say("print")
        path = window.next("page")["path"]
        assert server.ask(path, host="evil.example")[0] == 421
        status, headers, body = server.ask(path)
        assert (status, "Results of the simulation" in body) == (200, True)
        policy = headers["content-security-policy"]
        assert "script-src 'sha256-" in policy
        assert "frame-ancestors 'self'" in policy
        assert "'self'" not in policy.replace("frame-ancestors 'self'", "")
        assert server.ask(path)[0] == 404
        window.say("print")
        path = window.next("page")["path"]
        now[0] = 61.0
        assert server.ask(path)[0] == 404
    assert server.ask("/print/nothing")[0] == 404


def test_only_few_pages_wait_to_be_printed():
    guard = Guard(80)
    tickets = [guard.new_page(f"page {number}") for number in range(6)]
    assert [guard.use_page(ticket) for ticket in tickets] == [None, None, *(f"page {number}" for number in range(2, 6))]


def test_a_ticket_is_good_once_and_the_oldest_go(open_book):
    guard = open_book.server.guard
    tickets = [guard.new_ticket() for _ in range(150)]
    good = [guard.use_ticket(each) for each in tickets]
    assert good == [False] * 50 + [True] * 100
    assert not any(map(guard.use_ticket, tickets))
    assert not guard.use_ticket(None)


def test_a_gigabyte_is_refused_before_it_is_sent(open_book):
    for size in (1 << 30, MOST_UPLOADED + 1):
        status, _, body = open_book.ask("/drop?name=a.xlsx", "POST", b"PK", Content_Length=str(size), **open_book.own)
        assert status == 413
        assert "64 MB" in json.loads(body)["trouble"]
    status, _, _ = open_book.ask(
        "/drop?name=a.xlsx", "POST", b"0\r\n\r\n", Transfer_Encoding="chunked", **open_book.own
    )
    assert status == 413  # of no known length


def test_a_workbook_that_is_dropped_is_opened(running, tmp_path):
    server = running(folder=tmp_path)
    data = small(tmp_path / "source.xlsx").read_bytes()
    with server.connected("/start") as page:
        page.say("ticket")
        ticket = page.next("ticket")["ticket"]
    ask = {"method": "POST", "body": data, "Content_Length": str(len(data)), **server.own, "X-Xlmc-Ticket": ticket}
    status, _, body = server.ask("/drop?name=..%2F..%2Fa%3Cb%3E.xlsx", **ask)
    assert status == 200
    key = json.loads(body)["key"]
    path = server.library.path(key)
    assert path.name == "a_b_.xlsx"
    assert path.is_relative_to(server.library.keeper.dropped)
    assert path.read_bytes() == data
    with server.window(key) as window:
        assert window.next("rest")["sentences"]
    for name, sent in (("a.exe", data), ("a.xlsx", b"no zip")):
        ask |= {"body": sent, "Content_Length": str(len(sent)), **server.own}
        status, _, body = server.ask(f"/drop?name={name}", **ask)
        assert status == 400
        assert "not an Excel workbook" in json.loads(body)["trouble"]


def test_a_folder_shows_its_workbooks_and_no_link_leads_out(running, tmp_path):
    folder, outside = tmp_path / "folder", tmp_path / "outside"
    folder.mkdir()
    outside.mkdir()
    shutil.copy(SIMPLE, folder / "a.xlsx")
    shutil.copy(SIMPLE, outside / "secret.xlsx")
    (folder / "~$a.xlsx").write_bytes(b"lock")
    (folder / "b.txt").write_text("text", encoding="utf-8")
    (folder / "link.xlsx").symlink_to(outside / "secret.xlsx")
    server = running(folder=folder)
    assert [each["name"] for each in server.library.books()] == ["a.xlsx"]
    key = server.library._add(folder / "a.xlsx")
    with server.window(key) as window:
        window.next("book")
    (folder / "a.xlsx").unlink()
    (folder / "a.xlsx").symlink_to(outside / "secret.xlsx")  # after it was listed
    with server.window(key) as window, pytest.raises(ConnectionClosed, match="4404"):
        window.next("book")


def test_a_template_is_copied_and_never_over_a_file(tmp_path, monkeypatch):
    sample = Sample("skid", "?", TEMPLATES["skid"])
    library = Library(Keeper(tmp_path / "state"), folder=tmp_path, samples=[sample])
    (tmp_path / "skid.xlsx").write_text("mine", encoding="utf-8")
    (row,) = library.templates()
    path = library.path(library.copy_template(row["key"]))
    assert path.name == "skid-2.xlsx"
    assert path.read_bytes() == TEMPLATES["skid"].read_bytes()
    assert (tmp_path / "skid.xlsx").read_text(encoding="utf-8") == "mine"
    with pytest.raises(XlmcError):
        library.copy_template("nothing")
    path.write_bytes(b"a person's")
    monkeypatch.setattr(
        "xlmc.outputs.live.library.unused_path", lambda _: path
    )  # as if the file had come just after the look
    with pytest.raises(TakenError, match="exists already"):
        library.copy_template(row["key"])
    assert path.read_bytes() == b"a person's"


def test_both_editions_of_a_template_stand_in_one_row(tmp_path):
    samples = [Sample("beam", "?", TEMPLATES["beam"]), Sample("beam", "?", TEMPLATES["beam-si"], "SI")]
    library = Library(Keeper(tmp_path / "state"), folder=tmp_path, samples=samples)
    (row,) = library.templates()
    ((si, key),) = ((each["units"], each["key"]) for each in row["editions"])
    assert si == "SI"
    assert library.path(library.copy_template(key)).read_bytes() == TEMPLATES["beam-si"].read_bytes()


def test_the_start_page_copies_a_template(running, tmp_path):
    samples = [Sample("skid", "How fast?", TEMPLATES["skid"]), Sample("lost", "?", tmp_path / "lost.xlsx")]
    server = running(folder=tmp_path, samples=samples)
    with server.connected("/start") as page:
        skid, lost = page.next("books")["templates"]
        page.say("copy", key=lost["key"])
        assert "lost.xlsx" in page.next("trouble")["text"]
        page.say("copy", key=skid["key"])
        assert server.library.path(page.next("open")["key"]).name == "skid.xlsx"


def test_the_start_page_goes_on_to_the_one_workbook(open_book):
    with open_book.connected("/start") as page:
        assert page.next("open")["key"] == open_book.library.only


def test_two_windows_show_one_state_and_a_new_one_gets_it(running, book):
    open_book = running(book=book)
    key = open_book.library.only
    with open_book.window(key) as first, open_book.window(key) as second:
        name = first.next("state")["assumptions"][0]["name"]
        number = first.heard[-1]["assumptions"][0]["numbers"][-1]
        first.next("rest")
        second.next("rest")
        value = number["value"] * 1.01
        first.say("set", **change(name, number["key"], value, held=True).fields)
        moved = second.next("moved")
        assert (moved["name"], moved["value"]) == (name, value)
        first.say("set", **change(name, number["key"], value, seq=2).fields)
        ended = [each.next("rest", lambda message: message["version"] == 2) for each in (first, second)]
        assert ended[0] == ended[1]
        with open_book.window(key) as third:
            assert third.next("state")["changes"] == first.heard_last("state")["changes"] != []
            assert third.next("rest") == ended[0]


def test_a_hundred_changes_a_second_do_not_starve_it(running, book):
    open_book = running(book=book)
    with open_book.window(open_book.library.only) as window:
        row = window.next("state")["assumptions"][0]
        window.next("rest")
        number, enough = row["numbers"][-1], threading.Event()

        def move():
            seq = 0
            while not enough.wait(0.005):
                seq += 1
                value = number["value"] * (1 + seq % 200 / 10_000)
                window.say("set", **change(row["name"], number["key"], value, held=True, seq=seq).fields)
            return seq

        with ThreadPoolExecutor(1) as pool:
            moving = pool.submit(move)
            try:
                frames = [window.next("frame", lambda message: message["stage"] == "moving") for _ in range(3)]
            finally:
                enough.set()
        assert [each["seq"] for each in frames] == sorted(each["seq"] for each in frames)
        last = moving.result() + 1
        window.say("set", **change(row["name"], number["key"], number["value"] * 1.03, seq=last).fields)
        window.next("rest", lambda message: message["version"] == last)


def test_it_ends_when_nobody_has_looked_for_a_while(running, book):
    now = [0.0]
    server = running(book=book, idle=0.5, clock=lambda: now[0])
    with server.window(server.library.only) as window:
        window.next("rest")
        now[0] += 1.0
        time.sleep(0.3)  # it looks every eighth of a second
        assert server.ask("/static/window.js")[0] == 200
    end = time.monotonic() + 120
    while time.monotonic() < end:
        now[0] += 1.0
        try:
            server.ask("/static/window.js")
        except OSError:
            return
        time.sleep(0.1)
    pytest.fail("it is still listening")


def test_a_port_that_is_taken_is_told():
    with bound_socket(0) as taken, pytest.raises(XlmcError, match="--port"):
        bound_socket(taken.getsockname()[1])


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere another program could take the port over")
def test_a_port_can_be_used_again_at_once():
    """Also while connections that this end has closed are remembered, which Linux does for a minute."""
    with bound_socket(0) as before:
        port = before.getsockname()[1]
        with socket.create_connection(("127.0.0.1", port), timeout=120) as client:
            before.accept()[0].close()
            assert client.recv(1) == b""
    with bound_socket(port) as after:
        assert after.getsockname()[1] == port
        with pytest.raises(XlmcError, match="--port"):
            bound_socket(port)


def test_a_link_works_as_soon_as_there_is_one():
    with bound_socket(0) as waiting:
        socket.create_connection(waiting.getsockname(), timeout=120).close()


HALVES = {
    "nothing": b"",
    "half a line": b"GET / HT",
    "half a head": b"GET / HTTP/1.1\r\nHost: ",
    "a request, and half of another": b"GET /static/live.css HTTP/1.1\r\nHost: {host}\r\n\r\nGET /",
    "half a body": (
        b"POST /drop?name=a.xlsx HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n"
        b"X-Xlmc-Ticket: {ticket}\r\nContent-Length: 100\r\n\r\nPK"
    ),
}


@pytest.mark.parametrize("sent", HALVES.values(), ids=HALVES.keys())
def test_half_a_request_is_given_up(open_book, monkeypatch, sent):
    monkeypatch.setattr("xlmc.outputs.live.timed_requests._HEAD_SECONDS", 0.2)
    monkeypatch.setattr("xlmc.outputs.live.server._BODY_SECONDS", 0.2)
    words = {"host": open_book.host, "ticket": open_book.server.guard.new_ticket()}
    for word, value in words.items():
        sent = sent.replace(f"{{{word}}}".encode(), value.encode())
    with socket.create_connection(("127.0.0.1", open_book.port), timeout=120) as client:
        client.sendall(sent)
        while client.recv(1 << 16):
            pass


def test_a_connection_whose_head_came_in_time_lives_on(open_book, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.live.timed_requests._HEAD_SECONDS", 0.2)
    with open_book.window(open_book.library.only) as window:
        window.next("rest")
        time.sleep(0.5)
        window.say("view", forecasts=[], chosen=[], tab="tables", first="", second="", fits=False, trial=0)
        assert window.next("part")["tab"] == "tables"


def test_small_messages_are_sent_at_once():
    """Else the second of two waits until the first is acknowledged, some 40 ms."""
    result = []

    async def connected(_, writer):
        sent_at_once = writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
        result.append(bool(sent_at_once))
        writer.close()

    async def connect_once():
        with bound_socket(0) as made:
            async with await asyncio.start_server(connected, sock=made):
                reader, writer = await asyncio.open_connection(*made.getsockname())
                await reader.read()
                writer.close()

    asyncio.run(connect_once())
    assert result == [True]


def test_it_listens_on_the_loopback_address_alone(open_book):
    assert open_book.server._socket.getsockname()[0] == "127.0.0.1"


@pytest.mark.parametrize(
    "sent", [b"\x00\x01\r\n\r\n", b"GET / HTTP/1.1\r\nHost: {host}\r\nUpgrade: h2c\r\nConnection: Upgrade\r\n\r\n"]
)
def test_what_another_program_sends_is_not_printed(open_book, sent, capfd):
    with socket.create_connection(("127.0.0.1", open_book.port)) as connection:
        connection.sendall(sent.replace(b"{host}", open_book.host.encode()))
        assert connection.recv(100)
    open_book.ask("/static/wire.js")
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("name", ["con.xlsx", "NUL.xlsx", "com1.backup.xlsm", "LPT9.xls"])
def test_a_dropped_workbook_has_no_name_of_a_device(tmp_path, name):
    library = Library(Keeper(tmp_path / "state"))
    data = b"PK" if not name.endswith(".xls") else b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
    assert library.path(library.take(name, data)).name == f"_{name}"


def test_secrets_are_long_and_all_different():
    guards = [Guard(1), Guard(1)]
    secrets = [
        text
        for each in guards
        for text in (each.secret, each.new_ticket(), *(each.new_code().partition(".")[2] for _ in range(2)))
    ]
    assert len({*secrets}) == len(secrets)
    assert min(map(len, secrets)) >= 40
    assert not guards[0].use(guards[1].new_code().partition(".")[0])
