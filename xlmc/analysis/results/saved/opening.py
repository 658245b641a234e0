"""Open a saved run as the same `RunResult`, without simulating again."""

from __future__ import annotations

import hashlib
import json
import zipfile
from collections import Counter
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.saved.archive import AGAIN, DAMAGE, RUN, WORKBOOK, Package, open_package, read_column
from xlmc.analysis.results.saved.run_json import (
    FORMAT,
    VERSION,
    build,
    changed_from_of,
    counts,
    mapping,
    origin_of,
    rare_of,
    require,
    settings_of,
    stopped_of,
    tally_of,
    texts,
    whole,
)
from xlmc.errors import SimulationError, WorkbookError, XlmcError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.own_functions import OwnFunctions, the_same_functions
from xlmc.excel.workbook.package import LIMITS
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.columns import ColumnStore, parts
from xlmc.montecarlo.definitions.feeds import Feed
from xlmc.montecarlo.diagnostics.weighing import weighing
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.forecast_filters import filters_by_forecast
from xlmc.montecarlo.model.joining import joined
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["is_saved_run", "open_run", "refuse_other_function"]

_LARGEST_DOCUMENT: Final = 64 << 20
_TRIED: Final = 1_000
"""Accepted trials that show whether a function of Python is the one that was run."""

_KINDS: Final = {"trial": "<i8", "input": "<f8", "prior": "<f8", "forecast": "<f8"}

Document = Mapping[str, Any]
Column = NDArray[Any]
Python = Mapping[Cell, ir.Expression]


def is_saved_run(path: Path) -> bool:
    """Whether the file looks like a saved run, whatever its name."""
    if not path.is_file() or not zipfile.is_zipfile(path):
        return False
    try:
        with zipfile.ZipFile(path) as package:
            return RUN in package.namelist()
    except DAMAGE:
        return False


def open_run(path: str | Path, python: Python | None = None, functions: OwnFunctions | None = None) -> RunResult:
    """Open the run that was saved in a file, with the model of its workbook: every statistic is the same to the last
    bit.

    Columns go into memory, or, where they are large together, into temporary files.

    Args:
        path: of the file.
        python: the cells that a function of Python computes, each with the call; None for none.
        functions: those that the run's formulas called.

    Raises:
        WorkbookError: the file cannot be read, is no saved run, or is damaged; or these are not its functions.
        XlmcError: this xlmc refuses its workbook.
    """
    path = Path(path)
    with open_package(path) as package:
        result = _document(package, path)
        model = _model(package, result, path, python, _functions(result, functions, path))
        try:
            if settings_of(result["settings"]).evidence == "weights":
                model = weighing(model)
            columns = _Columns(result["columns"], model, path)
            columns.read(package)
            return _simulation(result, model, columns)
        except (KeyError, ValueError, SimulationError) as error:
            raise _damage_error(path, error) from error


def refuse_other_function(run: RunResult, path: str | Path) -> None:
    """Refuse a run that its model's function of Python did not compute, as the first accepted trials show.

    Raises:
        SimulationError: the function gives other numbers for their draws.
    """
    rows = slice(min(run.kept_inputs, _TRIED))
    draws = {name: np.array(column[rows]) for name, column in run.inputs.items()}
    if not draws or not rows.stop:
        return
    for name, values in run.model.function(draws).items():
        if name not in run.labels and not np.array_equal(values, run.forecasts[name][rows], equal_nan=True):
            message = f"the function gives other numbers as {name!r} than this run has"
            raise SimulationError(message, where=Path(path), hint="Give the model that was run")


def _document(package: Package, path: Path) -> Document:
    if package.size(RUN) > _LARGEST_DOCUMENT:
        raise WorkbookError(f"{RUN} in the saved run is larger than any that xlmc writes", where=path, hint=AGAIN)
    with package.reading(RUN) as entry:
        data = entry.read()
    try:
        result = mapping(json.loads(data), "its format")
        require(result.get("format") == FORMAT, "its format")
        whole(result.get("version"), "its version")
    except (ValueError, RecursionError) as error:
        raise _damage_error(path, error) from error
    if result["version"] != VERSION:
        message = f"the saved run is of version {result['version']}, and this xlmc reads version {VERSION}"
        raise WorkbookError(message, where=path, hint="Install the xlmc that it was saved with")
    return dict(result)


def _functions(result: Document, given: OwnFunctions | None, path: Path) -> OwnFunctions | None:
    """Return the functions that the run's formulas called; None where there were none."""
    if "functions" not in result:
        return None
    try:
        about = build(_Book, result["functions"], "its functions")
    except (KeyError, ValueError) as error:
        raise _damage_error(path, error) from error
    return the_same_functions(given, about.name, about.sha256, path)


