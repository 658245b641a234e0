"""The charts of rounding: how far each form is off along each sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from stressing.charts import COLOURS, figure, save
from stressing.forms import FORMS
from stressing.rounding import UNIT
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

FLOOR: Final = 1e-17
"""The smallest error drawn."""


def draw(result: Mapping[str, Any], folder: Path) -> list[Path]:
    """A panel a sweep; solid lines are rewritten forms, dashed ones printed."""
    return [_drawn(result, name, folder / f"{name}.png") for name in CHARTS]


def _drawn(result: Mapping[str, Any], name: str, path: Path) -> Path:
    title, sweeps, numbers = CHARTS[name]
    width = max(5.2 * len(sweeps) + 0.6, 12.5)
    made, axes = figure(1, len(sweeps), title, figsize=(width, 5.6), sharey="row")
    for axis, sweep in zip(axes.flat, sweeps, strict=True):
        _panel(axis, result[sweep], numbers)
        axis.set_title(SWEEPS[sweep].title, fontsize=11)
        axis.set_xlabel(SWEEPS[sweep].axis)
        axis.axhline(UNIT, color="#6B7785", lw=1, ls=":", label="one rounding")
        axis.invert_xaxis()
    for axis in axes[:, 0]:
        axis.set_ylabel("relative error (of directions: over 180°)")
    save(made, axes, path, columns=4 if len(sweeps) > 2 else 3)
    return path


def _panel(axis: Any, sweep: Mapping[str, Any], numbers: Sequence[int]) -> None:
    x = np.asarray(sweep["x"])
    positive = x[x > 0]
    at = np.where(x > 0, x, positive.min() / 10)  # 0 itself stands a decade beyond the smallest
    for form, colour in zip([f for f in FORMS if f.number in numbers], COLOURS, strict=False):
        for cell, line, kind in ((form.printed, "--", "printed"), (form.rewritten, "-", "rewritten")):
            error = np.clip(np.asarray(sweep["errors"]["numpy"][cell], float), FLOOR, 1e3)
            axis.plot(at, error, line, color=colour, marker="." if kind == "printed" else None, ms=4, lw=1.4,
                      label=f"({form.number}) {form.what}, {kind}")  # fmt: skip
    axis.set(xscale="log", yscale="log", ylim=(FLOOR, 1e2))
    if (x == 0).any():
        axis.axvline(positive.min() / 10, color="#6B7785", lw=0.8)
        axis.annotate("exactly", (positive.min() / 10, 3e1), (-4, 0), textcoords="offset points", ha="right",
                      fontsize=8)  # fmt: skip
