"""The names of the ways to use evidence, which the command line knows before it imports anything that takes time."""

from __future__ import annotations

from typing import Final

__all__ = ["EVIDENCE_METHODS"]

EVIDENCE_METHODS: Final = ("auto", "rejection", "weights")
"""How a run uses evidence whose error is no limit; `auto` decides by the run's first trials."""
