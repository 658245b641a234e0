"""What the page and the server tell each other: JSON objects over one WebSocket, each with its `kind`.

**The page says**

| kind | fields | meaning |
|---|---|---|
| `hello` | `name`, `nonce` | first of all: which key the page will prove that it knows, that of a link's code or the \
secret, and a number that is used once; anything else before it ends the connection |
| `proof` | `proof` | the answer to the server's `proof` (`xlmc.outputs.live.guard` says of what) |
| `copy` | `key` | on the start page: copy a template into the folder and open it |
| `ticket` | | on the start page: a file is to be sent |
| `set` | `of`, `name`, `key`, `value`, `held`, `seq` | a number, a switch or the kind of an \
assumption, filter, forecast, correlation, decision or cell that is solved for; `value` null: as in the book, \
`none`: taken away; `held`: a handle is \
still held; `seq`: counts the page's changes, and comes back with the frame |
| `numbers` | `of`, `name`, `values`, `seq` | several numbers of one row at once: key -> number |
| `run` | `trials`, `seed` | of runs at rest, instead of what the workbook says; null: what it says |
| `undo`, `redo` | | go back to the state before the last change, and forth again |
| `reset` | `of`, `name` | everything of one row as in the book; with an empty `name`: of all, and the run |
| `view` | `forecasts`, `chosen`, `tab`, `first`, `second`, `trial`, `fits` | which charts can be seen, of which \
forecasts the other tabs are, which tab is open, whose pairs it \
shows, which trial is stepped to (from 0), whether fitted distributions are wanted |
| `pin` | | the state now becomes the one that is drawn behind |
| `restore` | `take` | bring back what was set when the window was last closed, or forget it |
| `stop` | | end the run that is going on |
| `keep` | `name` | keep the state now as a scenario of that name |
| `show` | `name` | bring a kept scenario back; with an empty name the book's own state |
| `drop` | `name` | forget a kept scenario |
| `compare` | | run every kept scenario, and put them into one table |
| `save` | `what` | write the result `book`, `page`, `json` or `run` beside the workbook; `copy`: a copy of the \
workbook with the changes; `into`: the changes into the workbook itself |
| `print` | | make the page of results of the state that is shown, to be printed |
| `variants` | | keep the usual variants of the workbook as scenarios |
| `study` | `what`, `other` | start `verify` on the workbook's file, or `stability`, `screen`, `methods` or `compare` \
on the state that is shown; `other`: the key of the workbook to compare it with |
| `cancel` | | end the study that is going on |

**The server says**

| kind | fields | meaning |
|---|---|---|
| `proof` | `nonce`, `proof` | first of all: a number of the server's own, and the proof that it knows the key |
| `welcome` | `secret` | the page may look; it keeps the secret for its next connection |
| `books` | `folder`, `books`, `recent`, `templates`, `trouble` | what the start page shows |
| `open` | `key` | the start page goes on to this workbook |
| `ticket` | `ticket` | one file may be sent with it |
| `book` | `name`, `folder`, `forecasts`, `notices`, `settings`, `shapes` | the workbook as it is now |
| `others` | `books` | the workbooks beside it that it can be compared with: `name` and `key` |
| `state` | `version`, `assumptions`, `filters`, `forecasts`, `correlations`, `decisions`, `solves`, `run`, `changes`, \
`scenarios`, `shown`, `offered`, `behind`, `undo`, `redo` | what is set; \
`run`: trials and seed, those of the workbook, and whether they differ; `changes` in words; `undo`, `redo`: whether \
there is something to |
| `moved` | `of`, `name`, `key`, `value` | what was set while a handle is held; `state` follows when it is let go |
| `frame` | `stage`, `version`, `seq`, `trials`, `accepted`, `share`, `few`, `shapes`, `forecasts` | an answer; `few`: \
from too few trials; `stage`: \
`moving` or `rest`; `shapes`: the distributions that differ from those of the workbook |
| `rest` | `version`, `sentences`, `warnings`, `checks`, `filters`, `sampling` | what is said of a run at rest |
| `part` | `tab`, `version`, `html`, or `pair` and `matrix`; of `step` also `trial` and `trials` | the contents of the \
open tab |
| `running` | `version`, `stage`, `share` | how far a run is; `share` 1: done |
| `study` | `what`, `of`, `state`, `step`, `seconds`, `text` | how far a study is; `of`: the changes that it is asked \
with; `state`: `running`, `done`, `cancelled`, \
`failed`; `text`: its answer |
| `page` | `path` | the page of results to be printed; its address is good once, for a minute |
| `trouble` | `about`, `text` | why something could not be done; an empty text: the trouble is over |
| `news` | `text`, `link` | what was done, such as a file that was written |

Numbers that are no numbers are null. What the page sends is checked here before anything looks at it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from xlmc.errors import XlmcError
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.live.adjustments import NONE, PARTS
from xlmc.outputs.live.kinds import KINDS

__all__ = ["MOST_BYTES", "Message", "PageMessage", "ProtocolError", "read_message", "written"]

MOST_BYTES: Final = 1 << 16
"""The fields of each kind of message from the page."""

_LONGEST: Final = 2_000
"""Characters of a name; Excel's cells hold more, its names fewer."""

