"""Listens on the loopback address: hands out the page, takes workbooks that are dropped, speaks with windows."""

from __future__ import annotations

import asyncio
import json
import socket
import sys
import time
from collections.abc import Callable
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any, Final

import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from xlmc.errors import XlmcError
from xlmc.outputs.live.desk import Desk
from xlmc.outputs.live.guard import HEADERS, MOST_UPLOADED, Guard
from xlmc.outputs.live.library import Library
from xlmc.outputs.live.protocol import MOST_BYTES, ProtocolError, read_message
from xlmc.outputs.live.timed_requests import TimedRequests

__all__ = ["IDLE_SECONDS", "LiveServer", "bound_socket"]

IDLE_SECONDS: Final = 600.0
"""Seconds from the closing of the last window to the end of the server."""

_MOST_WINDOWS: Final = 32
_HELLO_SECONDS: Final = 10.0
_BODY_SECONDS: Final = 60.0
"""Seconds in which a window's first message, and the body of a request, must have arrived."""

_UNKNOWN: Final = 4401
_FULL: Final = 4429
"""Why a WebSocket is closed."""

_ENTERED: Final = (
    '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>xlmc</title>'
    '<link rel="icon" href="data:,">'
    '<meta http-equiv="refresh" content="0;url=/"></head><body><p><a href="/">To the window</a></p></body></html>'
)

_REPORT: Final = "xlmc.outputs.page"
_LIVE: Final = "xlmc.outputs.live.page"

