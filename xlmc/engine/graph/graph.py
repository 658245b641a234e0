"""Make each node of the graph once: equal ones are one, and constants are folded."""

from __future__ import annotations

import hashlib
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from functools import partial
from typing import Any, Final, NamedTuple, assert_never

import numpy as np

from xlmc.engine.graph.node_values import apart, evaluate_node
from xlmc.engine.graph.nodes import Apply, Constant, Forgotten, IfErrorNode, Input, Node, Range, Select, uses
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Cell, host_of
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.budget import MOST_KEPT, TooLargeError, ask_for_live
from xlmc.excel.functions.number_text import dates_from_1904, parse_number
from xlmc.excel.functions.registry import from_1904
from xlmc.excel.functions.values import BLANK, ERROR, LOGICAL, NUMBER, TEXT, Codes, Floats, Value, constant

__all__ = ["MANY", "Dag", "Repeat", "Size", "constants"]

Size = tuple[int, ...] | None
"""Rows and columns of a value that is many cells; None for a single one."""

MANY: Final = (-1, -1)
"""The size of a value that may be many cells; how many is known only during the run."""


class Repeat(NamedTuple):
    """A node to be made like an earlier one: of `function`, or by `make` where that is None.

    Attributes:
        slots: which of the nodes known by then it uses.
        kind, size: what it gives.
    """

    make: Callable[[tuple[int, ...]], Node]
    function: Function | None
    slots: tuple[int, ...]
    kind: Kind
    size: Size


