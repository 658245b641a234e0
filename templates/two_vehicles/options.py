"""Rows that wait until they are needed: a turning vehicle, the impact's duration; and what only the drawing uses."""

from __future__ import annotations

from templates.description import RULE_OF_TYRES, Equation, FilterRow, Input, Section
from templates.editions import Both
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = ["drawing_inputs", "duration_inputs", "duration_section", "turn_filters", "turn_inputs", "turn_section"]

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

_JUDGED = Equation(
    "t_judged",
    "Δtj",
    "Duration by which the tyre impulse is judged",
    "s",
    "IF(t_impact>0,t_impact,t_otherwise)",
    "input",
    number_format="0.000",
)

_MOST = (
    "MAX(" + ",".join(f"IF([w|m]_{j}<100*[w|m]_{k},100*f_{j}*g*t_judged/dV_{j},0)" for j, k in ((1, 2), (2, 1))) + ")"
)

_RULE = Equation(
    RULE_OF_TYRES,
    "",
    "Tyre impulse neglected, judged by the rule of 10 %",
    "",
    f'IF({_MOST}>10,"Tyre forces neglected may be "&TEXT({_MOST},"0")&" % of an impulse in "&TEXT(t_judged,"0.00")&'
    '" s: above 10 % use a model that keeps them","–")',
    "assumption 1 of the paper",
    "Of the vehicle that it is most of; a wall, 100 times as heavy, has no tyres. Sheet Inputs says so, too.",
    number_format="General",
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


def duration_inputs() -> tuple[Input, ...]:
    """The impact's duration, blank, and the one that the tyre impulse is judged by meanwhile."""
    source = "Optional. 0.1 s, say. Gives the mean acceleration and the tyre impulse neglected"
    judged = (
        "Used only to judge the tyre impulse where no duration is entered. It amounts to about [1.8 mph|2.8 km/h] in "
        "each 0.1 s of contact at a friction of 0.8: f·g·Δt"
    )
    return (
        Input("t_impact", "Δt", "Impact duration", "s", None, source, number_format="0.000"),
        Input("t_otherwise", "Δt0", "The same, where it is blank", "s", 0.1, judged, number_format="0.000"),
    )


def duration_section(number: int) -> Section:
    """Mean acceleration, and the tyre impulse that the model neglects."""
    return Section(f"{number}  Optional: duration of the impact", (*for_both(_DURATION), _JUDGED, _RULE))


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
