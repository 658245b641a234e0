"""Workbooks of Crystal Ball whose hidden blocks are broken: the text, the compressed data, the objects, the names."""

from __future__ import annotations

import io
import random
import re
import struct
import sys
import zipfile
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests" / "session"))

from crystal_ball_book import Asked, Decided, Drawn, Tied, save

from fuzzing import zips
from fuzzing.inputs import Disagreement, Input, Reached, steps_of
from xlmc.engine.engines import ENGINES
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.definitions_reader import read_definitions

__all__ = ["BLOCK_CHANGES", "book_parts", "make", "refuse_silence", "run"]

_SHEET, _OTHER = "Model data", "Other's"
_STEPS: Final = {"summary": 0.2, "verify": 0.05, "check": 0.1, "simulate": 0.01}
_CELLS: Final = (*(f"'{_SHEET}'!B{row}" for row in (2, 3, 4)), "'Other''s'!A1", "'Other''s'!A2")
_ANSWERS: Final = (f"'{_SHEET}'!B6", f"'{_SHEET}'!B7", "'Other''s'!A3")
_TEXT: Final = re.compile(rb"(<x:ScriptText>)(.*?)(?=</x:ScriptText>)", re.DOTALL)
_NAME: Final = re.compile(rb'(<definedName name="CB[^>]*>)([^<]*)')


@cache
def book_parts() -> tuple[tuple[str, bytes], ...]:
    """A book with everything that a block may hold."""
    mass = Drawn(_SHEET, "$B$2", "Mass", "Normal", {"Mean": 100.0, "StdDev": 15.0}, {"LoCut": 60.0})
    speed = Drawn(
        _SHEET,
        "$B$3",
        "=B9",
        "Normal",
        {"Mean": 20.0, "StdDev": 2.0},
        references={2: "$B$2", 3: "$D$1"},
        named_by="$A$3",
    )
    drag = Drawn(_SHEET, "$B$4", "Drag", "LogNormal", {"Mean": 0.7, "StdDev": 0.1, "Location": 0.0})
    share = Drawn(_OTHER, "$A$1", "Share", "Beta", {"Min": 0.1, "Max": 0.9, "Alpha": 2.0, "Beta": 5.0})
    count = Drawn(_OTHER, "$A$2", "Count", "Uniform", {"Min": 1.0, "Max": 9.0})
    keep = {"fFilterPrefs": {"fUseFilter": True, "fFilterMin": 90.0}}
    answers = [Asked(_SHEET, "$B$6", "Total", "ft", prefs=keep), Asked(_SHEET, "$B$7", "Other", named_by="$A$7")]
    tied = [Tied(_SHEET, "$D$2", mass, drag, 0.5), Decided(_SHEET, "$D$3", "Choice")]
    cells = {
        _SHEET: {"B2": 100, "B3": 20, "B4": 0.7, "A3": "Speed", "A7": "Out", "D1": 2, "D2": 0.5, "D3": 1}
        | {"B6": "=B2+B3*D3", "B7": "=B4*B3"},
        _OTHER: {"A1": 0.3, "A2": 4, "A3": "=A1*A2"},
    }
    with TemporaryDirectory() as folder:
        path = Path(folder) / "book.xlsx"
        blocks = [[mass, speed, drag, *tied], answers, [share, count, Asked(_OTHER, "$A$3", "Product")]]
        save(path, cells, blocks, comments=[(_SHEET, "A1", "a comment")])
        with zipfile.ZipFile(path) as package:
            return tuple((name, package.read(name)) for name in package.namelist())


def make(rng: random.Random) -> Input:
    """The book with one block, or the names that lead to the cells, changed in one to three ways."""
    parts = dict(book_parts())
    message = []
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        if rng.random() < 0.85:
            message.append(_change_block(rng, parts))
        else:
            message.append(_change_name(rng, parts))
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as package:
        for name, data in parts.items():
            package.writestr(name, data)
    return Input("fuzz.xlsx", stream.getvalue(), "; ".join(message), steps_of(rng, _STEPS))


def run(given: Input, folder: Path) -> Reached:
    """Read and run it: see `zips.run`; and see that no assumption became a constant without a word.

    Raises:
        XlmcError: as xlmc does.
        Disagreement: a cell that was drawn is a constant now, though its name still leads to it.
    """
    if "a name" not in given.said:
        refuse_silence(given)
    return zips.run(given, folder)


def refuse_silence(given: Input) -> None:
    """See that no cell that was drawn is a constant now, and no forecast gone, without a word.

    Raises:
        XlmcError: as xlmc does.
        Disagreement: one is.
    """
    definitions = read_definitions(read_workbook(given.data, given.name), ENGINES)
    if not definitions.problems:
        known = {str(each.cell) for each in definitions.assumptions} | {str(cell) for cell in definitions.rewritten}
        if silent := set(_CELLS) - known:
            raise Disagreement(f"drawn before, and a constant now: {', '.join(sorted(silent))}")
        answers = {str(each.cell) for each in definitions.forecasts}
        if not definitions.refused and (gone := set(_ANSWERS) - answers):
            raise Disagreement(f"a forecast before, and none now: {', '.join(sorted(gone))}")


