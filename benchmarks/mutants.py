"""Which share of small faults the tests find: random mutants of xlmc, each against the tests of its own folder.

    python benchmarks/mutants.py                     30 mutants of all of xlmc/, with a seed that it prints
    python benchmarks/mutants.py -n 300 --seed 7     300, the same ones as anybody's with this seed
    python benchmarks/mutants.py --under xlmc/excel  of one folder

A mutant differs from the code in one place: a comparison, an operator, `and` or `or`, a number, True or False, a `not`.
It is made in a copy of the repository. pytest runs the examples in the module and the test file of its own, if there
are any; then tests near by that import it, the own tests of modules near by that import it, the folder that mirrors its
own, and the files in the folder above, those that killed most so far first, until a test fails or the processor time is
up: that of pytest and its children, so that a busy machine decides nothing. In the end every test that killed a mutant
is run without one: where it fails even so, it killed nothing. Survivors are printed with file, line and what was
changed: some change nothing that anybody could see, and the others ask for a test. This takes a minute for a mutant at
most, so it is no part of `.ci/run`; Ctrl-C ends it with what is known by then.

No mutants are made of what cannot change a result: annotations and names of types, decorators (`slots=True`, the size
of a cache), bases and keywords of a class, functions without a body (`@overload`, protocols), what only type checkers
read, `zip(..., strict=True)`, which asserts that lengths agree, and the width of a column or a line.
"""

from __future__ import annotations

import argparse
import ast
import compileall
import json
import os
import py_compile
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil
from pathlib import Path
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
    match node:
        case ast.If(test=test) if "TYPE_CHECKING" in ast.unparse(test) or "__main__" in ast.unparse(test):
            return
        case ast.FunctionDef(body=[*_, ast.Expr(value=ast.Constant(value=value))]) if value is ...:
            return
        case ast.AnnAssign(annotation=annotation) if "TypeAlias" in ast.unparse(annotation):
            return
        case ast.keyword(arg="strict", value=ast.Constant(value=True)):
            return
        case ast.keyword(arg=str(name), value=ast.Constant()) if name.endswith("width"):
            return
        case ast.Call(func=ast.Attribute(attr="set_column")):
            return
    left_out = {"annotation", "returns", "decorator_list", "bases"}
    left_out |= {"keywords"} if isinstance(node, ast.ClassDef) else set()
    yield node
    for name, value in ast.iter_fields(node):
        if name in left_out:
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


def tests_of(path: Path, root: Path) -> list[list[str]]:
    """Return what pytest is given for a module of a repository at `root` in turn, no file twice.

    First its examples and own tests, then tests near by of what imports it, its folder, and the folder above.
    """
    own = own_tests(path)
    folder = own.parent
    while not any((root / folder).glob("test_*.py")) and folder != Path("tests"):
        folder = folder.parent
    examples = [path] if (root / path).exists() and ">>>" in (root / path).read_text(encoding="utf-8") else []
    stages = [[*examples, *([own] if (root / own).exists() else [])]]
    if folder != Path("tests"):
        wide = folder if folder.parent == Path("tests") else folder.parent
        module = re.compile(rf"^(from|import) {re.escape('.'.join(path.with_suffix('').parts))} ", re.MULTILINE)
        near = [each.relative_to(root) for each in sorted((root / wide).rglob("test_*.py"))]
        layer = (each.relative_to(root) for each in sorted((root / "xlmc" / wide.relative_to("tests")).rglob("*.py")))
        users = {own_tests(each) for each in layer if module.search((root / each).read_text(encoding="utf-8"))}
        importing = [each for each in near if module.search((root / each).read_text(encoding="utf-8"))]
        stages.append([*importing, *(each for each in near if each in users)])
        stages.append(sorted((each for each in near if folder in each.parents), key=lambda each: len(each.parts)))
        stages.append([each for each in near if each.parent == wide])
    once: dict[Path, int] = {}
    for stage, tests in enumerate(stages):
        for each in tests:
            once.setdefault(each, stage)
    new = ([str(each) for each, first in once.items() if first == stage] for stage in range(len(stages)))
    return [tests for tests in new if tests]


def own_tests(path: Path) -> Path:
    """Return where the tests of a module's own are, or would be."""
    return Path("tests", *path.parts[1:-1], f"test_{path.stem}.py")


