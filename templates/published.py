"""Worked examples with published or independently computed answers, as filled-in templates."""

from __future__ import annotations

from dataclasses import replace

from templates import (
    airborne,
    collinear,
    critical_speed_yaw,
    crush_energy,
    edr_speed,
    low_speed,
    momentum_energy,
    motorcycle,
    pedestrian,
    pedestrian_throw,
    skid,
    time_distance,
    video_speed,
)
from templates.description import ForecastRow, GuideSection, Template
from templates.editions import Edition, edition
from templates.filled import filled
from templates.planar_forward import describe as planar_forward
from templates.two_vehicles.example_scene import FORWARD_EXAMPLE
from templates.vehicles import vehicle

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
        "Georgia Tech's Impact, problem 2 (aeresources.gatech.edu) prints 80 m/s (288 km/h) for the impact speed. The "
        "answer is 26.67 m/s (96 km/h): the printed one comes from a separation speed of the wrong sign. It is entered "
        "here as the claimed speed, and its check in "
        "sheet Model is red: «1» would leave through «2», with a restitution of −0.5."
    ),
)

_FORWARD = edition(planar_forward(FORWARD_EXAMPLE), Edition.IMPERIAL)
_BARRIER = filled(
    _FORWARD,
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

_BUMPER_TEST = filled(
    edition(low_speed.TEMPLATE, Edition.IMPERIAL),
    "A Polo into a Fiesta that stood",
    "5.5 mph; delta-V 3.5 and 3.1 mph",
    {
        "w_1": 3100,
        "w_2": 3500,
        "e": 0.2,
        "V1_before": 5.5,
        "f_1": 0,
        "f_2": 0,
        "v_bumper_1": 2.5,
        "v_bumper_2": 2.5,
    },
    _GIVEN,
    _about(
        "A published bumper test: a closing speed of 5.5 mph left delta-V of 3.5 and 3.1 mph. Both together are (1 "
        "+ e) times the closing speed: e = 0.2. Their ratio is that of the masses; only that ratio is known here, not "
        "the weights themselves. Brakes were off. Deflection and shape of the force are the template's examples, so "
        "that duration and mean accelerations are too.",
        "Bumpers that take 2.5 mph each, as 49 CFR 581.5 asks, would be at their limits at a closing speed of 5 mph "
        "if they were no better than that: section 3 of sheet Model.",
    ),
)

_MOTORCYCLE = filled(
    edition(motorcycle.TEMPLATE, Edition.SI),
    "A motorcycle head-on into a car",
    "250 kg against 1200 kg at 70 km/h, which go on together at 45 km/h",
    {
        "d_upright": 0,
        "m_1": 250,
        "m_2": 1200,
        "alpha_1": 180,
        "alpha_2": 0,
        "beta_1": 0,
        "beta_2": 0,
        "s_1": (45 / _KMH_PER_M_S) ** 2 / (2 * 0.65 * 9.80665),
        "f_1": 0.65,
        "s_2": (45 / _KMH_PER_M_S) ** 2 / (2 * 0.65 * 9.80665),
        "f_2": 0.65,
        "V2_before": 70,
        "s": 0,
        "car_known": 2,
    },
    _GIVEN,
    _about(
        "A worked problem (userz.net): 1200 kg at 70 km/h meet a motorcycle of 250 kg and push it on at 45 km/h. Its "
        "speed was 75 km/h. The page prints 74.23, as it rounds to 19.4 and 12.5 m/s on the way: with so light a "
        "partner 0.16 km/h of the car are 0.8 km/h of the motorcycle, and a check of sheet Model is red. "
        "The ways to rest are those of 45 km/h at 0.65 g.",
        "Head-on, directions say nothing (their sine is 0): the speed of the car is entered, and momentum taken along "
        "the motorcycle's way.",
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

_AMY = filled(
    edition(airborne.TEMPLATE, Edition.IMPERIAL),
    "The case of airborne Amy",
    "Skid of 32.7 ft at 0.45, then 44.6 ft across and 8.3 ft down, level take-off",
    {"d": 44.6, "h": 8.3, "theta": 0, "f": 0.45, "s": 32.7, "g": 32.2},
    _GIVEN,
    _about(
        "Inputs of Design News, 19 August 2002, with its g of 32.2 ft/s²: 0.718 s in the air, 62.12 ft/s (42.35 mph) "
        "at take-off, 69.33 ft/s (47.27 mph) before braking. A degree of slope at take-off moves the speed by 2 mph."
    ),
)

_LEFT_TURN = filled(
    edition(time_distance.TEMPLATE, Edition.IMPERIAL),
    "A left turn from rest",
    "40 mph at the impact after 60 ft of braking; would it have been avoided at 45 mph?",
    {
        "v_impact": 40,
        "d_brake": 60,
        "f": 0.7,
        "d_intruder": 22,
        "u": 0,
        "a_intruder": 0.2,
        "clearance": 12,
        "t_fresh": 1.25,
        "limit": 45,
    },
    _GIVEN,
    _about(
        "A worked example, checked by a program that steps through time in 10 µs: 53.45 mph before braking, a response "
        "time of 1.739 s. At 45 mph the same driver would have arrived 0.259 s after the other had cleared: "
        "avoided. At 50 mph it would have come 0.375 s too early, at 32.6 mph. At 40 mph it would have stopped."
    ),
)

_RECORDED = filled(
    edition(edr_speed.TEMPLATE, Edition.IMPERIAL),
    "40 mph in the last sample, braking hard",
    "13 % slip, 0.7 g, the impact 0.25 s after the last sample; delta-V 20 mph",
    {
        "q": 0,
        "kappa": 0.13,
        "f": 0.7,
        "tau": 0.25,
        "v_last": 40,
        "dv_long": 20,
        "w_own": 3500,
        "w_other": 4000,
        "e": 0.1,
    },
    _GIVEN,
    _about(
        "A worked example: 40 mph recorded is 45.98 mph true, and 42.14 mph at the impact. A delta-V of 20 mph of "
        "3500 lb into 4000 lb, e = 0.1, along one line, is a closing speed of 34.09 mph."
    ),
)

_TWO_FRAMES = filled(
    edition(video_speed.TEMPLATE, Edition.IMPERIAL),
    "10 ft in two frames",
    "Ten frames a second (Lynch, forensicdjs.com): 50 ft/s",
    {"d": 10, "n": 2, "rate": 10, "a": 0},
    _GIVEN,
    _about(
        "10 ft in two frames at ten a second are 50 ft/s, 34.1 mph. What the example does not say: each crossing lies "
        "anywhere within a frame, so that 95 % of such readings mean 24.6 to 55.7 mph. The red check says so."
    ),
)

_NEARLY_HEAD_ON = filled(
    edition(momentum_energy.TEMPLATE, Edition.SI),
    "Nearly head-on",
    "880 kg and 1600 kg, after the impact 35 and 51 km/h; EES 66 and 42 km/h",
    {
        "m_1": 880,
        "alpha_1": 0,
        "beta_1": -9,
        "s_1": round((35 / _KMH_PER_M_S) ** 2 / (2 * 0.7 * 9.81), 9),
        "f_1": 0.7,
        "m_2": 1600,
        "beta_2": 182,
        "s_2": round((51 / _KMH_PER_M_S) ** 2 / (2 * 0.7 * 9.81), 9),
        "f_2": 0.7,
        "EES_1": 66,
        "phi_1": 200,
        "mu_1": 0.4,
        "I_1": 998.348,
        "R_1": 2.4,
        "EES_2": 42,
        "phi_2": 64,
        "mu_2": 0.3,
        "I_2": 2681.42,
        "R_2": 2.795,
        "g": 9.81,
        "length_1": 3.725,
        "length_2": 4.725,
    },
    _GIVEN,
    _about(
        "Inputs of Schreier and Nelson (SAE Transactions 96, 1987, page 152); the travel distances are those of the "
        "speeds after the impact. A closing speed of 141.6 km/h, impact speeds of 70.68 and 70.99 km/h, and the second "
        "vehicle from 183.87°. Momentum alone, with that angle known within 3°, leaves 95 % of −817 to +1036 km/h."
    ),
)

_THROWN = filled(
    edition(pedestrian_throw.TEMPLATE, Edition.IMPERIAL),
    "A body thrown at 30 mph",
    "60.42 ft from the impact to rest; 15° above the ground, 2.3 ft of fall, friction 0.66",
    {"s": 60.42319, "mu": 0.66, "H": 2.3, "angle": 15, "efficiency": 0.9, "g": 32.174},
    _GIVEN,
    _about(
        "A worked example, checked by a program that steps through flight, landing and slide in 10 µs: a body that "
        "leaves at 30 mph, 15° above the ground, falls 2.3 ft and slides at 0.66 comes to rest after 60.42 ft. The "
        "sheet returns 30 mph. If 0.9 of the vehicle's speed was given to it, the vehicle had 33.3 mph.",
        "Where the angle is not known, the throw alone says at least 28.46 mph. After a hit and run that may be all.",
    ),
)

_CROSSING = filled(
    edition(pedestrian.TEMPLATE, Edition.IMPERIAL),
    "A pedestrian who walked 20 ft",
    "25 mph, not braked; 4 to 5 ft/s on foot: how far away was the car?",
    {
        "f": 0.7,
        "d_before": 0,
        "d_after": round((25 / _MPH_PER_FT_S) ** 2 / (2 * 0.7 * 32.174), 9),
        "s": 0,
        "walked": 20,
        "walking": (4, 5),
        "known": 1,
        "braked": 2,
        "limit": 20,
        "g": 32.174,
    },
    "As the example gives it",
    _about(
        "A published example (Schorr, forensicdjs.com): a pedestrian walks 20 ft at 4 to 5 ft/s, and a car at 25 mph "
        "is then 145 to 180 ft away when they step off. Exactly it is 146.7 to 183.3 ft. The speed is entered as the "
        "braking that it takes after the impact, 29.84 ft at 0.7 g, which the example does not have.",
        "The car had not braked when it struck. So the scene gives a lower bound of the response time, 4 to 5 s, and "
        "for 20 mph both ends: stops always, if it brakes as soon as that time has passed; never, if it never brakes.",
    ),
)

_SEARCH_RANGE = "Searched: all that the scene allows"
_REST = filled(
    replace(
        _FORWARD,
        settings=(("Until accepted", 10_000), ("Seed", 999)),
        forecasts=(
            *(row for row in _FORWARD.forecasts if row.symbol.startswith(("V1_fits", "V2_fits", "dV"))),
            *(ForecastRow(f"{vehicle(j)} approach angle that fits", f"alpha_fits_{j}", "deg") for j in (1, 2)),
        ),
    ),
    "Impact speeds searched from rest positions",
    "Both vehicles' departure and travel to rest are known; speeds and headings are searched for",
    {
        "w_1": (3400, 3600),
        "I_1": (1950, 2250),
        "alpha_1": (-6, 6),
        "V1_before": (10, 70),
        "f_1": (0.6, 0.75),
        "x_1": (78, 86),
        "y_1": (0, 12),
        "w_2": (3000, 3200),
        "I_2": (1600, 1900),
        "alpha_2": (75, 105),
        "V2_before": (0, 50),
        "f_2": (0.6, 0.75),
        "x_2": (4, 24),
        "y_2": (-35, -29),
        "gamma_t": (80, 100),
        "e_n": (0.04, 0.24),
        "e_t": (0, 0.25),
    },
    _SEARCH_RANGE,
    _about(
        "What an optimiser of PC-Crash does, with all solutions in place of one: impact speeds and headings are drawn "
        "from wide ranges, the impact and the run-out follow, and evidence keeps the trials that end where the "
        "vehicles were found. The base case is the middle of every range; it does not fit.",
        "The scene is computed, so that its truth is known: 38 mph at 0° into 24 mph at 90°, friction 0.68, "
        "restitution 0.12 and 0.1. The vehicles left at 21.0° and 35.5° and went 17.8 and 38.8 ft: these are the "
        "readings, within 2° and 1.5 ft.",
        "One trial in about 7,000 fits, so the run goes on until 10,000 are accepted (sheet Results wanted). A single "
        "best fit would hide how wide the answer is.",
    ),
    {"beta_1": (21.0, 2), "s_1": (17.8, 1.5), "beta_2": (35.5, 2), "s_2": (38.8, 1.5)},
)

PUBLISHED: dict[str, Template] = {
    "skid-100-ft": _SKID,
    "yaw-mark": _YAW,
    "collinear-equal-cars": _EQUAL_CARS,
    "collinear-head-on": _HEAD_ON,
    "textbook-claim": _TEXTBOOK,
    "barrier-corner": _BARRIER,
    "bumper-test": _BUMPER_TEST,
    "motorcycle-head-on": _MOTORCYCLE,
    "crush-balance": _CRUSH,
    "airborne-amy": _AMY,
    "left-turn": _LEFT_TURN,
    "edr-hard-braking": _RECORDED,
    "video-two-frames": _TWO_FRAMES,
    "nearly-head-on": _NEARLY_HEAD_ON,
    "thrown-body": _THROWN,
    "crossing-pedestrian": _CROSSING,
    "rest-positions": _REST,
}
"""File name without its ending -> what the workbook says."""
