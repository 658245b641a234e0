"""Ranges that go on beyond all that a sheet holds, as whole columns do: read up to there, but computed as if whole.

Their further rows (or columns) are all alike: empty. What a function makes of them follows from one of them, or does
not matter; where neither is known, a whole column is refused. An expression of whole columns, as in
`SUMPRODUCT((A:A>0)*B:B)`, is computed up to the last filled cell of all of them, and once more for one further row.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from xlmc.engine.graph.computed_references import join_areas, require
from xlmc.engine.graph.exposed_ranges import (
    CURVED,
    Change,
    change_exposed,
    degree,
    find_areas,
    has_exposed,
    is_numbered,
    is_spared,
)
from xlmc.engine.graph.further_cells import (
    by_halves,
    keep_within,
    level,
    one_behind,
    one_further,
    refusal,
    resize,
    to_filled,
    to_the_last,
)
from xlmc.engine.graph.nodes import Constant, IfErrorNode, Range
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.errors import FormulaError
from xlmc.excel.address import Area
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function
from xlmc.excel.functions.facts import EmptyCells, Repeats
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import BLANK, ERROR, LOGICAL, NUMBER

__all__ = ["lower_call"]

Arguments = tuple[ir.Expression, ...]
Make = Callable[[Arguments, Mapping[int, Function]], int]
"""Makes the node of a call from its arguments, some of which go through a function first."""


@dataclass(frozen=True)
class _Call:
    """A call of a function: by position, the areas of arguments that refer, and which others compute something of such
    ranges cell by cell; the scope is that of these.
    """

    lowering: TreeLowering
    name: str
    function: Function
    arguments: Arguments
    scope: Scope
    make: Make
    direct: Mapping[int, list[Area]]
    mixed: tuple[int, ...]

    def refusal(self) -> FormulaError:
        return refusal(self.name)

    def with_areas(self, areas: Mapping[int, Sequence[Area]]) -> Arguments:
        """Return the arguments with other areas, which are lowered by then."""
        return tuple(
            join_areas([require(self.lowering, area.filled) for area in areas[i]]) if i in areas else argument
            for i, argument in enumerate(self.arguments)
        )

    def change_all(self, change: Change) -> Arguments:
        """Return the arguments with every range that is cut changed."""
        direct = {i: [change(area) if area.is_cut else area for area in areas] for i, areas in self.direct.items()}
        made = self.with_areas(direct)

        def read(area: Area) -> Area:
            return require(self.lowering, change(area).filled)

        return tuple(
            change_exposed(self.lowering, part, self.scope, read) if i in self.mixed else part
            for i, part in enumerate(made)
        )

    def cut(self) -> list[Area]:
        """All ranges that are cut."""
        result: list[Area] = []

        def note(area: Area) -> Area:
            result.append(area)
            return area

        for i in self.mixed:
            change_exposed(self.lowering, self.arguments[i], self.scope, note)
        return result + [area for areas in self.direct.values() for area in areas if area.is_cut]


def lower_call(
    lowering: TreeLowering, name: str, function: Function, arguments: Arguments, scope: Scope, make: Make
) -> int:
    """Lower a call, whichever whole columns it is given.

    Args:
        lowering: of the workbook.
        name: the function's.
        function: its row.
        arguments: trees.
        scope: of the call.
        make: makes the node of a call with arguments of which none is cut.

    Raises:
        FormulaError: what the function makes of the empty cells is not known.
    """
    ranged = [i for i in range(len(arguments)) if function.parameter(i).ranged]
    scopes = {i: scope.of(function.parameter(i).ranges) for i in ranged}
    result = {i: find_areas(lowering, arguments[i], scopes[i]) for i in ranged}
    direct = {i: areas for i, areas in result.items() if areas is not None}
    computed = [i for i in ranged if i not in direct and (scopes[i].array or _is_index(arguments[i]))]
    mixed = tuple(i for i in computed if has_exposed(lowering, arguments[i], scopes[i]))
    if not mixed and not any(area.is_cut for areas in direct.values() for area in areas):
        return make(arguments, {})
    call = _Call(lowering, name, function, arguments, scope.over_arrays(), make, direct, mixed)
    return _of_expressions(call) if mixed else _of_areas(call)


def _is_index(tree: ir.Expression) -> bool:
    """Whether a tree is an INDEX, of which the first argument is computed cell by cell also in a plain formula."""
    return isinstance(tree, ir.Call) and tree.name == "INDEX"


def _of_areas(call: _Call) -> int:
    """Lower a call that is given whole columns as they are."""
    name, facts = call.name, call.function.facts
    if facts.mode_argument is not None:
        return _look_up(call, facts.mode_argument)
    if name == "INDEX":
        return _pick(call)
    if name == "UNIQUE" and len(call.arguments) == 1:
        return call.make(call.change_all(one_further), {})
    if facts.empty_cells is EmptyCells.PAIRED:
        return call.make(call.with_areas(level(call.direct)), {})
    cut = [i for i, areas in call.direct.items() if any(area.is_cut for area in areas)]
    texts = name == "TEXTJOIN" and call.arguments[1] == ir.Logical(True) and 0 not in cut
    in_first = facts.empty_cells is EmptyCells.IGNORED_IN_FIRST and cut == [0]
    if facts.empty_cells is EmptyCells.IGNORED or texts or in_first:
        return call.make(call.change_all(to_filled), {})
    raise call.refusal()


def _of_expressions(call: _Call) -> int:
    """Lower a call that is given something computed of whole columns, cell by cell."""
    facts = call.function.facts
    if facts.mode_argument is not None:
        return _look_up(call, facts.mode_argument)
    filled, further, count = _split_at_filled(call)
    if facts.repeats is Repeats.ADD_UP:
        return _add_up(call, filled, _ends(call, further), count)
    if facts.repeats is Repeats.ONCE:
        return call.make((*filled, *(part for end in _ends(call, further) for part in end)), {})
    if facts.repeats is Repeats.NUMBERS_COUNT and all(_is_ignored(call, further[i]) for i in call.mixed):
        return call.make(filled, {})
    if call.name == "FILTER" and 1 in call.mixed and _is_false(call, further[1]):
        return call.make(filled, {})
    raise call.refusal()


def _split_at_filled(call: _Call) -> tuple[Arguments, Arguments, int]:
    """Split the arguments: up to the last filled row; those of one further row; and the number of further rows.

    Empty cells of arguments that are ranges add nothing to a function that adds up.
    """
    cut = call.cut()
    across = cut[0].further_columns > 0
    sizes = {area.whole.columns if across else area.whole.rows for area in cut}
    if len(sizes) > 1 or any((area.further_rows if across else area.further_columns) for area in cut):
        raise call.refusal()
    length = max(area.columns if across else area.rows for area in cut)
    filled = call.change_all(lambda area: resize(area, length, across))
    further = call.change_all(lambda area: one_behind(area, length, across))
    for i in range(len(call.arguments)):
        if i in call.mixed:
            _check(call, filled[i], length, across)
            _check(call, further[i], 1, across)
    return filled, further, sizes.pop() - length


def _check(call: _Call, tree: ir.Expression, length: int, across: bool) -> None:
    """Make sure that an argument is as long as the whole columns in it: nothing longer is combined with them."""
    if isinstance(tree, ir.Call) and _is_index(tree):
        tree = tree.arguments[0]
    size = call.lowering.dag.sizes[call.lowering.lower(tree, call.scope)] or (1, 1)
    if size[1 if across else 0] != length:
        raise call.refusal()


def _ends(call: _Call, further: Arguments) -> list[Arguments]:
    """Return the arguments of the first further row, and of the last where the two differ; all others lie
    between them.
    """
    degrees = [_degree(call, i) for i in call.mixed]
    if not any(degrees):
        return [further]
    curved = CURVED in degrees or (call.name == "SUMPRODUCT" and sum(degrees) > 1)
    if curved or not _ends_tell(call):
        raise call.refusal()
    area = call.cut()[0]
    across = area.further_columns > 0
    length = (area.whole.columns if across else area.whole.rows) - 1
    return [further, call.change_all(lambda area: one_behind(area, length, across))]


def _ends_tell(call: _Call) -> bool:
    """Whether the first and the last further cell decide the result; for a lookup the last one does."""
    return call.function.facts.ends_suffice or call.function.facts.mode_argument is not None


def _degree(call: _Call, position: int) -> int:
    """How an argument depends on the number of the row: see `degree`."""

    def taken(tree: ir.Call) -> list[ir.Expression]:
        function = function_named(tree.name)
        if function is None:
            return list(tree.arguments)
        return [part for i, part in enumerate(tree.arguments) if not is_spared(function, i, call.scope)]

    return degree(call.arguments[position], taken) if position in call.mixed else 0


def _add_up(call: _Call, filled: Arguments, ends: Sequence[Arguments], count: int) -> int:
    lowering = call.lowering
    if call.name == "SUMPRODUCT" and any(not area.is_cut for areas in call.direct.values() for area in areas):
        raise call.refusal()
    share = lowering.number(count / len(ends))
    node = call.make(filled, {})
    for end in ends:
        for part in [end] if call.name == "SUMPRODUCT" else [(end[i],) for i in call.mixed]:
            one = call.make(part, {})
            if one != lowering.number(0.0):
                node = lowering.call("+", (node, lowering.call("*", (one, share))))
    return node


def _look_up(call: _Call, mode: int) -> int:
    """Lookups from the first cell on find the first empty cell; lookups by halves take the steps of the whole range."""
    name, arguments = call.name, call.arguments
    how = arguments[mode] if len(arguments) > mode else None
    if name in ("XMATCH", "XLOOKUP"):
        given = ir.Number(1.0) if how is None or isinstance(how, ir.Missing) else how
        if given == ir.Number(1.0) and not _degree(call, 1):
            return call.make(_with_one_further(call), {})
        if given == ir.Unary("-", ir.Number(1.0)) and not _degree(call, 1):
            return _from_behind(call)
        raise call.refusal()
    exact = how is not None and (isinstance(how, ir.Missing) or how in (ir.Number(0.0), ir.Logical(False)))
    if call.mixed:
        return _search_computed(call, exact)
    made = call.change_all(lambda area: _reach(area, name, exact))
    return call.make(made, _within_read(call))


def _from_behind(call: _Call) -> int:
    """XLOOKUP and XMATCH from the last cell on: they reach the further cells first, beginning with the last."""
    made = _with_one_further(call)
    sizes = {(area.rows, area.whole.rows, area.columns, area.whole.columns) for area in call.cut()}
    if call.name == "XLOOKUP":
        if _degree(call, 2) and not _is_not_found(call):
            raise call.refusal()
        return call.make(made, {})
    area = call.cut()[0]
    if len(sizes) > 1:
        raise call.refusal()
    across = area.further_columns > 0
    filled_count, whole = (area.columns, area.whole.columns) if across else (area.rows, area.whole.rows)
    return call.lowering.apply(to_the_last(filled_count, whole), (call.make(made, {}),))


def _is_not_found(call: _Call) -> bool:
    """Whether what is looked for is TRUE, exactly, and the further cells are not."""
    exact = len(call.arguments) < 5 or call.arguments[4] in (ir.Missing(), ir.Number(0.0))
    return exact and call.arguments[0] == ir.Logical(True) and _is_false(call, _split_at_filled(call)[1][1])


def _reach(area: Area, name: str, exact: bool) -> Area:
    """Return the area as far as a lookup comes in it; across the direction of the search, one further column or row."""
    further = one_further(area)
    if exact:
        return further
    halved = by_halves(area)
    if name in ("VLOOKUP", "HLOOKUP"):
        across = name == "VLOOKUP"
        return resize(halved, further.columns if across else further.rows, across)
    return halved


def _search_computed(call: _Call, exact: bool) -> int:
    """Look up in something computed of whole columns."""
    _, further, _ = _split_at_filled(call)
    passed = 1 in call.mixed and _is_passed_over(call, further[1])
    if _degree(call, 1) and not passed:
        raise call.refusal()
    passed = passed or exact
    cut = call.cut()
    across = cut[0].further_columns > 0
    length = max(area.columns if across else area.rows for area in map(one_further if exact else by_halves, cut))
    node = call.make(call.change_all(lambda area: resize(area, length, across)), {})
    return node if passed else _at_the_end(call, further, node)


def _at_the_end(call: _Call, further: Arguments, otherwise: int) -> int:
    """LOOKUP where it may find a further row: it then finds the last one, else what it finds before these."""
    dag = call.lowering.dag
    longest = max(max(area.rows, area.columns) for area in call.cut())
    shortest = min(max(area.whole.rows, area.whole.columns) for area in call.cut())
    numbered = call.mixed == (1, 2) and is_numbered(call.arguments[2])
    if call.name != "LOOKUP" or not (numbered or (call.mixed == (1,) and 2 in call.direct)) or 2 * longest >= shortest:
        raise call.refusal()
    if not numbered and not all(area.is_cut for area in call.direct[2]):
        raise call.refusal()
    there = call.make(_ends(call, further)[-1], {})
    if dag.sizes[there] is not None or dag.sizes[otherwise] is not None:
        raise call.refusal()
    return dag.add(IfErrorNode(there, otherwise, True))


def _within_read(call: _Call) -> dict[int, Function]:
    """Return the function that keeps VLOOKUP's column number, or HLOOKUP's row number, within the cells that
    are read.
    """
    for area in call.direct.get(1, ()):
        if call.name == "VLOOKUP" and area.further_columns:
            return {2: keep_within(area.columns + 1, area.whole.columns, False)}
        if call.name == "HLOOKUP" and area.further_rows:
            return {2: keep_within(area.rows + 1, area.whole.rows, False)}
    return {}


def _pick(call: _Call) -> int:
    """INDEX: beyond what is read, a number leads to a further cell."""
    if len(call.direct[0]) > 1:
        raise call.refusal()
    (area,) = call.direct[0]
    alone = len(call.arguments) == 2
    axes = {1: "columns"} if alone and area.whole.rows == 1 else {1: "rows", 2: "columns"}
    within = {}
    for i, axis in axes.items():
        one = getattr(area, "further_" + axis)
        given = i < len(call.arguments) and not isinstance(call.arguments[i], ir.Missing)
        if one and not given and not (alone and area.whole.columns == 1):
            raise call.refusal()
        if one and given:
            within[i] = keep_within(getattr(area, axis) + 1, getattr(area.whole, axis), True)
    return call.make(call.change_all(one_further), within)


def _with_one_further(call: _Call) -> Arguments:
    """Return the arguments of XLOOKUP and XMATCH with one further cell; different sizes must stay different."""
    if call.mixed:
        _split_at_filled(call)
        sizes = {(area.whole.rows, area.further_columns > 0) for area in call.cut()}
        if len(sizes) > 1 or any(not area.is_cut for areas in call.direct.values() for area in areas):
            raise call.refusal()
        across = call.cut()[0].further_columns > 0
        length = max(area.columns if across else area.rows for area in call.cut()) + 1
        return call.change_all(lambda area: resize(area, length, across))
    longer = {i: [one_further(area) if area.is_cut else area for area in areas] for i, areas in call.direct.items()}
    return call.with_areas(level(longer))


def _kinds(call: _Call, tree: ir.Expression) -> set[tuple[int, float]] | None:
    """Kinds and numbers of the cells of an argument; None if they vary."""
    dag = call.lowering.dag
    node = dag.nodes[call.lowering.lower(tree, call.scope)]
    cells = [dag.nodes[cell] for row in node.rows for cell in row] if isinstance(node, Range) else [node]
    result: set[tuple[int, float]] = set()
    for cell in cells:
        if not isinstance(cell, Constant):
            return None
        result |= set(zip(cell.value.kinds.ravel().tolist(), cell.value.numbers.ravel().tolist(), strict=True))
    return result


def _is_ignored(call: _Call, tree: ir.Expression) -> bool:
    kinds = _kinds(call, tree)
    return kinds is not None and all(NUMBER < kind < ERROR for kind, _ in kinds)


def _is_passed_over(call: _Call, tree: ir.Expression) -> bool:
    kinds = _kinds(call, tree)
    return kinds is not None and all(kind == BLANK or kind >= ERROR for kind, _ in kinds)


def _is_false(call: _Call, tree: ir.Expression) -> bool:
    kinds = _kinds(call, tree)
    return kinds is not None and all(kind in (NUMBER, LOGICAL, BLANK) and number == 0.0 for kind, number in kinds)
