"""Listens on the loopback address: hands out the page, takes workbooks that are dropped, speaks with windows."""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import logging
import secrets
import socket
import sys
import time
from collections.abc import Awaitable, Callable
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any, Final

import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.types import Message as AsgiMessage
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from xlmc.errors import XlmcError
from xlmc.outputs.live.guard import HEADERS, MOST_UPLOADED, PRINTED, Guard, proof
from xlmc.outputs.live.library import Library
from xlmc.outputs.live.open_book import OpenBook
from xlmc.outputs.live.protocol import MOST_BYTES, Message, PageMessage, ProtocolError, read_message, written
from xlmc.outputs.live.session import MEMORY
from xlmc.outputs.live.timed_requests import TimedRequests

__all__ = ["IDLE_SECONDS", "LiveServer", "bound_socket"]

IDLE_SECONDS: Final = 600.0
"""Seconds from the closing of the last window to the end of the server."""

_MOST_WINDOWS: Final = 32
_HELLO_SECONDS: Final = 10.0
_BODY_SECONDS: Final = 60.0
"""Seconds in which a window's first message, and the body of a request, must have arrived."""

_ENDS: Final = 1012
_UNKNOWN: Final = 4401
_NO_BOOK: Final = 4404
_LATE: Final = 4408
_FULL: Final = 4429
"""Why a WebSocket is closed."""

_GOODBYE_SECONDS: Final = 1.0
"""Seconds for which windows may take note that the server ends."""

_REPORT: Final = "xlmc.outputs.page"
_LIVE: Final = "xlmc.outputs.live.page"

STYLES: Final = {
    "uPlot.min.css": (_REPORT, "uplot/uPlot.min.css"),
    "page.css": (_REPORT, "page.css"),
    "charts.css": (_REPORT, "charts.css"),
    "live.css": (_LIVE, "live.css"),
}
SCRIPTS: Final = {
    "entry.js": (_LIVE, "entry.js"),
    "sharp.js": (_REPORT, "sharp.js"),
    "uPlot.iife.min.js": (_REPORT, "uplot/uPlot.iife.min.js"),
    "numbers.js": (_REPORT, "numbers.js"),
    "certainty.js": (_REPORT, "certainty.js"),
    "chart.js": (_REPORT, "chart.js"),
    "grabbers.js": (_REPORT, "grabbers.js"),
    "panel.js": (_REPORT, "panel.js"),
    "overlay.js": (_REPORT, "overlay.js"),
    "copies.js": (_REPORT, "copies.js"),
    "making.js": (_LIVE, "making.js"),
    "wire.js": (_LIVE, "wire.js"),
    "handles.js": (_LIVE, "handles.js"),
    "vectors.js": (_LIVE, "vectors.js"),
    "live_chart.js": (_LIVE, "live_chart.js"),
    "trend.js": (_LIVE, "trend.js"),
    "left_side.js": (_LIVE, "left_side.js"),
    "right_side.js": (_LIVE, "right_side.js"),
    "further_tabs.js": (_LIVE, "further_tabs.js"),
    "window.js": (_LIVE, "window.js"),
}
START_SCRIPTS: Final = {name: (_LIVE, name) for name in ("entry.js", "making.js", "wire.js", "start_page.js")}
_ASSETS: Final = {**STYLES, **SCRIPTS, **START_SCRIPTS}


def bound_socket(port: int) -> socket.socket:
    """Return a socket that listens on the loopback address, on a port that is free, or on this one.

    From then on a link to it works: who follows it before `LiveServer.serve` runs waits for a moment.

    Raises:
        XlmcError: something else has the port.
    """
    # Asyncio sends small messages at once only through sockets that name their protocol; others wait up to 40 ms.
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    if hasattr(socket, "SO_EXCLUSIVEADDRUSE"):  # Windows lets two programs share a port otherwise
        made.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
    elif sys.platform == "linux":  # connections that were closed a minute ago do not keep the port
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind(("127.0.0.1", port))
        made.listen()  # with SO_REUSEADDR it is this that fails where another program listens, too
    except OSError as error:
        made.close()
        hint = "give another with --port, or none"
        raise XlmcError(f"the port {port} cannot be used: {error.strerror or error}", hint=hint) from error
    return made


