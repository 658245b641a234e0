"""The rows of `xlmc_assumptions`: uncertain inputs, each cell read and the rules of its distribution checked."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.cell_references import cell_of_reference, formula_at
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Parameter
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.stating import Uncertainty
from xlmc.montecarlo.definitions.tables.data import OPTIONS, cached_data_family, given_data, refuse_options
from xlmc.montecarlo.definitions.tables.identity import Claims, identify
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import (
    Row,
    logical,
    number_in,
    optional_text,
    parameter,
    required_text,
    rows_of,
    static_value,
    word_in,
)
from xlmc.montecarlo.distributions import FAMILIES, Family, ParameterSpec, family_named
from xlmc.montecarlo.distributions.by_moments import COV, COV_SHARE, by_moments
from xlmc.montecarlo.distributions.by_percentiles import by_percentiles
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, MEAN, STD_DEV, show
from xlmc.montecarlo.distributions.spelling import name_key, nearest, plain
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["PARAMETERS", "UNCERTAINTY", "is_percentile", "read_assumptions"]

_OURS = (heading for family in FAMILIES.values() for spec in family.parameters for heading in spec.headings)

PLUS_MINUS = ("±", "+/-", "Plus minus")
"""Columns of a distance on both sides of the cell's own value."""

PLUS_MINUS_PERCENT = ("± %", "+/- %", "Plus minus %")
"""The same in percent of that value."""

_FURTHER = (*COV.headings, *COV_SHARE.headings, *PLUS_MINUS, *PLUS_MINUS_PERCENT)

PARAMETERS = tuple(dict.fromkeys((*_OURS, "Data", *_FURTHER)))
"""Every column that means a parameter of some distribution, beside percentiles: filled in, it is no note."""

UNCERTAINTY = "Kind of uncertainty"
"""The column that says whether an assumption varies from lack of knowledge or by scatter."""

STREAM = "Random stream"
"""The column that names the stream of an assumption's random numbers, where that is not its own name."""

_LIMITS = frozenset({"low", "minimum", "min", "high", "maximum", "max"})

_FIXED = (
    "Name",
    "Value",
    "Cell",
    "Distribution",
    *CUTOFFS.values(),
    "Units",
    "Source",
    "Frozen",
    UNCERTAINTY,
    "Call in",
    "Call",
    STREAM,
)
_KNOWN = (*_FIXED, *PARAMETERS, *OPTIONS)

_SLIP = 0.7  # likeness above which a column may be meant for one that a distribution needs

_CHOOSE = "Choose one under Distribution, such as Normal or Lognormal"

_HEADING = re.compile(r"p(\d{1,3}(?:\.\d+)?)")


def read_assumptions(
    workbook: Workbook, tables: Iterable[DefinitionTable], computed: Computed, claims: Claims, findings: Findings
) -> tuple[Assumption, ...]:
    """Return the assumptions without a mistake, in the order of the rows.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells have formulas; an assumption must not.
        claims: takes their names and cells.
        findings: takes mistakes and remarks.
    """
    tables = tuple(tables)
    percentiles = (written for table in tables for written, _ in table.columns.values() if is_percentile(written))
    known = (*_KNOWN, *percentiles)
    rows = rows_of(workbook, tables, ("Name",), known, findings)
    result = []
    for row in rows:
        with findings.recording():
            if not _waits(row):
                result.append(_assumption(row, known, computed, claims, findings))
    return tuple(filter(None, result))


def _waits(row: Row) -> bool:
    """Whether a row is ready and not used: Frozen, without a value to be held at, and without a parameter."""
    frozen = row.filled("Frozen") and row.has("Value") and not row.filled("Value") and logical(row, "Frozen")
    return bool(frozen) and _is_bare(row, _family(row))


def _is_bare(row: Row, family: Family) -> bool:
    """Whether a row has no parameter of its distribution, no cutoff and no data."""
    headings = {heading for spec in family.parameters for heading in spec.headings}
    return not any(map(row.filled, headings | {*CUTOFFS.values(), "Data"}))


