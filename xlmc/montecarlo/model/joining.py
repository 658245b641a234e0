"""Workbooks whose answers feed assumptions of another one, joined to one model: every trial goes through all of them.

The cells of a workbook that feeds stand on sheets named as Excel names those of others, `[momentum.xlsx]Model`. Its
formulas were resolved among its own names and tables; here only the sheets of their cells are renamed. An
assumption that is fed becomes a formula, `='[momentum.xlsx]Model'!D31`. The filters of all workbooks hold. Assumptions
of one name are one assumption, drawn once, and must be defined alike.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any, Final, TypeVar

from xlmc.errors import DefinitionError, FormulaError, Notice, SimulationError
from xlmc.excel.address import Area, Cell, InFormula, host_of
from xlmc.excel.formula import ir
from xlmc.excel.formula.graph import BREAK
from xlmc.excel.formula.substitute import substitute
from xlmc.excel.workbook.lazy_sheets import with_cells
from xlmc.excel.workbook.workbook import CellContent, Formula, LinkedBook, Sheet, Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Check, Definitions, Filter, Forecast
from xlmc.montecarlo.definitions.feeds import Feed, Feeding
from xlmc.montecarlo.definitions.units import factor_between
from xlmc.montecarlo.distributions.spelling import by_names, did_you_mean, name_key
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["joined"]

_T = TypeVar("_T")

_OF_ONE_BOOK: Final = frozenset({"INDIRECT", "SHEET", "SHEETS", "CELL", "GETPIVOTDATA", "FORMULATEXT"})
"""Functions whose texts name cells of the workbook that they stand in."""

_KEPT_AS_THEY_ARE: Final = frozenset({"own_family", "checked"})
"""Fields of definitions without cells."""


def joined(model: CompiledModel, feeds: Sequence[Feed], sources: Mapping[str, CompiledModel]) -> CompiledModel:
    """Make the model with assumptions fed by answers of other workbooks.

    Args:
        model: of the workbook that is run; stays as it is.
        feeds: which assumption takes which answer.
        sources: file name -> the model of a workbook that feeds, by itself.

    Raises:
        SimulationError: there is no such assumption or answer, nothing needs the assumption, units are of two kinds, or
            workbooks cannot be joined.
        DefinitionError: assumptions of one name are defined in two ways.
        FormulaError: a cell cannot be computed in the joined model.
    """
    _refuse_names(model, sources)
    joining = _Joining(model, sources)
    for feed in feeds:
        joining.feed(feed)
    books = {name: source.workbook for name, source in sources.items()}
    definitions = replace(joining.definitions(), feeding=Feeding(tuple(feeds), model.workbook, books))
    try:
        return CompiledModel(joining.workbook(), definitions, model.path)
    except FormulaError as error:
        circle = _circle(feeds) if error.hint == BREAK else ()
        if not circle:
            raise
        message = f"the workbooks feed each other in a circle: {' → '.join((*circle, circle[0]))}"
        raise SimulationError(message, where=circle[0], hint="leave out one of the feeds between them") from error


def _circle(feeds: Sequence[Feed]) -> tuple[str, ...]:
    """Return the names of workbooks of which each feeds the next, and the last the first; none if there are none."""
    fed: dict[str, dict[str, None]] = {}
    names = {each.file.casefold(): each.file for each in feeds}
    for each in feeds:
        fed.setdefault(each.file.casefold(), {})[each.book.casefold()] = None

    def walk(path: tuple[str, ...]) -> tuple[str, ...]:
        for book in fed.get(path[-1], ()):
            result = path[path.index(book) :] if book in path else walk((*path, book))
            if result:
                return result
        return ()

    return tuple(names.get(each, each) for each in next(filter(None, (walk((each,)) for each in fed)), ()))


def _refuse_names(model: CompiledModel, sources: Mapping[str, CompiledModel]) -> None:
    names = [model.path.name, *sources]
    for name in names:
        if [each.casefold() for each in names].count(name.casefold()) > 1:
            message = f"two of the workbooks are called {name!r}"
            raise SimulationError(message, where=name, hint="rename one of the files")
        if name in sources and any(mark in name for mark in "[]"):
            raise SimulationError(f"the name {name!r} has brackets", where=name, hint="rename the file without them")


class _Joining:
    """The workbooks that are joined, and what has been found of them."""

    def __init__(self, model: CompiledModel, sources: Mapping[str, CompiledModel]) -> None:
        self._model = model
        self._books = {"": model, **sources}
        self._notices: list[Notice] = []
        self._fed: dict[tuple[str, str], tuple[Feed, Assumption, ir.Expression, str]] = {}
        for name, source in sources.items():
            _refuse_parts(source, name)
            if source.workbook.date1904 != model.workbook.date1904:
                message = f"dates of {name} and of {model.path.name} do not count from the same day"
                raise SimulationError(message, where=name, hint="set both to the 1900 date system, in Excel's options")

    def feed(self, feed: Feed) -> None:
        """Take a feed."""
        book = self._book(feed.book)
        target, source = self._books[book], self._books[self._book(feed.file)]
        label = book or target.path.name
        assumption = _named(feed.assumption, {"assumption": target.assumptions}, label)
        if isinstance(assumption.cell, InFormula):
            message = f"the assumption {assumption.name!r} is drawn by a call in a formula"
            raise SimulationError(message, where=assumption.row, hint="give it a cell and a row in xlmc_assumptions")
        if assumption.name in {each.name for each in target.needed.idle}:
            message = f"no forecast or filter needs the assumption {assumption.name!r}"
            raise SimulationError(message, where=assumption.cell, hint="feed one that the answers depend on")
        answer = _named(feed.answer, {"forecast": source.forecasts, "assumption": source.assumptions}, feed.file)
        factor = factor_between(answer.units, assumption.units)
        if factor is None:
            units = " and ".join(repr(each.units) if each.units else "no unit" for each in (assumption, answer))
            message = f"the assumption {assumption.name!r} and {answer.name!r} of {feed.file} have the units {units}"
            raise SimulationError(message, where=assumption.cell, hint="give both the same Units, or such as mph, km/h")
        cell = _in_book(answer.cell, feed.file)
        tree: ir.Expression = cell if factor == 1.0 else ir.Binary("*", cell, ir.Number(factor))
        text = str(cell) if factor == 1.0 else f"{cell}*{factor!r}"
        self._fed[book, name_key(assumption.name)] = (feed, assumption, tree, text)
        messages = f"{assumption.name!r} takes {answer.name!r} of {feed.file} in each trial"
        self._notices.append(Notice(messages, _in_book(assumption.cell, book)))

    def _book(self, name: str) -> str:
        """Return the key of a workbook that was named by its file name, or not at all.

        Raises:
            SimulationError: no workbook of the run is called so.
        """
        if name.casefold() in ("", self._model.path.name.casefold()):
            return ""
        text = next((each for each in self._books if each.casefold() == name.casefold()), None)
        if text is None:
            message = f"no workbook of this run is called {name!r}, so it cannot be fed"
            known = [self._model.path.name, *filter(None, self._books)]
            raise SimulationError(message, where=name, hint=did_you_mean(name, known))
        return text

    def definitions(self) -> Definitions:
        """Return what all workbooks ask for together."""
        own = self._model.definitions
        names = _Names((*own.filters, *own.forecast_filters, *own.evidence, *own.checks))
        parts = [self._left(own, "")]
        self._drawn = {name_key(a.names[-1]): ("", a) for a in parts[0].assumptions}
        self._called = {name_key(name) for a in parts[0].assumptions for name in a.names}
        self._tied = {frozenset((row.first, row.second)): row for row in parts[0].correlations}
        self._shared: dict[Cell, Cell] = {}
        for name, source in self._books.items():
            if name:
                parts.append(self._of_source(source, name, names))
        rewritten = dict(own.rewritten)
        for name, source in self._books.items():
            rewritten |= {_in_book(c, name): _tree_in_book(t, name) for c, t in source.trees.items()} if name else {}
        rewritten.update(self._shared)
        rewritten |= {_in_book(a.cell, book): tree for (book, _), (_, a, tree, _) in self._fed.items()}
        return replace(
            own,
            assumptions=_all(each.assumptions for each in parts),
            forecasts=(*own.forecasts, *self._fed_forecasts()),
            filters=_all(each.filters for each in parts),
            correlations=_all(each.correlations for each in parts),
            copulas=_all(each.copulas for each in parts),
            checks=_all(each.checks for each in parts),
            evidence=_all(each.evidence for each in parts),
            notices=(*_all(each.notices for each in parts), *self._notices),
            refused=_all(each.refused for each in parts),
            rewritten=rewritten,
        )

    def _left(self, definitions: Definitions, book: str) -> Definitions:
        """Return the definitions of a workbook without its assumptions that are fed.

        Raises:
            SimulationError: one of them is correlated.
        """
        fed = {assumption.name for (of, _), (_, assumption, _, _) in self._fed.items() if of == book}
        for row in definitions.correlations:
            if {row.first, row.second} & fed and row.value:
                both = f"{row.first!r} and {row.second!r} are correlated, and one of them is fed"
                raise SimulationError(both, where=_in_book(row.row, book), hint="leave the row out, or set it to 0")
        for copula in definitions.copulas:
            if fed & {*copula.names}:
                message = f"{', '.join(copula.names)} are drawn together, and one of them is fed"
                raise SimulationError(message, where=_in_book(copula.row, book), hint="leave the copula out")
        rows = tuple(row for row in definitions.correlations if not {row.first, row.second} & fed)
        left = tuple(a for a in definitions.assumptions if a.name not in fed)
        return replace(definitions, assumptions=left, correlations=rows)

    def _of_source(self, source: CompiledModel, book: str, names: _Names) -> Definitions:
        """Return what a workbook that feeds asks for, in terms of the joined one's cells and names."""
        definitions = self._left(source.definitions, book)
        own: list[Assumption] = []
        for each in definitions.assumptions:
            here = _definition_in_book(each, book)
            other = self._drawn.get(name_key(each.names[-1]))
            if other is None:
                if each.stream and name_key(each.name) in self._called:  # the label of another draw, too
                    here = replace(here, name=f"{each.name} ({book})")
                    each = replace(each, name=here.name)
                self._called |= {name_key(name) for name in here.names}
                self._drawn[name_key(each.names[-1])] = (book, each)
                own.append(here)
            else:
                self._share(here, each, book, other)
        spelt = {name_key(a.name): self._drawn[name_key(a.names[-1])][1].name for a in definitions.assumptions}
        asked = {name_key(feed.answer) for feed, _, _, _ in self._fed.values() if self._book(feed.file) == book}
        for_answers = [f for f in definitions.forecast_filters if asked & set(map(name_key, f.only_for))]
        filters = (*definitions.filters, *(replace(each, only_for=()) for each in for_answers))
        names_of = (
            [row.name for row in filters],
            [row.name for row in definitions.evidence],
            [row.name for row in definitions.checks],
        )
        rows = dict.fromkeys(name for kind in names_of for name in kind)
        renamed = {name: names.free(name, book) for name in rows}
        return replace(
            definitions,
            assumptions=tuple(own),
            filters=tuple(_renamed(_definition_in_book(each, book), renamed) for each in filters),
            checks=tuple(_renamed(_definition_in_book(each, book), renamed) for each in definitions.checks),
            evidence=tuple(_renamed(_definition_in_book(each, book), renamed) for each in definitions.evidence),
            correlations=tuple(self._ties(definitions, book, spelt)),
            copulas=tuple(
                replace(_definition_in_book(each, book), names=tuple(spelt[name_key(name)] for name in each.names))
                for each in definitions.copulas
            ),
            notices=tuple(_of_book(each, book) for each in definitions.notices),
            refused=(),
        )

    def _ties(self, definitions: Definitions, book: str, spelt: Mapping[str, str]) -> Iterator[Any]:
        """Its correlations, but for those that another workbook has, too.

        Raises:
            DefinitionError: two workbooks correlate the same assumptions in two ways.
        """
        for row in definitions.correlations:
            first, second = (spelt[name_key(name)] for name in (row.first, row.second))
            here = replace(_definition_in_book(row, book), first=first, second=second)
            other = self._tied.setdefault(frozenset((first, second)), here)
            if other is here:
                yield here
            elif other.value != here.value:
                message = f"{first!r} and {second!r} are correlated by {here.value} here"
                hint = f"and by {other.value} in {other.row}: give them one correlation"
                raise DefinitionError(message, where=here.row, hint=hint)

    def _share(self, here: Assumption, there: Assumption, book: str, other: tuple[str, Assumption]) -> None:
        """Draw an assumption once for two workbooks.

        Raises:
            DefinitionError: they define it in two ways.
        """
        whose, first = other
        if not _alike(first, there):
            of = whose or self._model.path.name
            message = f"the assumption {there.name!r} is defined otherwise in {of}, {_in_book(first.row, whose)}"
            hint = "inputs of one name are one input: give both the same distribution and units, or other names"
            raise DefinitionError(message, where=here.row, hint=hint)
        self._shared[here.cell] = _in_book(first.cell, whose)
        messages = f"{there.name!r} is the same input in {whose or self._model.path.name} and {book}, and is drawn once"
        self._notices.append(Notice(messages, here.cell))

    def _fed_forecasts(self) -> Iterator[Forecast]:
        """Return what the fed assumptions are, as answers of the run."""
        taken = {name_key(each.name) for each in self._model.forecasts}
        for (book, _), (_, assumption, _, _) in self._fed.items():
            name = assumption.name if name_key(assumption.name) not in taken else f"{assumption.name} (fed)"
            taken.add(name_key(name))
            yield Forecast(
                name, _in_book(assumption.cell, book), _in_book(assumption.row, book), units=assumption.units
            )

    def workbook(self) -> Workbook:
        """Return the workbook that is run, with formulas in the fed cells, and the others as those that it links to."""
        own = self._model.workbook
        formulas = {
            _in_book(a.cell, book): _formula(text, a.cell) for (book, _), (_, a, _, text) in self._fed.items()
        } | {cell: _formula(str(other), cell) for cell, other in self._shared.items()}
        links = dict(own.links)
        for name, source in self._books.items():
            if name:
                links[f"[{name}]"] = _linked(source, name, formulas)
        changed: dict[str, dict[tuple[int, int], CellContent]] = {}
        for cell, content in formulas.items():
            if cell.sheet in own.sheets:
                changed.setdefault(cell.sheet, {})[cell[1:]] = content
        return replace(own, sheets=with_cells(own.sheets, changed), links=links)