STYLES: Final = {
    "uPlot.min.css": (_REPORT, "uplot/uPlot.min.css"),
    "page.css": (_REPORT, "page.css"),
    "charts.css": (_REPORT, "charts.css"),
    "live.css": (_LIVE, "live.css"),
}
SCRIPTS: Final = {
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
    "left_side.js": (_LIVE, "left_side.js"),
    "right_side.js": (_LIVE, "right_side.js"),
    "further_tabs.js": (_LIVE, "further_tabs.js"),
    "window.js": (_LIVE, "window.js"),
}
START_SCRIPTS: Final = {"making.js": (_LIVE, "making.js"), "start_page.js": (_LIVE, "start_page.js")}
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
    """

    def __init__(
        self,
        sock: socket.socket,
        library: Library,
        *,
        idle: float = IDLE_SECONDS,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._socket, self._library, self._idle, self._clock = sock, library, idle, clock
        self.port: int = sock.getsockname()[1]
        self.guard = Guard(self.port)
        self._desks: dict[str, Desk] = {}
        self._last_seen = clock()
        routes = [
            Route("/", self._start_page),
            Route("/book/{key}", self._book_page),
            Route("/static/{name}", _asset),
            Route("/open/{key}", self._open, methods=["POST"]),
            Route("/drop", self._drop, methods=["POST"]),
            WebSocketRoute("/live/{key}", self._live),
        ]
        self.app: ASGIApp = _Guarded(Starlette(routes=routes), self.guard)
        config = uvicorn.Config(
            self.app,
            http=TimedRequests,
            log_config=None,
            access_log=False,
            lifespan="off",
            ws_max_size=MOST_BYTES,
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=1,
            server_header=False,
            date_header=False,
            h11_max_incomplete_event_size=1 << 15,
        )
        self._server = _Uvicorn(config)

    @property
    def link(self) -> str:
        """A link that opens the window, once."""
        return f"http://127.0.0.1:{self.port}/?token={self.guard.new_token()}"

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
            await asyncio.gather(*(desk.close() for desk in self._desks.values()))

    async def _end_when_idle(self) -> None:
        while True:
            await asyncio.sleep(min(1.0, self._idle / 4))
            if any(desk.windows for desk in self._desks.values()):
                self._last_seen = self._clock()
            elif self._clock() - self._last_seen > self._idle:
                self.end()

    # Pages

    async def _start_page(self, request: Request) -> Response:
        token = request.query_params.get("token")
        if token is not None:
            if not self.guard.exchange(token):
                return _refusal(
                    "This link was used already. Type xlmc open again, or go on in the browser that has it."
                )
            return self._entered()
        if not self.guard.is_known(request.cookies):
            return _refusal("Open the link that xlmc open has printed.")
        first = self._library.only
        if first is not None:
            return RedirectResponse(f"/book/{first}", 303)
        data = {
            "folder": str(self._library.folder or ""),
            "books": self._library.books(),
            "recent": self._library.recent(),
            "templates": self._library.templates(),
            "trouble": self._library.trouble,
        }
        return self._page("start.html", START_SCRIPTS, {"title": "xlmc", "data": _as_data(data)})

    def _entered(self) -> Response:
        """The cookie, and a page that goes on to the window; a redirect from elsewhere would bring no cookie."""
        answer = HTMLResponse(_ENTERED)
        answer.set_cookie(self.guard.cookie, self.guard.secret, httponly=True, samesite="strict", path="/")
        return answer

    async def _book_page(self, request: Request) -> Response:
        if not self.guard.is_known(request.cookies):
            return _refusal("Open the link that xlmc open has printed.")
        path = self._library.path(request.path_params["key"])
        if path is None:
            return _refusal("There is no such workbook here.", 404)
        return self._page("window.html", SCRIPTS, {"title": escape(path.name), "key": request.path_params["key"]})

    def _page(self, name: str, scripts: dict[str, tuple[str, str]], more: dict[str, str]) -> Response:
        styles = "".join(f'<link rel="stylesheet" href="/static/{each}">\n' for each in STYLES)
        tags = "".join(f'<script src="/static/{each}" defer></script>\n' for each in scripts)
        text = Template(files(_LIVE).joinpath(name).read_text(encoding="utf-8"))
        return HTMLResponse(text.substitute(more, page=self.guard.page, styles=styles, scripts=tags))

    # What changes something

    def _may_change(self, request: Request) -> bool:
        headers = request.headers
        return (
            self.guard.is_known(request.cookies)
            and self.guard.is_page(headers.get("x-xlmc-page"))
            and self.guard.is_origin(headers.get("origin"), headers.get("host"))
        )

    async def _open(self, request: Request) -> Response:
        """Copy a template into the folder and open it."""
        if not self._may_change(request):
            return _refusal("This page may not do that.")
        try:
            key = await asyncio.to_thread(self._library.copy_template, request.path_params["key"])
        except XlmcError as error:
            return JSONResponse({"trouble": str(error)}, 400)
        return JSONResponse({"open": f"/book/{key}"})

    async def _drop(self, request: Request) -> Response:
        """Take a workbook that was dropped onto the page."""
        if not self._may_change(request):
            return _refusal("This page may not do that.")
        too_large = JSONResponse({"trouble": f"The file is larger than {MOST_UPLOADED >> 20} MB."}, 413)
        said = request.headers.get("content-length", "")
        if not said.isdigit() or int(said) > MOST_UPLOADED:
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
        return JSONResponse({"open": f"/book/{key}"})

    # Windows

    async def _live(self, socket: WebSocket) -> None:
        """Speak with one window."""
        host = socket.headers.get("host")
        path = self._library.path(socket.path_params["key"])
        is_own = self.guard.is_origin(socket.headers.get("origin"), host) and self.guard.is_known(socket.cookies)
        if not is_own or path is None:
            await socket.close(_UNKNOWN)  # before it is accepted: the browser is told 403
            return
        await socket.accept()
        try:
            said = read_message(await asyncio.wait_for(_heard(socket), _HELLO_SECONDS))
            if said.kind != "hello" or not self.guard.is_page(said["page"]):
                await socket.close(_UNKNOWN)
                return
            if sum(desk.windows for desk in self._desks.values()) >= _MOST_WINDOWS:
                await socket.close(_FULL)
                return
            await self._speak(socket, self._desk(socket.path_params["key"], path))
        except (ProtocolError, TimeoutError):
            await socket.close(_UNKNOWN)
        except WebSocketDisconnect:
            pass

    def _desk(self, key: str, path: Path) -> Desk:
        if key not in self._desks:
            self._desks[key] = Desk(path, self._library)
            self._library.opened(path)
            self._desks[key].start()
        return self._desks[key]

    async def _speak(self, socket: WebSocket, desk: Desk) -> None:
        window = desk.join()
        self._last_seen = self._clock()

        async def send() -> None:
            while True:
                await socket.send_text(await window.next())

        sending = asyncio.create_task(send())
        try:
            while True:
                desk.hear(window, read_message(await _heard(socket)))
        finally:
            desk.leave(window)
            self._last_seen = self._clock()
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)


async def _heard(socket: WebSocket) -> str:
    """The next message's text.

    Raises:
        WebSocketDisconnect: there is none any more.
        ProtocolError: it is no text.
    """
    message = await socket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message.get("code", 1005))
    text = message.get("text")
    if text is None:
        raise ProtocolError("a message is not text")
    return str(text)


class _Uvicorn(uvicorn.Server):
    """Leaves signals to the command that started it."""

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

        async def guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers[name] = value
            await send(message)

        hosts = Headers(scope=scope).getlist("host")
        if len(hosts) == 1 and self._guard.is_host(hosts[0]):
            await self._app(scope, receive, guarded)
        elif scope["type"] == "http":
            await _refusal("This address is not the window's.", 421)(scope, receive, guarded)
        else:
            await receive()
            await send({"type": "websocket.close", "code": _UNKNOWN, "reason": ""})


def _refusal(text: str, status: int = 403) -> Response:
    return PlainTextResponse(f"xlmc: {text}\n", status)


_TYPES: Final = {".js": "text/javascript", ".css": "text/css"}


async def _asset(request: Request) -> Response:
    """A script or a style; they are the same for everybody, and hold nothing of a workbook."""
    found = _ASSETS.get(request.path_params["name"])
    if found is None:
        return _refusal("There is no such file.", 404)
    package, name = found
    return Response(files(package).joinpath(name).read_bytes(), media_type=_TYPES[Path(name).suffix])


def _as_data(found: object) -> str:
    """JSON that can stand in an element of a page."""
    text = json.dumps(found)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
