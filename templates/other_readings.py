"""Rows of sheet Evidence that more than one template has: speeds from elsewhere, recorders, testimony."""

from __future__ import annotations

from templates.description import EvidenceRow
from templates.editions import Both

__all__ = ["cut_off_delta_v", "recorded_delta_v", "seen_speed", "told_speed"]

_RULE = "49 CFR 563.8: within 10 %, in steps of 1 km/h"
_OFF_BY = {"Percent": 10, "Resolution": Both(0.31, 0.5)}


def seen_speed(name: str, symbol: str) -> EvidenceRow:
    """A speed from a recorder or a video."""
    source = (
        "A reading of its own: middle and standard deviation of edr-speed or video-speed, if they share no input with "
        "this workbook"
    )
    return EvidenceRow(f"{name}, from an EDR or a video", symbol, None, "Normal", {}, source)


def told_speed(name: str, symbol: str) -> EvidenceRow:
    """A speed that a witness named."""
    source = "Testimony. Enter the speed, and how far it may be off: widely"
    return EvidenceRow(f"{name}, as a witness told", symbol, None, "Uniform", {}, source)


def recorded_delta_v(name: str, symbol: str) -> EvidenceRow:
    """The delta-V of a recorder that kept the whole pulse."""
    return EvidenceRow(f"{name} in its EDR", symbol, None, "Instrument", _OFF_BY, f"{_RULE}. The whole pulse was kept")


def cut_off_delta_v(name: str, symbol: str) -> EvidenceRow:
    """The delta-V of a recorder that stopped, or was clipped, before the pulse had ended."""
    source = (
        "The record ended, or its sensor was clipped, before the pulse had ended: what was recorded is a lower limit. "
        f"{_RULE}. Or clear both and enter a Std dev: a normal error"
    )
    return EvidenceRow(f"{name} in its EDR, cut off", symbol, None, "At least", _OFF_BY, source)