def _model(
    package: Package, result: Document, path: Path, python: Python | None, functions: OwnFunctions | None
) -> CompiledModel:
    try:
        about = build(_Book, result["workbook"], "its workbook")
    except (KeyError, ValueError) as error:
        raise _damage_error(path, error) from error
    alone = _model_of(package, WORKBOOK, about, path, python, functions)
    if "feeds" not in result:
        return alone
    try:
        feeds = tuple(build(Feed, each, "its feeds") for each in result["feeds"])
        books = [build(_Book, each, "the workbooks that fed it") for each in result["fed_by"]]
        sources = {
            each.name: _model_of(package, f"fed/{n}", each, path, None, functions) for n, each in enumerate(books)
        }
        require({feed.source for feed in feeds} == sources.keys(), "the workbooks that fed it")
    except (KeyError, TypeError, ValueError) as error:
        raise _damage_error(path, error) from error
    return joined(alone, feeds, sources)


def _model_of(
    package: Package,
    entry: str,
    about: _Book,
    path: Path,
    python: Python | None,
    functions: OwnFunctions | None,
) -> CompiledModel:
    """Return the model of a workbook in the package.

    Raises:
        WorkbookError: it is not the one that was run.
    """
    name = Path(about.name).name
    if package.size(entry) > LIMITS.total:
        raise WorkbookError(f"the workbook in it is larger than {LIMITS.total >> 20} MB", where=path, hint=AGAIN)
    with package.reading(entry) as reader:
        data = reader.read()
    if hashlib.sha256(data).hexdigest() != about.sha256:
        raise WorkbookError("the workbook in the saved run is not the one that was run", where=path, hint=AGAIN)
    return build_model(read_workbook(data, name, functions), Path(name), python=python)


@dataclass(frozen=True, slots=True)
class _Book:
    """What the document says of the workbook."""

    name: str
    sha256: str


@dataclass(frozen=True, slots=True)
class _Column:
    """What the document says of a column."""

    kind: str
    name: str
    type: str
    count: int
    entry: str
    sha256: str


def _called(column: _Column, inputs: Mapping[str, str], forecasts: Mapping[str, str]) -> _Column:
    """Return a column under the name that its assumption or forecast has now: a run may be older than their labels."""
    named = inputs if column.kind in ("input", "prior") else forecasts if column.kind == "forecast" else {}
    return replace(column, name=named.get(column.name, column.name))


def _names_now(model: CompiledModel) -> dict[str, str]:
    """Name of a forecast, or its cell where none is called so -> its name."""
    return {name: f.name for f in model.forecasts for name in reversed(f.names)} | {
        f.name: f.name for f in model.forecasts
    }


def _by_names_now(value: object, model: CompiledModel) -> object:
    """Return what a document says of forecasts by the names that these have now."""
    named = _names_now(model)
    return {named.get(key, key): each for key, each in value.items()} if isinstance(value, dict) else value


class _Columns:
    """The columns of a saved run, as the document lists them.

    Raises:
        ValueError: they are not those of the model.
    """

    def __init__(self, value: object, model: CompiledModel, path: Path) -> None:
        require(isinstance(value, list), "its columns")
        assert isinstance(value, list)
        inputs = {name: a.name for a in model.live for name in reversed(a.names)}
        listed = [_called(build(_Column, each, "a column"), inputs, _names_now(model)) for each in value]
        self._listed, self._path = listed, path
        self._names = {kind: [each.name for each in listed if each.kind == kind] for kind in _KINDS}
        live = [a.name for a in model.live]
        require(self._names["trial"] == [""], "its list of trials")
        require(
            self._names["input"] == self._names["prior"] == live, "its assumptions, which this xlmc reads otherwise"
        )
        require(self._names["forecast"] == [f.name for f in model.forecasts], "its forecasts, which are read otherwise")
        require(len(listed) == sum(map(len, self._names.values())), "a column of a kind that there is not")
        types: dict[Hashable, np.dtype[Any]] = {
            self._key(each): np.dtype(_KINDS[each.kind]).newbyteorder("=") for each in listed
        }
        self._keeper = ColumnStore(types)

    @staticmethod
    def _key(about: _Column) -> tuple[str, str]:
        return about.kind, about.name

    def read(self, package: Package) -> None:
        """Copy every column out of the package, and check it."""
        lengths: dict[str, set[int]] = {kind: set() for kind in _KINDS}
        for about in self._listed:
            lengths[about.kind].add(whole(about.count, "the length of a column"))
            digest = hashlib.sha256()
            with package.reading(about.entry) as entry:
                for part in read_column(entry, _KINDS[about.kind], about.count, about.entry, digest):
                    self._keeper.add(self._key(about), part)
                    self._keeper.write_if_full()
            require(digest.hexdigest() == about.sha256, f"the column {about.entry}: its SHA-256 is another")
        accepted = lengths["trial"]
        require(all(len(result) <= 1 for result in lengths.values()), "columns of different lengths")
        require(
            lengths["forecast"] <= accepted and max(lengths["input"], default=0) <= max(accepted), "too long columns"
        )

    def of(self, kind: str) -> Mapping[str, Column]:
        """Return the columns of a kind by name, in their order."""
        return self._keeper.columns({name: (kind, name) for name in self._names[kind]})


