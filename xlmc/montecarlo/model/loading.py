"""Read a workbook and build its model; look whether its filters can be ones.

The cell of a filter without a limit must be a test, TRUE or FALSE, and what the cell computes to says whether it is. It
is computed, not read: a file may hold no saved values, or stale ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from xlmc.engine.engine import TEXT_RESULT, Column, Target
from xlmc.engine.engines import ENGINES
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.errors import DefinitionError, DefinitionsError, Notice, SimulationError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.own_functions import OwnFunctions
from xlmc.excel.workbook.lazy_sheets import with_values
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.definitions.definitions_reader import NO_SWITCHES, read_definitions
from xlmc.montecarlo.definitions.feeds import Feed
from xlmc.montecarlo.definitions.number_styles import in_style
from xlmc.montecarlo.definitions.tables.filters import LIMIT_HINT
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.model.joining import joined
from xlmc.montecarlo.model.labels import calculate_labels
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import filter_limits
from xlmc.montecarlo.model.plain_words import list_of

__all__ = ["build_model", "fed", "filter_faults", "load", "model_with_values"]

_DASHES: Final = ("–", "—", "-")
"""What the cell of a forecast holds that waits for inputs."""

_DRAWN: Final = 64
"""Trials that are looked at beside the base case, in which a quantity may happen to be 0 or 1."""


def load(path: str | Path, feeds: Sequence[Feed] = (), functions: OwnFunctions | None = None) -> CompiledModel:
    """Read a workbook and compile what its forecasts and filters need.

    Args:
        path: of the workbook.
        feeds: which of its assumptions take answers of other workbooks, which are read, too.
        functions: a person's own, which formulas of all these workbooks may call.

    Raises:
        WorkbookError: a file cannot be read.
        SimulationError: the workbooks cannot be joined.
        DefinitionError, FormulaError: as for `build_model`.
    """
    return fed(build_model(read_workbook(path, functions=functions), Path(path)), feeds)


def fed(model: CompiledModel, feeds: Sequence[Feed]) -> CompiledModel:
    """Make the model fed by other workbooks, which are read; itself where there are no feeds.

    Raises:
        WorkbookError, SimulationError, DefinitionError, FormulaError: as for `load`.
    """
    if not feeds:
        return model
    paths: dict[str, Path] = {}
    for feed in feeds:
        source = Path(feed.source)
        if source.resolve() == model.path.resolve():
            message = "this is the workbook that is run, and it cannot feed itself, nor one that feeds it"
            hint = "run the workbook at the end of the chain, or compute the answer where it is needed"
            raise SimulationError(message, where=feed.file, hint=hint)
        if paths.setdefault(feed.file, source).resolve() != source.resolve():
            message = f"two of the workbooks are called {feed.file!r}"
            raise SimulationError(message, where=feed.file, hint="rename one of the files")
    functions = model.workbook.functions
    return joined(model, feeds, {name: load(source, functions=functions) for name, source in paths.items()})


def model_with_values(
    model: CompiledModel,
    values: Mapping[Cell, CellValue],
    tabulated: int = 1,
    switched: Mapping[str, bool] = NO_SWITCHES,
) -> CompiledModel:
    """Make the model of a workbook with values typed into its cells, which is fed as the first one is.

    Args:
        model: of the workbook as it is.
        values: cell -> what is typed into it; those of workbooks that feed it stay as they are.
        tabulated: as for `build_model`.
        switched: as for `build_model`; rows of workbooks that feed it stay as they are.

    Raises:
        DefinitionError, FormulaError, SimulationError: as for `load`.
    """
    feeding = model.definitions.feeding
    if feeding is None:
        book = with_values(model.workbook, values)
        return build_model(book, model.path, tabulated, switched, model.definitions.python)
    own = {cell: value for cell, value in values.items() if cell.sheet in feeding.first.sheets}
    alone = build_model(with_values(feeding.first, own), model.path, tabulated, switched)
    sources = {name: build_model(book, Path(name)) for name, book in feeding.sources.items()}
    return joined(alone, feeding.feeds, sources)


def build_model(
    workbook: Workbook,
    path: Path,
    tabulated: int = 1,
    switched: Mapping[str, bool] = NO_SWITCHES,
    python: Mapping[Cell, ir.Expression] | None = None,
) -> CompiledModel:
    """Make the model of a workbook that was read.

    Args:
        workbook: that was read.
        path: where it is.
        tabulated: which of its values every `RiskSimtable` gives, from 1.
        switched: see `read_definitions`.
        python: the cells that a function of Python computes, each with the call; None for none.

    Raises:
        DefinitionError: a definition is not what it must be; all faulty ones are listed.
        FormulaError: a needed cell cannot be computed.
    """
    workbook = calculate_labels(workbook)
    definitions = read_definitions(workbook, ENGINES, tabulated, switched, python)
    if definitions.problems:
        raise _joined(definitions.problems)
    with in_style(definitions.settings.number_style):
        model = _without_dashes(CompiledModel(workbook, definitions, path))
        if faults := filter_faults(model):
            raise _joined(faults)
    return model


def _without_dashes(model: CompiledModel) -> CompiledModel:
    """Return the model without the forecasts whose cells are a dash in every trial, as they wait for inputs.

    One of which nothing else is asked stays, so that it is reported.
    """
    known = {each.name: model.lowering.known(Target(each.cell, each.cell)) for each in model.forecasts}
    waiting = {name for name, value in known.items() if value is not None and value.objects().ravel()[0] in _DASHES}
    if not waiting or len(waiting) == len(model.forecasts):
        return model
    definitions = model.definitions
    left = tuple(each for each in definitions.forecasts if each.name not in waiting)
    message = f"forecasts whose cells are a dash, and which wait for inputs: {list_of([*map(repr, sorted(waiting))])}"
    first = next(each for each in definitions.forecasts if each.name in waiting)
    notices = (*definitions.notices, Notice(message, first.row))
    filters = tuple(
        replace(each, only_for=tuple(name for name in each.only_for if name not in waiting))
        for each in definitions.forecast_filters
        if not waiting.issuperset(each.only_for)
    )
    changed = replace(definitions, forecasts=left, forecast_filters=filters, notices=notices)
    return model.changed(model.workbook, changed)


def _joined(problems: Sequence[DefinitionError]) -> DefinitionError:
    lines = dict.fromkeys(map(str, problems))  # a column is found faulty in each of its rows
    return problems[0] if len(lines) == 1 else DefinitionsError("\n".join(lines))


def filter_faults(model: CompiledModel) -> list[DefinitionError]:
    """Return the filters whose cells are no tests, each with its cell: a quantity without a limit, a text.

    The base case is looked at, where there is one; then, for quantities, some trials.
    """
    every = (*model.filters, *model.forecast_filters)
    rows = [each for each in every if each.evidence is None or filter_limits(each)]
    filters = [each for each in rows if not filter_limits(each) or _may_be_text(model, each)]
    if not filters:
        return []
    targets = [target for each in filters for target in (Target(each.cell, each.cell), _length(each))]
    drawn = frozenset(a.name for a in model.live)
    evaluator = NumpyProgram.of(model.lowering, targets, [], drawn).evaluator(_DRAWN)
    base = {name: np.full(1, np.nan if base is None else base) for name, base in model.bases.items()}
    base |= model.certain(1)
    result = dict(_faults(filters, evaluator.filters(base, 1), "at the base case", texts=True))
    if any(not filter_limits(each) and each.cell not in result for each in filters):
        columns = evaluator.filters(model.sampler(0, _DRAWN).draw(0), _DRAWN)
        result = {**dict(_faults(filters, columns, "in a trial", texts=False)), **result}
    return [result[each.cell] for each in filters if each.cell in result]


def _may_be_text(model: CompiledModel, filter_: Filter) -> bool:
    """Whether the file does not say that the cell holds a number."""
    saved = model.workbook.content(filter_.cell).value
    return saved is None or isinstance(saved, str)


def _length(filter_: Filter) -> Target:
    """How many characters its cell has; what stands for nothing, `=IF(A1>0,A1,"")`, is no mistake."""
    return Target(ir.Call("LEN", (filter_.cell,)), filter_.cell)


def _faults(
    filters: Sequence[Filter], columns: Sequence[Column], when: str, *, texts: bool
) -> Iterator[tuple[Cell, DefinitionError]]:
    """Return the cell of each filter that is no test, and the message.

    Args:
        filters: those that are looked at.
        columns: the value of each one's cell, and the length of that.
        when: in words.
        texts: whether a text is a mistake.
    """
    for filter_, column, length in zip(filters, columns[::2], columns[1::2], strict=True):
        codes = np.zeros(column.values.size, np.uint8) if column.codes is None else column.codes
        numbers = np.asarray(column.values, np.float64)
        quantities = numbers[(codes == 0) & (numbers != 0.0) & (numbers != 1.0)]
        if texts and np.any((codes == TEXT_RESULT) & (np.asarray(length.values, np.float64) > 0)):
            message = f"The cell of the filter {filter_.name!r} is a text {when}"
        elif quantities.size and not filter_limits(filter_):
            shown = f"{show(float(quantities[0]))} {when}"
            message = f"The filter {filter_.name!r} has no limit, and its cell is {shown}, neither TRUE nor FALSE"
        else:
            continue
        yield filter_.cell, DefinitionError(message, where=filter_.cell, hint=LIMIT_HINT)
