"""Open a saved run: the same `Simulation` again, without simulating."""

from __future__ import annotations

import hashlib
import json
import zipfile
from collections import Counter
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.definitions.model import name_key
from xlmc.errors import WorkbookError, XlmcError
from xlmc.model import Model, understood
from xlmc.saved.archive import AGAIN, DAMAGE, RUN, WORKBOOK, Package, opened
from xlmc.saved.columns import read_column
from xlmc.saved.document import (
    FORMAT,
    VERSION,
    origin_of,
    plan_of,
    rare_of,
    rounding_of,
    settings_of,
    stopped_of,
    tally_of,
    told,
)
from xlmc.scratch import Keeper, parts
from xlmc.simulation import Simulation
from xlmc.workbook import read_workbook
from xlmc.workbook.package import LIMITS

__all__ = ["is_saved_run", "open_run"]

_LARGEST_DOCUMENT: Final = 64 << 20
_KINDS: Final = {"trial": "<i8", "input": "<f8", "prior": "<f8", "forecast": "<f8"}

Document = Mapping[str, Any]
Column = NDArray[Any]


def is_saved_run(path: Path) -> bool:
    """Whether the file looks like a saved run, whatever its name."""
    if not path.is_file() or not zipfile.is_zipfile(path):
        return False
    try:
        with zipfile.ZipFile(path) as package:
            return RUN in package.namelist()
    except DAMAGE:
        return False


def open_run(path: str | Path) -> Simulation:
    """The run that was saved in a file, with the model of its workbook: every statistic is the same to the last bit.

    Columns go into memory, or, where they are large together, into temporary files.

    Raises:
        WorkbookError: the file cannot be read, is no saved run, or is damaged.
        XlmcError: its workbook cannot be understood any more.
    """
    path = Path(path)
    with opened(path) as package:
        found = _document(package, path)
        model = _model(package, found, path)
        try:
            columns = _Columns(found["columns"], model, path)
            columns.read(package)
            return _simulation(found, model, columns)
        except (AttributeError, LookupError, TypeError, ValueError, OverflowError, RecursionError) as error:
            raise _damaged(path, error) from error


def _document(package: Package, path: Path) -> Document:
    if package.size(RUN) > _LARGEST_DOCUMENT:
        raise WorkbookError(f"{RUN} in the saved run is larger than any that xlmc writes", where=path, hint=AGAIN)
    with package.reading(RUN) as entry:
        data = entry.read()
    try:
        found = json.loads(data)
        told(isinstance(found, dict) and found.get("format") == FORMAT, "its format")
    except (ValueError, RecursionError) as error:
        raise _damaged(path, error) from error
    if found.get("version") != VERSION:
        message = f"the saved run is of version {found.get('version')}, and this xlmc reads version {VERSION}"
        raise WorkbookError(message, where=path, hint="Install the xlmc that it was saved with")
    return dict(found)


def _model(package: Package, found: Document, path: Path) -> Model:
    try:
        name, sha256 = str(found["workbook"]["name"]), found["workbook"]["sha256"]
    except (KeyError, TypeError) as error:
        raise _damaged(path, error) from error
    if package.size(WORKBOOK) > LIMITS.total:
        raise WorkbookError(f"its workbook is larger than {LIMITS.total >> 20} MB", where=path, hint=AGAIN)
    with package.reading(WORKBOOK) as entry:
        data = entry.read()
    if hashlib.sha256(data).hexdigest() != sha256:
        raise WorkbookError("the workbook in the saved run is not the one that was run", where=path, hint=AGAIN)
    return understood(read_workbook(data, Path(name).name), Path(Path(name).name))