class LiveServer:
    """See the module.

    Args:
        sock: to listen on.
        library: which workbooks may be opened.
        idle: seconds after the last window was closed, and after the start, until it ends.
        clock: gives these seconds.
        memory: see `Session`.
    """

    def __init__(
        self,
        sock: socket.socket,
        library: Library,
        *,
        idle: float = IDLE_SECONDS,
        clock: Callable[[], float] = time.monotonic,
        memory: int = MEMORY,
    ) -> None:
        self._socket, self._library, self._idle, self._clock, self._memory = sock, library, idle, clock, memory
        self.port: int = sock.getsockname()[1]
        self.guard = Guard(self.port, clock)
        self._open_books: dict[str, OpenBook] = {}
        self._windows: set[WebSocket] = set()
        self._last_seen = clock()
        routes = [
            Route("/", self._start_page),
            Route("/book/{key}", self._book_page),
            Route("/static/{name}", _asset),
            Route("/print/{ticket}", self._print),
            Route("/drop", self._drop, methods=["POST"]),
            WebSocketRoute("/start", self._start),
            WebSocketRoute("/live/{key}", self._live),
        ]
        self.app: ASGIApp = _Guarded(Starlette(routes=routes), self.guard)
        config = uvicorn.Config(
            self.app,
            http=TimedRequests,
            log_config=None,
            log_level=logging.CRITICAL + 1,  # what another program sends is not for the person's terminal
            access_log=False,
            lifespan="off",
            ws_max_size=MOST_BYTES,
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=1,
            server_header=False,
            date_header=False,
            h11_max_incomplete_event_size=1 << 15,
        )
        self._server = _Uvicorn(config, self._say_goodbye)

    @property
    def link(self) -> str:
        """Return a link that opens the window, once, within a minute."""
        only = self._library.only
        return f"http://127.0.0.1:{self.port}/{'' if only is None else f'book/{only}'}#{self.guard.new_code()}"

    def end(self) -> None:
        """Stop listening, soon; also from a signal's handler."""
        self._server.should_exit = True

    async def serve(self) -> None:
        """Listen until somebody ends it, or nobody has looked for a while."""
        watching = asyncio.create_task(self._end_when_idle())
        try:
            await self._server.serve([self._socket])
        finally:
            watching.cancel()
            await asyncio.gather(*(open_book.close() for open_book in self._open_books.values()))

    async def _end_when_idle(self) -> None:
        while True:
            await asyncio.sleep(min(1.0, self._idle / 4))
            if self._windows:
                self._last_seen = self._clock()
            elif self._clock() - self._last_seen > self._idle:
                self.end()

    async def _say_goodbye(self) -> None:
        """Close every window, and wait until it has answered: a connection that is cut meanwhile is only lost."""
        await asyncio.gather(*(each.close(_ENDS) for each in self._windows), return_exceptions=True)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(_GOODBYE_SECONDS):
                while self._windows:
                    await asyncio.sleep(0.01)

    # Pages; they hold nothing of a workbook

    async def _start_page(self, request: Request) -> Response:
        return _page("start.html", START_SCRIPTS)

    async def _book_page(self, request: Request) -> Response:
        return _page("window.html", SCRIPTS)

    async def _print(self, request: Request) -> Response:
        """Hand over a page of results, once: the window prints it in a frame, in which its own scripts alone run."""
        text = self.guard.use_page(request.path_params["ticket"])
        if text is None:
            return _refusal("This page was printed already; print it again from the window.", 404)
        return HTMLResponse(text.encode("utf-8", "xmlcharrefreplace"), headers=PRINTED)

    # Files

    async def _drop(self, request: Request) -> Response:
        """Take a workbook that was dropped onto the page."""
        headers = request.headers
        is_own = self.guard.is_origin(headers.get("origin"), headers.get("host"))
        if not is_own or not self.guard.use_ticket(headers.get("x-xlmc-ticket")):
            return _refusal("This page may not do that.")
        too_large = JSONResponse({"trouble": f"The file is larger than {MOST_UPLOADED >> 20} MB."}, 413)
        sent = request.headers.get("content-length", "")
        if not sent.isdigit() or int(sent) > MOST_UPLOADED:
            return too_large
        data = bytearray()
        try:
            async with asyncio.timeout(_BODY_SECONDS):
                async for part in request.stream():
                    data += part
                    if len(data) > MOST_UPLOADED:
                        return too_large
        except TimeoutError:
            return JSONResponse({"trouble": "The file did not arrive in time."}, 408, {"Connection": "close"})
        try:
            key = await asyncio.to_thread(self._library.take, request.query_params.get("name", ""), bytes(data))
        except XlmcError as error:
            return JSONResponse({"trouble": str(error)}, 400)
        return JSONResponse({"key": key})

    # Windows

    async def _live(self, window: WebSocket) -> None:
        """Speak with one window on a workbook."""
        key = window.path_params["key"]

        async def speak() -> None:
            path = self._library.path(key)
            if path is None:
                await window.close(_NO_BOOK)
            else:
                await self._speak(window, self._open_book(key, path))

        await self._admit(window, speak)

    async def _start(self, window: WebSocket) -> None:
        """Speak with one start page."""

        async def speak() -> None:
            if self._library.only is not None:
                await _send(window, {"kind": "open", "key": self._library.only})
            await _send(window, self._books())
            while True:
                sent = await _receive(window)
                if sent.kind == "ticket":
                    await _send(window, {"kind": "ticket", "ticket": self.guard.new_ticket()})
                elif sent.kind == "copy":
                    await _send(window, await self._copied(sent["key"]))

        await self._admit(window, speak)

    def _books(self) -> Message:
        result = {
            "books": self._library.books(),
            "recent": self._library.recent(),
            "templates": self._library.templates(),
        }
        folder = str(self._library.folder or "")
        return {"kind": "books", "folder": folder, **result, "trouble": self._library.trouble}

    async def _copied(self, key: str) -> Message:
        """Copy a template into the folder, to be opened."""
        try:
            return {"kind": "open", "key": await asyncio.to_thread(self._library.copy_template, key)}
        except XlmcError as error:
            return {"kind": "trouble", "about": "copy", "text": str(error)}

    async def _admit(self, window: WebSocket, speak: Callable[[], Awaitable[None]]) -> None:
        """Speak with a page that proves that it may look; a page that says what none of xlmc's does is closed."""
        if not self.guard.is_origin(window.headers.get("origin"), window.headers.get("host")):
            await window.close(_UNKNOWN)  # before it is accepted: the browser is told 403
            return
        await window.accept()
        try:
            if not await self._is_known(window):
                await window.close(_UNKNOWN)
                return
            if len(self._windows) >= _MOST_WINDOWS:
                await window.close(_FULL)
                return
            self._windows.add(window)
            try:
                await _send(window, {"kind": "welcome", "secret": self.guard.secret})
                await speak()
            finally:
                self._windows.discard(window)
                self._last_seen = self._clock()
        except TimeoutError:
            await window.close(_LATE)  # the machine slept, or is busy: a page tries again
        except ProtocolError:
            await window.close(_UNKNOWN)
        except WebSocketDisconnect:
            pass

    async def _is_known(self, window: WebSocket) -> bool:
        """Return whether the page has proved that it knows its key, to which this end has proved the same."""
        async with asyncio.timeout(_HELLO_SECONDS):
            hello = await _receive(window, "hello")
            key = self.guard.key(hello["name"])
            if key is None:
                return False
            ends: tuple[str, str] = (hello["nonce"], secrets.token_hex(32))
            await _send(window, {"kind": "proof", "nonce": ends[1], "proof": proof(key, "server", *ends)})
            sent = (await _receive(window, "proof"))["proof"]
        wanted = proof(key, "page", *ends)
        is_right = hmac.compare_digest(sent.encode("utf-8", "surrogatepass"), wanted.encode())
        return is_right and self.guard.use(hello["name"])

    def _open_book(self, key: str, path: Path) -> OpenBook:
        if key not in self._open_books:
            self._open_books[key] = OpenBook(path, self._library, self.guard.new_page, self._memory)
            self._library.opened(path)
            self._open_books[key].start()
        return self._open_books[key]

    async def _speak(self, socket: WebSocket, open_book: OpenBook) -> None:
        window = open_book.join()

        async def send() -> None:
            while True:
                await socket.send_text(await window.next())

        sending = asyncio.create_task(send())
        try:
            while True:
                open_book.hear(window, await _receive(socket))
        finally:
            open_book.leave(window)
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)


