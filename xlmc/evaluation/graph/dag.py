"""The computation as a directed graph of nodes, each made once: common subexpressions are shared, constants folded."""

from __future__ import annotations

import hashlib
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple, assert_never

import numpy as np

from xlmc.address import Cell, host_of
from xlmc.errors import ErrorCode, FormulaError
from xlmc.evaluation.graph.alignment import aligned, arguments_of, single
from xlmc.evaluation.graph.ragged import Ragged, by_trial
from xlmc.functions import Function, Kind
from xlmc.functions.budget import MOST_KEPT, TooLargeError, ask_for_cells
from xlmc.functions.logical import if_, if_error, if_na
from xlmc.functions.values import BLANK, ERROR, LOGICAL, NUMBER, TEXT, ShapeVaries, Value, constant

__all__ = [
    "MANY",
    "Apply",
    "Constant",
    "Dag",
    "Input",
    "Node",
    "Range",
    "Repeat",
    "Rescue",
    "Select",
    "constants",
    "evaluated",
    "uses",
]


@dataclass(frozen=True, slots=True, eq=False)
class Constant:
    """A value known before the run, `(1,)` or `(1, r, c)`."""

    value: Value


@dataclass(frozen=True, slots=True)
class Input:
    """An assumption's draws, `(n,)`."""

    name: str


class Apply(NamedTuple):
    """A function of the registry. A tuple, because nearly every node is one, and looked up in a dict."""

    function: Function
    arguments: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Select:
    """`IF`: a node of its own because only one branch is needed in each trial."""

    condition: int
    yes: int
    no: int


@dataclass(frozen=True, slots=True)
class Rescue:
    """`IFERROR`, `IFNA`: `instead` is needed only where `value` is an error."""

    value: int
    instead: int
    only_na: bool


@dataclass(frozen=True, slots=True)
class Range:
    """Cells side by side, `(n, r, c)`."""

    rows: tuple[tuple[int, ...], ...]


Node = Constant | Input | Apply | Select | Rescue | Range


Size = tuple[int, ...] | None
"""Rows and columns of a value that is many cells; None for a single one."""

MANY: Final = (-1, -1)
"""The size of a value that may be many cells, how many being known only during the run."""


class Repeat(NamedTuple):
    """A node to be made as it was made before: of `function`, or by `make` where that is None.

    Attributes:
        slots: which of the places known by then it uses.
        kind, size: what it gives.
    """

    make: Callable[[tuple[int, ...]], Node]
    function: Function | None
    slots: tuple[int, ...]
    kind: Kind
    size: Size


