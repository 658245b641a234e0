"""Spearman rank correlations between assumptions: the rows of `xlmc_correlations`, and square tables of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Correlation, Parameter
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import Row, parameter, required_text, rows_of, static_value
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key

__all__ = ["read_correlations"]

_KNOWN = ("First", "Second", "Correlation")

_Pairs = dict[frozenset[str], Cell]


def read_correlations(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    matrices: Iterable[DefinitionTable],
    names: Mapping[str, str],
    frozen: Iterable[str],
    findings: Findings,
) -> tuple[Correlation, ...]:
    """Return the correlations without a mistake, in the order of the rows, those of frozen assumptions left out.

    Args:
        workbook: where they are read.
        tables: the lists of pairs.
        matrices: the square tables: names in the first column, the same names as headings.
        names: every assumption, also one with a mistake of its own: name key -> name as defined.
        frozen: the names of assumptions that do not vary.
        findings: takes mistakes and remarks.
    """
    frozen_names, pairs = frozenset(frozen), _Pairs()
    rows = rows_of(workbook, tables, _KNOWN, _KNOWN, findings)
    result = [_correlation(row, names, frozen_names, pairs, findings) for row in rows]
    for matrix in matrices:
        result += _of_matrix(workbook, matrix, names, frozen_names, pairs, findings)
    return tuple(each for each in result if each is not None)


def _of_matrix(
    workbook: Workbook,
    matrix: DefinitionTable,
    names: Mapping[str, str],
    frozen: frozenset[str],
    pairs: _Pairs,
    findings: Findings,
) -> Iterator[Correlation]:
    """Yield the correlations of a square table; either half of it may be blank."""
    first, *headings = matrix.columns.values()
    columns = {
        column: findings.attempt(_named, names, heading, matrix.heading_cell(column)) for heading, column in headings
    }
    values: dict[frozenset[str], tuple[Parameter, Cell]] = {}
    seen: dict[str, Cell] = {}
    for row in rows_of(workbook, [matrix], (), [heading for heading, _ in matrix.columns.values()], findings):
        name = findings.attempt(_assumption_named, row, first[0], names)
        if name is not None and seen.setdefault(name, row.where) != row.where:
            findings.problem(f"Two rows are named {name!r}, this one and {seen[name]}", row.where, "Correct one name")
            continue
        for (heading, _), other in zip(headings, columns.values(), strict=True):
            if name is None or other is None or not row.filled(heading):
                continue
            value, where = findings.attempt(_coefficient, row, heading), row.cell(heading)
            if value is None:
                continue
            if name == other:
                if static_value(value, workbook) not in (1.0, None):
                    message = f"The correlation of {name!r} with itself is 1"
                    findings.problem(message, where, "Type 1, or clear the cell")
                continue
            pair = frozenset((name, other))
            if pair not in values:
                values[pair] = value, where
            elif static_value(values[pair][0], workbook) != static_value(value, workbook):
                message = f"The matrix gives {name!r} and {other!r} two correlations, here and in {values[pair][1]}"
                findings.problem(message, where, "Correct one of them, or clear one half of the matrix")
    for pair, (value, where) in values.items():
        if pair in pairs:
            one, other = sorted(pair)
            message = f"{one!r} and {other!r} are correlated here and in {pairs[pair]}"
            findings.problem(message, where, "Clear one of them")
        elif not pair & frozen and value != 0.0:
            pairs[pair] = where
            one, other = sorted(pair, key=[*names.values()].index)
            yield Correlation(one, other, value, where)


def _named(names: Mapping[str, str], typed: str, where: Cell) -> str:
    """Return the assumption's name as defined.

    Raises:
        DefinitionError: there is no such assumption.
    """
    if name_key(typed) in names:
        return names[name_key(typed)]
    hint = did_you_mean(typed, names.values()) if names else "Define the assumption in the table xlmc_assumptions"
    raise DefinitionError(f"There is no assumption {typed!r}", where=where, hint=hint)


def _correlation(
    row: Row, names: Mapping[str, str], frozen: frozenset[str], pairs: _Pairs, findings: Findings
) -> Correlation | None:
    first = findings.attempt(_assumption_named, row, "First", names)
    second = findings.attempt(_assumption_named, row, "Second", names)
    value = findings.attempt(_coefficient, row)
    if first is None or second is None or findings.attempt(_take_pair, row, first, second, pairs) is None:
        return None
    frozen_names = [name for name in (first, second) if name in frozen]
    if frozen_names:
        findings.notice(f"{frozen_names[0]!r} is frozen, so this correlation has no effect", row.where)
    return None if frozen_names or value is None else Correlation(first, second, value, row.where)


def _assumption_named(row: Row, heading: str, names: Mapping[str, str]) -> str:
    """Return the assumption's name as defined.

    Raises:
        DefinitionError: there is no such assumption.
    """
    return _named(names, required_text(row, heading), row.cell(heading))


def _coefficient(row: Row, heading: str = "Correlation") -> Parameter:
    value = parameter(row, heading, "Correlation")  # the columns of a matrix are called by names
    where = row.cell(heading)
    if value is None:
        raise DefinitionError("Correlation is blank", where=where, hint="Type a number from -1 to 1")
    known = static_value(value, row.workbook)
    if known is not None and not -1 <= known <= 1:
        message = f"Correlation ({show(known)}) must lie between -1 and 1"
        raise DefinitionError(message, where=where, hint="Type a rank correlation from -1 to 1")
    return value


def _take_pair(row: Row, first: str, second: str, pairs: _Pairs) -> bool:
    """Take the pair for this row, whichever comes first.

    Raises:
        DefinitionError: both are one assumption, or another row has the pair.
    """
    pair = frozenset((first, second))
    if len(pair) == 1:
        message = f"{first!r} is correlated with itself"
        raise DefinitionError(message, where=row.cell("Second"), hint="Name two different assumptions")
    if pair in pairs:
        message = f"Two rows correlate {first!r} and {second!r}, this one and {pairs[pair]}"
        raise DefinitionError(message, where=row.where, hint="Keep one of them")
    pairs[pair] = row.where
    return True
