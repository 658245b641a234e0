"""The calls of one cell, read as assumptions: cells of their own stand in the formula for each and for arguments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from xlmc.address import Area, Cell, InFormula
from xlmc.definitions.computed import Computed
from xlmc.definitions.definitions import Assumption, DataRange, Parameter
from xlmc.definitions.in_cells.call_arguments import difference, is_left_out, number_of, total
from xlmc.definitions.in_cells.call_draws import Drawn, MatrixRow, base_of, percentile_cutoffs
from xlmc.definitions.in_cells.crystal_ball_functions import crystal_ball_draw
from xlmc.definitions.in_cells.random_functions import random_draw
from xlmc.definitions.in_cells.result_functions import NOT_COMPUTED, ResultCall, is_result, not_computed, result_call
from xlmc.definitions.in_cells.risk_functions import risk_draw
from xlmc.definitions.in_cells.risk_properties import is_property
from xlmc.definitions.tables.fields import number_in, static_value
from xlmc.definitions.tables.table_rows import as_text, is_blank
from xlmc.distributions import FAMILIES
from xlmc.errors import FormulaError
from xlmc.formula import formula_text, ir
from xlmc.formula.substitute import is_bound, substitute
from xlmc.workbook.workbook import Workbook

__all__ = ["CellReading", "Output"]

_SUPPORTED: Final = 'see "Functions in cells" in docs/workbooks.md for what is; replace the call by one of those'


@dataclass(frozen=True, slots=True)
class Output:
    """What `RiskOutput` says: a name and units, where it gives them."""

    name: str | None
    units: str


@dataclass(frozen=True, slots=True)
class _Draw:
    assumption: Assumption
    matrix: MatrixRow | None


class CellReading:
    """The calls of one cell.

    Attributes:
        host: the cell.
        draws: by their position in the formula.
        trees: of the arguments that are expressions, by the cells that stand for them.
        output, asked, idle, has_lognorm: see `in_cells.InCells`.
        unavailable: why it cannot show the results that it should show; empty where it can, or should show none.
    """

    def __init__(
        self, workbook: Workbook, computed: Computed, lognorm: str, bases: dict[Cell, float | None], host: Cell
    ) -> None:
        self._workbook, self._computed, self._lognorm, self._bases = workbook, computed, lognorm, bases
        self.host = host
        self.draws: dict[tuple[int, int], _Draw] = {}
        self.trees: dict[Cell, ir.Expression] = {}
        self.output: Output | None = None
        self.asked: list[ResultCall] = []
        self.unavailable = ""
        self.idle: tuple[str, ...] = ()
        self.has_lognorm = False
        self._count = self._depth = 0

    def rewrite(self, tree: ir.Expression) -> ir.Expression:
        """The formula with assumptions instead of calls.

        Raises:
            FormulaError: a call is not supported or not what it must be, or shows results of the run.
        """
        self._find_results(tree)
        return substitute(tree, self._replacement)

    def _find_results(self, tree: ir.Expression) -> None:
        calls: list[ir.Call] = []

        def look(part: ir.Expression) -> None:
            if isinstance(part, ir.Call) and (is_result(part) or not_computed(part)):
                calls.append(part)

        substitute(tree, look)
        if not calls:
            return
        self._take_asked(tree, calls)
        message = f"{self.asked[0].function} shows results of the run, on which the run itself cannot depend"
        raise FormulaError(message, hint="let no forecast and no filter depend on this cell")

    def _take_asked(self, tree: ir.Expression, calls: Sequence[ir.Call]) -> None:
        """Take what the calls ask for.

        Raises:
            FormulaError: one of them cannot be answered, or the formula draws, too.
        """
        try:
            if _draws(tree):
                hint = "show the result in a cell of its own"
                raise FormulaError("the formula both draws and shows results of the run", hint=hint)
            self.asked = [result_call(call) for call in calls if is_result(call)]
            if missing := [each for call in calls if (each := not_computed(call))]:
                known = missing[0] in NOT_COMPUTED
                what = (
                    f"{missing[0]} is not computed by xlmc" if known else f"the function {missing[0]} is not supported"
                )
                raise FormulaError(what, hint=_SUPPORTED)
        except FormulaError as error:
            self.unavailable = error.message
            raise

    def _replacement(self, part: ir.Expression) -> ir.Expression | None:
        if isinstance(part, ir.Lambda):
            _refuse_calls_within(part)
        drawn = random_draw(part)
        if drawn is not None:
            number, parameters = self._next(), self._rewrite_each(drawn.parameters)
            return self._take_draw(replace(drawn, parameters=parameters, text=formula_text(part)), number)
        if not isinstance(part, ir.Call) or not part.name.startswith(("RISK", "CB.")):
            return None
        if self._depth and is_property(part):
            return None
        if part.name == "RISKOUTPUT":
            self._take_output(part)
            return ir.Number(0.0)
        return self._program_call(part)

    def _program_call(self, call: ir.Call) -> ir.Expression:
        """What stands instead of a call of Crystal Ball or @RISK."""
        number = self._next()
        self._depth += 1
        rewritten = ir.Call(call.name, tuple(substitute(argument, self._replacement) for argument in call.arguments))
        self._depth -= 1
        drawn = crystal_ball_draw(rewritten) or risk_draw(rewritten, self._lognorm)
        if drawn is None:
            raise FormulaError(f"the function {call.name} is not supported", hint=_SUPPORTED)
        self.has_lognorm = self.has_lognorm or drawn.function == "RiskLognorm"
        return self._take_draw(replace(drawn, text=formula_text(call)), number)

    def _next(self) -> int:
        self._count += 1
        return self._count

    def _rewrite_each(self, trees: Mapping[str, ir.Expression]) -> dict[str, ir.Expression]:
        return {key: substitute(tree, self._replacement) for key, tree in trees.items()}

    def _take_output(self, call: ir.Call) -> None:
        name = units = None
        for index, argument in enumerate(call.arguments):
            if isinstance(argument, ir.Call) and argument.name == "RISKUNITS":
                units = self._text("RiskUnits", argument.arguments[0]) if argument.arguments else None
            elif index == 0 and not is_left_out(argument):
                name = self._text("RiskOutput", argument)
        if self.output is not None:
            raise FormulaError("the formula has two RiskOutput", hint="keep one of them")
        self.output = Output(name, units or "")

    def _text(self, function: str, tree: ir.Expression) -> str:
        value = tree.value if isinstance(tree, ir.Text | ir.Number) else None
        if isinstance(tree, Cell):
            value = self._workbook.content(tree).value
        text = as_text(value)
        if not text:
            raise FormulaError(f"{function} needs a text", hint="write it in quotes, or name a cell that holds one")
        return text

    def _take_draw(self, drawn: Drawn, number: int) -> ir.Expression:
        """Take the draw for an assumption, or for many; what stands in the formula instead of the call."""
        plan = self._plan(drawn, number)
        if drawn.grid is None:
            return self._shift(drawn, self._drawn_at(plan, drawn, str(number), (number, 0)))
        rows, columns = drawn.grid
        return ir.Array(
            tuple(
                tuple(
                    self._drawn_at(plan, drawn, f"{number}({r},{c})", (number, (r - 1) * columns + c))
                    for c in range(1, columns + 1)
                )
                for r in range(1, rows + 1)
            )
        )

    @staticmethod
    def _shift(drawn: Drawn, site: ir.Expression) -> ir.Expression:
        shift = drawn.properties.shift
        return site if shift is None else total(site, shift)

    def _drawn_at(self, plan: Assumption, drawn: Drawn, label: str, position: tuple[int, int]) -> Cell:
        site = InFormula.of(self.host, label)
        name = plan.name or str(site)
        self.draws[position] = _Draw(replace(plan, cell=site, name=name), drawn.properties.matrix)
        self._bases[site] = plan.base
        return site

    def _plan(self, drawn: Drawn, number: int) -> Assumption:
        """The assumption, but for its cell and for a name where it does not name itself.

        Raises:
            FormulaError: an argument cannot be used.
        """
        properties = drawn.properties
        parameters = {key: self._parameter(tree, f"{number} {key}") for key, tree in drawn.parameters.items()}
        data = self._data(drawn, number) if drawn.data else None
        lower, upper = self._cutoffs(drawn, number)
        numbers = {key: self._base_number(tree) for key, tree in drawn.parameters.items()}
        static = None if properties.static is None else self._base_number(properties.static)
        shift = 0.0 if properties.shift is None else self._base_number(properties.shift)
        if static is None:
            limits = tuple(None if limit is None else self._base_parameter(limit) for limit in (lower, upper))
            base = base_of(drawn.family, numbers, data, (lower, upper), limits, self._saved_number)
        else:
            base = None if shift is None else static - shift
        if properties.locked and base is None:
            hint = "add RiskStatic with the value to hold it at"
            raise FormulaError(f"{drawn.function} is locked, and its value is not known", hint=hint)
        self.idle += properties.idle
        return Assumption(
            name="" if properties.name is None else self._text("RiskName", properties.name),
            cell=self.host,
            distribution=drawn.family.name,
            parameters=parameters,
            row=self.host,
            base=base,
            lower_cutoff=lower,
            upper_cutoff=upper,
            units="" if properties.units is None else self._text("RiskUnits", properties.units),
            source=f"{drawn.function} in the cell{'' if properties.shift is None else ', before its shift'}",
            frozen=properties.locked,
            notes={"Call": drawn.text},
            own_family=None if drawn.family is FAMILIES[drawn.family.name] else drawn.family,
            data=data,
        )

    def _cutoffs(self, drawn: Drawn, number: int) -> tuple[Parameter | None, Parameter | None]:
        properties = drawn.properties
        if properties.percents is not None:
            numbers = {key: number_of(tree, self._constant) for key, tree in drawn.parameters.items()}
            return percentile_cutoffs(drawn, numbers, properties.percents)
        found: list[Parameter | None] = []
        for key, tree in (("low cutoff", properties.lower), ("high cutoff", properties.upper)):
            if tree is not None and properties.shifted_cutoffs and properties.shift is not None:
                tree = difference(tree, properties.shift)
            found.append(None if tree is None else self._parameter(tree, f"{number} {key}"))
        if drawn.data and not (drawn.family.data and drawn.family.data.truncates) and found != [None, None]:
            raise FormulaError(f"{drawn.function} cannot be cut off", hint="leave out what lies beyond the cutoff")
        return found[0], found[1]

    def _parameter(self, tree: ir.Expression, label: str) -> Parameter:
        """A number, a cell, or a new cell that holds the expression."""
        number = number_of(tree)
        if number is not None:
            return number
        if isinstance(tree, Cell):
            return tree
        if is_bound(tree):
            hint = "put what it stands for into a cell of its own"
            raise FormulaError("an argument of a draw uses a name that LET binds", hint=hint)
        site = InFormula.of(self.host, label)
        self.trees[site] = tree
        return site

    def _data(self, drawn: Drawn, number: int) -> DataRange:
        rows = tuple(
            tuple(self._element(tree, f"{number} {r},{c}") for c, tree in enumerate(row, start=1))
            for r, row in enumerate(drawn.data, start=1)
        )
        area = next((source for source in drawn.sources if isinstance(source, Area)), None)
        own = Area(self.host.sheet, self.host.row, self.host.column, self.host.row, self.host.column)
        text = ", ".join(formula_text(source) for source in drawn.sources)
        return DataRange(area or own, rows, text=text)

    def _element(self, tree: ir.Expression, label: str) -> Parameter | None:
        if isinstance(tree, Cell) and tree not in self._bases and not self._computed.at_all(tree):
            content = self._workbook.content(tree)
            return None if is_blank(content) else number_in("The data cell", content, tree)
        return self._parameter(tree, label)

    def _base_number(self, tree: ir.Expression) -> float | None:
        """What a tree is in the base case, as far as the file says."""
        return number_of(tree, self._saved_number)

    def _base_parameter(self, parameter: Parameter) -> float | None:
        if isinstance(parameter, Cell):
            return self._base_number(self.trees.get(parameter, parameter))
        return parameter

    def _saved_number(self, cell: Cell) -> float | None:
        if cell in self.trees:
            return self._base_number(self.trees[cell])
        return self._bases[cell] if cell in self._bases else static_value(cell, self._workbook)

    def _constant(self, cell: Cell) -> float | None:
        """What a cell holds that nothing changes."""
        return None if cell in self._bases or self._computed.at_all(cell) else static_value(cell, self._workbook)


def _draws(tree: ir.Expression) -> bool:
    """Whether a tree holds a call that draws, or belongs to Crystal Ball or @RISK and shows no result."""
    found: list[ir.Expression] = []

    def look(part: ir.Expression) -> None:
        if _is_draw_of_a_program(part) or random_draw(part) is not None:
            found.append(part)

    substitute(tree, look)
    return bool(found)


def _is_draw_of_a_program(part: ir.Expression) -> bool:
    if not isinstance(part, ir.Call) or not part.name.startswith(("RISK", "CB.")):
        return False
    return not (is_result(part) or is_property(part) or not_computed(part))


def _refuse_calls_within(tree: ir.Lambda) -> None:
    """A call in a LAMBDA would draw as often as the LAMBDA is called."""
    if _draws(tree.body):
        raise FormulaError("a LAMBDA draws at random", hint="draw in cells of their own, and give these to the LAMBDA")