def _linked(source: CompiledModel, name: str, formulas: Mapping[Cell, CellContent]) -> LinkedBook:
    """Return the sheets of a workbook that its formulas or definitions read, under the names that they have in the
    other.
    """
    book = source.workbook
    read = {host_of(cell).sheet for cell in (*source.read, *source.trees, *(a.cell for a in source.assumptions))}
    result: dict[str, Sheet] = {}
    for each in sorted(read):
        sheet = book.sheet_of(Cell(each, 1, 1))
        if sheet is not None:
            moved = f"[{name}]{each}"
            new = {cell[1:]: content for cell, content in formulas.items() if cell.sheet == moved}
            result[moved] = replace(sheet, name=moved, cells={**sheet.cells, **new})
    return LinkedBook(name, result)


def _formula(text: str, cell: Cell) -> CellContent:
    return CellContent(None, Formula(text, cell.row, cell.column))


def _refuse_parts(source: CompiledModel, name: str) -> None:
    """Refuse a workbook with formulas that mean other cells when they stand in a joined one."""
    for cell, tree in source.trees.items():
        formula = source.workbook.content(host_of(cell)).formula
        many = formula is not None and formula.array is not None and formula.array.rows * formula.array.columns > 1
        called = [part.name for part in _parts(tree) if isinstance(part, ir.Call) and part.name in _OF_ONE_BOOK]
        solved = isinstance(tree, ir.Call) and tree.given is not None
        if many or (formula is None and not solved) or called:
            what = f"calls {called[0]}" if called else "fills several cells"
            message = f"the formula {what}, which a workbook that feeds another cannot do"
            raise SimulationError(message, where=_in_book(cell, name), hint="write it with plain references")
    if source.needed.graph.circles:
        cell = next(iter(source.needed.graph.circles))
        message = "cells of a workbook that feeds another need each other in a circle"
        raise SimulationError(message, where=_in_book(cell, name), hint="break the circle")


