"""Who may talk to the window: tokens, the cookie, Host and Origin, and the headers of every answer.

Whoever has the link that was printed may come in, once: the token in it is exchanged for a cookie that scripts cannot
read and that no other site's page brings along. A WebSocket, and every request that changes something, needs more: the
token that stands in the page, which no other site's page can read. And it must come from this very address: `Host` is
checked against names that lead elsewhere, `Origin` against pages from elsewhere.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Mapping
from typing import Final

__all__ = ["HEADERS", "MOST_UPLOADED", "Guard"]

MOST_UPLOADED: Final = 64 << 20
"""Bytes of a workbook that is dropped; Excel's own largest ones are no larger on most desks."""

_POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",
        "connect-src 'self'",
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
"""Headers of every answer."""


class Guard:
    """The secrets of one server.

    Args:
        port: that it listens on.
    """

    def __init__(self, port: int) -> None:
        self.cookie = f"xlmc-{port}"
        self.secret, self.page = secrets.token_urlsafe(32), secrets.token_urlsafe(32)
        self._tokens: set[str] = set()
        self._hosts = (f"127.0.0.1:{port}", f"localhost:{port}")

    def new_token(self) -> str:
        """A token for a link, which is good for one browser."""
        token = secrets.token_urlsafe(32)
        self._tokens.add(token)
        return token

    def exchange(self, token: str) -> bool:
        """Whether the token is good; it is not a second time."""
        for known in self._tokens:
            if _same(known, token):
                self._tokens.discard(known)
                return True
        return False

    def is_host(self, host: str | None) -> bool:
        """Whether the address that was typed, or that a page asked for, is this server's own."""
        return host is not None and host.lower() in self._hosts

    def is_origin(self, origin: str | None, host: str | None) -> bool:
        """Whether a request comes from a page of this server, by the same name."""
        return origin is not None and host is not None and origin.lower() == f"http://{host.lower()}"

    def is_known(self, cookies: Mapping[str, str]) -> bool:
        """Whether the browser has the cookie."""
        return _same(cookies.get(self.cookie, ""), self.secret)

    def is_page(self, token: str | None) -> bool:
        """Whether a page of this server asks."""
        return token is not None and _same(token, self.page)


def _same(first: str, second: str) -> bool:
    return hmac.compare_digest(first.encode("utf-8", "surrogatepass"), second.encode("utf-8", "surrogatepass"))