_MOST_NAMES: Final = 500
_MOST_AT_ONCE: Final = 20

Message = dict[str, Any]
"""The kinds of message from the server."""


class ProtocolError(XlmcError):
    """A message that no page of xlmc sends."""


@dataclass(frozen=True, slots=True)
class PageMessage:
    """A message from the page, checked."""

    kind: str
    fields: Mapping[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.fields[name]


def _is_text(value: object) -> bool:
    return isinstance(value, str) and len(value) <= _LONGEST


def _is_value(value: object) -> bool:
    return value is None or isinstance(value, bool) or value == NONE or value in KINDS or _is_number(value)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and _is_finite(value)


def _is_finite(value: float) -> bool:
    """Return whether a float can hold the number: an integer of JSON may have 400 digits."""
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_count(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 1 << 53


def _is_count_or_none(value: object) -> bool:
    return value is None or _is_count(value)


def _are_texts(value: object) -> bool:
    return isinstance(value, list) and len(value) <= _MOST_NAMES and all(map(_is_text, value))


def _are_numbers(value: object) -> bool:
    """Return whether it is a mapping of few names to numbers."""
    return (
        isinstance(value, dict)
        and 0 < len(value) <= _MOST_AT_ONCE
        and all(map(_is_text, value))
        and all(map(_is_number, value.values()))
    )


def _one_of(*words: str) -> Callable[[object], bool]:
    return lambda value: isinstance(value, str) and value in words


_OF: Final = _one_of(*PARTS)

_FIELDS: Final[Mapping[str, Mapping[str, Callable[[object], bool]]]] = {
    "hello": {"name": _is_text, "nonce": _is_text},
    "proof": {"proof": _is_text},
    "copy": {"key": _is_text},
    "ticket": {},
    "set": {
        "of": _OF,
        "name": _is_text,
        "key": _is_text,
        "value": _is_value,
        "held": _is_flag,
        "seq": _is_count,
    },
    "numbers": {"of": _OF, "name": _is_text, "values": _are_numbers, "seq": _is_count},
    "run": {"trials": _is_count_or_none, "seed": _is_count_or_none},
    "undo": {},
    "redo": {},
    "reset": {"of": _OF, "name": _is_text},
    "view": {
        "forecasts": _are_texts,
        "chosen": _are_texts,
        "tab": _one_of("charts", "matters", "pairs", "tables", "step", "scenarios", "studies"),
        "first": _is_text,
        "second": _is_text,
        "trial": _is_count,
        "fits": _is_flag,
    },
    "pin": {},
    "restore": {"take": _is_flag},
    "stop": {},
    "keep": {"name": _is_text},
    "show": {"name": _is_text},
    "drop": {"name": _is_text},
    "compare": {},
    "save": {"what": _one_of("book", "page", "json", "run", "copy", "into")},
    "print": {},
    "variants": {},
    "study": {"what": _one_of("verify", "stability", "screen", "methods", "compare"), "other": _is_text},
    "cancel": {},
}


def read_message(text: str | bytes) -> PageMessage:
    """Read what the page said.

    Raises:
        ProtocolError: it is nothing that a page says.
    """
    if len(text) > MOST_BYTES:
        raise ProtocolError(f"a message of {count_text(len(text))} characters is too long")
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ProtocolError("a message is not JSON") from error
    kind = value.get("kind") if isinstance(value, dict) else None
    wanted = _FIELDS.get(kind) if isinstance(kind, str) else None
    if wanted is None:
        raise ProtocolError("a message has no kind that is known")
    for name, fits in wanted.items():
        if name not in value or not fits(value[name]):
            raise ProtocolError(f"{name!r} of a message {kind!r} is not what it must be")
    return PageMessage(str(kind), {name: value[name] for name in wanted})


def written(message: Message) -> str:
    """Write a message as text."""
    return json.dumps(message, allow_nan=False, separators=(",", ":"), ensure_ascii=True)
