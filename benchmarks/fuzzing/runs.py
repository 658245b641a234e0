"""Saved runs and result workbooks that were damaged, or edited with digests made to fit: opened, reported, replayed."""

from __future__ import annotations

import hashlib
import io
import json
import random
import tempfile
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from fuzzing import formulas
from fuzzing.books import shipped
from fuzzing.featured import featured
from fuzzing.inputs import Input, Reached, steps_of
from fuzzing.json_changes import edited
from fuzzing.outputs import examined
from fuzzing.xml_changes import changed
from xlmc.analysis.results.saved import open_run
from xlmc.api import Simulation
from xlmc.errors import XlmcError
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs.replay import replay

__all__ = ["make", "run"]

TRIALS: Final = 40
_STEPS: Final = {"summary": 0.5, "report": 0.015, "replay": 0.1}
_BOOKS: Final = ("intersection.xlsx", "yaw-mark.xlsx")


@cache
def _saved() -> tuple[tuple[str, bytes, bytes], ...]:
    """Runs of some books: name, the saved run, the result workbook; of a featured one by other methods too."""
    books = [(name, data, {}) for name, data in shipped() if name in _BOOKS]
    more: tuple[dict[str, Any], ...] = ({}, {"sampling": "lhs"}, {"until_accepted": 40}, {"precision": "50%"})
    books += [("featured.xlsx", featured(), options) for options in more]
    books += [("formulas.xlsx", formulas.book_of("SUM(B5:B6)*A1"), {"sampling": "sobol"})]
    with tempfile.TemporaryDirectory() as folder:
        return tuple(_run_of(Path(folder), name, data, options) for name, data, options in books)


def _run_of(folder: Path, name: str, data: bytes, options: dict[str, Any]) -> tuple[str, bytes, bytes]:
    (folder / name).write_bytes(data)
    trials = {"until_accepted": None, "precision": None}.keys() & options.keys()
    most = 5_000 if trials or name == _BOOKS[0] else TRIALS
    result = Simulation(run_model(load(folder / name), RunOptions.of(trials=most, **options)))
    run, book = folder / "made.xlmcrun", folder / f"{Path(name).stem}-results.xlsx"
    for path in (run, book):
        path.unlink(missing_ok=True)
    result.keep(run)
    result.save(book)
    return name, run.read_bytes(), book.read_bytes()


def make(rng: random.Random) -> Input:
    """A saved run with edits in its `run.json`, columns, workbook or bytes; or a result book with edits."""
    saved = _saved()
    name, kept, book = rng.choices(saved, [1 if each[0] in _BOOKS else 8 for each in saved])[0]
    if rng.random() < 0.12:
        data, message = _edited_book(rng, book)
        return Input("fuzz-results.xlsx", data, f"results of {name}: {message}")
    message, data = [name], kept
    if rng.random() < 0.85:
        entries = _entries(kept)
        for _ in range(rng.choice([1, 1, 1, 2, 3])):
            messages, edit = rng.choices(_EDITS, _WEIGHTS)[0]
            message.append(f"{messages} {edit(rng, entries) or ''}")
        data = _stored(entries)
    else:
        data = _bytes(rng, kept)
        message.append("bytes changed")
    return Input("fuzz.xlmcrun", data, "; ".join(message), steps_of(rng, _STEPS))


def run(given: Input, folder: Path) -> Reached:
    """Open the run and summarise it; replay a result book.

    Steps: `summary` makes the table for people, `report` writes everything again, `replay` repeats the run.

    Raises:
        XlmcError: as xlmc does.
    """
    path = folder / given.name
    path.write_bytes(given.data)
    if path.suffix == ".xlsx":
        result = replay(path)
        if result.fault is not None and not isinstance(result.fault, XlmcError):
            raise result.fault
        return Reached.RAN
    opened = open_run(path)
    examined(opened, folder, given.steps)
    if "report" in given.steps:
        written = Simulation(opened)
        written.save_json(folder / "out.json")
        written.save_page(folder / "out.html")
        (folder / "out-results.xlsx").unlink(missing_ok=True)
        written.save(folder / "out-results.xlsx")
    if "replay" in given.steps:
        replay(path)
    return Reached.RAN


Entries = list[tuple[str, bytes]]


def _entries(data: bytes) -> Entries:
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        return [(name, package.read(name)) for name in package.namelist()]


def _stored(entries: Entries) -> bytes:
    """The package, with the digests that its `run.json` should have."""
    import warnings

    file = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a name is written twice
        with zipfile.ZipFile(file, "w") as package:
            for name, content in entries:
                package.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content)
    return file.getvalue()


def _document(entries: Entries) -> tuple[int, Any]:
    at = next((n for n, (name, _) in enumerate(entries) if name == "run.json"), -1)
    try:
        return at, json.loads(entries[at][1]) if at >= 0 else {}
    except (ValueError, RecursionError):
        return -1, {}


def _put(entries: Entries, at: int, document: object) -> None:
    if at >= 0:
        entries[at] = "run.json", json.dumps(document).encode("utf-8", "surrogatepass")


def _edit_document(rng: random.Random, entries: Entries) -> str:
    """One value of `run.json`, any deep, becomes another."""
    at, document = _document(entries)
    message = edited(rng, document)
    if message:
        _put(entries, at, document)
    return message


def _edit_column(rng: random.Random, entries: Entries) -> str:
    """Numbers of a column, or its header; the digest is made to fit where that is possible."""
    columns = [n for n, (name, _) in enumerate(entries) if name.startswith("columns/")]
    if not columns:
        return ""
    at = rng.choice(columns)
    name, content = entries[at]
    made, message = rng.choice(_COLUMN_EDITS)(rng, content)
    entries[at] = name, made
    where, document = _document(entries)
    listed = document.get("columns") if isinstance(document, dict) else None
    for column in listed if isinstance(listed, list) else ():
        if isinstance(column, dict) and column.get("entry") == name and rng.random() < 0.9:
            column["sha256"] = hashlib.sha256(made).hexdigest()
            body = _body(made)
            if body is not None and rng.random() < 0.9:
                column["count"] = int(body.size)
    _put(entries, where, document)
    return f"{name}: {message}"


