"""The rooms of xlmc, and what imports what: `python tests/session/rooms.py` prints rooms, floors, arrows, circles.

A room is a folder of `xlmc/`, or a module beside them; `__init__` and `__main__` are the doors and no rooms. Every
import counts: those inside of functions, and those for type checkers only.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "xlmc"

TABLE = (PACKAGE.parent / "ARCHITECTURE.md").read_text(encoding="utf-8").split("| room | what it does |")[1]
ROOMS = dict(re.findall(r"^\| `(\w+)` \| (.+) \|$", TABLE.partition("\n\n")[0], re.MULTILINE))
"""What each room does, as ARCHITECTURE.md has it, in the order in which a workbook flows: a room imports from those
above it in this table, never from those below."""

DOORS = ("__init__", "__main__")
MODULES = sorted(PACKAGE.rglob("*.py"))


def room_of(path: Path) -> str:
    """The room that a module lies in."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


_IMPORT = re.compile(
    r"^[ \t]*(import [\w.]+.*|from [\w.]+ import (?:\([^)]*\)|[^(\n#]+))[ \t]*(?:#.*)?$"
    r"|[;:][ \t]*(?:import [\w.]+|from [\w.]+ import \w+)\b",
    re.MULTILINE,
)
"""An import, which begins a line, as ruff sees to, also in the text of a program; one behind a `;` or a `:` is refused.
"""


@cache
def imported(path: Path) -> frozenset[str]:
    """Full names of all that a file imports, wherever in it: read from these lines alone, which is soon done."""
    names: set[str] = set()
    for statement in _IMPORT.findall(path.read_text(encoding="utf-8")):
        (node,) = ast.parse(statement).body
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.update({node.module, *(f"{node.module}.{alias.name}" for alias in node.names)})
    return frozenset(names)


@cache
def arrows() -> dict[tuple[str, str], set[str]]:
    """(room, the room that it imports from) -> the files that do."""
    found: dict[tuple[str, str], set[str]] = {}
    for path in MODULES:
        own = room_of(path)
        for other in {room for name in imported(path) if (room := _room_named(name))} - {own}:
            if own not in DOORS:
                found.setdefault((own, other), set()).add(str(path.relative_to(PACKAGE)))
    return found


def _room_named(name: str) -> str:
    """The room of a module's full name; `__init__` where a name of the package itself is imported."""
    first, _, rest = name.partition(".")
    room = rest.partition(".")[0]
    if first != "xlmc" or not room:  # `from xlmc import run` is told by the name that follows
        return ""
    return room if (PACKAGE / room).is_dir() or (PACKAGE / f"{room}.py").is_file() else "__init__"


def floors() -> dict[str, int]:
    """Room -> its floor: 1 where it imports from no other, else one above the highest that it imports from.

    Raises:
        ValueError: rooms import from each other in a circle.
    """
    below: dict[str, set[str]] = {room: set() for room in ROOMS}
    for own, other in arrows():
        below[own].add(other)
    found: dict[str, int] = {}
    while len(found) < len(below):
        ready = {
            room: 1 + max((found[to] for to in below[room]), default=0)
            for room in below.keys() - found.keys()
            if below[room] <= found.keys()
        }
        if not ready:
            raise ValueError(f"a circle of rooms: {', '.join(sorted(below.keys() - found.keys()))}")
        found |= ready
    return found


def upwards() -> Iterator[str]:
    """The imports that run up the table, a line each."""
    order = list(ROOMS)
    for (own, other), files in arrows().items():
        if other not in ROOMS or order.index(other) > order.index(own):
            yield from (f"{file} imports from {other}" for file in sorted(files))


LISTS = (
    "evaluation/engines.py",
    "report/sheets/book.py",
    "sampling/sampling_methods.py",
    "studies/methods/study.py",
)
"""Modules that list things of one kind; what they and the packages' doors import stands alone, however small it is."""

SMALL = 60
"""Lines: a module below that which one other imports is a piece of that other."""


def importers() -> dict[Path, set[Path]]:
    """Module -> the modules that import it or a name of it, anywhere in them; a package's own door counts, too."""
    paths = {_name_of(path): path for path in MODULES}
    found: dict[Path, set[Path]] = {path: set() for path in MODULES}
    for path in MODULES:
        for name in imported(path) & paths.keys():
            found[paths[name]].add(path)
    return found


def _name_of(path: Path) -> str:
    return ".".join(("xlmc", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")


def pieces() -> Iterator[str]:
    """Small modules that one other imports, a line each."""
    for path, others in importers().items():
        name = str(path.relative_to(PACKAGE))
        if len(others) == 1 and path.stem not in DOORS:
            (whole,) = others
            lines = len(path.read_text(encoding="utf-8").splitlines())
            of = str(whole.relative_to(PACKAGE))
            if lines < SMALL and whole.stem not in DOORS and of not in LISTS:
                yield f"{name} ({lines} lines) is a piece of {of}"


def circles() -> list[list[str]]:
    """Modules that import each other in a circle; what a package's door shows of its own modules is no circle."""
    below: dict[str, set[str]] = {}
    for path, others in importers().items():
        for other in others:
            if other.stem not in DOORS and path.stem not in DOORS:
                below.setdefault(str(other.relative_to(PACKAGE)), set()).add(str(path.relative_to(PACKAGE)))
    sorter = TopologicalSorter(below)
    try:
        sorter.prepare()
    except CycleError as error:
        return [list(error.args[1])]
    return []


def main() -> None:
    """Print them."""
    standing = floors()
    for room, words in ROOMS.items():
        print(f"{standing[room]:2}  {room:14}{words}")
    print(f"{len(ROOMS)} rooms on {max(standing.values())} floors, {len(arrows())} arrows, no circle")
    print("\n".join(upwards()) or "no arrow up")
    print("\n".join(" → ".join(circle) for circle in circles()) or "no circle of modules")
    print("\n".join(pieces()) or "no piece of a module")


if __name__ == "__main__":
    main()
