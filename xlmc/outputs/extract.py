"""Accepted trials as a table in a file: CSV or Parquet, written a part at a time, every number exactly."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.record import make_record
from xlmc.errors import SimulationError, WorkbookError
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.writer import whole_file
from xlmc.montecarlo.columns import PART, release
from xlmc.montecarlo.simulation.simulation import TRIAL, assumption_heading, forecast_heading, weight_heading

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

Values = NDArray[np.float64] | NDArray[np.int64]

__all__ = ["OUTER_DRAW", "check_extract_path", "extract", "safe_heading"]


_STARTS_A_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r", "\n", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""Characters that make a spreadsheet take a CSV field for a formula; the last four in East Asian editions."""

_BEHIND_A_SEPARATOR: Final = re.compile('([;|\t\n]["\\s]*)([=+\\-@\uff1d\uff0b\uff0d\uff20])')

OUTER_DRAW: Final = "Outer draw"
"""The heading of the column with the outer draw of each trial of two loops, counted from 0."""

_ROW_GROUP: Final = 2 * PART


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the table.

    Attributes:
        name: as in `Simulation.frame`.
        kind: `outer draw`, `assumption`, `weight` or `forecast`.
        values: `(m,)`, whole numbers or doubles, NaN where there is no number; shorter where the draws of later trials
            were not kept.
    """

    name: str
    kind: str
    units: str
    cell: str
    values: NDArray[np.float64] | NDArray[np.int64]
    labels: Sequence[str] | None = None


def extract(simulation: RunResult, path: Path, *, command: str | None = None, overwrite: bool = False) -> Path:
    """Write the accepted trials, one in each row: the trial's number, the assumptions, the forecasts.

    Args:
        simulation: the finished run.
        path: where to; its ending, `.csv` or `.parquet`, says how.
        command: what the person typed, for the record in a Parquet file.
        overwrite: replace a file that is there: a table bears no mark of who wrote it.

    Returns:
        The path.

    Raises:
        TakenError: there is a file already.
        WorkbookError: the ending is another, or the file cannot be written.
        SimulationError: Parquet was asked for, and pyarrow is not installed.
    """
    write = _writer(path)
    check_extract_path(path)
    target = Target(path, simulation.model.workbook.name, overwrite, read=simulation.model.files)
    target.check()
    with whole_file(path, target.check) as file:
        write(simulation, file, command)
    return path


def check_extract_path(path: Path) -> None:
    """Refuse, before a run, a file that could not be written after it.

    Raises:
        WorkbookError: the ending is neither `.csv` nor `.parquet`.
        SimulationError: it is `.parquet`, and pyarrow is not installed.
    """
    if _writer(path) is _write_parquet and find_spec("pyarrow") is None:
        hint = 'Install it: pip install "pyarrow>=16"; or write a .csv file'
        raise SimulationError("Parquet files need pyarrow, which is not installed", where=path, hint=hint)


def safe_heading(name: str) -> str:
    """Write a name as a field of a CSV file that no spreadsheet takes for a formula: `=A1` becomes `'=A1`.

    Where a semicolon separates fields, as in most of Europe, what stands behind one in a name begins a field, too.

    >>> safe_heading("speed;=A1")
    "speed;'=A1"
    """
    apart = _BEHIND_A_SEPARATOR.sub(r"\1'\2", name)
    return f"'{apart}" if apart.startswith(_STARTS_A_FORMULA) else apart


def _writer(path: Path) -> Callable[[RunResult, BinaryIO, str | None], None]:
    result = {".csv": _write_csv, ".parquet": _write_parquet}.get(path.suffix.casefold())
    if result is None:
        hint = f"Name it {path.stem + '.csv'!r} or {path.stem + '.parquet'!r}"
        raise WorkbookError("trials are extracted to a .csv or a .parquet file", where=path, hint=hint)
    return result


def _columns(simulation: RunResult) -> list[Column]:
    """In two loops the outer draw; assumptions, then forecasts."""
    forecasts = {forecast.name for forecast in simulation.model.forecasts}
    columns = []
    if simulation.plan.outer:
        names = {*forecasts, *(a.name for a in simulation.model.live)}
        name = OUTER_DRAW if OUTER_DRAW not in names else f"{OUTER_DRAW} of the trial"
        columns.append(Column(name, "outer draw", "", "", simulation.trial_index // simulation.plan.size))
    columns += [
        Column(assumption_heading(a.name, forecasts), "assumption", a.units, str(a.cell), values)
        for a in simulation.model.live
        for values in [simulation.inputs[a.name]]
    ]
    if simulation.weighting is not None:
        name = weight_heading({*forecasts, *(each.name for each in columns)})
        columns.append(Column(name, "weight", "", "", simulation.weighting.weights))
    return columns + [
        Column(
            forecast_heading(f.name),
            "forecast",
            f.units,
            str(f.cell),
            simulation.forecasts[f.name],
            simulation.labels.get(f.name),
        )
        for f in simulation.model.forecasts
    ]


def _chunks(
    simulation: RunResult, columns: list[Column], size: int
) -> Iterator[tuple[NDArray[np.int64], list[Values]]]:
    """Yield the trials a part at a time, and with them a part of every column, filled up with NaN."""
    index = simulation.trial_index
    for start in range(0, index.size, size):
        trials = index[start : start + size]
        yield trials, [_fill_up(column.values[start : start + size], trials.size) for column in columns]
        for values in (index, *(column.values for column in columns)):
            release(values)


def _fill_up(values: Values, size: int) -> Values:
    if values.size == size:
        return values
    return np.concatenate([values, np.full(size - values.size, np.nan)])


def _write_csv(simulation: RunResult, file: BinaryIO, command: str | None) -> None:
    """RFC 4180 in UTF-8; with a byte order mark where the headings need it, for Excel takes other files for ANSI."""
    columns = _columns(simulation)
    headings = [safe_heading(name) for name in (TRIAL, *(column.name for column in columns))]
    encoding = "utf-8" if all(heading.isascii() for heading in headings) else "utf-8-sig"
    text = io.TextIOWrapper(file, encoding, newline="")
    try:
        writer = csv.writer(text)
        writer.writerow(headings)
        for trials, values in _chunks(simulation, columns, PART):
            fields = [_fields(part, column.labels) for part, column in zip(values, columns, strict=True)]
            writer.writerows(zip(trials.tolist(), *fields, strict=True))
    finally:
        text.detach()  # flushed, and not closed


def _fields(values: Values, labels: Sequence[str] | None) -> list[float | str]:
    """Numbers, which the writer gives their shortest exact text, or texts; nothing where there is none."""
    result: list[Any] = values.tolist()
    if labels is not None:
        return ["" if value != value else safe_heading(labels[int(value)]) for value in result]
    return ["" if value != value else value for value in result] if np.isnan(values).any() else result


def _parquet_type(pa: Any, column: Column) -> Any:
    if column.labels is not None:
        return pa.string()
    return pa.int64() if column.values.dtype.kind == "i" else pa.float64()


def _write_parquet(simulation: RunResult, file: BinaryIO, command: str | None) -> None:
    """Doubles, null where there is no number; units and cells with the columns, the record with the table."""
    import pyarrow as pa
    from pyarrow import parquet

    columns = _columns(simulation)
    fields = [pa.field(TRIAL, pa.int64(), nullable=False)]
    fields += [
        pa.field(
            each.name,
            _parquet_type(pa, each),
            metadata={"kind": each.kind, "units": each.units, "cell": each.cell},
        )
        for each in columns
    ]
    record = json.dumps(make_record(simulation, command).as_dict(), ensure_ascii=False, allow_nan=False)
    schema = pa.schema(fields, metadata={"xlmc": record})
    with parquet.ParquetWriter(file, schema) as writer:
        for trials, values in _chunks(simulation, columns, _ROW_GROUP):
            arrays = [pa.array(trials)]
            for part, column in zip(values, columns, strict=True):
                if column.labels is None:
                    arrays.append(pa.array(part, mask=np.isnan(part)))
                else:
                    texts = [None if each != each else column.labels[int(each)] for each in part.tolist()]
                    arrays.append(pa.array(texts, pa.string()))
            writer.write_batch(pa.record_batch(arrays, schema=schema))
