"""The workbooks that belong to the project, by name: tests take these, and never what a run left beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

__all__ = ["BOOKS", "CRASHES", "EXAMPLES", "ROOT", "TEMPLATES"]

ROOT: Final = Path(__file__).resolve().parents[2]

_EXAMPLES: Final = (
    "airborne-amy",
    "barrier-corner",
    "collinear-equal-cars",
    "collinear-head-on",
    "crossing-pedestrian",
    "crush-balance",
    "bumper-test",
    "edr-hard-braking",
    "intersection",
    "intersection-momentum",
    "left-turn",
    "motorcycle-head-on",
    "nearly-head-on",
    "rest-positions",
    "skid-100-ft",
    "textbook-claim",
    "thrown-body",
    "video-two-frames",
    "yaw-mark",
)
_TEMPLATES: Final = (
    "airborne",
    "collinear",
    "critical-speed-yaw",
    "crush-energy",
    "edr-speed",
    "low-speed",
    "momentum",
    "momentum-energy",
    "motorcycle",
    "pedestrian",
    "pedestrian-throw",
    "planar-forward",
    "planar-impact",
    "skid",
    "time-distance",
    "video-speed",
)

_OTHER_FIELDS: Final = (
    "beam",
    "beam-si",
    "mass-calibration",
    "project",
    "tolerance-stack",
    "tolerance-stack-si",
    "warranty",
)
"""A model without units has one edition."""

EXAMPLES: Final = {name: ROOT / "examples" / f"{name}.xlsx" for name in _EXAMPLES}
CRASHES: Final = {name + end: ROOT / "templates" / f"{name}{end}.xlsx" for name in _TEMPLATES for end in ("", "-si")}
"""The templates for the reconstruction of crashes."""
TEMPLATES: Final = CRASHES | {name: ROOT / "templates" / f"{name}.xlsx" for name in _OTHER_FIELDS}
BOOKS: Final = EXAMPLES | TEMPLATES
"""Name without its ending -> file."""