def _spelt(model: CompiledModel) -> dict[str, str]:
    """Return the name of each assumption that is drawn, by the keys of all that it may be called."""
    others = {name_key(name): a.name for a in model.live for name in a.names}
    return {**others, **{name_key(name): name for name in model.draws}}


def _simulation(result: Document, model: CompiledModel, columns: _Columns) -> RunResult:
    settings, spelt = settings_of(result["settings"]), _spelt(model)
    order, invalid = texts(result["order"], "its order of dimensions"), counts(result["invalid"], "its invalid draws")
    require(set(order) <= spelt.keys(), "its order of dimensions")
    require(set(invalid) <= spelt.keys(), "its invalid draws")
    plan = replace(SamplingPlan.of(settings.sampling, settings.trials), order=tuple(map(spelt.__getitem__, order)))
    trials = whole(result["trials"], "its number of trials")
    require(1 <= trials <= plan.trials, "its number of trials")
    index = columns.of("trial")[""]
    rare = rare_of(result["rare"])
    _check_index(index, trials if rare is None else rare.kept)
    forecasts, faults = columns.of("forecast"), mapping(_by_names_now(result["faults"], model), "its faults")
    for name in forecasts:
        require(not _holds_infinity(forecasts[name]), f"the forecast {name!r}")
    inputs, prior = columns.of("input"), columns.of("prior")
    for name in inputs:
        require(not _holds_infinity(inputs[name]) and not _holds_infinity(prior[name]), f"the draws of {name!r}")
    return RunResult(
        model=model,
        settings=settings,
        plan=plan,
        block=max(1, whole(result["block"], "the size of its blocks")),
        trials=trials,
        accepted_index=index,
        inputs=inputs,
        prior=prior,
        forecasts=forecasts,
        faults={name: counts(faults[name], f"the faults of {name!r}") for name in forecasts},
        tally=tally_of(result["tally"], len(model.filters), trials),
        invalid=Counter({spelt[name]: count for name, count in invalid.items()}),
        error_trials=whole(result["error_trials"], "its number of trials with errors"),
        stopped=stopped_of(result["stopped"]),
        rare=rare,
        origin=origin_of(result["origin"]),
        changed_from=changed_from_of(result.get("changed_from")),
        discards=_discards(_by_names_now(result.get("discards", {}), model), model),
        labels=_labels(_by_names_now(result.get("labels", {}), model), model, forecasts),
    )


def _labels(value: object, model: CompiledModel, forecasts: Mapping[str, Column]) -> dict[str, tuple[str, ...]]:
    """Return the texts of forecasts whose answers are texts; a run saved before texts were answers has none of them."""
    given = mapping(value, "its texts")
    names = [model.forecasts[number].name for number in model.categories]
    require(set(given) <= set(names), "its texts, which are read otherwise")
    read = {name: tuple(texts(given[name], f"the texts of {name!r}")) for name in given}
    for name in names:
        read.setdefault(name, ())
        numbers = (part[~np.isnan(part)] for part in parts(forecasts[name]))
        known = all(bool(np.all((part >= 0) & (part < len(read[name])) & (part == np.floor(part)))) for part in numbers)
        require(known, f"the texts of {name!r}")
    return read


def _discards(value: object, model: CompiledModel) -> dict[str, Counter[str]]:
    """Return the counts of filters of some forecasts only; runs saved before there were any have none."""
    given = mapping(value, "its discarded trials")
    own = filters_by_forecast(model.forecasts, model.forecast_filters)
    names = {
        forecast.name: [model.forecast_filters[index].name for index in indices]
        for forecast, indices in zip(model.forecasts, own, strict=True)
        if indices
    }
    require(set(given) == set(names), "its discarded trials")
    read = {name: counts(given[name], "its discarded trials") for name in given}
    require(all(set(read[name]) == set(filters) for name, filters in names.items()), "its discarded trials")
    return read


def _holds_infinity(column: Column) -> bool:
    return any(bool(np.isinf(part).any()) for part in parts(column))


def _check_index(index: Column, trials: int) -> None:
    """Refuse trial numbers that do not ascend, or that the run does not have."""
    last = -1
    for part in parts(index):
        require(bool(part[0] > last) and bool(np.all(np.diff(part) > 0)), "its trial numbers")
        last = int(part[-1])
    require(last < trials, "its trial numbers")


def _damage_error(path: Path, error: Exception) -> XlmcError:
    reason = f"it lacks {error.args[0]!r}" if isinstance(error, KeyError) else str(error)
    return WorkbookError(f"the saved run is damaged: {reason}", where=path, hint=AGAIN)
