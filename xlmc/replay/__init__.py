"""Repeat a recorded run, and prove that it gives the same numbers, or name what differs."""

from __future__ import annotations

from xlmc.replay.changes import Change, NumberChange
from xlmc.replay.repeat import Replayed, replay

__all__ = ["Change", "NumberChange", "Replayed", "replay"]
