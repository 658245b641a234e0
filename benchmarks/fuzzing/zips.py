"""Workbooks with broken zips and broken XML."""

from __future__ import annotations

import io
import random
import re
import struct
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final

from fuzzing import formulas
from fuzzing.books import shipped
from fuzzing.commands import commanded
from fuzzing.featured import featured
from fuzzing.inputs import Input, Reached, steps_of
from fuzzing.outputs import examined
from fuzzing.second_reader import agreed
from fuzzing.xml_changes import changed
from xlmc.engine.engines import ENGINES
from xlmc.errors import XlmcError
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.labels import calculate_labels
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model

__all__ = ["defined", "make", "run"]

TRIALS: Final = 64
_STEPS: Final = {"summary": 0.3, "write": 0.015, "verify": 0.06, "check": 0.1, "simulate": 0.015}
_NAME: Final = "fuzz.xlsx"


@cache
def _books() -> tuple[tuple[str, tuple[tuple[str, bytes], ...]], ...]:
    """Name and parts of the books that are broken: those shipped, and some with what these do not use."""
    made = [("featured", featured()), ("formulas", formulas.book_of("SUM(B1:D6)+Twice(A1)", "dynamic"))]
    result = []
    for name, data in [*shipped(), *made * 40]:
        with zipfile.ZipFile(io.BytesIO(data)) as package:
            result.append((name, tuple((entry, package.read(entry)) for entry in package.namelist())))
    return tuple(result)


def make(rng: random.Random) -> Input:
    """One of the books, changed in one to four ways."""
    name, kept = rng.choice(_books())
    parts, message = list(kept), [name]
    for _ in range(rng.choice([1, 1, 1, 2, 2, 3, 4])):
        if rng.random() < 0.85:
            message.append(_change_xml(rng, parts))
        else:
            messages, change = rng.choice(_PART_CHANGES)
            change(rng, parts)
            message.append(messages)
    data = _zip(rng, parts)
    if rng.random() < 0.15:
        messages, broken = rng.choice(_BYTE_CHANGES)
        data = broken(rng, data)
        message.append(messages)
    return Input(_NAME, data, "; ".join(message), steps_of(rng, _STEPS))


def run(given: Input, folder: Path) -> Reached:
    """Read the book, all of its sheets, see that an independent reader reads the same, and run it.

    Steps: `summary` makes the table for people; `write` writes its results and examines them; `verify` recomputes its
    formulas; `check` and `simulate` give it to the command line, and to nothing else.

    Raises:
        Disagreement: two readers see two values.
        XlmcError: as xlmc does.
    """
    path = folder / given.name
    path.write_bytes(given.data)
    if {"check", "simulate"} & {*given.steps}:
        return commanded(path, given.steps)
    workbook = read_workbook(path)
    problems: list[XlmcError] = []
    for name in workbook.sheets:
        try:
            _ = workbook.sheets[name]
        except XlmcError as error:
            problems.append(error)
    if problems:
        raise problems[0]
    if path.suffix != ".xls":  # of which LibreOffice makes the cells
        agreed(workbook, given.data)
    calculated, definitions = defined(workbook, given.steps)
    result = run_model(CompiledModel(calculated, definitions, path), RunOptions.of(trials=TRIALS))
    examined(result, folder, given.steps)
    return Reached.RAN


def defined(workbook: Workbook, steps: tuple[str, ...]) -> tuple[Workbook, Definitions]:
    """Give the workbook with the labels that formulas make, and what its tables define; `verify` is a step.

    Raises:
        XlmcError: as xlmc does; of several faults in the tables the first.
    """
    calculated = calculate_labels(workbook)
    definitions = read_definitions(calculated, ENGINES)
    if "verify" in steps:
        from xlmc.analysis.studies.verify import verify

        verify(workbook, definitions)
    if definitions.problems:
        raise definitions.problems[0]
    return calculated, definitions


def _change_xml(rng: random.Random, parts: list[tuple[str, bytes]]) -> str:
    """One part's XML; those that xlmc reads first of all."""
    read = [
        n for n, (name, _) in enumerate(parts) if re.search(r"sheet\d|workbook|table|shared|metadata|rels|Types", name)
    ]
    at = rng.choice(read or range(len(parts))) if rng.random() < 0.9 else rng.randrange(len(parts))
    name, xml = parts[at]
    made, message = changed(rng, xml)
    parts[at] = name, made
    return f"{name}: {message}"


def _twice(rng: random.Random, parts: list[tuple[str, bytes]]) -> None:
    name, content = rng.choice(parts)
    parts.append((rng.choice([name, name.upper(), name + "/", "./" + name, "/" + name]), content))


def _gone(rng: random.Random, parts: list[tuple[str, bytes]]) -> None:
    if len(parts) > 1:
        del parts[rng.randrange(len(parts))]


