"""The checks that any momentum solution of two vehicles must pass."""

from __future__ import annotations

from templates.checks import check

__all__ = ["ANGLES", "BOUNDS", "CLOSING", "ENERGY", "FORWARD", "FRICTION"]

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
    "FALSE: momentum alone says little here. 1° of β1 moves V1i by 9 % at δ = 10° and 94 % at 1°; use crush energy.",
)
FORWARD = check(
    "check_forward",
    "Both vehicles move forward",
    "AND(V1_i>0,V2_i>0)",
    "physics",
    "FALSE: a negative impact speed. The approach and departure angles contradict each other.",
)
CLOSING = check(
    "check_closing",
    "The contact points approach each other",
    "approach_[mph|kmh]>0",
    "physics",
    "FALSE: the vehicles move apart before they touch. Look at γ, the impact centre and the approach angles.",
)
BOUNDS = check(
    "check_restitution",
    "Both restitutions lie between −1 and 1",
    "AND(ABS(e_n)<=1,ABS(e_t)<=1)",
    "eqs (9), (10)",
    "FALSE: no impact behaves so. The filters reject such trials; a base case should not be one.",
)
FRICTION = check(
    "check_friction",
    "Frictions are those of road tyres, up to 1.2",
    "AND(MIN(f_1,f_2)>0,MAX(f_1,f_2)<=1.2)",
    "published values",
    "FALSE: more than road tyres give; the published range ends at 0.95. A percentage entered as a number?",
)
