"""Rows that wait until they are needed: a turning vehicle, the impact's duration; and what only the drawing uses."""

from __future__ import annotations

from templates.description import Equation, FilterRow, Input, Section
from templates.editions import Both
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = ["drawing_inputs", "duration_input", "duration_section", "turn_filters", "turn_inputs", "turn_section"]

_DURATION = (
    Equation(
        "a_mean_{j}",
        "ā{j}",
        "{who} mean acceleration during the impact",
        "g",
        'IF(t_impact>0,dV_{j}/(g*t_impact),"–")',
        "definition",
        "<A dash until a duration is entered on sheet Inputs. Severity is delta-V and the time it takes.|>",
        number_format="0.0",
    ),
    Equation(
        "dV_tyres_{j}",
        "ΔV{j} tyres",
        "{who} speed change by its tyres meanwhile",
        "[mph|km/h]",
        f'IF(t_impact>0,f_{{j}}*g*t_impact*{MPH},"–")',
        "assumption 1 of the paper",
        "<What this model neglects: the tyres' impulse, at most the post-impact friction times the duration.|>",
        number_format="0.00",
    ),
    Equation(
        "share_tyres_{j}",
        "",
        "{who} tyre impulse neglected, share of the impulse",
        "%",
        'IF(t_impact>0,100*f_{j}*g*t_impact/dV_{j},"–")',
        "assumption 1 of the paper",
        "<Above some 10 % of a delta-V that matters, use a model that keeps tyre forces.|>",
        number_format="0.0",
    ),
)

_TURN = (
    Equation(
        "a_lat_{j}",
        "alat{j}",
        "{who} lateral acceleration in its turn",
        "g",
        "IF(R_turn_{j}>0,V{j}_i^2/(g*R_turn_{j}),0)",
        "filter of the paper",
        "<0 until a radius is entered on sheet Inputs. A filter limits it to what the tyres can hold.|>",
        number_format="0.000",
    ),
)


def duration_input() -> Input:
    """The impact's duration, blank."""
    source = "Optional. 0.1 s, say. Gives the mean acceleration and the tyre impulse neglected"
    return Input("t_impact", "Δt", "Impact duration", "s", None, source, number_format="0.000")


def duration_section(number: int) -> Section:
    """Mean acceleration, and the tyre impulse that the model neglects."""
    return Section(f"{number}  Optional: duration of the impact", for_both(_DURATION))


def turn_inputs() -> tuple[Input, ...]:
    """The radius of either vehicle's turn, blank."""
    source = "Optional. Radius of the path before the impact, if the vehicle was turning: limits its speed"
    return tuple(
        Input(f"R_turn_{j}", f"Rturn,{j}", f"{vehicle(j)} radius of its turn", "[ft|m]", None, source) for j in (1, 2)
    )


def turn_section(number: int) -> Section:
    """The lateral acceleration that the impact speed would need."""
    return Section(f"{number}  Optional: a turning vehicle", for_both(_TURN))


def turn_filters() -> tuple[FilterRow, ...]:
    """A vehicle cannot turn faster than its tyres hold: off until a radius is entered."""
    because = (
        "Example; off until the radius of its turn is entered on sheet Inputs. Limit: the top of the range of "
        "friction; the tyres can hold no more sideways"
    )
    return tuple(FilterRow(f"{vehicle(j)} lateral acceleration", f"a_lat_{j}", because, at_most=0.95) for j in (1, 2))


def drawing_inputs() -> tuple[Input, ...]:
    """Length and width of the vehicles, for the drawing only."""
    sizes = (("length", "length", Both(16, 4.9)), ("width", "width", Both(6, 1.8)))
    return tuple(
        Input(f"{symbol}_{j}", "", f"{vehicle(j)} {name}", "[ft|m]", value, "Only for the drawing on sheet Scene")
        for j in (1, 2)
        for symbol, name, value in sizes
    )