def _change_block(rng: random.Random, parts: dict[str, bytes]) -> str:
    drawings = [name for name, data in parts.items() if name.endswith(".vml") and _TEXT.search(data)]
    name = rng.choice(drawings)
    result = list(_TEXT.finditer(parts[name]))
    match = max(result, key=lambda each: len(each[2])) if rng.random() < 0.7 else rng.choice(result)
    text = match[2].decode()
    messages, change = rng.choice(BLOCK_CHANGES)
    try:
        new = change(rng, text)
    except (ValueError, zlib.error, IndexError):
        return f"{messages}, of what was broken already"
    data = parts[name]
    parts[name] = data[: match.start(2)] + new.encode("utf-8", "replace") + data[match.end(2) :]
    return f"{name}: {messages}"


def _stream(text: str) -> bytearray:
    return bytearray(zlib.decompress(bytes.fromhex(text.encode("utf-16-be").decode("ascii"))))


def _packed(data: bytes) -> str:
    return zlib.compress(bytes(data), 1).hex().encode().decode("utf-16-be")


def _in_stream(change: Callable[[random.Random, bytearray], bytearray]) -> Callable[[random.Random, str], str]:
    return lambda rng, text: _packed(change(rng, _stream(text)))


def _flipped(rng: random.Random, data: bytearray) -> bytearray:
    for _ in range(rng.choice([1, 1, 2, 8])):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return data


def _number(rng: random.Random, data: bytearray) -> bytearray:
    at = rng.randrange(len(data) - 8)
    kind, value = rng.choice([("<i", rng.choice([-1, 0, 1, 2**31 - 1, -(2**31), 65536])), ("<d", rng.choice(_DOUBLES))])
    struct.pack_into(kind, data, at, value)
    return data


_DOUBLES: Final = (float("nan"), float("inf"), -1.0, 0.0, 1e308, 5e-324)


def _text_length(rng: random.Random, data: bytearray) -> bytearray:
    at = rng.choice([each.start() for each in re.finditer(rb"[\x01-\x40][A-Za-z_]{3}", data)])
    data[at] = rng.choice([0, 1, 127, 128, 255, data[at] + 1])
    return data


def _word(rng: random.Random, data: bytearray) -> bytearray:
    words = (
        b"Normal",
        b"Mean=",
        b"StdDev=",
        b"mVarName",
        b"mGuid",
        b"AssumptionCellRef",
        b"value__",
        b"_size",
        b"CBCR_",
    )
    present = [word for word in words if word in data]
    word = rng.choice(present)
    new = bytearray(word)
    new[rng.randrange(len(new))] = rng.choice(b"AxZ=,0#")
    return bytearray(data.replace(word, bytes(new), rng.choice([1, -1])))


def _cut(rng: random.Random, data: bytearray) -> bytearray:
    return data[: rng.randrange(len(data))]


def _again(rng: random.Random, data: bytearray) -> bytearray:
    at, length = rng.randrange(len(data)), rng.randint(1, 200)
    return data[:at] + data[at : at + length] + data[at:]


def _gone(rng: random.Random, data: bytearray) -> bytearray:
    at = rng.randrange(len(data))
    return data[:at] + data[at + rng.randint(1, 60) :]


def _character(rng: random.Random, text: str) -> str:
    at = rng.randrange(len(text))
    return text[:at] + rng.choice(["0", "㜸", "&#65;", "\u3067", "é", ""]) + text[at + 1 :]


BLOCK_CHANGES: Final[tuple[tuple[str, Callable[[random.Random, str], str]], ...]] = (
    ("bits of the objects", _in_stream(_flipped)),
    ("bits of the objects", _in_stream(_flipped)),
    ("a number of the objects", _in_stream(_number)),
    ("the length of a text", _in_stream(_text_length)),
    ("a word", _in_stream(_word)),
    ("the objects cut short", _in_stream(_cut)),
    ("objects twice", _in_stream(_again)),
    ("objects gone", _in_stream(_gone)),
    ("nothing but zeros", lambda rng, _: _packed(bytes(rng.choice([10, 1 << 25])))),
    ("a character", _character),
    ("the text cut short", lambda rng, text: text[: rng.randrange(len(text))]),
    ("no text", lambda _rng, _text: ""),
)


def _change_name(rng: random.Random, parts: dict[str, bytes]) -> str:
    data = parts["xl/workbook.xml"]
    match = rng.choice(list(_NAME.finditer(data)))
    new = rng.choice(
        [b"#REF!", b"#N/A", b"1+", b"Sheet9!$A$1", b"[1]Prices!$A$1", b"$A$1:$C$9", b"", b"'Model data'!$B$6"]
    )
    parts["xl/workbook.xml"] = data[: match.start(2)] + new + data[match.end(2) :]
    return f"a name: {new.decode()}"
