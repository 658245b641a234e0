from __future__ import annotations

from pathlib import Path

import parts_of_a_command
import pytest
from parts_of_a_command import PACKAGE, PARTS, part_of, table

IMPORTLIB = ("<frozen importlib._bootstrap>", "_find_and_load")
LIBRARY = "/lib/python3.11/site-packages"


def _own(place, name):
    return (PACKAGE + place, name)


@pytest.mark.parametrize(
    ("stack", "part"),
    [
        ([("/usr/bin/x.py", "<module>")], "the rest"),
        ([_own("cli/simulate.py", "simulate")], "other work of xlmc"),
        ([_own("cli/simulate.py", "simulate"), _own("montecarlo/model/loading.py", "load")], "loading the workbook"),
        (
            [
                _own("outputs/sheets/book.py", "build_sheets"),
                _own("outputs/filter_effect.py", "marginal"),
                ("np.py", "f"),
            ],
            "draws before and after filters",
        ),
        ([_own("outputs/document/build.py", "anything")], "record, tables and other statistics"),
        ([_own("a.py", "f"), IMPORTLIB], "imports: modules of xlmc and of Python"),
        ([_own("a.py", "<module>"), ("re.py", "compile")], "imports: modules of xlmc and of Python"),
        ([_own("a.py", "<module>"), ("dataclasses.py", "wrap")], "imports: making dataclasses"),
        (
            [_own("a.py", "f"), IMPORTLIB, (f"{LIBRARY}/scipy/a.py", "<module>"), (f"{LIBRARY}/numpy/b.py", "g")],
            "imports: scipy",
        ),
        ([_own("a.py", "f"), (f"{LIBRARY}/numpy/b.py", "g")], "other work of xlmc"),
    ],
)
def test_a_moment_belongs_to_a_part(stack, part):
    assert part_of(stack) == part


def test_every_function_of_a_part_is_there():
    named = [each.split() for functions in PARTS.values() for each in functions if each != "*"]
    for file, name in named:
        text = Path(PACKAGE, file).read_text(encoding="utf-8")
        assert name == "*" or f"def {name}(" in text, (file, name)


def test_shares_add_up():
    rows = table({"a": 1, "b": 3}, 2.0).splitlines()
    assert rows[2:] == ["| b | 1.500 | 75.0% |", "| a | 0.500 | 25.0% |", "| all | 2.000 |  |"]


def test_a_command_is_watched(tmp_path, monkeypatch, capsys):
    command = "import json, sys; open(sys.argv[2], 'w').write(json.dumps({'seen': {'a': 2}, 'seconds': 0.5}))"
    script = tmp_path / "script.py"
    script.write_text(command, encoding="utf-8")
    monkeypatch.setattr(parts_of_a_command, "HERE", script)
    parts_of_a_command.main(["--runs", "2", "check", "book.xlsx"])
    assert "| a | 0.500 | 100.0% |" in capsys.readouterr().out
