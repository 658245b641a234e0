"""The look of the charts, and the axes that several of them share."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np

__all__ = ["COLOURS", "NOMINAL", "binomial_error", "coverage_axis", "figure", "save"]

# Okabe and Ito's palette, told apart by people who see red and green alike; markers tell them apart without colour.
COLOURS: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8A7A00", "#6B7785")
NOMINAL: Final = 95.0
_GRID: Final = "#D5DBE3"


def figure(rows: int, columns: int, title: str, **more: Any) -> tuple[Any, Any]:
    """A figure and its axes, always a two-dimensional array."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    more.setdefault("figsize", (5.2 * columns + 0.6, 4.1 * rows + 1.2))
    made, axes = pyplot.subplots(rows, columns, layout="constrained", squeeze=False, **more)
    made.suptitle(title, fontsize=13)
    for axis in axes.flat:
        axis.grid(which="major", color=_GRID, lw=0.7)
        axis.set_axisbelow(True)
    return made, axes


def coverage_axis(axis: Any, title: str, low: float = 60.0) -> None:
    """Coverage in percent, with a line at what is promised."""
    axis.axhline(NOMINAL, color="#1F3044", lw=1.2)
    axis.set(title=title, ylim=(low, 101.5))
    axis.set_ylabel("intervals that hold the truth, %")


def binomial_error(share: Sequence[float], runs: Sequence[float]) -> Any:
    """Two standard errors of shares, in percent."""
    p, n = np.asarray(share), np.maximum(np.asarray(runs, float), 1.0)
    return 200.0 * np.sqrt(np.maximum(p * (1.0 - p), 0.25 / n) / n)


def save(made: Any, axes: Any, path: Path, *, columns: int = 4) -> None:
    """With the legend of all axes below them."""
    from matplotlib import pyplot
    from PIL import Image

    entries: dict[str, Any] = {}
    for axis in axes.flat:
        entries |= {label: handle for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    if entries:
        made.legend(entries.values(), entries, loc="outside lower center", ncols=columns, frameon=False)
    buffer = BytesIO()
    made.savefig(buffer, dpi=110)
    pyplot.close(made)
    with Image.open(buffer) as image:  # of 128 colours it is a third of the size
        image.convert("RGB").quantize(128, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
            path, optimize=True
        )
