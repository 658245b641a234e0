"""Repeat a recorded run, and prove that it gives the same numbers, or name what differs."""

from __future__ import annotations

from xlmc.outputs.replay.changes import Change, NumberChange
from xlmc.outputs.replay.repeat import Replayed, recorded_run, replay
from xlmc.outputs.replay.sheets import CellDifference, SheetComparison

__all__ = ["CellDifference", "Change", "NumberChange", "Replayed", "SheetComparison", "recorded_run", "replay"]
