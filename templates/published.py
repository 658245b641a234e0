"""Worked examples with published or independently computed answers, as filled-in templates."""

from __future__ import annotations

from templates import collinear, critical_speed_yaw, crush_energy, skid
from templates.description import GuideSection, Template
from templates.editions import Edition, edition
from templates.filled import filled
from templates.planar_forward import describe as planar_forward
from templates.two_vehicles.example_scene import FORWARD_EXAMPLE

__all__ = ["PUBLISHED"]

_MPH_PER_FT_S = 3600 / 5280
_KMH_PER_M_S = 3.6
_GIVEN = "As the example gives it: one value, no range"


def _about(*paragraphs: str) -> GuideSection:
    return GuideSection("This workbook", paragraphs)


_SKID = filled(
    edition(skid.TEMPLATE, Edition.IMPERIAL),
    "Skid of 100 ft",
    "Friction 0.75, level, to rest",
    {"f_1": 0.75, "d_1": 100, "d_2": 0, "d_3": 0, "v_end": 0},
    _GIVEN,
    _about("A worked example: 100 ft of skid at 0.75 g to rest is 47.366 mph (g = 32.174 ft/s²)."),
)

_YAW = filled(
    edition(critical_speed_yaw.TEMPLATE, Edition.IMPERIAL),
    "Yaw mark of 52 ft chord",
    "Middle ordinate 6 ft, friction 0.2",
    {"chord": 52, "ordinate": 6, "f": 0.2},
    _GIVEN,
    _about("A worked example: chord 52 ft and middle ordinate 6 ft are a radius of 59.33 ft; at 0.2 g, 13.32 mph."),
)

_EQUAL_CARS = filled(
    edition(collinear.TEMPLATE, Edition.IMPERIAL),
    "Into an equal car that stands",
    "5000 lb at 90 ft/s, plastic",
    {
        "w_1": 5000,
        "w_2": 5000,
        "e": 0,
        "V2_before": 0,
        "V1_before": 90 * _MPH_PER_FT_S,
        "V2_after": 45 * _MPH_PER_FT_S,
        "known": 1,
    },
    _GIVEN,
    _about("A worked example: 5000 lb at 90 ft/s (61.36 mph) into an equal car at rest, plastic: 45 ft/s together."),
)

_HEAD_ON = filled(
    edition(collinear.TEMPLATE, Edition.IMPERIAL),
    "Head-on, momenta equal",
    "5000 lb at 20 mph against 2500 lb at 40 mph, plastic",
    {"w_1": 5000, "w_2": 2500, "e": 0, "V2_before": -40, "V1_before": 20, "V2_after": 0, "known": 2},
    _GIVEN,
    _about("A worked example: 5000 lb at 20 mph against 2500 lb at 40 mph, head-on, plastic: both stop."),
)

_TEXTBOOK = filled(
    edition(collinear.TEMPLATE, Edition.SI),
    "A published answer that physics refuses",
    "1500 kg into 2500 kg at rest, which leaves at 15 m/s; e = 0.5",
    {
        "m_1": 1500,
        "m_2": 2500,
        "e": 0.5,
        "V2_before": 0,
        "V2_after": 15 * _KMH_PER_M_S,
        "known": 2,
        "V1_claimed": 80 * _KMH_PER_M_S,
    },
    _GIVEN,
    _about(
        "A textbook prints 80 m/s (288 km/h) for the impact speed. The answer is 26.67 m/s (96 km/h): the printed one "
        "has the separation speed negative. It stands here as the claimed speed, and its check in sheet Model is red: "
        "«1» would leave through «2», with a restitution of −0.5."
    ),
)

_BARRIER = filled(
    edition(planar_forward(FORWARD_EXAMPLE), Edition.IMPERIAL),
    "Front corner into a barrier",
    "SAE 2019-01-0422: 39.95 mph, tangent at 74.6°, impulse ratio up to 0.82, e = 0",
    {
        "w_1": 3574.2,
        "I_1": 2336.3,
        "alpha_1": 0,
        "V1_before": 39.9545,
        "x_1": 3.6209 * 12,
        "y_1": 2.0071 * 12,
        "w_2": 1e7,
        "I_2": 1e8,
        "alpha_2": 74.6,
        "V2_before": 0,
        "x_2": 0,
        "y_2": 0,
        "gamma_t": 74.6,
        "e_n": 0,
        "e_t": 0,
        "mu": 0.82,
        "closure": 2,
        "g": 32.2,
        "length_2": 24,
        "width_2": 1,
    },
    _GIVEN,
    _about(
        "The worked example of SAE 2019-01-0422: a car of 3574.2 lb strikes a barrier of 10,000,000 lb with its right "
        "front corner. Published: delta-V −35.7275 mph along and 7.5998 mph to the left, change in yaw rate −176.43 "
        "deg/s, 170,421 ft·lb lost. g is 32.2 ft/s², as the published change in yaw rate requires."
    ),
)

_STATIONS = range(1, 7)

_CRUSH = filled(
    edition(crush_energy.TEMPLATE, Edition.IMPERIAL),
    "Two stiffnesses, one force",
    "A 479.7/355.8 lb/in, B 52.2/34.0 lb/in²; 14 in of crush against 25.138 in, over 60 in",
    {
        "A_given_1": 479.7,
        "B_given_1": 52.2,
        "A_given_2": 355.8,
        "B_given_2": 34.0,
        "L_1": 60,
        "L_2": 60,
        **{f"c_1_{station}": 14 for station in _STATIONS},
        **{f"c_2_{station}": 25.138 for station in _STATIONS},
        **{f"{symbol}_{j}": 0 for symbol in ("bias", "theta", "h") for j in (1, 2)},
    },
    _GIVEN,
    _about(
        "A worked example: 14 in of crush on one vehicle balances 25.138 in on the other; over 60 in they took 70,178 "
        "and 107,743 ft·lb. A and B are published single values: their scatter is not known."
    ),
)

PUBLISHED: dict[str, Template] = {
    "skid-100-ft": _SKID,
    "yaw-mark": _YAW,
    "collinear-equal-cars": _EQUAL_CARS,
    "collinear-head-on": _HEAD_ON,
    "textbook-claim": _TEXTBOOK,
    "barrier-corner": _BARRIER,
    "crush-balance": _CRUSH,
}
"""File name without its ending -> what the workbook says."""
