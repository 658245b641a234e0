"""What the contracts of import-linter in `pyproject.toml` cannot say."""

from __future__ import annotations

import ast
import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1] / "xlmc"
LAYERS = {"excel", "engine", "montecarlo", "analysis", "outputs", "cli", "api", "errors.py"}


def test_the_package_has_five_layers_and_what_stands_beside_them():
    names = {path.name for path in PACKAGE.iterdir() if not path.name.startswith("__")}
    assert names == LAYERS | {"py.typed"}


def test_no_text_is_run_as_code_and_only_the_command_line_prints():
    forbidden = ("eval", "exec", "compile", "__import__", "print")
    called_perhaps = re.compile(rf"(?<![\w.])(?:{'|'.join(forbidden)})\b(?!=)")  # spares parsing what calls none
    texts = {path: path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")}
    called = [
        f"{path.relative_to(PACKAGE)}:{node.lineno}: {node.func.id}"
        for path, text in texts.items()
        if called_perhaps.search(text)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in forbidden
    ]
    assert called == []