def failures(tests: Sequence[str], copy: Path, seconds: float, *options: str) -> set[str] | None:
    """Return the tests that fail in a copy of the repository, or None where the processor time is up first."""
    before, cache = processor_time(), copy / ".cache_of_pytest"
    shutil.rmtree(cache, ignore_errors=True)
    limit = f"import resource as r, runpy; r.setrlimit(r.RLIMIT_CPU, ({ceil(seconds)},) * 2); "
    start = [sys.executable, "-c", limit + "runpy.run_module('pytest', run_name='__main__')"]
    command = [*start, "-q", "--no-header", "--tb=no", "-o", f"cache_dir={cache}", *options, *tests]
    environment = {**os.environ, "PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
    try:  # a process that sleeps for ever uses no processor time
        done = subprocess.run(
            command, cwd=copy, env=environment, timeout=30 * seconds, capture_output=True, check=False
        )
    except subprocess.TimeoutExpired:
        return None
    if done.returncode in (0, 5):  # all passed, or there are none
        return set()
    if processor_time() - before >= seconds:
        return None
    failed = cache / "v" / "cache" / "lastfailed"
    return set(json.loads(failed.read_text(encoding="utf-8"))) if failed.exists() else {*tests}


def keep_bytecode(copy: Path) -> None:
    """Compile a copy of the repository once; what is changed afterwards is seen by its hash, even within one second."""
    checked = py_compile.PycInvalidationMode.CHECKED_HASH
    compileall.compile_dir(copy / "xlmc", quiet=1, invalidation_mode=checked)
    written = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    collect = [sys.executable, "-m", "pytest", "-q", "--collect-only", "-p", "no:cacheprovider", "tests"]
    subprocess.run(collect, cwd=copy, env={**written, "PYTHONPATH": str(copy)}, capture_output=True, check=False)


def processor_time() -> float:
    """Return the seconds of processor time of all children so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def fate(mutant: Mutant, copy: Path, seconds: float, kills: Counter[str] | None = None) -> tuple[str, set[str]]:
    """Return `killed`, `survived`, `time up` or `no tests` of a mutant in a copy, and the tests that fail.

    Of tests that are equally near, the files with the most `kills` so far come first; those of this mutant are added.
    """
    kills = Counter() if kills is None else kills
    file, ends = copy / mutant.path, processor_time() + seconds
    tests = tests_of(mutant.path, copy)  # the repository itself may have changed meanwhile
    source = file.read_text(encoding="utf-8")
    file.write_text(mutant.text(source), encoding="utf-8")
    try:
        for each in tests:  # the file by itself first: to collect a large folder takes long
            often = sorted(each, key=lambda tests: -kills[tests])
            failed = failures(often, copy, max(1.0, ends - processor_time()), "-x")
            if failed is None:
                return "time up", set()
            if failed:
                kills.update(str(Path(test.partition("::")[0])) for test in failed)
                return "killed", failed
    finally:
        file.write_text(source, encoding="utf-8")
    return ("survived" if tests else "no tests"), set()


def main(given: Sequence[str] | None = None) -> None:
    """Make mutants, run their tests, and print the share that is killed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-n", type=int, default=30, help="how many mutants")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10**6), help="which ones")
    parser.add_argument("--under", default="xlmc", help="folder or file to mutate")
    parser.add_argument("--seconds", type=float, default=60.0, help="of processor time for the tests of each")
    asked = parser.parse_args(given)
    under = Path(asked.under)
    files = [under] if under.suffix else sorted(path.relative_to(ROOT) for path in (ROOT / under).rglob("*.py"))
    every = [each for path in files for each in mutants(path, (ROOT / path).read_text(encoding="utf-8"))]
    chosen = random.Random(asked.seed).sample(every, min(asked.n, len(every)))
    print(f"{len(chosen)} of {len(every):,} mutants of {under}, seed {asked.seed}", flush=True)
    ends: list[tuple[str, Mutant, set[str]]] = []
    kills: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "copy")
        left_out = shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache")
        shutil.copytree(ROOT, copy, ignore=left_out)
        keep_bytecode(copy)
        try:
            for number, mutant in enumerate(chosen, 1):
                end, failed = fate(mutant, copy, asked.seconds, kills)
                ends.append((end, mutant, failed))
                if end != "killed":
                    print(f"{number}: {end}: {mutant}", flush=True)
        except KeyboardInterrupt:
            print(f"ended after {len(ends)}", flush=True)
        killers = sorted(set().union(*(failed for _, _, failed in ends)))
        always = failures(killers, copy, 60.0 + 20.0 * len(killers)) if killers else set()
    counts: Counter[str] = Counter()
    for end, mutant, failed in ends:
        without = end == "killed" and failed <= (always or set())
        counts["fails without it" if without else end] += 1
        if without:
            print(f"fails without it: {mutant}: {', '.join(failed)}", flush=True)
    share = counts["killed"] / max(1, len(ends))
    error = (share * (1.0 - share) / max(1, len(ends))) ** 0.5
    rest = ", ".join(f"{count} {end}" for end, count in counts.items() if end != "killed") or "none left"
    print(f"killed: {counts['killed']} of {len(ends)}, {share:.1%} with a standard error of {error:.1%}; {rest}")


if __name__ == "__main__":
    main()
