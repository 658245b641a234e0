"""`RiskCompound(frequency, severity, [deductible], [limit])`: what it draws, made of the draws within it.

The frequency is a call that draws, or a value of each trial. The severity is a call that draws, a cell whose formula is
one, which then draws anew for each amount, or a value of each trial. What @RISK says of an amount holds here: the
deductible is subtracted from it, at least 0 is left, and of that at most the limit counts.

Source: @RISK's manual, RiskCompound.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.in_cells.call_arguments import difference, is_left_out
from xlmc.montecarlo.definitions.in_cells.call_draws import Drawn, Properties
from xlmc.montecarlo.distributions import Family
from xlmc.montecarlo.distributions.compound import Compound, Part

__all__ = ["COMPOUND", "compound_of"]

COMPOUND = "RISKCOMPOUND"

_TAKES = "it takes a frequency, a severity and, if wanted, a deductible and a limit"

Cutoffs = tuple[ir.Expression | None, ir.Expression | None]


def compound_of(
    frequency: Drawn | ir.Expression,
    severity: Drawn | ir.Expression,
    ends: tuple[ir.Expression, ...],
    properties: Properties,
    built: Callable[[Drawn], Family],
    percents: Callable[[Drawn], Cutoffs],
) -> Drawn:
    """Return what the call draws.

    Args:
        frequency: what the number of amounts is drawn from, or its value.
        severity: the same of each amount.
        ends: deductible and limit, as far as given.
        properties: of the compound itself.
        built: the family of an inner draw, with its data.
        percents: the cutoffs of an inner draw that gives them as probabilities.

    Raises:
        FormulaError: it has a property that it cannot have.
    """
    if len(ends) > 2:
        raise FormulaError(f"RiskCompound has {len(ends) + 2} arguments", hint=_TAKES)
    if properties.matrix is not None or properties.copula is not None:
        hint = "give RiskCorrmat or RiskCopula to its frequency instead"
        raise FormulaError("RiskCompound itself cannot be correlated", hint=hint)
    trees: dict[str, ir.Expression] = {}
    count = _part("frequency", frequency, built, percents, trees)
    amount = _part("severity", severity, built, percents, trees)
    if isinstance(frequency, Drawn):
        properties = replace(properties, matrix=frequency.properties.matrix, copula=frequency.properties.copula)
    if isinstance(severity, Drawn) and (severity.properties.matrix or severity.properties.copula):
        hint = "take it out: the amounts of one draw are independent of each other and of everything else"
        raise FormulaError("the severity of RiskCompound cannot be correlated", hint=hint)
    given = {name: end for name, end in zip(("deductible", "limit"), ends, strict=False) if not is_left_out(end)}
    family = Compound(count, amount, "deductible" in given, "limit" in given)
    return Drawn("RiskCompound", family, trees | given, properties=properties)


def _part(
    name: str,
    part: Drawn | ir.Expression,
    built: Callable[[Drawn], Family],
    percents: Callable[[Drawn], Cutoffs],
    trees: dict[str, ir.Expression],
) -> Part:
    """One of the two, whose parameters are added to `trees`."""
    if not isinstance(part, Drawn):
        if is_left_out(part):
            raise FormulaError(f"RiskCompound leaves out its {name}", hint=_TAKES)
        trees[name] = part
        return Part(name)
    if part.grid is not None or part.properties.locked:
        hint = "take RiskLock out, or write the value instead of the distribution"
        raise FormulaError(f"the {name} of RiskCompound is locked", hint=hint)
    properties, family = part.properties, built(part)
    trees |= {f"{name} {key}": part.parameters[key] for key in family.keys if key in part.parameters}
    lower, upper = properties.lower, properties.upper
    if properties.percents is not None:
        lower, upper = percents(part)
    elif properties.shifted_cutoffs and properties.shift is not None:
        lower, upper = (None if end is None else difference(end, properties.shift) for end in (lower, upper))
    for key, tree in (("lower cutoff", lower), ("upper cutoff", upper), ("shift", properties.shift)):
        if tree is not None:
            trees[f"{name} {key}"] = tree
    return Part(name, family, lower is not None, upper is not None, properties.shift is not None)