class _Columns:
    """The columns of a saved run, as the document lists them.

    Raises:
        KeyError, TypeError, ValueError: they are not those of the model.
    """

    def __init__(self, listed: list[Document], model: Model, path: Path) -> None:
        self._listed, self._path = listed, path
        self._names = {kind: [str(each["name"]) for each in listed if each["kind"] == kind] for kind in _KINDS}
        live = [a.name for a in model.live]
        told(self._names["trial"] == [""], "its list of trials")
        told(self._names["input"] == self._names["prior"] == live, "its assumptions, which this xlmc reads otherwise")
        told(self._names["forecast"] == [f.name for f in model.forecasts], "its forecasts, which are read otherwise")
        told(len(listed) == sum(map(len, self._names.values())), "a column of a kind that there is not")
        types: dict[Hashable, np.dtype[Any]] = {
            self._key(each): np.dtype(_KINDS[each["kind"]]).newbyteorder("=") for each in listed
        }
        self._keeper = Keeper(types)

    @staticmethod
    def _key(about: Document) -> tuple[str, str]:
        return str(about["kind"]), str(about["name"])

    def read(self, package: Package) -> None:
        """Copy every column out of the package, and check it."""
        counts: dict[str, set[int]] = {kind: set() for kind in _KINDS}
        for about in self._listed:
            counts[about["kind"]].add(_whole(about["count"]))
            digest = hashlib.sha256()
            with package.reading(str(about["entry"])) as entry:
                kind = _KINDS[about["kind"]]
                for part in read_column(entry, kind, _whole(about["count"]), str(about["entry"]), digest):
                    self._keeper.add(self._key(about), part)
                    self._keeper.settle()
            told(digest.hexdigest() == about["sha256"], f"the column {about['entry']}: its SHA-256 is another")
        accepted = counts["trial"]
        told(all(len(found) <= 1 for found in counts.values()), "columns of different lengths")
        told(counts["forecast"] <= accepted and max(counts["input"], default=0) <= max(accepted), "too long columns")

    def of(self, kind: str) -> Mapping[str, Column]:
        """The columns of a kind by name, in their order."""
        return self._keeper.columns({name: (kind, name) for name in self._names[kind]})


def _simulation(found: Document, model: Model, columns: _Columns) -> Simulation:
    settings = settings_of(found["settings"])
    plan, trials = plan_of(settings, found["order"]), _whole(found["trials"])
    told(1 <= trials <= plan.trials, "its number of trials")
    live = {name_key(a.name) for a in model.live}
    told(set(plan.order) <= live, "its order of dimensions")
    told(set(found["invalid"]) <= live, "its invalid draws")
    index = columns.of("trial")[""]
    rare = rare_of(found["rare"])
    _check_index(index, trials if rare is None else rare.kept)
    forecasts = columns.of("forecast")
    for name in forecasts:
        told(not any(bool(np.isinf(part).any()) for part in parts(forecasts[name])), f"the forecast {name!r}")
    return Simulation(
        model=model,
        settings=settings,
        plan=plan,
        block=max(1, _whole(found["block"])),
        trials=trials,
        trial_index=index,
        inputs=columns.of("input"),
        prior=columns.of("prior"),
        forecasts=forecasts,
        faults={name: Counter(found["faults"][name]) for name in forecasts},
        tally=tally_of(found["tally"], len(model.filters)),
        invalid=Counter(found["invalid"]),
        error_trials=_whole(found["error_trials"]),
        stopped=stopped_of(found["stopped"]),
        rounding=rounding_of(found["rounding"]),
        rare=rare,
        origin=origin_of(found["origin"]),
    )


def _check_index(index: Column, trials: int) -> None:
    """Refuse trial numbers that do not ascend, or are none of the run's."""
    last = -1
    for part in parts(index):
        told(bool(part[0] > last) and bool(np.all(np.diff(part) > 0)), "its trial numbers")
        last = int(part[-1])
    told(last < trials, "its trial numbers")


def _whole(value: object) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f"the number {value!r}")
    return value


def _damaged(path: Path, error: Exception) -> XlmcError:
    return WorkbookError(f"the saved run is damaged: {error}", where=path, hint=AGAIN)