async def _receive(socket: WebSocket, kind: str | None = None) -> PageMessage:
    """Return the next message.

    Raises:
        WebSocketDisconnect: there is none any more.
        ProtocolError: no page says it, or it is of another kind.
    """
    message = await socket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message.get("code", 1005))
    text = message.get("text")
    if text is None:
        raise ProtocolError("a message is not text")
    sent = read_message(str(text))
    if kind is not None and sent.kind != kind:
        raise ProtocolError(f"a message {sent.kind!r} comes before {kind!r}")
    return sent


async def _send(socket: WebSocket, message: Message) -> None:
    if socket.application_state is WebSocketState.CONNECTED:  # the server may have said goodbye meanwhile
        await socket.send_text(written(message))


class _Uvicorn(uvicorn.Server):
    """Leaves signals to the command that started it, and closes connections after a goodbye."""

    def __init__(self, config: uvicorn.Config, goodbye: Callable[[], Awaitable[None]]) -> None:
        super().__init__(config)
        self._goodbye = goodbye

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        await self._goodbye()
        await super().shutdown(sockets)

    def capture_signals(self) -> Any:
        from contextlib import nullcontext

        return nullcontext()


class _Guarded:
    """Refuses what is addressed to another name, and puts the headers on every answer."""

    def __init__(self, app: ASGIApp, guard: Guard) -> None:
        self._app, self._guard = app, guard

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return

        async def guarded(message: AsgiMessage) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        hosts = Headers(scope=scope).getlist("host")
        if len(hosts) == 1 and self._guard.is_host(hosts[0]):
            await self._app(scope, receive, guarded)
        elif scope["type"] == "http":
            await _refusal("This address is not the window's.", 421)(scope, receive, guarded)
        else:
            await receive()
            await send({"type": "websocket.close", "code": _UNKNOWN, "reason": ""})


def _page(name: str, scripts: dict[str, tuple[str, str]]) -> Response:
    styles = "".join(f'<link rel="stylesheet" href="/static/{each}">\n' for each in STYLES)
    tags = "".join(f'<script src="/static/{each}" defer></script>\n' for each in scripts)
    text = Template(files(_LIVE).joinpath(name).read_text(encoding="utf-8"))
    return HTMLResponse(text.substitute(styles=styles, scripts=tags))


def _refusal(text: str, status: int = 403) -> Response:
    return PlainTextResponse(f"xlmc: {text}\n", status)


_TYPES: Final = {".js": "text/javascript", ".css": "text/css"}


async def _asset(request: Request) -> Response:
    """Hand out a script or a style, which are the same for everybody and hold nothing of a workbook."""
    pair = _ASSETS.get(request.path_params["name"])
    if pair is None:
        return _refusal("There is no such file.", 404)
    package, name = pair
    return Response(files(package).joinpath(name).read_bytes(), media_type=_TYPES[Path(name).suffix])
