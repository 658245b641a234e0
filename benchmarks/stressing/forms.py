"""The table of forms: each equation of SAE 2001-01-3347 as printed, and as the templates have it.

The rewritten forms are the templates' own equations, read from their description, so that what is measured is what is
shipped. To add a form: write its printed cells into `PRINTED`, name both cells in `FORMS`, and say in `exact.py` what
the answer is.

Printed forms have their angles in radians, as a sheet with a column of radians has them: that is the printed equation,
read literally.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from templates.description import Equation
from templates.editions import Edition, edition
from templates.planar_impact.equations import model_sections
from templates.two_vehicles.answers import FORCE
from templates.vehicles import for_both

__all__ = ["FORMS", "INPUTS", "PRINTED", "REWRITTEN", "Form"]

INPUTS: Final = {
    **dict.fromkeys(("alpha_1", "alpha_2", "beta_1", "beta_2", "gamma_t"), (-1024.0, 1024.0)),
    **dict.fromkeys(("V1_f", "V2_f", "m_1", "m_2", "I_1", "I_2"), (2.0**-40, 2.0**40)),
    **dict.fromkeys(("a_1", "b_1", "a_2", "b_2"), (-1024.0, 1024.0)),
}
"""Evidence -> the range that the workbook allows: degrees, m/s, kg, kg·m², m."""

CONSTANTS: Final = {"omega1_deg": 0.0, "omega2_deg": 0.0, "s_per_hour": 3600.0, "m_per_km": 1000.0}


class Form(NamedTuple):
    """An equation of the paper.

    Attributes:
        number: in the paper.
        what: the quantity.
        printed, rewritten: the cells that compute it.
        angle: whether it is one, in degrees, of which 360 more or less are the same.
    """

    number: int
    what: str
    printed: str
    rewritten: str
    angle: bool = False


FORMS: Final = (
    Form(15, "impact speed of vehicle 1", "V1_i_printed", "V1_i"),
    Form(16, "impact speed of vehicle 2", "V2_i_printed", "V2_i"),
    Form(17, "change in yaw rate of vehicle 1", "d_omega_1_printed", "d_omega_1"),
    Form(19, "delta-V of vehicle 1", "dV_1_printed", "dV_1"),
    Form(23, "direction of the force on vehicle 1", "PDOF_1_printed", "PDOF_1", angle=True),
    Form(10, "tangential restitution", "e_t_printed", "e_t"),
)

PRINTED: Final[Mapping[str, str]] = {
    **{f"{angle}_{j}_rad": f"RADIANS({angle}_{j})" for angle in ("alpha", "beta") for j in (1, 2)},
    "gamma_rad": "RADIANS(gamma_t)",
    "V1_i_printed": "(m_1*V1_f*SIN(beta_1_rad-alpha_2_rad)-m_2*V2_f*SIN(alpha_2_rad-beta_2_rad))"
    "/(m_1*SIN(alpha_1_rad-alpha_2_rad))",
    "V2_i_printed": "1/(m_2*COS(alpha_2_rad))"
    "*(-m_1*V1_i_printed*COS(alpha_1_rad)+m_1*V1_f*COS(beta_1_rad)+m_2*V2_f*COS(beta_2_rad))",
    **{
        f"d_omega_{j}_printed": f"m_{j}/I_{j}*V{j}_f*(COS(beta_{j}_rad)*b_{j}-SIN(beta_{j}_rad)*a_{j})"
        f"-m_{j}/I_{j}*V{j}_i_printed*(COS(alpha_{j}_rad)*b_{j}-SIN(alpha_{j}_rad)*a_{j})"
        for j in (1, 2)
    },
    "dV1_x_printed": "V1_f*COS(beta_1_rad)-V1_i_printed*COS(alpha_1_rad)",
    "dV1_y_printed": "V1_f*SIN(beta_1_rad)-V1_i_printed*SIN(alpha_1_rad)",
    "dV_1_printed": "SQRT(dV1_x_printed^2+dV1_y_printed^2)",
    "PDOF_1_printed": "180+DEGREES(ATAN(dV1_y_printed/dV1_x_printed))-alpha_1",
    "sep_x_printed": "V1_f*COS(beta_1_rad)+b_1*d_omega_1_printed-V2_f*COS(beta_2_rad)-b_2*d_omega_2_printed",
    "sep_y_printed": "V2_f*SIN(beta_2_rad)-a_2*d_omega_2_printed-V1_f*SIN(beta_1_rad)+a_1*d_omega_1_printed",
    "close_x_printed": "V2_i_printed*COS(alpha_2_rad)-V1_i_printed*COS(alpha_1_rad)",
    "close_y_printed": "V1_i_printed*SIN(alpha_1_rad)-V2_i_printed*SIN(alpha_2_rad)",
    "e_t_printed": "(-sep_x_printed*COS(gamma_rad)+sep_y_printed*SIN(gamma_rad))"
    "/(-close_x_printed*COS(gamma_rad)+close_y_printed*SIN(gamma_rad))",
}
"""Cell -> its formula, (15) to (17), (19) to (21), (23), and (10) to (14) from these; ω before the impact is 0."""


def _of_templates() -> dict[str, str]:
    """The cells of the planar-impact template, in SI units, that are not evidence here."""
    sections = edition(model_sections(more=False), Edition.SI)
    rows: tuple[Equation, ...] = tuple(row for section in sections for row in section.equations)
    force = edition(for_both(FORCE), Edition.SI)
    rows += tuple(row for row in force if row.symbol in ("dV1_long", "dV1_right", "PDOF_1"))
    return {row.symbol: row.formula for row in rows if row.symbol not in INPUTS}


REWRITTEN: Final[Mapping[str, str]] = _of_templates()
