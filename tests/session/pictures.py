"""Pictures that are drawn, but not laid out: where their parts stand takes most of the time."""

from __future__ import annotations

import importlib.util

import pytest

__all__ = ["leave_out_layout"]


def leave_out_layout(patch: pytest.MonkeyPatch) -> None:
    """Have the parts of pictures stand where they happen to, as long as the patch lasts."""
    if importlib.util.find_spec("matplotlib"):
        patch.setattr("matplotlib.layout_engine.ConstrainedLayoutEngine.execute", lambda *_: None)
