"""Who may talk to the window: the link's code, proofs of the secret, Host and Origin, and the headers of every answer.

A browser sends cookies to every port of an address, and a port may belong to another program tomorrow; so there is no
cookie, and no page ever says the secret. The link carries a code that is good once, for a minute. The two ends of a new
connection prove to each other that they know the code, or the secret that the page got for it: each names a number
that is used once, and the other answers with a keyed hash (HMAC) of both numbers. A file that is dropped comes by a
request of its own; it carries a ticket that the page got over its connection, and that is good once; so is the address
of a page of results that is to be printed. And everything
must come from this very address: `Host` is checked against names that lead elsewhere, `Origin` against pages from
elsewhere.
"""

from __future__ import annotations

import hmac
import secrets
import time
from collections.abc import Callable, Mapping
from typing import Final, Literal

from xlmc.outputs.page import page_policy

__all__ = ["HEADERS", "MOST_UPLOADED", "PRINTED", "SECRET", "Guard", "proof"]

MOST_UPLOADED: Final = 64 << 20
"""Bytes of a workbook that is dropped; Excel's own largest ones are seldom larger."""

SECRET: Final = "secret"
"""What a page names that has the secret; other pages name the code of their link."""

_CODE_SECONDS: Final = 60.0
"""Seconds for which a link is good."""

_MOST_TICKETS: Final = 100

_MOST_PAGES: Final = 4
"""Pages that wait to be printed."""

_POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",
        "connect-src 'self'",
        "frame-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)

HEADERS: Final[Mapping[str, str]] = {
    "Content-Security-Policy": _POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""Headers of every answer, unless it has others."""

PRINTED: Final[Mapping[str, str]] = {
    "Content-Security-Policy": f"{page_policy()}; frame-ancestors 'self'",
    "X-Frame-Options": "SAMEORIGIN",
}
"""Headers of a page of results, which is shown in a frame of the window alone."""


def proof(key: str, end: Literal["server", "page"], page_nonce: str, server_nonce: str) -> str:
    """Prove to these two numbers that the key is known: an HMAC with SHA-256, in hexadecimal."""
    text = " ".join((end, page_nonce, server_nonce))
    return hmac.new(key.encode(), text.encode("utf-8", "surrogatepass"), "sha256").hexdigest()


class Guard:
    """The secrets of one server.

    Args:
        port: that it listens on.
        clock: gives the seconds for which a link is good.
    """

    def __init__(self, port: int, clock: Callable[[], float] = time.monotonic) -> None:
        self.secret = secrets.token_urlsafe(32)
        self._clock = clock
        self._codes: dict[str, tuple[str, float]] = {}
        self._tickets: dict[str, None] = {}
        self._pages: dict[str, tuple[str, float]] = {}
        self._hosts = (f"127.0.0.1:{port}", f"localhost:{port}")

    def new_code(self) -> str:
        """Return a code for a link: its name, a point, and its key."""
        name, key = secrets.token_hex(8), secrets.token_urlsafe(32)
        self._codes[name] = (key, self._clock() + _CODE_SECONDS)
        return f"{name}.{key}"

    def key(self, name: str) -> str | None:
        """Return the key that a page must know which names `SECRET`, or a code that is still good."""
        if name == SECRET:
            return self.secret
        key, until = self._codes.get(name, ("", 0.0))
        return key if key and self._clock() <= until else None

    def use(self, name: str) -> bool:
        """Return whether what was named is still good; a code is not a second time."""
        return name == SECRET or self._codes.pop(name, None) is not None

    def new_ticket(self) -> str:
        """Return a ticket for one file."""
        ticket = secrets.token_urlsafe(32)
        self._tickets[ticket] = None
        if len(self._tickets) > _MOST_TICKETS:
            del self._tickets[next(iter(self._tickets))]
        return ticket

    def use_ticket(self, ticket: str | None) -> bool:
        """Return whether the ticket is good; it is not a second time."""
        return ticket is not None and self._tickets.pop(ticket, ticket) is None

    def new_page(self, text: str) -> str:
        """Keep a page that is to be printed, and return the ticket for it."""
        ticket = secrets.token_urlsafe(32)
        self._pages[ticket] = text, self._clock() + _CODE_SECONDS
        while len(self._pages) > _MOST_PAGES:
            del self._pages[next(iter(self._pages))]
        return ticket

    def use_page(self, ticket: str) -> str | None:
        """Return the page of a ticket, once, within a minute; otherwise None."""
        text, until = self._pages.pop(ticket, ("", 0.0))
        return text if text and self._clock() <= until else None

    def is_host(self, host: str | None) -> bool:
        """Return whether the address that was typed, or that a page asked for, is this server's own."""
        return host is not None and host.lower() in self._hosts

    def is_origin(self, origin: str | None, host: str | None) -> bool:
        """Return whether a request comes from a page of this server, by the same name."""
        return origin is not None and host is not None and origin.lower() == f"http://{host.lower()}"
