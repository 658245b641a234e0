"""The charts of rounding: how far each form is off along each sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from stressing.charts import COLOURS, figure, save
from stressing.forms import FORMS
from stressing.rounding import UNITS
from stressing.sweeps import SWEEPS

__all__ = ["CHARTS", "draw"]

CHARTS: Final[Mapping[str, tuple[str, Sequence[str], Sequence[int]]]] = {
    "angles": (
        "Nearly parallel approaches: error of the printed and the rewritten forms",
        ("catching up", "sideswipe", "head-on"),
        (15, 16, 17, 19, 23),
    ),
    "square": (
        "A vehicle that travels along Y: the printed equation (16) divides by cos α2",
        ("through 90", "through 270"),
        (15, 16, 17, 19, 23),
    ),
    "light": (
        "A light touch: delta-V as a small difference of large velocities", ("light",), (15, 16, 17, 19, 23)
    ),
    "pole": ("Tangential restitution (10) near its pole", ("pole",), (10,)),
}  # fmt: skip
"""Picture -> title, sweeps (columns), equations."""

ROWS: Final = (("float64", "numpy"), ("float32", "jit"))
FLOORS: Final = {"float64": 1e-17, "float32": 1e-10}
"""Arithmetic -> the smallest error drawn."""


def draw(found: Mapping[str, Any], folder: Path) -> list[Path]:
    """One row of panels an arithmetic; solid lines are rewritten forms, dashed ones printed."""
    return [_drawn(found, name, folder / f"{name}.png") for name in CHARTS]


def _drawn(found: Mapping[str, Any], name: str, path: Path) -> Path:
    title, sweeps, numbers = CHARTS[name]
    width = max(5.2 * len(sweeps) + 0.6, 12.5)
    rows, columns = (2, len(sweeps)) if len(sweeps) > 1 else (1, 2)
    made, axes = figure(rows, columns, title, figsize=(width, 4.2 * rows + 1.4), sharey="row" if rows > 1 else False)
    panels = [(row, sweep) for row in ROWS for sweep in sweeps]
    for axis, ((arithmetic, engine), sweep) in zip(axes.flat, panels, strict=True):
        _panel(axis, found[f"{sweep}, {arithmetic}"], (engine, arithmetic), numbers)
        axis.set_title(f"{SWEEPS[sweep].title}: {engine}, {arithmetic}", fontsize=11)
        axis.set_xlabel(SWEEPS[sweep].axis)
        axis.axhline(UNITS[arithmetic], color="#6B7785", lw=1, ls=":", label="one rounding")
        axis.invert_xaxis()
    for axis in axes[:, 0]:
        axis.set_ylabel("relative error (of directions: over 180°)")
    save(made, axes, path, columns=4 if len(sweeps) > 2 else 3)
    return path


def _panel(axis: Any, sweep: Mapping[str, Any], way: tuple[str, str], numbers: Sequence[int]) -> None:
    floor = FLOORS[way[1]]
    x = np.asarray(sweep["x"])
    positive = x[x > 0]
    at = np.where(x > 0, x, positive.min() / 10)  # 0 itself stands a decade beyond the smallest
    for form, colour in zip([f for f in FORMS if f.number in numbers], COLOURS, strict=False):
        for cell, line, kind in ((form.printed, "--", "printed"), (form.rewritten, "-", "rewritten")):
            error = np.clip(np.asarray(sweep["errors"][", ".join(way)][cell], float), floor, 1e3)
            axis.plot(at, error, line, color=colour, marker="." if kind == "printed" else None, ms=4, lw=1.4,
                      label=f"({form.number}) {form.what}, {kind}")  # fmt: skip
    axis.set(xscale="log", yscale="log", ylim=(floor, 1e2))
    if (x == 0).any():
        axis.axvline(positive.min() / 10, color="#6B7785", lw=0.8)
        axis.annotate("exactly", (positive.min() / 10, 3e1), (-4, 0), textcoords="offset points", ha="right",
                      fontsize=8)  # fmt: skip
