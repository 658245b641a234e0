"""The calls of one cell, read as assumptions: cells of their own stand in the formula for each and for arguments."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, InFormula
from xlmc.excel.formula import Resolver, formula_text, ir
from xlmc.excel.formula.substitute import is_bound, substitute
from xlmc.excel.workbook.labels import Label, label_of
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, DataRange, Parameter
from xlmc.montecarlo.definitions.in_cells.call_arguments import difference, is_left_out, number_of, total
from xlmc.montecarlo.definitions.in_cells.call_draws import Drawn, Properties, base_of, built_family, percentile_cutoffs
from xlmc.montecarlo.definitions.in_cells.compound_calls import COMPOUND, compound_of
from xlmc.montecarlo.definitions.in_cells.constant_text import constant_text
from xlmc.montecarlo.definitions.in_cells.crystal_ball_functions import crystal_ball_draw
from xlmc.montecarlo.definitions.in_cells.other_programs import of_another_program, shows_its_result
from xlmc.montecarlo.definitions.in_cells.random_functions import INVERSES, may_be_many, random_draw
from xlmc.montecarlo.definitions.in_cells.result_functions import (
    NOT_COMPUTED,
    ResultCall,
    is_result,
    not_computed,
    result_call,
)
from xlmc.montecarlo.definitions.in_cells.risk_functions import risk_draw
from xlmc.montecarlo.definitions.in_cells.risk_properties import is_property, properties_of
from xlmc.montecarlo.definitions.in_cells.stand_ins import STAND_INS, stand_in, unsupported
from xlmc.montecarlo.definitions.in_cells.theory import THEORETICAL, Distribution, theoretical
from xlmc.montecarlo.definitions.tables.table_rows import number_in, static_value
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.sampling.draws import Draw

_THEORY: Final = {name.upper(): name for name in THEORETICAL}

__all__ = ["CellDraw", "CellReading", "Output"]


@dataclass(frozen=True, slots=True)
class Output:
    """What `RiskOutput` says: a name and units, where it gives them."""

    name: str | None
    units: str


@dataclass(frozen=True, slots=True)
class CellDraw:
    """A draw: the assumption, what its call says beside, and the coefficient of its `RiskDepC`."""

    assumption: Assumption
    properties: Properties
    coefficient: Parameter | None = None


class CellReading:
    """The calls of one cell.

    Attributes:
        host: the cell.
        draws: by their position in the formula.
        trees: of the arguments that are expressions, by the cells that stand for them.
        output, asked, idle, has_lognorm, taken: see `suspects.InCells`.
        simtables: the values of each `RiskSimtable`.
        shifted: the draws that are shifted, as cells -> with what is added.
        shown: the formula of a cell that shows results, or numbers of distributions, with these; None for another.
        unavailable: why it cannot show the results that it should show; empty where it can, or should show none.
    """

    def __init__(
        self,
        workbook: Workbook,
        computed: Computed,
        lognorm: str,
        bases: dict[Cell, float | None],
        host: Cell,
        rows: Mapping[Cell, Cell],
        tabulated: int = 1,
    ) -> None:
        self._workbook, self._computed, self._lognorm, self._bases = workbook, computed, lognorm, bases
        self.host, self._rows, self._tabulated = host, rows, tabulated
        self.taken: set[Cell] = set()
        self.draws: dict[tuple[int, int], CellDraw] = {}
        self.trees: dict[Cell, ir.Expression] = {}
        self.output: Output | None = None
        self.asked: list[ResultCall] = []
        self.unavailable = ""
        self.shown: ir.Expression | None = None
        self.idle: tuple[str, ...] = ()
        self.has_lognorm = False
        self.simtables: list[tuple[ir.Expression, ...]] = []
        self.shifted: dict[Cell, ir.Expression] = {}
        self._count = self._depth = 0
        self._has_theory = False

    def rewrite(self, tree: ir.Expression) -> ir.Expression:
        """Return the formula with assumptions instead of calls.

        Raises:
            FormulaError: a call is not supported or not what it must be, or shows results of the run.
        """
        self._refuse_other_programs(tree)
        known = substitute(tree, self._theory)
        self.shown = None if _draws(known) else known
        self._find_results(known)
        if not self._has_theory:
            self.shown = None
        return substitute(known, self._replacement)

    @cached_property
    def label(self) -> Label:
        """The name and the unit beside the cell."""
        return label_of(self._workbook, self.host)

    def draws_alone(self, tree: ir.Expression | FormulaError) -> bool:
        """Whether the rewritten formula is one draw, which it may shift, and nothing else."""
        return any(
            tree in (draw.assumption.cell, self.shifted.get(draw.assumption.cell)) for draw in self.draws.values()
        )

    def _refuse_other_programs(self, tree: ir.Expression) -> None:
        """Refuse a call of a program that xlmc does not read; a cell that shows a result of it can show none here.

        Raises:
            FormulaError: there is one.
        """

        def look(part: ir.Expression) -> None:
            if isinstance(part, ir.Call) and (error := of_another_program(part.name)) is not None:
                if shows_its_result(part.name):
                    self.unavailable = error.message
                raise error

        substitute(tree, look)

    def _theory(self, part: ir.Expression) -> ir.Expression | None:
        """Return the number that a function of a distribution itself is.

        Raises:
            FormulaError: its distribution is not known before the run.
        """
        if not isinstance(part, ir.Call) or part.name not in _THEORY:
            return None
        function, self._has_theory = _THEORY[part.name], True
        try:
            return ir.Number(self._theoretical(function, part.arguments))
        except FormulaError as error:
            self.unavailable = error.message
            raise

    def _theoretical(self, function: str, arguments: Sequence[ir.Expression]) -> float:
        count = THEORETICAL[function][0]
        if len(arguments) != count + 1:
            takes = "a distribution, or its cell" + ", and a number" * count
            raise FormulaError(f"{function} has {len(arguments)} arguments", hint=f"it takes {takes}")
        number = number_of(arguments[1], self._saved_number) if count else 0.0
        if number is None:
            raise FormulaError(f"{function} needs a number", hint="write it, or name a cell that holds one")
        return theoretical(function, self._distribution(function, arguments[0]), number)

    def _distribution(self, function: str, tree: ir.Expression) -> Distribution:
        """Return the distribution of the one draw that a call, or a cell's formula, holds."""
        if isinstance(tree, Cell):
            formula = self._workbook.content(tree).formula
            tree = tree if formula is None else Resolver(self._workbook).formula(tree, formula)
        calls = _drawing_calls(tree)
        inner = [call for call in calls if call.name == COMPOUND for call in _drawing_calls_in(call.arguments)]
        if len(calls) != 1 or any(_draws(each) for call in inner or calls for each in call.arguments):
            hint = "name a cell that holds one call such as RiskNormal(5,1), whose parameters are fixed"
            raise FormulaError(f"{function} needs one distribution whose numbers are known", hint=hint)
        (call,) = calls
        drawn = self._compound(call, 0) if call.name == COMPOUND else self._drawn(call)
        family = built_family(drawn, self._data(drawn, 0) if drawn.data else None, self._constant)
        numbers = {key: number_of(part, self._constant) for key, part in drawn.parameters.items()}
        shift = 0.0 if drawn.properties.shift is None else number_of(drawn.properties.shift, self._constant)
        limits = [None if each is None else self._number_of_cutoff(each) for each in self._cutoffs(drawn, 0)]
        known = {key: number for key, number in numbers.items() if number is not None}
        if len(known) < len(numbers) or shift is None:
            hint = "type its parameters as numbers, or into cells as numbers"
            raise FormulaError(f"{function} needs a distribution whose parameters are numbers", hint=hint)
        draw = Draw.of(function, family, known | {k: v for k, v in zip(CUTOFFS, limits, strict=True) if v is not None})
        if (fault := draw.fault()) is not None:
            raise FormulaError(f"{function}: {fault.message}", hint=fault.hint)
        return Distribution(draw.distribution, shift)

    def _number_of_cutoff(self, cutoff: Parameter) -> float:
        """Return a cutoff as a number; NaN, which is no distribution, where it is not known."""
        if not isinstance(cutoff, Cell):
            return cutoff
        value = number_of(self.trees.get(cutoff, cutoff), self._constant)
        return math.nan if value is None else value

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
        missing = [name for call in calls if (name := not_computed(call))]
        try:
            if missing and missing[0] not in NOT_COMPUTED:
                raise unsupported(missing[0].upper())
            if _draws(tree):
                hint = "show the result in a cell of its own"
                raise FormulaError("the formula both draws and shows results of the run", hint=hint)
            self.asked = [result_call(call) for call in calls if is_result(call)]
            if missing:
                raise FormulaError(f"{missing[0]} is not computed by xlmc", hint=unsupported(missing[0].upper()).hint)
        except FormulaError as error:
            self.unavailable = error.message
            raise

    def _replacement(self, part: ir.Expression) -> ir.Expression | None:
        if isinstance(part, ir.Lambda):
            _refuse_calls_within(part)
        drawn = random_draw(part)
        if drawn is not None and drawn.function in INVERSES and self._is_of_many(drawn):
            drawn = None  # one uniform number for all of its values: the formula goes on from that
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

    def _is_of_many(self, drawn: Drawn) -> bool:
        """Report whether a parameter of a draw may be an array: Excel then computes the function for each value."""
        formula = self._workbook.content(self.host).formula
        in_array = formula is not None and (formula.dynamic or formula.array is not None)
        return any(may_be_many(tree, in_array) for tree in drawn.parameters.values())

    def _program_call(self, call: ir.Call) -> ir.Expression:
        """Return what stands instead of a call of Crystal Ball or @RISK."""
        if call.name in STAND_INS:
            value, values = stand_in(call, self._tabulated)
            if values:
                self.simtables.append(values)
            return substitute(value, self._replacement)
        number = self._next()
        drawn = self._compound(call, number) if call.name == COMPOUND else self._drawn(call)
        return self._take_draw(replace(drawn, text=formula_text(call)), number)

    def _drawn(self, call: ir.Call) -> Drawn:
        """Return what a call draws whose arguments may draw, too."""
        rewritten = ir.Call(call.name, self._rewritten(call.arguments))
        drawn = crystal_ball_draw(rewritten) or risk_draw(rewritten, self._lognorm)
        if drawn is None:
            raise unsupported(call.name)
        return drawn

    def _rewritten(self, trees: Iterable[ir.Expression]) -> tuple[ir.Expression, ...]:
        """Return the arguments of a call with assumptions instead of the calls in them."""
        self._depth += 1
        expression = tuple(substitute(tree, self._replacement) for tree in trees)
        self._depth -= 1
        return expression

    def _compound(self, call: ir.Call, number: int) -> Drawn:
        """Return what `RiskCompound` draws; the draws within it are no assumptions of their own."""
        count = next((i for i, part in enumerate(call.arguments) if is_property(part)), len(call.arguments))
        if count < 2:
            raise FormulaError(
                f"RiskCompound has {count} arguments", hint="it takes a frequency and a severity at least"
            )
        frequency, severity, *ends = call.arguments[:count]
        properties = properties_of("RiskCompound", self._rewritten(call.arguments[count:]))
        return compound_of(
            self._inner(frequency),
            self._inner(self._formula_of(severity)),
            self._rewritten(ends),
            properties,
            lambda drawn: built_family(drawn, self._data(drawn, number) if drawn.data else None, self._constant),
            self._percent_trees,
        )

    def _inner(self, tree: ir.Expression) -> Drawn | ir.Expression:
        """Return what an argument of `RiskCompound` draws; the argument itself, rewritten, where it is a value."""
        if isinstance(tree, ir.Call) and _is_draw_of_a_program(tree) and tree.name != COMPOUND:
            drawn = self._drawn(tree)
            self.has_lognorm = self.has_lognorm or drawn.function == "RiskLognorm"
            return drawn
        (rewritten,) = self._rewritten([tree])
        return rewritten

    def _formula_of(self, severity: ir.Expression) -> ir.Expression:
        """Read the call in a cell that holds nothing else: its draws are made anew for each amount.

        Raises:
            FormulaError: it draws by a larger formula.
        """
        content = self._workbook.content(severity) if isinstance(severity, Cell) else None
        tree = severity
        if isinstance(severity, Cell) and content is not None and content.formula is not None:
            formula = Resolver(self._workbook).formula(severity, content.formula)
            tree = formula if _draws(formula) else severity
        if _draws(tree) and not (isinstance(tree, ir.Call) and _is_draw_of_a_program(tree)):
            where = f" ({severity})" if isinstance(severity, Cell) else ""
            hint = "let the severity be one distribution, and multiply or add to what RiskCompound gives"
            raise FormulaError(f"the severity of RiskCompound is a formula that draws{where}", hint=hint)
        return tree

    def _percent_trees(self, drawn: Drawn) -> tuple[ir.Expression | None, ir.Expression | None]:
        """Return the cutoffs of an inner draw that `RiskTruncateP` gives, as trees."""
        assert drawn.properties.percents is not None
        numbers = {key: number_of(tree, self._constant) for key, tree in drawn.parameters.items()}
        low, high = percentile_cutoffs(drawn, numbers, drawn.properties.percents)
        return _as_tree(low), _as_tree(high)

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
            elif index == 0 and not is_left_out(argument) and not is_property(argument):
                name = self._text("RiskOutput", argument)
        if self.output is not None:
            raise FormulaError("the formula has two RiskOutput", hint="keep one of them")
        self.output = Output(name, units or "")

    def _text(self, function: str, tree: ir.Expression) -> str:
        text = constant_text(self._workbook, tree, self.host)
        if not text:
            hint = "write it in quotes, or name cells that hold one and vary with no draw"
            raise FormulaError(f"{function} needs a text", hint=hint)
        return text

    def _take_draw(self, drawn: Drawn, number: int) -> ir.Expression:
        """Take the draw for an assumption, or for many; what stands in the formula instead of the call."""
        plan = self._plan(drawn, number)
        if drawn.grid is None:
            site = self._drawn_at(plan, drawn, str(number), (number, 0))
            if drawn.properties.shift is not None:
                self.shifted[site] = total(site, drawn.properties.shift)
            return self.shifted.get(site, site)
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

    def _drawn_at(self, plan: Assumption, drawn: Drawn, label: str, position: tuple[int, int]) -> Cell:
        site = InFormula.of(self.host, label)
        if site in self._rows:
            self.taken.add(site)
            return self._rows[site]
        self.has_lognorm = self.has_lognorm or drawn.function == "RiskLognorm"
        name = plan.name or str(site)
        partner = drawn.properties.partner
        asked = None if partner is None else partner.coefficient
        coefficient = None if asked is None else self._parameter(asked, f"{label} coefficient")
        self.draws[position] = CellDraw(replace(plan, cell=site, name=name), drawn.properties, coefficient)
        self._bases[site] = plan.base
        return site

    def _plan(self, drawn: Drawn, number: int) -> Assumption:
        """Return the assumption, but for its cell and for a name where it does not name itself.

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
        cutoffs = {key: limit for key, limit in zip(CUTOFFS, (lower, upper), strict=True) if limit is not None}
        return Assumption(
            name="" if properties.name is None else self._text("RiskName", properties.name),
            cell=self.host,
            distribution=drawn.family.name,
            given=parameters | cutoffs,
            row=self.host,
            base=base,
            units="" if properties.units is None else self._text("RiskUnits", properties.units),
            source=f"{drawn.function} in the cell{'' if properties.shift is None else ', before its shift'}",
            frozen=properties.locked,
            notes={"Call": drawn.text},
            own_family=None if drawn.family is FAMILIES.get(drawn.family.name) else drawn.family,
            data=data,
        )

    def _cutoffs(self, drawn: Drawn, number: int) -> tuple[Parameter | None, Parameter | None]:
        properties = drawn.properties
        if not drawn.family.truncates and (properties.percents or properties.lower or properties.upper):
            raise FormulaError(f"{drawn.function} cannot be cut off", hint="limit it by a formula: MIN, MAX or IF")
        if properties.percents is not None:
            numbers = {key: number_of(tree, self._constant) for key, tree in drawn.parameters.items()}
            return percentile_cutoffs(drawn, numbers, properties.percents)
        result: list[Parameter | None] = []
        for key, tree in (("low cutoff", properties.lower), ("high cutoff", properties.upper)):
            if tree is not None and properties.shifted_cutoffs and properties.shift is not None:
                tree = difference(tree, properties.shift)
            result.append(None if tree is None else self._parameter(tree, f"{number} {key}"))
        if drawn.data and not (drawn.family.data and drawn.family.data.truncates) and result != [None, None]:
            raise FormulaError(f"{drawn.function} cannot be cut off", hint="leave out what lies beyond the cutoff")
        return result[0], result[1]

    def _parameter(self, tree: ir.Expression, label: str) -> Parameter:
        """Return a number, a cell, or a new cell that holds the expression."""
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
            return None if content.is_blank else number_in("The data cell", content, tree)
        return self._parameter(tree, label)

    def _base_number(self, tree: ir.Expression) -> float | None:
        """Return what a tree is in the base case, as far as the file says."""
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
        """Return what a cell holds that nothing changes."""
        return None if cell in self._bases or self._computed.at_all(cell) else static_value(cell, self._workbook)


def _as_tree(parameter: Parameter | None) -> ir.Expression | None:
    return ir.Number(parameter) if isinstance(parameter, float) else parameter


def _draws(tree: ir.Expression) -> bool:
    """Whether a tree holds a call that draws, or belongs to Crystal Ball or @RISK and shows no result."""
    result: list[ir.Expression] = []

    def look(part: ir.Expression) -> None:
        if _is_draw_of_a_program(part) or random_draw(part) is not None:
            result.append(part)

    substitute(tree, look)
    return bool(result)


def _drawing_calls_in(trees: Iterable[ir.Expression]) -> list[ir.Call]:
    return [call for tree in trees for call in _drawing_calls(tree)]


def _drawing_calls(tree: ir.Expression) -> list[ir.Call]:
    """Yield the calls of Crystal Ball and @RISK that draw, the outermost ones."""
    calls: list[ir.Call] = []

    def look(part: ir.Expression) -> ir.Expression | None:
        if isinstance(part, ir.Call) and part.name not in STAND_INS and _is_draw_of_a_program(part):
            if part.name != "RISKOUTPUT":
                calls.append(part)
            return part
        return None

    substitute(tree, look)
    return calls


def _is_draw_of_a_program(part: ir.Expression) -> bool:
    if not isinstance(part, ir.Call) or not part.name.startswith(("RISK", "CB.")):
        return False
    return not (is_result(part) or is_property(part) or not_computed(part) or part.name in _THEORY)


def _refuse_calls_within(tree: ir.Lambda) -> None:
    """Refuse a call in a LAMBDA, which would draw as often as the LAMBDA is called."""
    if _draws(tree.body):
        raise FormulaError("a LAMBDA draws at random", hint="draw in cells of their own, and give these to the LAMBDA")