def _renamed(rng: random.Random, parts: list[tuple[str, bytes]]) -> None:
    at = rng.randrange(len(parts))
    new = rng.choice(
        [
            "x",
            "../" + parts[at][0],
            parts[at][0].upper(),
            parts[at][0].replace("/", "\\"),
            "xl/é.xml",
            "",
            "a\x01b",
            "\u202e",
        ]
    )
    parts[at] = new, parts[at][1]


def _exchanged(rng: random.Random, parts: list[tuple[str, bytes]]) -> None:
    a, b = rng.randrange(len(parts)), rng.randrange(len(parts))
    parts[a], parts[b] = (parts[a][0], parts[b][1]), (parts[b][0], parts[a][1])


def _replaced(rng: random.Random, parts: list[tuple[str, bytes]]) -> None:
    at = rng.randrange(len(parts))
    new = rng.choice(
        [
            b"",
            b"\0" * 1000,
            b"<a/>",
            b"\xff\xfe<\0a\0/\0>\0",
            b"\xef\xbb\xbf" + parts[at][1],
            b"PK\3\4",
            rng.randbytes(300),
        ]
    )
    parts[at] = parts[at][0], new


def _borrowed(rng: random.Random, parts: list[tuple[str, bytes]]) -> None:
    """A part of another book in the place of the own one."""
    other = dict(rng.choice(_books())[1])
    at = rng.randrange(len(parts))
    parts[at] = parts[at][0], other.get(parts[at][0], rng.choice(list(other.values())))


_Change = Callable[[random.Random, list[tuple[str, bytes]]], None]
_PART_CHANGES: Final[tuple[tuple[str, _Change], ...]] = (
    ("a part twice", _twice),
    ("a part gone", _gone),
    ("a part renamed", _renamed),
    ("two parts exchanged", _exchanged),
    ("a part replaced", _replaced),
    ("a part of another book", _borrowed),
)


def _zip(rng: random.Random, parts: list[tuple[str, bytes]]) -> bytes:
    """The package, in some cases compressed; names twice are written as they are."""
    import warnings

    file = io.BytesIO()
    method = rng.choice([zipfile.ZIP_STORED] * 3 + [zipfile.ZIP_DEFLATED])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a name is written twice
        with zipfile.ZipFile(file, "w", method, compresslevel=1) as package:
            for name, content in parts:
                package.writestr(zipfile.ZipInfo(name or "x", (1980, 1, 1, 0, 0, 0)), content, method)
    return file.getvalue()


def _flipped(rng: random.Random, data: bytes) -> bytes:
    """Some bits, most of them in the directory at the end."""
    broken = bytearray(data)
    directory = data.find(b"PK\1\2")
    for _ in range(rng.randint(1, 6)):
        start = directory if rng.random() < 0.6 and directory > 0 else 0
        broken[rng.randrange(start, len(broken))] ^= 1 << rng.randrange(8)
    return bytes(broken)


def _truncated(rng: random.Random, data: bytes) -> bytes:
    return data[: rng.randrange(len(data))]


def _sizes(rng: random.Random, data: bytes) -> bytes:
    """Sizes, offsets or counts of the directory that lie."""
    broken = bytearray(data)
    entries = [result.start() for result in re.finditer(b"PK\1\2", data)] or [0]
    at = rng.choice(entries) + rng.choice([8, 10, 16, 20, 24, 28, 30, 32, 42])
    lie = rng.choice([0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0xFFFF, 100_000_000])
    if at + 4 <= len(broken):
        struct.pack_into("<I", broken, at, lie)
    return bytes(broken)


def _ending(rng: random.Random, data: bytes) -> bytes:
    """The record at the end of the directory."""
    broken = bytearray(data)
    at = data.rfind(b"PK\5\6") + rng.choice([4, 8, 10, 12, 16, 20])
    if 0 <= at <= len(broken) - 2:
        struct.pack_into("<H", broken, at, rng.choice([0, 1, 0xFFFF, 0x7FFF, 500]))
    return bytes(broken)


def _around(rng: random.Random, data: bytes) -> bytes:
    return (
        rng.choice([b"", b"MZ", b"PK\3\4", rng.randbytes(20)])
        + data
        + rng.choice([b"", b"\0" * 100, rng.randbytes(50)])
    )


def _bomb(rng: random.Random, data: bytes) -> bytes:
    """A part that unpacks to a hundred megabytes of blanks."""
    file = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(data)) as old,
        zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as new,
    ):
        victim = rng.choice(old.namelist())
        for name in old.namelist():
            new.writestr(name, b" " * rng.choice([20 << 20, 100 << 20]) if name == victim else old.read(name))
    return file.getvalue()


_BYTE_CHANGES: Final[tuple[tuple[str, Callable[[random.Random, bytes], bytes]], ...]] = (
    ("bits flipped", _flipped),
    ("bits flipped", _flipped),
    ("cut off", _truncated),
    ("sizes that lie", _sizes),
    ("sizes that lie", _sizes),
    ("the directory's end", _ending),
    ("bytes around it", _around),
)
