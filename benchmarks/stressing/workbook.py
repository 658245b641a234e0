"""The forms as a workbook that xlmc reads like any other, and their values from any engine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xlsxwriter
from numpy.typing import NDArray

from stressing.forms import CONSTANTS, FORMS, INPUTS, PRINTED, REWRITTEN
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["FORMS_ENGINES", "book_of", "forms_book", "values_of"]

Floats = NDArray[np.float64]

FORMS_ENGINES = ("numpy", "jit")
"""Those that the forms are measured with."""


def book_of(
    assumptions: Mapping[str, Sequence[object]],
    cells: Mapping[str, object],
    forecasts: Sequence[str],
    filters: Sequence[Sequence[object]] = (),
    correlations: Sequence[Sequence[object]] = (),
) -> CompiledModel:
    """A workbook written to disk and loaded.

    Args:
        assumptions: defined name -> base value, distribution, and its parameters as (column, value) pairs.
        cells: defined name -> formula with `=`, or a constant.
        forecasts: names among the cells.
        filters: name of the cell, at least, at most, above, below.
        correlations: first, second, rank correlation.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / "stress.xlsx"
        with xlsxwriter.Workbook(path) as book:
            sheet = book.add_worksheet("Model")
            columns = list(dict.fromkeys(c for _, _, *pairs in assumptions.values() for c, _ in pairs))  # type: ignore[misc]
            rows = []
            for row, (name, (base, family, *pairs)) in enumerate(assumptions.items(), 1):
                given = dict(pairs)  # type: ignore[call-overload]
                rows.append([name, base, family, *(given.get(column) for column in columns)])
                book.define_name(name, f"=Model!$B${row + 1}")
            _table(sheet, 0, "xlmc_assumptions", ["Name", "Value", "Distribution", *columns], rows)
            for row, (name, value) in enumerate(cells.items(), len(rows) + 3):
                sheet.write(row, 0, name)
                sheet.write(row, 1, value)
                book.define_name(name, f"=Model!$B${row + 1}")
            results = book.add_worksheet("Results wanted")
            _table(results, 0, "xlmc_forecasts", ["Name", "Cell"], [[name, f"={name}"] for name in forecasts])
            if filters:
                wanted = ["Name", "Cell", "At least", "At most", "Above", "Below"]
                _table(results, 10, "xlmc_filters", wanted, [[name, f"={name}", *limits] for name, *limits in filters])
            if correlations:
                _table(results, 20, "xlmc_correlations", ["First", "Second", "Correlation"], correlations)
        return load(path)


def _table(
    sheet: xlsxwriter.worksheet.Worksheet,
    column: int,
    name: str,
    headings: Sequence[str],
    rows: Sequence[Sequence[object]],
) -> None:
    for row, values in enumerate(rows, 1):
        for place, value in enumerate(values, column):
            sheet.write(row, place, value)
    sheet.add_table(
        0,
        column,
        len(rows),
        column + len(headings) - 1,
        {"name": name, "columns": [{"header": heading} for heading in headings]},
    )


def forms_book() -> CompiledModel:
    """Every cell of `forms`, each form's two cells as forecasts."""
    assumptions = {
        name: ((low + high) / 2, "Uniform", ("Low", low), ("High", high)) for name, (low, high) in INPUTS.items()
    }
    cells = {
        **CONSTANTS,
        **{name: f"={text}" for name, text in REWRITTEN.items()},
        **{name: f"={text}" for name, text in PRINTED.items()},
    }
    return book_of(assumptions, cells, [name for form in FORMS for name in (form.printed, form.rewritten)])


def values_of(model: CompiledModel, inputs: Mapping[str, Floats], engine: str) -> dict[str, Floats]:
    """Every forecast of given draws, `(n,)`, NaN where it is an error; with numpy by `Model.function` itself."""
    if engine == "numpy":
        return model.function(inputs)
    n = next(iter(inputs.values())).size
    evaluator = model.program(engine).evaluator(n)
    evaluator.filters({name: np.ascontiguousarray(column) for name, column in inputs.items()}, n)
    columns = evaluator.forecasts(np.arange(n))
    return {f.name: column.as_floats() for f, column in zip(model.forecasts, columns, strict=True)}
