"""The rows of `xlmc_correlations`: Spearman rank correlations between assumptions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

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
    names: Mapping[str, str],
    frozen: Iterable[str],
    findings: Findings,
) -> tuple[Correlation, ...]:
    """Return the correlations without a mistake, in the order of the rows, those of frozen assumptions left out.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        names: every assumption, also one with a mistake of its own: name key -> name as defined.
        frozen: the names of assumptions that do not vary.
        findings: takes mistakes and remarks.
    """
    frozen_names, pairs = frozenset(frozen), _Pairs()
    rows = rows_of(workbook, tables, _KNOWN, _KNOWN, findings)
    found = [_correlation(row, names, frozen_names, pairs, findings) for row in rows]
    return tuple(each for each in found if each is not None)


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
    typed = required_text(row, heading)
    if name_key(typed) in names:
        return names[name_key(typed)]
    hint = did_you_mean(typed, names.values()) if names else "Define the assumption in the table xlmc_assumptions"
    raise DefinitionError(f"There is no assumption {typed!r}", where=row.cell(heading), hint=hint)


def _coefficient(row: Row) -> Parameter:
    value = parameter(row, "Correlation")
    where = row.cell("Correlation")
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
