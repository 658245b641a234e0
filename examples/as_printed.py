"""Write `as-printed.xlsx`: the case study of SAE 2001-01-3347 with its equations as the paper prints them.

    python examples/as_printed.py [folder]

For `xlmc stability`, which finds what is the matter with two of them: (16) divides by COS(α2), and the arctangent of
(23) loses the quadrant of the angle. (25) is left out, for its denominator is 0 in every trial.
"""

from __future__ import annotations

import sys
from pathlib import Path

import xlsxwriter

__all__ = ["ASSUMPTIONS", "write"]

ASSUMPTIONS = {  # name of the cell -> (what it is, units, low, high), as in Table 1
    "w_1": ("Chevrolet weight", "lb", 6661, 6861),
    "I_1": ("Chevrolet yaw inertia", "lb ft s²", 4712, 5208),
    "alpha_1": ("Chevrolet approach angle", "°", 181, 191),
    "beta_1": ("Chevrolet departure angle", "°", 187, 197),
    "s_1": ("Chevrolet travel", "ft", 20, 22),
    "f_1": ("Chevrolet deceleration", "g", 0.60, 0.95),
    "w_2": ("Nissan weight", "lb", 3410, 3510),
    "I_2": ("Nissan yaw inertia", "lb ft s²", 1849, 2043),
    "alpha_2": ("Nissan approach angle", "°", 272, 292),
    "beta_2": ("Nissan departure angle", "°", 192, 202),
    "s_2": ("Nissan travel", "ft", 20, 24),
    "f_2": ("Nissan deceleration", "g", 0.60, 0.95),
    "x_1": ("Chevrolet impact centre x", "in", 97.5, 103.5),
    "y_1": ("Chevrolet impact centre y", "in", -16, -10),
    "x_2": ("Nissan impact centre x", "in", -3.2, 3.2),
    "y_2": ("Nissan impact centre y", "in", -28.6, -22.6),
    "gamma": ("Orientation of tangent", "°", 96, 106),
}

_CG = "=-(x_{j}*{x}(RADIANS(alpha_{j})){sign}y_{j}*{y}(RADIANS(alpha_{j})))/12"
_OMEGA = (
    "=m_{j}/I_{j}*V{j}f*(COS(RADIANS(beta_{j}))*b_{j}-SIN(RADIANS(beta_{j}))*a_{j})"
    "-m_{j}/I_{j}*V{j}i*(COS(RADIANS(alpha_{j}))*b_{j}-SIN(RADIANS(alpha_{j}))*a_{j})"
)

MODEL = {  # name of the cell -> (equation, formula)
    "g": ("32.174 ft/s²", 32.174),
    "m_1": ("w / g", "=w_1/g"),
    "m_2": ("w / g", "=w_2/g"),
    "V1f": ("√(2 g f s)", "=SQRT(2*g*f_1*s_1)"),
    "V2f": ("√(2 g f s)", "=SQRT(2*g*f_2*s_2)"),
    "a_1": ("", _CG.format(j=1, x="COS", y="SIN", sign="+")),
    "b_1": ("", _CG.format(j=1, x="SIN", y="COS", sign="-")),
    "a_2": ("", _CG.format(j=2, x="COS", y="SIN", sign="+")),
    "b_2": ("", _CG.format(j=2, x="SIN", y="COS", sign="-")),
    "V1i": (
        "(15)",
        "=(m_1*V1f*SIN(RADIANS(beta_1-alpha_2))-m_2*V2f*SIN(RADIANS(alpha_2-beta_2)))"
        "/(m_1*SIN(RADIANS(alpha_1-alpha_2)))",
    ),
    "V2i": (
        "(16)",
        "=1/(m_2*COS(RADIANS(alpha_2)))"
        "*(-m_1*V1i*COS(RADIANS(alpha_1))+m_1*V1f*COS(RADIANS(beta_1))+m_2*V2f*COS(RADIANS(beta_2)))",
    ),
    "omega_1": ("(17)", _OMEGA.format(j=1)),
    "omega_2": ("(18)", _OMEGA.format(j=2)),
    "dV1x": ("(20)", "=V1f*COS(RADIANS(beta_1))-V1i*COS(RADIANS(alpha_1))"),
    "dV1y": ("(21)", "=V1f*SIN(RADIANS(beta_1))-V1i*SIN(RADIANS(alpha_1))"),
    "dV2x": ("(20)", "=V2f*COS(RADIANS(beta_2))-V2i*COS(RADIANS(alpha_2))"),
    "dV2y": ("(21)", "=V2f*SIN(RADIANS(beta_2))-V2i*SIN(RADIANS(alpha_2))"),
    "dV_1": ("(19), mph", "=SQRT(dV1x^2+dV1y^2)*3600/5280"),
    "dV_2": ("(19), mph", "=SQRT(dV2x^2+dV2y^2)*3600/5280"),
    "PDOF_1": ("(23), °", "=180+DEGREES(ATAN(dV1y/dV1x))-alpha_1"),
    "PDOF_2": ("(23), °", "=180+DEGREES(ATAN(dV2y/dV2x))-alpha_2"),
    "sep_x": ("(11)", "=V1f*COS(RADIANS(beta_1))+b_1*omega_1-V2f*COS(RADIANS(beta_2))-b_2*omega_2"),
    "sep_y": ("(12)", "=V2f*SIN(RADIANS(beta_2))-a_2*omega_2-V1f*SIN(RADIANS(beta_1))+a_1*omega_1"),
    "close_x": ("(13)", "=V2i*COS(RADIANS(alpha_2))-V1i*COS(RADIANS(alpha_1))"),
    "close_y": ("(14)", "=V1i*SIN(RADIANS(alpha_1))-V2i*SIN(RADIANS(alpha_2))"),
    "e_n": (
        "(9)",
        "=(sep_x*SIN(RADIANS(gamma))+sep_y*COS(RADIANS(gamma)))"
        "/(close_x*SIN(RADIANS(gamma))+close_y*COS(RADIANS(gamma)))",
    ),
    "e_t": (
        "(10)",
        "=(-sep_x*COS(RADIANS(gamma))+sep_y*SIN(RADIANS(gamma)))"
        "/(-close_x*COS(RADIANS(gamma))+close_y*SIN(RADIANS(gamma)))",
    ),
    "V1_mph": ("mph", "=V1i*3600/5280"),
    "V2_mph": ("mph", "=V2i*3600/5280"),
}

