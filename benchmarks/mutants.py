"""Which share of small faults the tests find: random mutants of xlmc, each against the tests of its own folder.

    python benchmarks/mutants.py                     30 mutants of all of xlmc/, with a seed that it prints
    python benchmarks/mutants.py -n 300 --seed 7     300, the same ones as anybody's with this seed
    python benchmarks/mutants.py --under xlmc/excel  of one folder

A mutant differs from the code in one place: a comparison, an operator, `and` or `or`, a number, True or False, a `not`.
It is made in a copy of the repository, and pytest runs the test file of its module, if there is one, and then the
folder that mirrors its own, until a test fails or the time is up. Those that survive are printed with file, line and
what was changed: some change nothing that anybody could see, and the others ask for a test. This takes a minute for a
mutant at most, so it is no part of `.ci/run`.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[1]

_OTHERS: Final[dict[type[ast.AST], str]] = {
    ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==", ast.Is: "is not",
    ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in", ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*",
    ast.FloorDiv: "*", ast.Mod: "*", ast.Pow: "*", ast.BitAnd: "|", ast.BitOr: "&", ast.And: "or", ast.Or: "and",
}  # fmt: skip
"""Operator -> what stands there in a mutant."""

_WRITTEN: Final[dict[type[ast.AST], str]] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=", ast.Is: "is",
    ast.IsNot: "is not", ast.In: "in", ast.NotIn: "not in", ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
    ast.FloorDiv: "//", ast.Mod: "%", ast.Pow: "**", ast.BitAnd: "&", ast.BitOr: "|", ast.And: "and", ast.Or: "or",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change of a file: `new` instead of `old`, which begins at an offset of the text."""

    path: Path
    line: int
    offset: int
    old: str
    new: str

    def text(self, source: str) -> str:
        """Return the file's text with the change."""
        assert source.startswith(self.old, self.offset)
        return source[: self.offset] + self.new + source[self.offset + len(self.old) :]

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.old} -> {self.new}"


def mutants(path: Path, source: str) -> Iterator[Mutant]:
    """Yield every mutant of a file; annotations, docstrings and what only type checkers read stay as they are."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    lines = source.splitlines()

    def offset(line: int, column: int) -> int:
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    for node in _code(ast.parse(source)):
        for left, right, operator in _operators(node):
            low, high = offset(left.end_lineno, left.end_col_offset), offset(right.lineno, right.col_offset)
            old = _WRITTEN.get(type(operator), "")
            at = source.find(old, low, high) if old else -1
            if at >= 0:
                yield Mutant(path, source.count("\n", 0, at) + 1, at, old, _OTHERS[type(operator)])
        if isinstance(node, ast.Constant) and (new := _other_constant(node.value)):
            old = ast.get_source_segment(source, node) or ""
            yield Mutant(path, node.lineno, offset(node.lineno, node.col_offset), old, new)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            yield Mutant(path, node.lineno, offset(node.lineno, node.col_offset), "not ", "")


def _code(node: ast.AST) -> Iterator[ast.AST]:
    """Walk what is run."""
    if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not isinstance(child, ast.JoinedStr | ast.MatchValue):
                yield from _code(child)


def _operators(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr, ast.AST]]:
    """Yield each operator with what stands on its left and on its right."""
    match node:
        case ast.Compare():
            yield from zip([node.left, *node.comparators], node.comparators, node.ops, strict=False)
        case ast.BoolOp():
            yield from ((left, right, node.op) for left, right in zip(node.values, node.values[1:], strict=False))
        case ast.BinOp():
            yield node.left, node.right, node.op


def _other_constant(value: object) -> str:
    if isinstance(value, bool):
        return str(not value)
    if isinstance(value, int):
        return str(value + 1)
    return repr(value * 1.5 if value else 1.0) if isinstance(value, float) else ""


def tests_of(path: Path) -> list[str]:
    """Return what pytest is given for a module: its own file of tests, if there is one, and the folder that mirrors."""
    parts = path.with_suffix("").parts[1:]
    folder = Path("tests", *parts[:-1])
    own = folder / f"test_{parts[-1]}.py"
    while not any((ROOT / folder).glob("test_*.py")) and folder != Path("tests"):
        folder = folder.parent
    found = [own] if (ROOT / own).exists() else []
    return [str(each) for each in (found if folder == Path("tests") else [*found, folder])]


def fate(mutant: Mutant, copy: Path, seconds: float) -> str:
    """Return `killed`, `survived`, `not ended` in time, or `no tests`, of a mutant in a copy of the repository."""
    tests, file = tests_of(mutant.path), copy / mutant.path
    if not tests:
        return "no tests"
    source, ends = file.read_text(encoding="utf-8"), monotonic() + seconds
    command = [sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "--tb=no", "-p", "no:cacheprovider"]
    environment = {**os.environ, "PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
    file.write_text(mutant.text(source), encoding="utf-8")
    try:
        for each in tests:  # the file by itself first: to collect a large folder takes long
            left = max(0.1, ends - monotonic())
            done = subprocess.run(
                [*command, each], cwd=copy, env=environment, timeout=left, capture_output=True, check=False
            )
            if done.returncode:
                return "killed"
    except subprocess.TimeoutExpired:
        return "not ended"
    finally:
        file.write_text(source, encoding="utf-8")
    return "survived"


def main(given: Sequence[str] | None = None) -> None:
    """Make mutants, run their tests, and print the share that is killed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-n", type=int, default=30, help="how many mutants")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10**6), help="which ones")
    parser.add_argument("--under", default="xlmc", help="folder or file to mutate")
    parser.add_argument("--seconds", type=float, default=60.0, help="for the tests of each")
    asked = parser.parse_args(given)
    under = Path(asked.under)
    files = [under] if under.suffix else sorted(path.relative_to(ROOT) for path in (ROOT / under).rglob("*.py"))
    every = [each for path in files for each in mutants(path, (ROOT / path).read_text(encoding="utf-8"))]
    chosen = random.Random(asked.seed).sample(every, min(asked.n, len(every)))
    print(f"{len(chosen)} of {len(every):,} mutants of {under}, seed {asked.seed}", flush=True)
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "copy")
        left_out = shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache")
        shutil.copytree(ROOT, copy, ignore=left_out)
        for mutant in chosen:
            counts[end := fate(mutant, copy, asked.seconds)] += 1
            if end != "killed":
                print(f"{end}: {mutant}", flush=True)
    share = counts["killed"] / max(1, len(chosen))
    rest = ", ".join(f"{count} {end}" for end, count in counts.items() if end != "killed") or "none left"
    print(f"killed: {counts['killed']} of {len(chosen)}, {share:.0%}; {rest}")


if __name__ == "__main__":
    main()
