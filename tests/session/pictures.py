"""Pictures that are drawn, but not laid out: where their parts stand takes most of the time."""

from __future__ import annotations

import importlib.util

import pytest

__all__ = ["leave_out_layout"]


def leave_out_layout(patch: pytest.MonkeyPatch) -> None:
    """Have the parts of pictures stand where they happen to, as long as the patch lasts.

    Pictures are drawn once, not a first time to see how large their parts are, and without the hundreds of small ticks
    of logarithmic axes.
    """
    if importlib.util.find_spec("matplotlib"):
        patch.setattr("matplotlib.figure.Figure.set_layout_engine", lambda *_, **__: None)
        patch.setattr("matplotlib.figure.Figure.savefig", lambda figure, to, dpi: figure.canvas.print_png(to))
        patch.setattr("matplotlib.axis.Axis.get_minorticklocs", lambda _: [])