FORECASTS = {
    "Chevrolet delta-V": "dV_1",
    "Nissan delta-V": "dV_2",
    "Chevrolet impact speed": "V1_mph",
    "Nissan impact speed": "V2_mph",
    "Chevrolet PDOF": "PDOF_1",
    "Nissan PDOF": "PDOF_2",
}
FILTERS = {  # name -> (cell, at least, at most, above, below)
    "Restitution, normal": ("e_n", 0, "", "", 1),
    "Restitution, tangential": ("e_t", 0, 0.25, "", ""),
    "Nissan impact speed above 0": ("V2_mph", "", "", 0, ""),
}


def write(
    path: Path, ranges: dict[str, tuple[float, float]] | None = None, formulas: dict[str, str] | None = None
) -> None:
    """Write the workbook.

    Args:
        path: where to.
        ranges: name of the cell -> low and high, where they are not those of Table 1.
        formulas: name of the cell -> its formula, where it is not as printed.
    """
    ranges = {name: (low, high) for name, (_, _, low, high) in ASSUMPTIONS.items()} | (ranges or {})
    with xlsxwriter.Workbook(path) as book:
        inputs, model, results = (book.add_worksheet(name) for name in ("Inputs", "Model", "Results wanted"))
        rows = [
            [what, sum(ranges[name]) / 2, *ranges[name], units] for name, (what, units, _, _) in ASSUMPTIONS.items()
        ]
        _table(inputs, "xlmc_assumptions", ["Name", "Value", "Low", "High", "Units"], rows)
        for row, name in enumerate(ASSUMPTIONS, start=2):
            book.define_name(name, f"=Inputs!$B${row}")
        for row, (name, (equation, formula)) in enumerate(MODEL.items(), start=1):
            model.write_row(row - 1, 0, [name, equation])
            model.write(row - 1, 2, (formulas or {}).get(name, formula))
            book.define_name(name, f"=Model!$C${row}")
        places = {name: f"=Model!C{row}" for row, name in enumerate(MODEL, start=1)}
        wanted = [[name, places[cell]] for name, cell in FORECASTS.items()]
        _table(results, "xlmc_forecasts", ["Name", "Cell"], wanted)
        kept = [[name, places[cell], *limits, "evidence"] for name, (cell, *limits) in FILTERS.items()]
        headings = ["Name", "Cell", "At least", "At most", "Above", "Below", "Because"]
        _table(results, "xlmc_filters", headings, kept, first=len(wanted) + 3)


def _table(
    sheet: xlsxwriter.worksheet.Worksheet, name: str, headings: list[str], rows: list[list[object]], first: int = 0
) -> None:
    columns = [{"header": heading} for heading in headings]
    sheet.add_table(first, 0, first + len(rows), len(headings) - 1, {"name": name, "columns": columns})
    for down, row in enumerate(rows, start=first + 1):
        for across, item in enumerate(row):
            if item != "":
                sheet.write(down, across, item)


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    folder.mkdir(parents=True, exist_ok=True)
    write(folder / "as-printed.xlsx")
