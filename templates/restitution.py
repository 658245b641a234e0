"""Restitution where none was measured: one shape, and the published values it comes from."""

from __future__ import annotations

from collections.abc import Mapping

from templates.description import GuideSection, Input

__all__ = ["RESTITUTION", "restitution_input"]

_SHAPE: Mapping[str, float] = {"Low": 0.04, "Low likeliest": 0.04, "High likeliest": 0.24, "High": 0.35}
"""A trapezoid, columns of `xlmc_assumptions` -> value: flat over the barrier tests at 30 mph but the one of 0.35."""
_BASE = 0.15
_SOURCE = (
    "Frontal barrier tests at [30 mph|48 km/h]: 0.04 to 0.24, one about 0.35 (Monson and Germane, SAE 1999-01-0097). "
    "A delta-V of [2 to 5 mph|3 to 8 km/h] had 0.2 to 0.4 (SAE 931842): see sheet Guide"
)

RESTITUTION = GuideSection(
    "Restitution: published values",
    (
        "Restitution varies from test to test and no data will match a crash exactly: choose the tests that resemble "
        "it most, and limits wide enough for their scatter. Published values depend on how the normal was chosen.",
        "Where the template asks for a restitution, its range is that of the first row: flat from 0.04 to 0.24, with "
        "a tail to the one test of 0.35. It is for impacts at speed. At low speeds restitution is higher, and delta-V "
        "too: enter the row that fits.",
    ),
    (
        ("Source (a number in brackets: as cited in SAE 2001-01-3347)", "Values"),
        (
            "Monson and Germane [23], SAE 1999-01-0097, frontal barrier, [30 mph|48 km/h]",
            "e_n 0.04 to 0.24, one test about 0.35",
        ),
        (
            "Monson and Germane [23], frontal barrier, [35 mph|56 km/h]",
            "e_n 0.08 to 0.23; on average higher than at [30 mph|48 km/h] for transverse engines (the engine meets the "
            "cowl)",
        ),
        (
            "SAE 931842, vehicle into the rear of a standing one, delta-V of [2 to 5 mph|3 to 8 km/h]",
            "e_n 0.2 to 0.4",
        ),
        (
            "King, Siegmund and Bailey [18], low-speed barrier and vehicle to vehicle, bumpers",
            "e_n 0.25 to 0.75",
        ),
        (
            "Ishikawa [17], 45 vehicle-to-vehicle tests: 32 side, 13 frontal, cars of about 1000 kg",
            "e_n: no clear trend with severity across configurations. e_t falls with tangential closing speed in side "
            "impacts; engagement is superficial below about [15 mph|24 km/h] of normal closing speed",
        ),
        (
            "Any impact",
            "−1 to 1. Below 0: a common velocity was never reached (sideswipe, break-through). "
            "1 or more adds energy: reject",
        ),
    ),
)


def restitution_input(symbol: str, name: str) -> Input:
    """The input cell of a restitution along the normal, which is printed as it is called in formulas."""
    return Input(symbol, symbol, name, "", _BASE, _SOURCE, _SHAPE, "Trapezoid", "0.00")
