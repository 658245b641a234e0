"""The checks that any momentum solution of two vehicles must pass."""

from __future__ import annotations

from templates.checks import check

__all__ = ["ANGLES", "ENERGY", "FORWARD"]

ENERGY = check(
    "check_energy",
    "The impact takes energy away",
    "E_lost>=0",
    "physics",
    "FALSE: the vehicles leave with more energy than they brought. Look for a wrong angle or travel distance.",
)
ANGLES = check(
    "check_angles",
    "The approaches are at least 10° from parallel",
    "ABS(sin_delta)>=SIN(RADIANS(10))",
    "conditioning",
    "FALSE: momentum alone is blind here. 1° of β1 moves V1i by 9 % at δ = 10° and 94 % at 1°; use crush energy.",
)
FORWARD = check(
    "check_forward",
    "Both vehicles move forward",
    "AND(V1_i>0,V2_i>0)",
    "physics",
    "FALSE: a negative impact speed. The approach and departure angles contradict each other.",
)