class Dag:
    """Nodes in an order in which each comes after those it uses; a node is known by its index.

    Args:
        date1904: whether the workbook's dates count from 1904.

    Attributes:
        nodes: what each is.
        types: what each gives where it is no error; ANY where that is not known before the run, or is many cells.
        sizes: the size of each.
        origins: constants that were computed here -> the node that each was computed from.
        recording: where it is a list, every node that is asked for is noted in it, whether it is new or not.
        missing: the nodes that read, perhaps not in each trial, a value that is not there, of a cell in a circle.
        folded: a function of a long set -> the node that folds its cells one by one, to the same bits where nothing is
            an error.
        kept: the bytes of all constant arrays that are in memory; each counts once, however many formulas read it.
        hosts, ends: the formula cells in the order in which they were lowered, and how many nodes there were then.
    """

    def __init__(self, *, date1904: bool = False) -> None:
        self._date1904 = date1904
        self.nodes: list[Node] = []
        self.types: list[Kind] = []
        self.sizes: list[Size] = []
        self.origins: dict[int, Apply | Select | IfErrorNode | Range] = {}
        self.recording: list[int] | None = None
        self.missing: set[int] = set()
        self.folded: dict[int, int] = {}
        self._known: dict[object, int] = {}
        self.kept = 0
        self._forgettable: dict[int, int] = {}  # computed arrays of constants -> bytes
        self._forgotten: set[int] = set()
        self._read: set[int] = set()  # by nodes that vary, up to the one before `_looked_through`
        self._looked_through = 0
        self.hosts: list[Cell] = []
        self.ends: list[int] = []

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process gets only the nodes and their cells: it evaluates them and adds none."""
        parts = self.nodes, self.types, self.sizes, self.folded, self.hosts, self.ends
        return _of_nodes, (self._date1904, *parts)

    def with_inputs(self, names: Mapping[int, str]) -> Dag:
        """Return the same nodes, some of them as inputs by these names. It evaluates them, and adds none."""
        nodes = [Input(names[node]) if node in names else each for node, each in enumerate(self.nodes)]
        folded = {node: each for node, each in self.folded.items() if node not in names}
        return _of_nodes(self._date1904, nodes, self.types, self.sizes, folded, self.hosts, self.ends)

    def host_ends(self, cell: Cell) -> None:
        """Note that all nodes made since the last such note were made for the formula of this cell."""
        self.hosts.append(host_of(cell))
        self.ends.append(len(self.nodes))

    def naming_cell(self, error: TooLargeError) -> FormulaError:
        """Return the error, naming the cell whose formula first asked for its node."""
        return error if error.node is None else self.naming_cell_of(error, error.node)

    def naming_cell_of(self, error: FormulaError, node: int) -> FormulaError:
        """Return the error, naming the cell whose formula first asked for the node, unless it names a cell already."""
        at = bisect_right(self.ends, node)
        return error if at == len(self.ends) or error.where is not None else error.at(self.hosts[at])

    def constant(self, value: Value) -> int:
        """Return the node of a known value.

        Raises:
            TooLargeError: the constants of the workbook take too much memory.
        """
        key = _constant_key(value)
        if key not in self._known:
            value = apart(value)
            if value.numbers.size > 1:
                self._keep(value)
        return self._register(key, Constant(value), _constant_type(value), value.shape[1:] or None)

    def _keep(self, value: Value) -> None:
        """Count the memory of an array; where it is too much, forget computed arrays that no varying node reads."""
        self.kept += value.nbytes
        if self.kept > MOST_KEPT:
            self._forget()
        if self.kept > MOST_KEPT:
            self.kept -= value.nbytes
            raise TooLargeError(
                f"the arrays of constants of the workbook take more than {MOST_KEPT >> 20} MB up to here",
                hint="make the arrays smaller, or fewer",
            )

    def _forget(self) -> None:
        """Drop all computed arrays that no varying node reads so far."""
        for node in self.nodes[self._looked_through :]:
            if not isinstance(node, Constant):
                self._read.update(uses(node))
        self._looked_through = len(self.nodes)
        for node_id in self._forgettable.keys() - self._read:
            self.kept -= self._forgettable.pop(node_id)
            self.nodes[node_id] = Forgotten(partial(self._remember, node_id))
            self._forgotten.add(node_id)

    def _remember(self, node_id: int) -> Value:
        """Compute a forgotten array again, and keep it; where that was done meanwhile, return it.

        Raises:
            TooLargeError: the arrays that this needs at a time take too much memory.
        """
        node = self.nodes[node_id]
        if type(node) is Constant:
            return node.value
        order = self._to_compute(node_id)
        last = {part: each for each in order for part in uses(self.origins[each])}
        values: dict[int, Value] = {}
        live = 0
        for each in order:
            origin = self.origins[each]
            for part in uses(origin):
                if part not in values and isinstance(known := self.nodes[part], Constant):
                    values[part] = known.value
            values[each] = evaluate_node(origin, values)
            live += values[each].nbytes
            ask_for_live(live)
            for part in set(uses(origin)):
                if last[part] == each:
                    gone = values.pop(part)
                    live -= gone.nbytes if part in self._forgotten else 0
        value = apart(values[node_id])
        self._keep(value)
        self.nodes[node_id] = Constant(value)
        self._forgotten.discard(node_id)
        self._forgettable[node_id] = value.nbytes
        return value

    def _to_compute(self, node_id: int) -> list[int]:
        """Return a forgotten array and the forgotten ones that it is computed from, in the order of their making."""
        result, left = {node_id}, [node_id]
        while left:
            parts = self._forgotten.intersection(uses(self.origins[left.pop()])) - result
            result |= parts
            left += parts
        return sorted(result)

    def input(self, name: str) -> int:
        """Return the node of an assumption."""
        node = Input(name)
        return self._register(node, node, Kind.NUMBER, None)

    def circle(self) -> int:
        """Return the node of a value that is not there: that of a cell which is asked for while it is computed."""
        return self._register_missing(_CIRCLE, constant(ErrorCode.CALC))

    def part_of(self, node_id: int, cell: Value) -> int:
        """Return the node of one cell of a constant."""
        here = node_id in self.missing and bool((cell.kinds == ERROR + ErrorCode.CALC).any())
        return self.circle() if here else self.constant(cell)

    def _register_missing(self, key: object, value: Value) -> int:
        """Add a constant apart from those that are equal to it."""
        node_id = self._register(key, Constant(value), _constant_type(value), value.shape[1:] or None)
        self.missing.add(node_id)
        return node_id

    def add(self, node: Apply | Select | IfErrorNode | Range) -> int:
        """Add a node and return its index; a node whose parts are all constant becomes a constant at once.

        Raises:
            ValueError: parts of many cells have sizes that do not go together.
        """
        node_id = self._add(self._from_1904(node) if self._date1904 and isinstance(node, Apply) else node)
        if self.missing and self._known.get(node) == node_id and not isinstance(self.nodes[node_id], Constant):
            self._note_missing(node_id, uses(node))
        if self.recording is not None and not isinstance(self.nodes[node_id], Constant):
            self.recording.append(node_id)
        return node_id

    def _note_missing(self, node_id: int, used: Sequence[int]) -> None:
        if not self.missing.isdisjoint(used):
            self.missing.add(node_id)

    def replay(self, steps: Sequence[Repeat], local: list[int]) -> None:
        """Add nodes like earlier ones, one after another, and append each to `local`.

        Args:
            steps: what to make.
            local: the nodes that the slots of the steps refer to.
        """
        known, nodes, types, sizes = self._known, self.nodes, self.types, self.sizes
        for make, function, slots, kind, size in steps:
            used = tuple([local[slot] for slot in slots])
            node = make(used) if function is None else tuple.__new__(Apply, (function, used))
            node_id = known.get(node)
            if node_id is None:
                known[node] = node_id = len(nodes)
                nodes.append(node)
                types.append(kind)
                sizes.append(size)
                if self._forgotten:
                    self._remember_all(used)
                if self.missing:
                    self._note_missing(node_id, used)
            local.append(node_id)

    def _add(self, node: Apply | Select | IfErrorNode | Range) -> int:
        if node in self._known:
            return self._known[node]
        if isinstance(node, Apply) and self._is_plain(node):
            return self._register(node, node, node.function.returns, None)
        folded = self._fold_choice(node)
        if folded is not None:
            return folded
        size = self._size(node)
        known = {p: part.value for p in uses(node) if isinstance(part := self.nodes[p], Constant)}
        if len(known) == len(set(uses(node))) and not _volatile(node):
            new = len(self.nodes)
            value = apart(evaluate_node(node, known))
            if not self.missing.isdisjoint(known) and (value.kinds == ERROR + ErrorCode.CALC).any():
                return self._register_missing(node, value)
            node_id = self.constant(value)
            if node_id == new or not isinstance(node, Range) or value.numbers.size <= _LARGE:
                self._known[node] = node_id  # a second large range of the same values is found by these
            if node_id == new:  # else it was typed in, or computed before
                self.origins[node_id] = node
                if value.numbers.size > _LARGE and not isinstance(node, Range):
                    self._forgettable[node_id] = value.nbytes
            return node_id
        return self._register(node, node, self._type(node) if size is None else Kind.ANY, size)

    def _from_1904(self, node: Apply) -> Apply:
        """Return the call with texts that are dates as days from 1904 on: known ones now, others when they are
        computed.
        """
        arguments = list(node.arguments)
        for position, argument in enumerate(arguments):
            known = self._single_constant(argument) if self.types[argument] is Kind.TEXT else None
            if known is not None and node.function.parameter(position).kind is Kind.NUMBER:
                number = parse_number(str(known.texts[0]), date1904=True) if known.texts is not None else None
                arguments[position] = argument if number is None else self.constant(constant(number))
        sure = all(self.types[argument] in (Kind.NUMBER, Kind.LOGICAL) for argument in arguments)
        return Apply(node.function if sure else from_1904(node.function), tuple(arguments))

    def to_numbers(self, value: Value) -> tuple[Floats, Codes]:
        """Return what arithmetic reads of a value, by the workbook's calendar."""
        with dates_from_1904() if self._date1904 else nullcontext():
            return value.to_numbers()

    def _is_plain(self, node: Apply) -> bool:
        """Whether it makes one value of single ones, some of which vary, as nearly every node does."""
        if node.function.facts.spills or any(self.sizes[part] is not None for part in node.arguments):
            return False
        return not all(isinstance(self.nodes[part], Constant) for part in node.arguments)

    def _fold_choice(self, node: Apply | Select | IfErrorNode | Range) -> int | None:
        """Return what an `IF` or an `IFERROR` gives whose condition or value is a constant, which steps do not take."""
        match node:
            case Select(condition, yes, no):
                known = self._single_constant(condition)
                return (
                    None if known is None or not known.plain else self._zero_if_blank(yes if known.numbers[0] else no)
                )
            case IfErrorNode(value, instead, only_na):
                known = self._single_constant(value)
                if known is None:
                    return None
                kind = int(known.kinds[0])
                lost = kind == ERROR + ErrorCode.NA or (kind >= ERROR and not only_na)
                return self._zero_if_blank(instead if lost else value)
            case _:
                return None

    def _single_constant(self, node_id: int) -> Value | None:
        node = self.nodes[node_id]
        return node.value if isinstance(node, Constant) and self.sizes[node_id] is None else None

    def _zero_if_blank(self, node: int) -> int:
        known = self._single_constant(node)
        return self.constant(constant(0.0)) if known is not None and int(known.kinds[0]) == BLANK else node

    def _size(self, node: Apply | Select | IfErrorNode | Range) -> Size:
        if isinstance(node, Range):
            return len(node.rows), len(node.rows[0])
        parts = list(uses(node))
        if isinstance(node, Apply):  # what takes a range whole makes one value of it
            parts = [part for i, part in enumerate(parts) if not node.function.parameter(i).ranged]
        sizes = [size for part in parts if (size := self.sizes[part]) is not None]
        if MANY in sizes or (isinstance(node, Apply) and node.function.facts.spills):
            return MANY
        return np.broadcast_shapes(*sizes) if sizes else None

    def _register(self, key: object, node: Node, kind: Kind, size: Size) -> int:
        if key not in self._known:
            if self._forgotten and not isinstance(node, Constant):
                self._remember_all(uses(node))
            self._known[key] = len(self.nodes)
            self.nodes.append(node)
            self.types.append(kind)
            self.sizes.append(size)
        return self._known[key]

    def _remember_all(self, parts: Sequence[int]) -> None:
        """Compute again what a varying node reads: it is read in each trial."""
        self._read.update(parts)
        for part in self._forgotten.intersection(parts):
            self._remember(part)

    def _type(self, node: Apply | Select | IfErrorNode | Range) -> Kind:
        match node:
            case Apply(function):
                return function.returns
            case Select(_, yes, no):
                return self._common_type(yes, no)
            case IfErrorNode(value, instead):
                return self._common_type(value, instead)
            case Range():
                return Kind.ANY
            case _:
                assert_never(node)

    def _common_type(self, left: int, right: int) -> Kind:
        return self.types[left] if self.types[left] is self.types[right] else Kind.ANY

    def upstream(self, targets: Sequence[int], reads: Callable[[int], Sequence[int]] | None = None) -> list[int]:
        """Return the varying nodes that the targets need, in order; `reads` says what a node needs, if not
        all it uses.
        """
        needed, result = set(targets), []
        for node in range(max(needed, default=-1), -1, -1):
            if node in needed and not isinstance(self.nodes[node], Constant):
                result.append(node)
                needed.update(uses(self.nodes[node]) if reads is None else reads(node))
        return result[::-1]