def _body(content: bytes) -> Any:
    try:
        return np.load(io.BytesIO(content), allow_pickle=False)
    except Exception:  # a broken header makes NumPy raise whatever its parser does
        return None


def _saved_as_npy(array: Any) -> bytes:
    file = io.BytesIO()
    np.save(file, array, allow_pickle=False)
    return file.getvalue()


def _numbers(rng: random.Random, content: bytes) -> tuple[bytes, str]:
    array = _body(content)
    if array is None or not array.size or array.dtype.kind not in "fiub":  # another edit may have changed its kind
        return content, "nothing"
    array = array.copy()
    for _ in range(rng.randint(1, 5)):
        new = rng.choice([0.0, -1.0, np.nan, np.inf, 1e308, 5e-324, 1e18, 7.0])
        if array.dtype.kind == "i":
            new = rng.choice([0, -1, 2**62, 10**6, 5])
        with np.errstate(all="ignore"):
            array.flat[rng.randrange(array.size)] = np.asarray(new).astype(array.dtype)
    return _saved_as_npy(array), "other numbers"


def _length(rng: random.Random, content: bytes) -> tuple[bytes, str]:
    array = _body(content)
    if array is None:
        return content, "nothing"
    array = array.ravel()
    made = rng.choice(
        [array[:0], array[:1], array[:-1], np.concatenate([array, array]), array[::-1], array.reshape(1, -1)]
    )
    return _saved_as_npy(made), "another length"


def _kind(rng: random.Random, content: bytes) -> tuple[bytes, str]:
    array = _body(content)
    if array is None or array.dtype.kind not in "fiub":
        return content, "nothing"
    kind = rng.choice(["<f4", ">f8", "<i4", "<i8", "<c16", "?", "U3", "u1"])
    with np.errstate(all="ignore"):
        return _saved_as_npy(
            np.nan_to_num(array).astype(kind) if array.dtype.kind == "f" else array.astype(kind)
        ), "another type"


def _header(rng: random.Random, content: bytes) -> tuple[bytes, str]:
    head = bytearray(content[:128])
    for _ in range(rng.randint(1, 4)):
        if head:
            head[rng.randrange(len(head))] = rng.randrange(256)
    return bytes(head) + content[128:], "another header"


_COLUMN_EDITS: Final[tuple[Callable[[random.Random, bytes], tuple[bytes, str]], ...]] = (
    _numbers,
    _numbers,
    _length,
    _kind,
    _header,
)


def _edit_workbook(rng: random.Random, entries: Entries) -> str:
    """Another workbook, or the same with a change; its digest is made to fit."""
    at = next((n for n, (name, _) in enumerate(entries) if name == "workbook"), -1)
    if at < 0:
        return ""
    if rng.random() < 0.3:
        data = rng.choice([rng.choice(_saved())[2], rng.choice(shipped())[1], b"", b"PK", formulas.book_of("RAND()")])
        message = "another"
    else:
        data, message = _edited_book(rng, entries[at][1])
    entries[at] = "workbook", data
    where, document = _document(entries)
    if isinstance(document, dict) and isinstance(document.get("workbook"), dict):
        document["workbook"]["sha256"] = hashlib.sha256(data).hexdigest()
    _put(entries, where, document)
    return message


def _edit_entries(rng: random.Random, entries: Entries) -> str:
    at = rng.randrange(len(entries))
    kind = rng.randrange(4)
    if kind == 0 and len(entries) > 1:
        return f"without {entries.pop(at)[0]}"
    if kind == 1:
        entries.append(entries[at])
        return "one twice"
    if kind == 2:
        entries[at] = rng.choice(["x", "../x", "columns/999999.npy", "run.json", "workbook"]), entries[at][1]
        return "one renamed"
    entries[at] = entries[at][0], rng.choice([b"", b"{}", b"[]", b"null", b"[" * 100_000, rng.randbytes(100)])
    return f"{entries[at][0]} replaced"


def _edited_book(rng: random.Random, data: bytes) -> tuple[bytes, str]:
    try:
        entries = _entries(data)
    except (zipfile.BadZipFile, ValueError, OSError):
        return data, "none"
    texts = [n for n, (name, _) in enumerate(entries) if "sheet" in name or rng.random() < 0.15]
    message = []
    for _ in range(rng.randint(1, 3)):
        at = rng.choice(texts or [0])
        made, how = changed(rng, entries[at][1])
        entries[at] = entries[at][0], made
        message.append(f"{entries[at][0]}: {how}")
    return _stored(entries), "; ".join(message)


def _bytes(rng: random.Random, data: bytes) -> bytes:
    if rng.random() < 0.3:
        return data[: rng.randrange(len(data))]
    broken = bytearray(data)
    directory = data.rfind(b"PK\1\2", 0, max(1, len(data) - 200))
    for _ in range(rng.randint(1, 6)):
        start = max(0, directory) if rng.random() < 0.5 else 0
        broken[rng.randrange(start, len(broken))] = rng.randrange(256)
    return bytes(broken)


_EDITS: Final[tuple[tuple[str, Callable[[random.Random, Entries], str]], ...]] = (
    ("run.json", _edit_document),
    ("column", _edit_column),
    ("workbook", _edit_workbook),
    ("entries", _edit_entries),
)
_WEIGHTS: Final = (6, 2, 1.5, 1)