class Dag:
    """Nodes in an order in which each comes after those it uses; a node is known by its place.

    Attributes:
        nodes: by place.
        types: what each gives where it is no error; ANY where that is not known before the run, or is many cells.
        sizes: of each.
        origins: of constants that were computed here: the node that each came from.
        made: where it is a list, the nodes asked for are noted in it, whether they were new or not.
        hosts, ends: the formula cells in the order in which they were lowered, and how many nodes there were then.
    """

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.types: list[Kind] = []
        self.sizes: list[Size] = []
        self.origins: dict[int, Apply | Select | Rescue | Range] = {}
        self.made: list[int] | None = None
        self._known: dict[object, int] = {}
        self._kept = 0
        self.hosts: list[Cell] = []
        self.ends: list[int] = []

    def __reduce__(self) -> tuple[Any, ...]:
        """To another process go the nodes and their cells alone: it evaluates them and adds none."""
        return _of_nodes, (self.nodes, self.types, self.sizes, self.hosts, self.ends)

    def host_ends(self, cell: Cell) -> None:
        """Note that all nodes made since the last such note were made for the formula of this cell."""
        self.hosts.append(host_of(cell))
        self.ends.append(len(self.nodes))

    def told(self, error: TooLargeError) -> FormulaError:
        """The error, told of the cell whose formula first asked for the node."""
        return error if error.node is None else self.told_of(error, error.node)

    def told_of(self, error: FormulaError, node: int) -> FormulaError:
        """An error without a place, told of the cell whose formula first asked for the node."""
        at = bisect_right(self.ends, node)
        return error if at == len(self.ends) or error.where is not None else error.at(self.hosts[at])

    def constant(self, value: Value) -> int:
        """The node of a known value.

        Raises:
            TooLargeError: the constants of the workbook take too much memory.
        """
        if value.numbers.size > 1:
            self._keep(value)
        return self._place(_constant_key(value), Constant(value), _constant_type(value), value.shape[1:] or None)

    def _keep(self, value: Value) -> None:
        """Count the memory of an array's numbers, and of its copy in the key."""
        self._kept += value.nbytes
        if self._kept > MOST_KEPT:
            raise TooLargeError(
                f"the arrays of constants of the workbook take more than {MOST_KEPT >> 20} MB up to here",
                hint="make the arrays smaller, or fewer",
            )

    def input(self, name: str) -> int:
        """The node of an assumption."""
        node = Input(name)
        return self._place(node, node, Kind.NUMBER, None)

    def add(self, node: Apply | Select | Rescue | Range) -> int:
        """The node's place; a node whose parts are all constant becomes a constant at once.

        Raises:
            ValueError: parts of many cells have sizes that do not go together.
        """
        place = self._add(node)
        if self.made is not None and not isinstance(self.nodes[place], Constant):
            self.made.append(place)
        return place

    def again(self, steps: Sequence[Repeat], local: list[int]) -> None:
        """Nodes like some added before, one after another; their places are appended to `local`.

        Args:
            steps: what to make.
            local: the places that the slots of the steps count.
        """
        known, nodes, types, sizes = self._known, self.nodes, self.types, self.sizes
        for make, function, slots, kind, size in steps:
            used = tuple([local[slot] for slot in slots])
            node = make(used) if function is None else tuple.__new__(Apply, (function, used))
            place = known.get(node)
            if place is None:
                known[node] = place = len(nodes)
                nodes.append(node)
                types.append(kind)
                sizes.append(size)
            local.append(place)

    def _add(self, node: Apply | Select | Rescue | Range) -> int:
        if node in self._known:
            return self._known[node]
        if isinstance(node, Apply) and self._is_plain(node):
            return self._place(node, node, node.function.returns, None)
        settled = self._settled(node)
        if settled is not None:
            return settled
        size = self._size(node)
        known = {p: part.value for p in uses(node) if isinstance(part := self.nodes[p], Constant)}
        if len(known) == len(set(uses(node))) and not _volatile(node):
            new = len(self.nodes)
            place = self.constant(evaluated(node, known))
            self._known[node] = place
            if place == new:  # else it was typed in, or computed before
                self.origins[place] = node
            return place
        return self._place(node, node, self._type(node) if size is None else Kind.ANY, size)

    def _is_plain(self, node: Apply) -> bool:
        """Whether it makes one value of single ones, some of which vary: the case of nearly every node."""
        if node.function.facts.spills or any(self.sizes[part] is not None for part in node.arguments):
            return False
        return not all(isinstance(self.nodes[part], Constant) for part in node.arguments)

    def _settled(self, node: Apply | Select | Rescue | Range) -> int | None:
        """What an `IF` or a rescue gives where that is known before the run: steps take no single constant."""
        match node:
            case Select(condition, yes, no):
                known = self._single_constant(condition)
                return None if known is None or not known.plain else self._not_blank(yes if known.numbers[0] else no)
            case Rescue(value, instead, only_na):
                known = self._single_constant(value)
                if known is None:
                    return None
                kind = int(known.kinds[0])
                lost = kind == ERROR + ErrorCode.NA or (kind >= ERROR and not only_na)
                return self._not_blank(instead if lost else value)
            case _:
                return None

    def _single_constant(self, place: int) -> Value | None:
        node = self.nodes[place]
        return node.value if isinstance(node, Constant) and self.sizes[place] is None else None

    def _not_blank(self, place: int) -> int:
        known = self._single_constant(place)
        return self.constant(constant(0.0)) if known is not None and int(known.kinds[0]) == BLANK else place

    def _size(self, node: Apply | Select | Rescue | Range) -> Size:
        if isinstance(node, Range):
            return len(node.rows), len(node.rows[0])
        parts = list(uses(node))
        if isinstance(node, Apply):  # what takes a range whole makes one value of it
            parts = [part for i, part in enumerate(parts) if not node.function.parameter(i).ranged]
        sizes = [size for part in parts if (size := self.sizes[part]) is not None]
        if MANY in sizes or (isinstance(node, Apply) and node.function.facts.spills):
            return MANY
        return np.broadcast_shapes(*sizes) if sizes else None

    def _place(self, key: object, node: Node, kind: Kind, size: Size) -> int:
        if key not in self._known:
            self._known[key] = len(self.nodes)
            self.nodes.append(node)
            self.types.append(kind)
            self.sizes.append(size)
        return self._known[key]

    def _type(self, node: Apply | Select | Rescue | Range) -> Kind:
        match node:
            case Apply(function):
                return function.returns
            case Select(_, yes, no):
                return self._common_type(yes, no)
            case Rescue(value, instead):
                return self._common_type(value, instead)
            case Range():
                return Kind.ANY
            case _:
                assert_never(node)

    def _common_type(self, left: int, right: int) -> Kind:
        return self.types[left] if self.types[left] is self.types[right] else Kind.ANY

    def upstream(self, targets: Sequence[int], reads: Callable[[int], Sequence[int]] | None = None) -> list[int]:
        """The varying nodes that the targets need, in order; `reads` says what a node needs, if not all it uses."""
        needed = {place for place in targets if not isinstance(self.nodes[place], Constant)}
        for place in range(max(needed, default=-1), -1, -1):
            if place in needed:
                read = uses(self.nodes[place]) if reads is None else reads(place)
                needed.update(p for p in read if not isinstance(self.nodes[p], Constant))
        return sorted(needed)