def _parts(tree: ir.Expression) -> list[ir.Expression]:
    result: list[ir.Expression] = []

    def look(part: ir.Expression) -> None:
        result.append(part)

    substitute(tree, look)
    return result


def _named(name: str, known: Mapping[str, Iterable[Any]], label: str) -> Any:
    """Return the definition of a name, of the first kind that has it.

    Raises:
        SimulationError: none has.
    """
    for kind in known.values():
        if (value := by_names(kind).get(name_key(name))) is not None:
            return value
    names = [each.name for each in next(iter(known.values()))]
    message = f"there is no {' or '.join(known)} {name!r}"
    raise SimulationError(message, where=label, hint=did_you_mean(name, names) if names else None)


def _alike(first: Assumption, second: Assumption) -> bool:
    """Whether two rows define one input."""
    if first.frozen != second.frozen or factor_between(first.units, second.units) != 1.0:
        return False
    if first.frozen:
        return first.base == second.base
    data = [None if each.data is None else (each.data.rows, each.data.cumulative) for each in (first, second)]
    if any(each.formulas or (each.data is not None and any(each.data.cells)) for each in (first, second)):
        return False
    return (first.distribution, dict(first.given), data[0]) == (second.distribution, dict(second.given), data[1])


class _Names:
    """Names of filters, evidence and checks that are taken."""

    def __init__(self, rows: Iterable[Filter | Check | Any]) -> None:
        self._taken = {name_key(row.name) for row in rows}

    def free(self, name: str, book: str) -> str:
        """Take the name, with the workbook where another one has it."""
        text = f"{name} ({book})" if name_key(name) in self._taken else name
        self._taken.add(name_key(text))
        return text


