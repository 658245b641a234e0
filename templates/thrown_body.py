"""A body that a vehicle throws: flight, landing and slide, the same in every template.

With the fall H of its centre of gravity, s = (v·cos θ + μ·v·sin θ)²/(2·μ·g) + μ·H: the flight, then a landing at which
friction takes μ times the vertical speed from the speed along the ground, then the slide (Searle, SAE 831622). It holds
where the body slides on after it lands. A body that stops where it lands comes less far than that equation says: it was
faster, and its flight alone gives its speed. On a grade G the same follows with μ·g replaced by (μ + G)·g/√(1 + G²),
angles and distances taken along the road: flight, landing and slide lose speed to it at one rate.
"""

from __future__ import annotations

from templates.checks import check
from templates.description import Equation, Input
from templates.editions import Both

__all__ = [
    "ANGLE_CHECK",
    "EFFICIENCY_CHECK",
    "FRICTION_ROWS",
    "MORE_OF_THROW",
    "ON_THE_WAY",
    "SHARED_MOMENTUM",
    "THROWN",
    "projection",
]

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
        "Example, judged, for an adult on foot; no source read. Enter: from this body's height standing and lying, the "
        "vehicle's front, and the slope",
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

MORE_OF_THROW = (
    Input(
        "grade",
        "",
        "Grade of the road on which the body slid",
        "%",
        None,
        "Optional. Uphill along the throw positive. Blank: level",
    ),
    Input(
        "carried",
        "sc",
        "Way on the vehicle, from the impact to the projection",
        "[ft|m]",
        None,
        "Optional; it is part of the throw distance. Blank: none",
    ),
    Input(
        "w_body",
        "wb",
        "[Weight|Mass] of the body",
        "[lb|kg]",
        None,
        "Optional. With that of the vehicle: how much the body slowed it. Blank: not at all",
    ),
    Input("w_vehicle", "wv", "[Weight|Mass] of «1»", "[lb|kg]", None, "Optional. The same"),
)
"""Inputs that may stay blank: grade, way on the vehicle, and both weights."""

ON_THE_WAY = (
    Equation("slope", "G", "Grade", "", "N(grade)/100", "input", number_format="0.000"),
    Equation(
        "s_thrown",
        "sthr",
        "Way from the projection to rest",
        "[ft|m]",
        "s-N(carried)",
        "s − sc",
        number_format="0.00",
    ),
    Equation(
        "mu_road",
        "μG",
        "Friction and grade together",
        "",
        "(mu+slope)/SQRT(1+slope^2)",
        "(μ + G)/√(1 + G²)",
        "On level ground μ.",
        number_format="0.000",
    ),
)
"""What the throw is measured by; `projection` and bounds use it."""

SHARED_MOMENTUM = Equation(
    "slowed",
    "η·mb/mv",
    "Share of its speed after the impact that the vehicle gave to the body",
    "",
    "IF(AND(N(w_body)>0,N(w_vehicle)>0),efficiency*w_body/w_vehicle,0)",
    "momentum: mv·V = mv·V′ + mb·vp, vp = η·V′",
    "η is the body's speed over that of the vehicle after the impact; before it the vehicle had this share more.",
    number_format="0.0000",
)

_COSINE, _SINE, _TANGENT = (f"{of}(RADIANS(angle))" for of in ("COS", "SIN", "TAN"))
_SLIDES = f"IF(s_thrown>mu*H,SQRT(2*mu_road*g*(s_thrown-mu*H))/({_COSINE}+mu*{_SINE}),0)"
_STOPS = f"(s_thrown+slope*H)*SQRT(g/(2*(H+s_thrown*{_TANGENT})*(1-slope*{_TANGENT}))/SQRT(1+slope^2))/{_COSINE}"
_LANDING = f"SQRT((v_slide*{_SINE})^2+2*g*H/SQRT(1+slope^2))"


def projection(symbol: str, notation: str, name: str, where: str = "") -> tuple[Equation, ...]:
    """Steps to the speed `symbol` at which a body of the inputs `THROWN` leaves, to come to rest after `s_thrown`.

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
            "Searle, SAE 831622, with the fall H: √(2 μ g (s − μH))/(cos θ + μ sin θ); μG on a grade",
            "Flight, landing and slide with one μ; s is the whole distance.",
        ),
        Equation(
            "u_after",
            "ul",
            "Speed along the ground after landing",
            "[ft|m]/s",
            f"v_slide*{_COSINE}-slope*(v_slide*{_SINE}+{_LANDING})-mu*{_LANDING}",
            "v·cos θ − μ·√(v²·sin² θ + 2·g·H)",
            "Friction acts on the landing blow too, and the grade on the flight. Below 0: it stopped where it landed, "
            "after a flight only.",
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