def _of_nodes(
    date1904: bool,
    nodes: list[Node],
    types: list[Kind],
    sizes: list[Size],
    folded: dict[int, int],
    hosts: list[Cell],
    ends: list[int],
) -> Dag:
    dag = Dag(date1904=date1904)
    dag.nodes, dag.types, dag.sizes, dag.folded, dag.hosts, dag.ends = nodes, types, sizes, folded, hosts, ends
    return dag


_CIRCLE: Final = "circle"
"""The key of a value that is not there."""


def _volatile(node: Node) -> bool:
    return isinstance(node, Apply) and node.function.volatile


_LARGE: Final = 64
"""Cells of a constant whose numbers are looked up by a digest."""


def _constant_key(value: Value) -> object:
    texts = None if value.texts is None else tuple(str(text) for text in value.texts.ravel())
    if value.numbers.size > _LARGE:
        digest = hashlib.sha256(np.ascontiguousarray(value.numbers).data)
        digest.update(np.ascontiguousarray(value.kinds).data)
        for text in texts or ():
            digest.update(f"{len(text)}:{text}".encode("utf-8", "surrogatepass"))
        return value.shape, value.kinds.shape, digest.digest(), texts is None
    return value.shape, value.numbers.tobytes(), value.kinds.tobytes(), texts


def _constant_type(value: Value) -> Kind:
    if value.numbers.ndim == 3 or value.kinds.size != 1:
        return Kind.ANY
    return {NUMBER: Kind.NUMBER, LOGICAL: Kind.LOGICAL, TEXT: Kind.TEXT}.get(int(value.kinds.flat[0]), Kind.ANY)


def constants(dag: Dag) -> Iterator[tuple[int, Value]]:
    """Every constant node, but for forgotten arrays, which no varying node reads."""
    for node_id, node in enumerate(dag.nodes):
        if isinstance(node, Constant) and not isinstance(node, Forgotten):
            yield node_id, node.value