def _assumption(
    row: Row, known: tuple[str, ...], computed: Computed, claims: Claims, findings: Findings
) -> Assumption | None:
    """Return the assumption of a row; None if the findings have a problem of it.

    Raises:
        DefinitionError: its numbers break a rule of its distribution.
    """
    before = len(findings.problems)
    call = findings.attempt(_call, row)
    identity = identify(row, claims, findings)
    frozen = findings.attempt(logical, row, "Frozen") or False
    before_cell = len(findings.problems)
    base = None if identity is None else findings.attempt(_base, row.workbook, computed, identity[1], frozen, findings)
    has_cell = identity is not None and len(findings.problems) == before_cell
    kind = findings.attempt(_family, row)
    given: dict[str, Parameter] = {}
    family = data = None
    if kind is not None:
        refuse_options(row, kind, findings)
        if frozen and base is not None and kind is FAMILIES["Uniform"] and _is_bare(row, kind):
            given = {"low": base, "high": base}  # held at its value, whatever its range would be
        elif any(map(row.filled, (*PLUS_MINUS, *PLUS_MINUS_PERCENT))):
            given = (findings.attempt(_around, row, kind, base, findings) or {}) if has_cell else {}
        else:
            given = _given(row, kind, findings)
        data = None if kind.data is None else findings.attempt(given_data, row, kind, computed, findings)
        family = kind if data is None else findings.attempt(cached_data_family, data, kind, row.workbook)
    uncertainty = findings.attempt(word_in, row, UNCERTAINTY, Uncertainty)
    units = findings.attempt(optional_text, row, "Units") or ""
    source = findings.attempt(optional_text, row, "Source") or ""
    stream = "" if identity is None else findings.attempt(_stream, row, identity[0], claims) or ""
    if len(findings.problems) > before or not (identity and kind):
        return None
    name, cell = identity
    checked = None if family is None else _checked(name, family, given, row)
    if call is not None:
        claims.take_call(call, name, cell)
    if checked is not None and not frozen:
        _remark_on_range(checked, row, base, cell, findings)
    return Assumption(
        name=name,
        cell=cell,
        distribution=kind.name,
        given=given,
        row=row.where,
        base=base,
        units=units,
        source=source,
        frozen=frozen,
        uncertain=uncertainty is Uncertainty.UNCERTAIN,
        notes=row.notes(known),
        own_family=None if family is FAMILIES[kind.name] else family,
        data=data,
        call=call,
        checked=checked,
        stream=stream,
    )


def _stream(row: Row, name: str, claims: Claims) -> str:
    """Return the name that a row's random numbers are drawn by, now taken; empty where it is the row's own.

    Raises:
        DefinitionError: another assumption has it.
    """
    typed = optional_text(row, STREAM) or ""
    if not typed or name_key(typed) == name_key(name):
        return ""
    if name_key(typed) in claims.names:
        message = f"The assumption {claims.names[name_key(typed)][0]!r} is drawn by the stream {typed!r}, too"
        hint = f"Clear {STREAM}, and the name of the row is that of its stream"
        raise DefinitionError(message, where=row.cell(STREAM), hint=hint)
    claims.names[name_key(typed)] = name, row.cell(STREAM)
    return typed


def _call(row: Row) -> InFormula | None:
    """Return the call of a formula that the row stands for; None if it stands for none.

    Raises:
        DefinitionError: the row says the cell of the call or its number alone, or has no Value.
    """
    if not (row.filled("Call in") or row.filled("Call")):
        return None
    missing = next((heading for heading in ("Value", "Call in", "Call") if not row.has(heading)), None)
    missing = missing or next((heading for heading in ("Call in", "Call") if not row.filled(heading)), None)
    if missing is not None:
        message = f"a row that replaces a call needs {missing}"
        hint = "Fill in Call in with the call's cell, such as =Model!B7, and Call with its number in the formula"
        raise DefinitionError(message, where=row.where, hint=hint)
    where, content = row.cell("Call in"), row.content("Call in")
    if content.formula is None:
        message = "Call in holds no formula"
        raise DefinitionError(message, where=where, hint="Write a formula that is one reference, such as =Model!B7")
    cell = cell_of_reference(row.workbook, formula_at(content.formula, where), where.sheet, where)
    return InFormula.of(cell, required_text(row, "Call"))


