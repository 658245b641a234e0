"""What the live window keeps between two starts, damaged: `recent.json` and the scenarios of a workbook."""

from __future__ import annotations

import json
import random
import shutil
from pathlib import Path
from typing import Any, Final

from fuzzing import hostile
from fuzzing.inputs import Disagreement, Input, Reached
from fuzzing.json_changes import edited
from xlmc.errors import XlmcError
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.library import Library
from xlmc.outputs.live.stored_scenarios import Keeper

__all__ = ["make", "run"]

_BOOK: Final = "book.xlsx"
_RECENT: Final = "recent.json"
_SCENARIOS: Final = "scenarios.json"
_PATHS: Final = (
    "x" * 300,
    "y/" * 3_000,
    "/proc/1/root/x",
    "/dev/stdin",
    ".",
    "",
    "a\0b",
    "\ud800",
    "\udcff",
    "~",
    "..",
)


def make(rng: random.Random) -> Input:
    """One of the two files, with some values changed; or with its bytes changed."""
    name, document = rng.choice([(_RECENT, _recent(rng)), (_SCENARIOS, _scenarios(rng))])
    message = [name, *(edited(rng, document) for _ in range(rng.choice([0, 1, 1, 2, 4])))]
    data = json.dumps(document).encode("utf-8", "surrogatepass")
    if rng.random() < 0.2:
        broken = bytearray(data)
        for _ in range(rng.randint(1, 4)):
            broken[rng.randrange(len(broken))] = rng.randrange(256)
        data = bytes(broken[: rng.randrange(len(broken))] if rng.random() < 0.3 else broken)
        message.append("bytes changed")
    return Input(name, data, "; ".join(message))


def _recent(rng: random.Random) -> dict[str, Any]:
    others = [rng.choice([*_PATHS, hostile.text(rng)[:4_000]]) for _ in range(rng.randint(0, 4))]
    return {"books": [*others, _BOOK]}


def _scenarios(rng: random.Random) -> dict[str, Any]:
    def state() -> dict[str, Any]:
        values = {hostile.text(rng)[:50]: rng.choice([True, 0, -1.5, 1e308]) for _ in range(rng.randint(0, 3))}
        return {"assumptions": {"speed": {"low": 1.5, **values}}, "filters": {"stop": {"at_least": 3.0}}}

    return {"book": _BOOK, "scenarios": {"a": state(), hostile.text(rng)[:50]: state()}, "unkept": state()}


def run(given: Input, folder: Path) -> Reached:
    """Read the file as the window does when it starts, write it again, and read what was written.

    Raises:
        Disagreement: a page that cannot be sent as JSON, a damaged file that is gone, or what was kept is not found.
        XlmcError: as xlmc does, where it reads scenarios.
    """
    state, book = folder / "state", folder / _BOOK
    shutil.rmtree(state, ignore_errors=True)
    state.mkdir()
    book.write_bytes(b"PK")
    keeper = Keeper(state)
    path = state / _RECENT if given.name == _RECENT else keeper._of(book)
    path.write_bytes(given.data)
    return _recent_again(keeper, book, state, given.data) if given.name == _RECENT else _kept_again(keeper, book)


def _recent_again(keeper: Keeper, book: Path, state: Path, data: bytes) -> Reached:
    library = Library(keeper)
    result, trouble = library.recent(), library.trouble
    json.dumps([result, trouble], allow_nan=False).encode()
    if trouble and data not in [each.read_bytes() for each in state.iterdir() if ".damaged" in each.name]:
        raise Disagreement("recent.json: a damaged file is gone")
    library.opened(book)
    if keeper.recent()[:1] != [book]:
        raise Disagreement("recent.json: the workbook that was opened last is not the first")
    return Reached.REFUSED if trouble else Reached.RAN


def _kept_again(keeper: Keeper, book: Path) -> Reached:
    try:
        named, unkept = keeper.scenarios(book)
    except XlmcError:
        if keeper.scenarios(book) != ({}, Adjustments()):
            raise Disagreement("scenarios: a damaged file is read again") from None
        raise
    json.dumps([each.as_json() for each in (*named.values(), unkept)], allow_nan=False)
    keeper.keep(book, named, unkept)
    if Keeper(keeper._folder).scenarios(book) != (named, unkept):
        raise Disagreement("scenarios: what was kept is not what is found")
    return Reached.RAN
