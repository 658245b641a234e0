"""Eight books whose forecast has a known distribution, for the bar of `method_advice.py --truth`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

__all__ = ["KNOWN", "KnownBook"]

Floats = NDArray[np.float64]
UNIFORM: Final = ("Uniform", 0, 1, None, None)
HEADINGS: Final = ("Name", "Cell", "Distribution", "Low", "High", "Mean", "Std dev")


def normal(mean: float, deviation: float) -> tuple[Any, ...]:
    return ("Normal", None, None, mean, deviation)


@dataclass(frozen=True, slots=True)
class KnownBook:
    """A forecast `formula` of the assumptions in A1, A2 …; `quantile` of it; accepted where `above` is exceeded."""

    name: str
    formula: str
    drawn: tuple[tuple[Any, ...], ...]
    quantile: Callable[[Floats], Floats]
    above: float | None = None

    @property
    def words(self) -> str:
        """The forecast, its assumptions and its filter, as a cell of a table."""
        kinds = dict.fromkeys(self.drawn)
        drawn = ", ".join(
            "uniform 0 to 1" if each == UNIFORM else f"normal {each[3]:g} ± {each[4]:g}" for each in kinds
        )
        kept = "" if self.above is None else f", A1 above {self.above:g}"
        return f"`{self.formula[1:]}`: {drawn}{kept}"

    @property
    def accepted(self) -> float:
        """The share of trials that the filter on A1, which is uniform, accepts."""
        return 1.0 if self.above is None else 1.0 - self.above

    def write(self, folder: Path) -> Path:
        """The workbook, with A1 as its filter where there is one."""
        import openpyxl
        from openpyxl.worksheet.table import Table

        book = openpyxl.Workbook()
        sheet = book.active
        sheet.title = "S"
        for row, each in enumerate(self.drawn, start=1):
            sheet[f"A{row}"] = 0.75 if each == UNIFORM else each[3]
        sheet["B1"] = self.formula
        rows = [(f"x{row}", f"S!A{row}", *each) for row, each in enumerate(self.drawn, start=1)]
        tables: dict[str, list[tuple[Any, ...]]] = {
            "xlmc_assumptions": [HEADINGS, *rows],
            "xlmc_forecasts": [("Name", "Cell"), ("y", "S!B1")],
        }
        if self.above is not None:
            tables["xlmc_filters"] = [("Name", "Cell", "Above"), ("f", "S!A1", self.above)]
        for name, lines in tables.items():
            page = book.create_sheet(name)
            for line in lines:
                page.append(line)
            page.add_table(Table(displayName=name, ref=f"A1:{chr(64 + len(lines[0]))}{len(lines)}"))
        path = folder / f"{self.name}.xlsx"
        book.save(path)
        return path


def _inverse(cdf: Callable[[Floats], Floats], low: float, high: float) -> Callable[[Floats], Floats]:
    """Quantiles of a distribution function, by bisection."""

    def quantile(u: Floats) -> Floats:
        below, above = np.full(u.shape, low), np.full(u.shape, high)
        for _ in range(60):
            middle = (below + above) / 2.0
            under = cdf(middle) < u
            below, above = np.where(under, middle, below), np.where(under, above, middle)
        return (below + above) / 2.0

    return quantile


def _modes(share: float, apart: float, deviation: float) -> Callable[[Floats], Floats]:
    def cdf(y: Floats) -> Floats:
        return share * ndtr(y / deviation) + (1.0 - share) * ndtr((y - apart) / deviation)

    return _inverse(cdf, -10.0 * deviation, apart + 10.0 * deviation)


def _direction(y: Floats) -> Floats:
    """Of MOD(x, 360) with x normal about 0, SD 5."""
    return ndtr(y / 5.0) - 0.5 + ndtr((y - 360.0) / 5.0)


def _triangle(u: Floats) -> Floats:
    return np.where(u < 0.5, np.sqrt(2.0 * u), 2.0 - np.sqrt(2.0 * (1.0 - u)))


KNOWN: Final = (
    KnownBook("sum", "=A1-2*A2", (normal(0, 1), normal(0, 0.5)), lambda u: 2**0.5 * ndtri(u)),
    KnownBook("thirty", "=SUM(A1:A30)", (normal(1, 1),) * 30, lambda u: 30 + 30**0.5 * ndtri(u)),
    KnownBook("modes", "=IF(A1<0.26,0,20)+A2", (UNIFORM, normal(0, 1)), _modes(0.26, 20.0, 1.0)),
    KnownBook("gap", "=IF(A1<0.2452,0,20)+A2", (UNIFORM, normal(0, 1)), _modes(0.2452, 20.0, 1.0)),
    KnownBook("direction", "=MOD(A1,360)", (normal(0, 5),), _inverse(_direction, 0.0, 360.0)),
    KnownBook("growth", "=EXP(A1)", (normal(0, 0.5),), lambda u: np.exp(0.5 * ndtri(u))),
    KnownBook("triangle", "=A1+A2", (UNIFORM, UNIFORM), _triangle),
    KnownBook("half", "=A1^2", (UNIFORM,), lambda u: (0.5 + 0.5 * u) ** 2, 0.5),
)