def _family(row: Row) -> Family:
    typed = optional_text(row, "Distribution")
    family = family_named(typed, where=row.cell("Distribution")) if typed else FAMILIES["Uniform"]
    result = _with_percentiles(row, family)
    return _with_moments(row, result, typed) if result is family else result


def _base(workbook: Workbook, computed: Computed, cell: Cell, frozen: bool, findings: Findings) -> float | None:
    """Return the assumption cell's own value; None, with a notice, where it is blank.

    Raises:
        DefinitionError: the cell holds a formula or anything but a number, or is blank and frozen.
    """
    content = workbook.content(cell)
    if computed.by_formula(cell):
        message = "The assumption cell holds a formula, which every draw would overwrite"
        raise DefinitionError(
            message, where=cell, hint="Replace the formula by its value (Copy, Paste Special ▸ Values)"
        )
    if not content.is_blank:
        return number_in("The assumption cell", content, cell)
    if frozen:
        message = "The assumption is frozen, and its cell is blank"
        raise DefinitionError(message, where=cell, hint="Type the value to hold it at")
    findings.notice("The assumption cell is blank, so there is no base case", cell)
    return None


def _given(row: Row, family: Family, findings: Findings) -> dict[str, Parameter]:
    """Read the family's parameters and the cutoffs in this row by key; every mistake is recorded on its own."""
    result: dict[str, Parameter] = {
        spec.key: spec.default
        for spec in family.parameters
        if spec.default is not None and not any(map(row.filled, spec.headings))
    }
    required = (spec for spec in family.parameters if spec.key not in result)
    headings = {spec.key: findings.attempt(_heading_of, row, family, spec) for spec in required}
    headings |= {key: heading for key, heading in CUTOFFS.items() if row.filled(heading)}
    for key, heading in headings.items():
        if heading is None:
            continue
        with findings.recording():
            if (value := parameter(row, heading)) is not None:
                result[key] = value
    _refuse_unused(row, family, findings)
    return result


def _cell_of(row: Row, family: Family, key: str) -> Cell:
    """Return the cell that gives a parameter or a cutoff; the row's first cell for one that is left to its default."""
    headings = next((spec.headings for spec in family.parameters if spec.key == key), (CUTOFFS.get(key, ""),))
    return next((row.cell(heading) for heading in headings if row.filled(heading)), row.where)


def _checked(name: str, family: Family, given: Mapping[str, Parameter], row: Row) -> Draw | None:
    """Check the rules of the family on the numbers as they are now, typed in or as Excel cached them.

    A run checks dynamic ones in every trial.

    Returns:
        How these are drawn; None if one is not known.

    Raises:
        DefinitionError: a rule is broken; it names the cell of the parameter to look at first.
    """
    numbers = {**given}
    for key, cell in given.items():
        if isinstance(cell, Cell):
            saved = static_value(cell, row.workbook)
            if saved is None:
                return None
            numbers[key] = saved
    draw = Draw.of(name, family, numbers)
    if (fault := draw.fault()) is not None:
        raise DefinitionError(fault.message, where=_cell_of(row, family, fault.key), hint=fault.hint)
    return draw


def _remark_on_range(draw: Draw, row: Row, base: float | None, cell: Cell, findings: Findings) -> None:
    """Point out what is allowed but may be a slip: a constant, a base case that could never be drawn.

    Args:
        draw: the assumption, by numbers.
        row: that defines it.
        base: the base case, if there is any.
        cell: of the assumption.
        findings: takes the remarks.
    """
    family, (low, high) = draw.family, map(float, draw.distribution.support())
    if low == high:
        both = "Low and High are both" if {"low", "high"} <= {*family.keys} else "Every draw is"
        where = _cell_of(row, family, family.keys[0]) if family.keys else cell
        findings.notice(f"{both} {show(low)}: the assumption does not vary", where)
    if base is not None and not low <= base <= high:
        reach = f"{show(low)} to {show(high)}"
        findings.notice(f"The base case ({show(base)}) lies outside the distribution ({reach})", cell)


