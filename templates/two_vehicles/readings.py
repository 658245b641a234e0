"""Rows for what was measured of two vehicles beside their marks: recorders, videos, damage, direction of force."""

from __future__ import annotations

from templates.description import Equation, EvidenceRow, Input, Section
from templates.editions import Both
from templates.other_readings import cut_off_delta_v
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = ["direction_reading", "direction_section", "lever_inputs", "readings", "recorder_section", "rotation_inputs"]

_RECORDER = {"Percent": 10, "Resolution": Both(0.31, 0.5)}
_RULE = "49 CFR 563.8: within 10 %, in steps of 1 km/h"

_NEAR_READING = (
    Equation(
        "PDOF_near_{j}",
        "PDOF{j} near",
        "{who} PDOF, counted to within 180° of its reading",
        "deg",
        "IF(ISNUMBER(PDOF_reading_{j}),PDOF_{j}-360*ROUND((PDOF_{j}-PDOF_reading_{j})/360,0),PDOF_{j})",
        "convention",
        "<For a blow from behind: 179° and −179° are 2° apart. The reading of sheet Evidence says how to count, also "
        "where its Use is FALSE.|>",
        number_format="0.0",
    ),
)

_AT_THE_SENSOR = (
    Equation(
        "edr{j}_long",
        "ΔV{j} EDR,long",
        "{who} delta-V where its recorder sits, forward",
        "[mph|km/h]",
        f"dV{{j}}_long+d_omega_{{j}}*N(ys_{{j}})[/in_per_ft|]*{MPH}",
        "ΔV + Δω·y",
        "<The recorder turns about the CG with the vehicle. At the CG while its position is blank.|>",
        number_format="0.00",
    ),
    Equation(
        "edr{j}_right",
        "ΔV{j} EDR,right",
        "{who} delta-V where its recorder sits, to the right",
        "[mph|km/h]",
        f"dV{{j}}_right-d_omega_{{j}}*N(xs_{{j}})[/in_per_ft|]*{MPH}",
        "ΔV − Δω·x",
        "<To the right positive, as 49 CFR 563.5 asks of recorders. A reading that counts to the left: change its "
        "sign.|>",
        number_format="0.00",
    ),
    Equation(
        "omega{j}_after_deg",
        "ω{j}f (deg/s)",
        "{who} yaw rate after the impact",
        "deg/s",
        "DEGREES(omega{j}_f)",
        "eqs (17), (18)",
        number_format="0.0",
    ),
    Equation(
        "spin_{j}",
        "",
        "{who} energy of rotation, over the work of its tyres until rest",
        "",
        'IF(AND(phi_{j}<>0,N(mu_R_{j})>0,N(R_{j})>0),I_{j}*omega{j}_f^2/(mu_R_{j}*m_{j}*g*R_{j}*RADIANS(ABS(phi_{j}))),"–")',
        "I·ω²/(μR·m·g·R·|φ|)",
        "<A crude law: 1 within a factor of 1.5 to 2 where it turned so far to rest. A dash until sheet Inputs "
        "has the rotation.|>",
        number_format="0.00",
    ),
)


def lever_inputs() -> tuple[Input, ...]:
    """Where the recorders sit, blank."""
    return tuple(
        Input(f"{axis}s_{j}", f"{axis}s{j}", f"{vehicle(j)} recorder, {where} the CG", "[in|m]", None, source)
        for j in (1, 2)
        for axis, where, source in (
            ("x", "forward of", "Optional. Blank: at the CG"),
            ("y", "to the right of", "Optional. Blank: at the CG"),
        )
    )


def rotation_inputs() -> tuple[Input, ...]:
    """How far the vehicles turned until rest, blank."""
    rows = (
        ("phi", "φ", "rotation from the impact to rest", "deg", "Optional. Whole turns only where marks show them"),
        (
            "mu_R",
            "μR",
            "friction against rotating",
            "",
            "Optional. 0.3 to 0.4 in the case of Schreier and Nelson (1987)",
        ),
        ("R", "R", "wheelbase", "[ft|m]", "Optional. Published dimensions"),
    )
    return tuple(
        Input(f"{symbol}_{j}", f"{notation}{j}", f"{vehicle(j)} {name}", unit, None, source)
        for j in (1, 2)
        for symbol, notation, name, unit, source in rows
    )


def recorder_section(number: int) -> Section:
    """What recorders and rest headings are compared with, where yaw is known."""
    return Section(
        f"{number}  Optional: what recorders, rest headings and damage are held against",
        for_both(_AT_THE_SENSOR + _NEAR_READING),
    )


def direction_section(number: int) -> Section:
    """What a direction of force is compared with, where yaw is not known."""
    return Section(f"{number}  Optional: what the direction of force is held against", for_both(_NEAR_READING))


def direction_reading(j: int) -> EvidenceRow:
    """The direction of force of one vehicle, from its damage."""
    return EvidenceRow(
        f"{vehicle(j)} direction of force",
        f"PDOF_near_{j}",
        None,
        "Normal",
        {"Std dev": 12.6},
        "From the damage, counter-clockwise from the front; a clock direction h is −30·h. Investigators against EDRs: "
        "SD 12.6° (Traffic Injury Prevention)",
        named=f"PDOF_reading_{j}",
    )


def readings(*, yaw: bool) -> tuple[EvidenceRow, ...]:
    """The rows of both vehicles, off until a reading is entered.

    Args:
        yaw: the model has yaw rates.
    """
    rows: list[EvidenceRow] = []
    for j in (1, 2):
        who = vehicle(j)
        along, right = (f"edr{j}_long", f"edr{j}_right") if yaw else (f"dV{j}_long", f"dV{j}_right")
        rows += [
            EvidenceRow(
                f"{who} EDR delta-V, forward", along, None, "Instrument", _RECORDER, f"{_RULE}. Slowed: negative"
            ),
            EvidenceRow(
                f"{who} EDR delta-V, to the right",
                right,
                None,
                "Instrument",
                _RECORDER,
                f"{_RULE}. Right positive, as 49 CFR 563.5 counts",
            ),
            cut_off_delta_v(f"{who} delta-V", f"dV{j}_[mph|kmh]"),
            EvidenceRow(
                f"{who} impact speed, from an EDR or a video",
                f"V{j}_[mph|kmh]",
                None,
                "Normal",
                {},
                "A reading of its own: middle and standard deviation of edr-speed or video-speed, if they share "
                "no input with this workbook",
            ),
            direction_reading(j),
        ]
        if yaw:
            rows += [
                EvidenceRow(
                    f"{who} measured yaw rate after the impact",
                    f"omega{j}_after_deg",
                    None,
                    "Instrument",
                    {"Percent": 10},
                    "Enter the reading; 49 CFR 563.8 asks 10 % of angles, makers state their own for yaw rates",
                ),
                EvidenceRow(
                    f"{who} rotation until rest",
                    f"spin_{j}",
                    None,
                    "Lognormal",
                    {},
                    "First the rotation on sheet Inputs; then Reading 1, and a standard deviation of the logarithm: "
                    "the law is crude, a factor of 1.5 to 2",
                ),
            ]
    return (
        *rows,
        EvidenceRow(
            "Energy lost, from the damage of both",
            "E_lost",
            None,
            "Lognormal",
            {"Std dev": 0.2},
            "The energy lost to the crush by crush-energy, which is 1 − e² of the energy absorbed, if its profile is "
            "used nowhere else; where the contact slid, more was lost. Delta-V by CRASH3 was within 9 to 25 % (Smith "
            "and Noga, DOT HS 806 152), energy within twice that",
        ),
    )
