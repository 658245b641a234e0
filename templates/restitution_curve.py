"""Restitution against closing speed: a range at each of three published speeds, as a limit or a likelihood.

The range between two speeds is drawn straight, and held beyond the first and the last. Taken as two standard deviations
to either side of its middle, it says how many of them a trial's restitution is off.
"""

from __future__ import annotations

from templates.description import Curve, Diagram, Equation, EvidenceRow, Input, Look, Section
from templates.editions import Both

__all__ = ["curve_diagram", "curve_evidence", "curve_inputs", "curve_section"]

_POINTS = (
    (
        Both(8, 13),
        0.2,
        0.4,
        "SAE 931842: 0.2 to 0.4 at a delta-V of [2 to 5 mph|3 to 8 km/h] of a standing vehicle struck from behind, "
        "which like cars have that close at up to [8 mph|13 km/h]",
    ),
    (
        Both(60, 97),
        0.04,
        0.24,
        "Monson and Germane, SAE 1999-01-0097: 0.04 to 0.24 at [30 mph|48 km/h] into a barrier, one test about 0.35. "
        "Each of two like cars meets that which close at twice the speed",
    ),
    (
        Both(70, 113),
        0.08,
        0.23,
        "The same: 0.08 to 0.23 at [35 mph|56 km/h] into a barrier",
    ),
)


def curve_inputs() -> tuple[Input, ...]:
    """The speeds and ranges, filled in as published; they have no effect before a row of Evidence is used."""
    return tuple(
        Input(
            f"{symbol}_{k}",
            f"{notation}{k}",
            f"Restitution curve, point {k}: {name}",
            unit,
            value,
            source,
            number_format=shown,
        )
        for k, (speed, low, high, source) in enumerate(_POINTS, 1)
        for symbol, notation, name, unit, value, shown in (
            ("Vc_curve", "Vcurve,", "closing speed", "[mph|km/h]", speed, "0"),
            ("e_from", "efrom,", "from", "", low, "0.00"),
            ("e_to", "eto,", "to", "", high, "0.00"),
        )
    )


def _between(end: str, speed: str) -> str:
    def part(k: int) -> str:
        share = f"({speed}-Vc_curve_{k})/(Vc_curve_{k + 1}-Vc_curve_{k})"
        return f"{end}_{k}+({end}_{k + 1}-{end}_{k})*{share}"

    return (
        f"IF({speed}<=Vc_curve_1,{end}_1,IF({speed}<=Vc_curve_2,{part(1)},IF({speed}<=Vc_curve_3,{part(2)},{end}_3)))"
    )


def curve_section(number: int, restitution: str, speed: str) -> Section:
    """What the published range is at the closing speed of a trial, and where its restitution lies in it.

    Args:
        number: of the section.
        restitution: its symbol.
        speed: symbol of the closing speed, in mph or km/h.
    """
    reference = "sheet Inputs, straight between points"
    return Section(
        f"{number}  Optional: restitution against closing speed",
        (
            Equation(
                "e_least",
                "eleast",
                "Published restitution at this closing speed, from",
                "",
                _between("e_from", speed),
                reference,
            ),
            Equation("e_most", "emost", "The same, to", "", _between("e_to", speed), reference),
            Equation(
                "e_off",
                "eoff",
                "Restitution, standard deviations from the middle of that",
                "",
                f"({restitution}-(e_least+e_most)/2)/((e_most-e_least)/4)",
                "(e − middle)/(range/4)",
                "The range counts as two standard deviations to either side. Rows of sheet Evidence use it.",
                number_format="0.00",
            ),
        ),
    )


def curve_evidence() -> tuple[EvidenceRow, ...]:
    """The curve as a limit and as a likelihood, neither used."""
    why = "Tests scatter, and no test is this crash: sheet Guide. Set Use to TRUE in one of the two rows, not in both"
    return (
        EvidenceRow(
            "Restitution within the published range", "e_off", 0, "Uniform", {"Plus or minus": 2}, why, use=False
        ),
        EvidenceRow("Restitution by the published scatter", "e_off", 0, "Normal", {"Std dev": 1}, why, use=False),
    )


def curve_diagram(restitution: str, speed: str, *, low_speeds: bool = False) -> Diagram:
    """The published range against closing speed, and the base case in it.

    Args:
        restitution: its symbol.
        speed: symbol of the closing speed, in mph or km/h.
        low_speeds: draw as far as 20 mph, and no farther than the base case asks for.
    """

    def ends(symbol: str) -> tuple[tuple[str, str], ...]:
        if low_speeds:
            last = f"MAX([20|32],1.2*{speed})"
            return (("0", f"{symbol}_1"), ("Vc_curve_1", f"{symbol}_1"), (last, _between(symbol, last)))
        inner = tuple((f"Vc_curve_{k}", f"{symbol}_{k}") for k in (1, 2, 3))
        return (("0", f"{symbol}_1"), *inner, (f"MAX(1.2*Vc_curve_3,{speed})", f"{symbol}_3"))

    return Diagram(
        "Restitution against closing speed",
        "Closing speed, [mph|km/h]",
        "Restitution",
        (
            Curve("Range on sheet Inputs, to", Look.FIRST, ends("e_to")),
            Curve("The same, from", Look.SECOND, ends("e_from")),
            Curve("Base case", Look.POINT, ((speed, restitution),)),
        ),
        remark="Drawn from the cells below. The range is that of the points on sheet Inputs.",
    )