def _heading_of(row: Row, family: Family, spec: ParameterSpec) -> str:
    """Return the one column that gives the parameter in this row.

    Raises:
        DefinitionError: none does, or two do.
    """
    filled = [heading for heading in spec.headings if row.filled(heading)]
    if len(filled) > 1:
        message = f"{spec.heading} is given twice, as {row.heading(filled[0])} and as {row.heading(filled[1])}"
        raise DefinitionError(message, where=row.cell(filled[1]), hint="Clear one of them")
    if filled:
        return filled[0]
    present = [heading for heading in spec.headings if row.has(heading)]
    name = _called(optional_text(row, "Distribution"), family)
    if present:
        message = f"{name} needs {row.heading(present[0])}, and this cell is blank"
        raise DefinitionError(message, where=row.cell(present[0]), hint="Type a number, or a formula that gives one")
    slip = next((each for each in row.headings if _is_slip_of(each, spec)), None)
    if slip is not None:
        message = f"The column {slip!r} is not read: did you mean {spec.heading}?"
        where = row.table.heading_cell(row.table.columns[plain(slip)][1])
        raise DefinitionError(message, where=where, hint=f"Rename the column {spec.heading}")
    message = f"{name} needs {spec.heading}, and the table has no such column"
    raise DefinitionError(message, where=row.where, hint=f"Add a column {spec.heading}")


def _is_slip_of(heading: str, spec: ParameterSpec) -> bool:
    """Whether a column that nobody reads may be meant for a parameter that the table lacks."""
    if plain(heading) in {plain(each) for each in _KNOWN} or is_percentile(heading):
        return False
    return nearest(heading, spec.headings, _SLIP) is not None


def _refuse_unused(row: Row, family: Family, findings: Findings) -> None:
    """Refuse a number that would be silently ignored: whoever gives a Normal a Low believes that it ends there."""
    used = {plain(heading) for spec in family.parameters for heading in spec.headings}
    used |= {plain("Data")} if family.data else set()
    for heading in (*PARAMETERS, *filter(is_percentile, row.headings)):
        if plain(heading) in used or not row.filled(heading):
            continue
        hint = "Clear the cell, or choose a distribution that has this parameter"
        if plain(heading) in _LIMITS:
            hint = "Clear the cell; to cut the distribution off, use Lower cutoff and Upper cutoff"
        name = _called(optional_text(row, "Distribution"), family)
        findings.problem(f"{name} has no {row.heading(heading)}", row.cell(heading), hint)


def _with_moments(row: Row, family: Family, typed: str) -> Family:
    """Return the family with the row's mean and spread instead of its parameters; itself where it has these.

    Raises:
        DefinitionError: they do not say which member is meant.
    """
    spreads = [(spec, each) for spec in (STD_DEV, COV, COV_SHARE) for each in spec.headings if row.filled(each)]
    means = [heading for heading in MEAN.headings if row.filled(heading)]
    if len(spreads) > 1:
        message = f"{row.heading(spreads[0][1])} and {row.heading(spreads[1][1])} are both given"
        raise DefinitionError(message, where=row.cell(spreads[1][1]), hint="Clear one of them")
    if not spreads or (spreads[0][0] is STD_DEV and STD_DEV.key in family.keys):
        return family
    spread, heading = spreads[0]
    if not means:
        if spread is STD_DEV:
            return family
        message = f"{row.heading(heading)} is given without a Mean, of which it is a part"
        raise DefinitionError(message, where=row.cell(heading), hint="Give Mean, too")
    if not typed:
        message = f"the row gives Mean and {row.heading(heading)}, and no Distribution"
        raise DefinitionError(message, where=row.where, hint=_CHOOSE)
    given = [spec.key for spec in family.parameters if any(map(row.filled, spec.headings))]
    try:
        return by_moments(family, given, spread)
    except ValueError as error:
        own = ", ".join(spec.heading for spec in family.parameters) or "Data"
        hint = f"{_called(typed, family)} is given by {own}"
        raise DefinitionError(str(error), where=row.cell(heading), hint=hint) from None


