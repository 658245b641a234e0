"""Every text file is read and written as UTF-8: what platforms take for granted differs, Windows has code pages."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("xlmc", "tests", "benchmarks", "docs", "examples")
BESIDE = ROOT / "xlmc" / "excel" / "functions"
"""Nothing in there may touch a file; what is called `write_text` there writes a cell's text."""

SOURCES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py") if BESIDE not in path.parents)
_ENCODING_AT = {"read_text": 0, "write_text": 1}
"""Where a method of paths takes the encoding as an argument without a name."""

OPENS = re.compile(r"(?:open|read_text|write_text)\s*\((?![^()]*encoding=)")
"""A source without these words, or with the encoding behind each, has no call to be found; others are parsed."""


def silent_calls(tree: ast.Module) -> Iterator[ast.Call]:
    """The calls that open a text file and do not say its encoding."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and not any(each.arg in ("encoding", None) for each in node.keywords):
            at = _ENCODING_AT.get(_method(node))
            if (at is not None and len(node.args) <= at) or _opens_text(node):
                yield node


def _method(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else ""


def _opens_text(call: ast.Call) -> bool:
    """Whether it is `open(…)`, `path.open("w")` or `os.fdopen(…)` in a mode for text."""
    plain = isinstance(call.func, ast.Name) and call.func.id == "open"
    method = _method(call)
    if not plain and method not in ("fdopen", "open"):
        return False
    given = [each.value for each in call.keywords if each.arg == "mode"]
    place = 1 if plain or method == "fdopen" else 0
    mode = given[0] if given else call.args[place] if len(call.args) > place else None
    if method == "open" and not (isinstance(mode, ast.Constant) and set(str(mode.value)) <= set("rwaxt+")):
        return False  # an archive's, or a file that is no path's
    return not (isinstance(mode, ast.Constant) and "b" in str(mode.value))


def test_text_files_are_opened_as_utf_8():
    assert len(SOURCES) > 800
    result = []
    for path in SOURCES:
        text = path.read_text(encoding="utf-8")
        if OPENS.search(text):
            calls = silent_calls(ast.parse(text))
            result += [f"{path.relative_to(ROOT)}:{call.lineno}: {ast.unparse(call)}" for call in calls]
    assert result == []


@pytest.mark.parametrize(
    ("code", "silent"),
    [
        ("path.read_text()", True),
        ("path.write_text('x')", True),
        ("open(path)", True),
        ("open(path, 'w')", True),
        ("path.open('w')", True),
        ("os.fdopen(3, 'w')", True),
        ("open(path, 'rb')", False),
        ("open(path, mode='wb')", False),
        ("path.open('rb')", False),
        ("archive.open('sheet.xml')", False),
        ("path.read_text('utf-8')", False),
        ("path.write_text('x', encoding='utf-8')", False),
        ("open(path, **how)", False),
    ],
)
def test_which_calls_are_found(code, silent):
    assert OPENS.search(code) or not silent
    assert bool(list(silent_calls(ast.parse(code)))) == silent