def _of_nodes(nodes: list[Node], types: list[Kind], sizes: list[Size], hosts: list[Cell], ends: list[int]) -> Dag:
    dag = Dag()
    dag.nodes, dag.types, dag.sizes, dag.hosts, dag.ends = nodes, types, sizes, hosts, ends
    return dag


def uses(node: Node) -> tuple[int, ...]:
    """The places a node reads, from left to right."""
    match node:
        case Constant() | Input():
            return ()
        case Apply(_, arguments):
            return arguments
        case Select(condition, yes, no):
            return condition, yes, no
        case Rescue(value, instead):
            return value, instead
        case Range(rows):
            return tuple(place for row in rows for place in row)
        case _:
            assert_never(node)


def evaluated(node: Apply | Select | Rescue | Range, values: Mapping[int, Value]) -> Value:
    """The node's value with everything Excel minds: the reference path, and how constants fold."""
    needed = {place: values[place] for place in uses(node)}
    if isinstance(node, Range):
        ask_for_cells(max(value.shape[0] for value in needed.values()), len(node.rows), len(node.rows[0]))
    if not any(isinstance(value, Ragged) for value in needed.values()):
        try:
            return _evaluated(node, needed)
        except ShapeVaries:
            pass  # trial by trial, then
    return by_trial(lambda trial: _evaluated(node, trial), needed)


def _evaluated(node: Apply | Select | Rescue | Range, values: Mapping[int, Value]) -> Value:
    match node:
        case Apply(function, arguments):
            given = arguments_of(function, [values[place] for place in arguments])
            return function.checked(function(given), given)
        case Select(condition, yes, no):
            _ask_for_all(values[condition], values[yes], values[no])
            return _selected(values[condition], values[yes], values[no])
        case Rescue(value, instead, only_na):
            _ask_for_all(values[value], values[instead])
            return _rescued(values[value], values[instead], only_na)
        case Range(rows):
            return _stacked([[values[place] for place in row] for row in rows])
        case _:
            assert_never(node)


def _ask_for_all(*values: Value) -> None:
    """Ask for the array that the values spread to."""
    shapes = [value.shape for value in values]
    tables = [shape for shape in shapes if len(shape) == 3]
    if tables:
        n = max(shape[0] for shape in shapes)
        ask_for_cells(n, max(shape[1] for shape in tables), max(shape[2] for shape in tables))


def _selected(condition: Value, yes: Value, no: Value) -> Value:
    selected: Value = if_(*aligned((condition, yes, no)))
    return selected


def _rescued(value: Value, instead: Value, only_na: bool) -> Value:
    value, instead = aligned((value, instead))
    rescued: Value = if_na(value, instead) if only_na else if_error(value, instead)
    return rescued


def _stacked(rows: list[list[Value]]) -> Value:
    cells = [single(value) for row in rows for value in row]
    (n,) = np.broadcast_shapes(*(value.shape for value in cells))
    size = (n, len(rows), len(rows[0]))
    texts = None
    if any(value.texts is not None for value in cells):
        texts = _grid([np.full(1, "", object) if v.texts is None else v.texts for v in cells], size, object)
    numbers = _grid([v.numbers for v in cells], size, np.float64)
    return Value(numbers, _grid([v.kinds for v in cells], size, np.uint8), texts)


def _grid(columns: list[Any], size: tuple[int, int, int], dtype: Any) -> Any:
    """Columns (n,) to (n, r, c), each column's trials side by side in memory."""
    out = np.empty((size[1] * size[2], size[0]), dtype)
    for target, column in zip(out, columns, strict=True):
        target[:] = column
    return out.T.reshape(size)


def _volatile(node: Node) -> bool:
    return isinstance(node, Apply) and node.function.volatile


_LARGE: Final = 64
"""Cells of a constant whose numbers are looked up by a digest."""


def _constant_key(value: Value) -> object:
    texts = None if value.texts is None else tuple(str(text) for text in value.texts.ravel())
    if value.numbers.size > _LARGE:
        digest = hashlib.sha256(np.ascontiguousarray(value.numbers).data)
        digest.update(np.ascontiguousarray(value.kinds).data)
        return value.shape, digest.digest(), texts
    return value.shape, value.numbers.tobytes(), value.kinds.tobytes(), texts


def _constant_type(value: Value) -> Kind:
    if value.numbers.ndim == 3 or value.kinds.size != 1:
        return Kind.ANY
    return {NUMBER: Kind.NUMBER, LOGICAL: Kind.LOGICAL, TEXT: Kind.TEXT}.get(int(value.kinds.flat[0]), Kind.ANY)


def constants(dag: Dag) -> Iterator[tuple[int, Value]]:
    """Every constant node."""
    for place, node in enumerate(dag.nodes):
        if isinstance(node, Constant):
            yield place, node.value
