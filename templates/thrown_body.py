"""A body that a vehicle throws: flight, landing and slide, the same in every template.

With the fall H of its centre of gravity, s = (v·cos θ + μ·v·sin θ)²/(2·μ·g) + μ·H: the flight, then a landing at which
friction takes μ times the vertical speed from the speed along the ground, then the slide (Searle, SAE 831622). It holds
where the body slides on after it lands. A body that stops where it lands comes less far than that equation says: it was
faster, and its flight alone gives its speed.
"""

from __future__ import annotations

from templates.checks import check
from templates.description import Equation, Input
from templates.editions import Both

__all__ = ["ANGLE_CHECK", "EFFICIENCY_CHECK", "FRICTION_ROWS", "THROWN", "projection"]

THROWN = (
    Input(
        "mu",
        "μ",
        "Friction of the body on the ground",
        "",
        0.66,
        "Values that authors use with their equations: .5 to .8, most .60 to .71, Searle .66 and later .7 (Eubanks, "
        "Current Trends in Pedestrian Crash Reconstruction, 2008; sheet Guide). Enter: tests on this surface",
        {"Low": 0.5, "Low likeliest": 0.6, "High likeliest": 0.7, "High": 0.8},
        "Trapezoid",
        "0.00",
    ),
    Input(
        "H",
        "H",
        "Fall of the body's centre of gravity, from projection to rest",
        "[ft|m]",
        Both(2.3, 0.70),
        "Example, an adult on foot: [35 in|0.89 m] above the feet in a case on tarorigin.com, less some "
        "[7 in|0.19 m], judged, where it lies. Enter: from this body's height, the vehicle's front, and the slope",
        {"Low": Both(2.0, 0.6), "High": Both(2.7, 0.8)},
        number_format="0.00",
    ),
    Input(
        "angle",
        "θ",
        "Angle of projection above the ground",
        "deg",
        15,
        "Example, judged; riders of motorcycles leave at 10 to 20° (Hutchison, vceinc.com). Seldom known: 0 where the "
        "body was pushed forward; wide where it was lifted",
        {"Low": 0, "High": 30},
        number_format="0.0",
    ),
    Input(
        "efficiency",
        "η",
        "Projection speed over «1» speed",
        "",
        0.9,
        "Example, judged; no published value is quoted here. 1: the body reached the vehicle's speed. Less where it "
        "was lifted, or hit at the edge",
        {"Low": 0.8, "High": 1},
        number_format="0.00",
    ),
)
"""Friction on the ground, fall, angle of projection, and projection speed over that of the vehicle."""

_COSINE, _SINE = "COS(RADIANS(angle))", "SIN(RADIANS(angle))"
_SLIDES = f"IF(s>mu*H,SQRT(2*mu*g*(s-mu*H))/({_COSINE}+mu*{_SINE}),0)"
_STOPS = f"s*SQRT(g/(2*(H+s*TAN(RADIANS(angle)))))/{_COSINE}"


def projection(symbol: str, notation: str, name: str, where: str = "") -> tuple[Equation, ...]:
    """Steps to the speed `symbol` at which a body of the inputs `THROWN` leaves, to come to rest after `s`.

    Args:
        symbol: of the speed.
        notation: of the speed.
        name: of the speed.
        where: condition without which the throw has no speed; by default none.
    """
    speed = f"IF(u_after>=0,v_slide,{_STOPS})"
    return (
        Equation(
            "v_slide",
            "vslide",
            "Projection speed, if the body slides on after it lands",
            "[ft|m]/s",
            _SLIDES,
            "Searle, SAE 831622, with the fall H: √(2 μ g (s − μH))/(cos θ + μ sin θ)",
            "Flight, landing and slide with one μ; s is the whole distance.",
        ),
        Equation(
            "u_after",
            "ul",
            "Speed along the ground after landing",
            "[ft|m]/s",
            f"v_slide*{_COSINE}-mu*SQRT((v_slide*{_SINE})^2+2*g*H)",
            "v·cos θ − μ·√(v²·sin² θ + 2·g·H)",
            "Friction acts on the landing blow too. Below 0: it stopped where it landed, after a flight only.",
        ),
        Equation(
            symbol,
            notation,
            name,
            "[ft|m]/s",
            f"IF({where},{speed},NA())" if where else speed,
            "as above; where it stopped, the flight: s·√(g/(2·(H + s·tan θ)))/cos θ",
            "Steep or short throws stop where they land.",
        ),
    )


ANGLE_CHECK = check(
    "check_angle",
    "The angle of projection is an angle above or below the ground, within 90°",
    "ABS(angle)<90",
    "geometry",
    "FALSE: a compass direction entered as a slope?",
)

EFFICIENCY_CHECK = check(
    "check_efficiency",
    "The body is not faster than the vehicle",
    "AND(efficiency>0,efficiency<=1)",
    "physics",
    "FALSE: an inelastic body cannot leave faster than what pushes it.",
)

FRICTION_ROWS = (
    ("Searle", ".66, later .7"),
    ("Hague", ".62"),
    ("Northwestern University Traffic Institute", ".60"),
    ("Aronberg and Snider", ".5"),
    ("Collins", ".8"),
    ("Schmidt and Nagel", ".7"),
    ("Stcherbatcheff", ".71"),
)
"""Rows of the Guide: author, friction of a body in that author's equations, all as listed by Eubanks (2008)."""