def _renamed(row: _T, names: Mapping[str, str]) -> _T:
    """Return a filter, check or item of evidence under its name in the joined model."""
    value: Any = row
    if isinstance(value, Filter) and value.evidence is not None:
        value = replace(value, evidence=replace(value.evidence, name=names[value.evidence.name]))
    renamed: _T = replace(value, name=names[value.name])
    return renamed


def _of_book(notice: Notice, book: str) -> Notice:
    where = notice.where
    return replace(
        notice, where=_in_book(where, book) if isinstance(where, Cell) else f"{book}: {where}" if where else book
    )


def _in_book(cell: Cell, book: str) -> Cell:
    """Return the cell on its sheet's name in the joined workbook: `[momentum.xlsx]Model`; itself for no book."""
    return type(cell)(f"[{book}]{cell.sheet}", cell.row, cell.column) if book else cell


def _tree_in_book(tree: ir.Expression | FormulaError, book: str) -> ir.Expression | FormulaError:
    if isinstance(tree, FormulaError):
        return tree

    def in_book(part: ir.Expression) -> ir.Expression | None:
        if isinstance(part, Cell):
            return _in_book(part, book)
        return replace(part, sheet=f"[{book}]{part.sheet}") if isinstance(part, Area) else None

    return substitute(tree, in_book)


def _definition_in_book(value: _T, book: str) -> _T:
    """Return a definition with all its cells in the joined workbook."""
    results: Any = value
    moved: Any = value
    if isinstance(results, Cell):
        moved = _in_book(results, book)
    elif isinstance(results, Area):
        moved = replace(results, sheet=f"[{book}]{results.sheet}")
    elif isinstance(results, tuple):
        moved = tuple(_definition_in_book(each, book) for each in results)
    elif isinstance(results, Mapping):
        moved = {key: _definition_in_book(each, book) for key, each in results.items()}
    elif is_dataclass(results) and not isinstance(results, type):
        names = [each.name for each in fields(results) if each.name not in _KEPT_AS_THEY_ARE]
        moved = replace(results, **{name: _definition_in_book(getattr(results, name), book) for name in names})
    result: _T = moved
    return result


def _all(parts: Iterable[Collection[_T]]) -> tuple[_T, ...]:
    return tuple(each for part in parts for each in part)