def _around(row: Row, family: Family, base: float | None, findings: Findings) -> dict[str, Parameter]:
    """Return the ends of a distribution that reaches as far below the cell's value as above it.

    Raises:
        DefinitionError: the family has no such ends, they are given, too, or there is no value or no distance.
    """
    filled = [heading for heading in (*PLUS_MINUS, *PLUS_MINUS_PERCENT) if row.filled(heading)]
    heading, where = row.heading(filled[0]), row.cell(filled[0])
    if len(filled) > 1:
        message = f"{heading} and {row.heading(filled[1])} are both given"
        raise DefinitionError(message, where=row.cell(filled[1]), hint="Clear one of them")
    if family.name not in ("Uniform", "Triangular", "BetaPERT"):
        hint = "Choose one of these, or clear the cell and give the distribution's own parameters"
        message = (
            f"{heading} says how far Uniform, Triangular and BetaPERT reach, and the distribution is {family.name}"
        )
        raise DefinitionError(message, where=where, hint=hint)
    if base is None:
        message = f"{heading} needs a value to reach from, and the assumption's cell is blank"
        raise DefinitionError(message, where=where, hint="Type the value into the assumption's cell")
    if row.content(filled[0]).formula is not None:
        hint = "Type the number, or give Low and High as formulas"
        raise DefinitionError(f"{heading} holds a formula", where=where, hint=hint)
    distance = number_in(heading, row.content(filled[0]), where)
    if filled[0] in PLUS_MINUS_PERCENT:
        if 0 < distance < 1:
            findings.notice(
                f"{heading} {show(distance)} is read as {show(distance)} %, not {show(100 * distance)} %", where
            )
        if base == 0.0:
            hint = "Give the distance itself under ±, or give Low and High"
            raise DefinitionError(f"{heading} of a value of 0 is no distance", where=where, hint=hint)
        distance *= abs(base) / 100
    if not distance > 0:
        raise DefinitionError(f"{heading} must be above 0", where=where, hint="Give a positive number")
    given: dict[str, Parameter] = {"low": base - distance, "high": base + distance}
    if "likeliest" in family.keys:
        given["likeliest"] = base
    own = [each for spec in family.parameters for each in spec.headings if row.filled(each)]
    if own:
        message = f"{heading} and {row.heading(own[0])} are both given"
        raise DefinitionError(message, where=row.cell(own[0]), hint="Clear one of them")
    for key, cutoff in CUTOFFS.items():
        if row.filled(cutoff) and (value := findings.attempt(parameter, row, cutoff)) is not None:
            given[key] = value
    return given


def _called(typed: str, family: Family) -> str:
    """Return what to call a family: as the person typed it, with xlmc's name where that is another."""
    return family.name if not typed or name_key(typed) == name_key(family.name) else f"{typed} ({family.name})"


def is_percentile(heading: str) -> bool:
    """Whether a column of that name holds percentiles."""
    return _HEADING.fullmatch(plain(heading)) is not None


def _with_percentiles(row: Row, family: Family) -> Family:
    """Return the family with the row's percentiles instead of the parameters that it leaves blank; itself without any.

    Raises:
        DefinitionError: the row has more or fewer percentiles than blank parameters, or one outside 0 to 100.
    """
    headings = [heading for heading in row.headings if is_percentile(heading) and row.filled(heading)]
    if not (headings and family.roles):
        return family
    if not row.filled("Distribution") and not any(map(row.filled, (*LOW.headings, *HIGH.headings))):
        message = f"the row gives {', '.join(map(row.heading, headings))}, and no Distribution"
        raise DefinitionError(message, where=row.where, hint=_CHOOSE)
    percents = [_percent(row, heading) for heading in headings]
    blank = [spec for spec in family.parameters if not any(row.filled(heading) for heading in spec.headings)]
    try:
        return by_percentiles(family, {*family.keys} - {spec.key for spec in blank}, percents)
    except ValueError:
        left = ", ".join(spec.heading for spec in blank) or "no parameter"
        message = f"{family.name} leaves {left} blank, and gives {', '.join(map(row.heading, headings))}"
        hint = "Give one percentile for each parameter that is left blank"
        raise DefinitionError(message, where=row.cell(headings[-1]), hint=hint) from None


def _percent(row: Row, heading: str) -> float:
    match = _HEADING.fullmatch(plain(heading))
    percent = float(match[1]) if match else 0.0
    if not 0 < percent < 100:
        message = f"{row.heading(heading)} is not a percentile"
        raise DefinitionError(message, where=row.cell(heading), hint="Percentiles lie above P0 and below P100")
    return percent
