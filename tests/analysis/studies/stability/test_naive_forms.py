"""Forms in which the templates' equations are often written, beside the templates: the study names them, and only them.

Each case stretches the ranges to where the naive form loses its digits, and puts it into spare cells of sheet Model as
further forecasts, so that both forms see the same trials.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest

from xlmc.analysis.studies.stability import Level, rounding_errors, stability
from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

ROOT = Path(__file__).resolve().parents[4]
SPARE = "AD"

pytestmark = pytest.mark.usefixtures("few_points")

DIGITS = {"quadrant", "division", "cancellation", "rounding", "angles"}
"""Kinds of finding that another form of the formula removes."""

STOPS = "-b*t_response+SQRT((b*t_response)^2+2*b*D_0)"

# Template; ranges and held values, by symbol; naive forms; what is found of each.
CASES = [
    # An intruder that hardly accelerates, and marks of a hundredth of a foot.
    (
        "time-distance",
        {"a_intruder": (1e-6, 1e-4), "u": (2.5, 3), "d_intruder": (8, 9), "d_brake": (0.001, 0.01)},
        {"(-u_s+SQRT(u_s^2+2*a_intruder*g*d_intruder))/(a_intruder*g)": "cancellation", "(v_0-v_i)/b": "cancellation"},
    ),
    # A vehicle that creeps: hardly any distance in the time of response.
    (
        "time-distance",
        {"v_impact": (1e-4, 1e-3), "d_brake": (0, 1e-9), "u": (2.5, 3), "a_intruder": (0, 1e-9), "d_intruder": (8, 9)},
        {STOPS: "cancellation"},
    ),
    (
        "pedestrian",
        {"d_after": (1e-7, 1e-6), "d_before": (1e-9, 1e-8), "angle": (1e-6, 1e-5)},
        {
            STOPS: "cancellation",
            "(v_0-v_i)/b": "cancellation",
            # what a flat throw takes from the speed along the ground
            "v_projected*(1-COS(RADIANS(angle)))": "cancellation",
        },
    ),
    # A fall far deeper than wide.
    ("airborne", {"h": (300, 310), "d": (0.5, 1)}, {"SQRT(g*(SQRT(d^2+h^2)-h))": "cancellation"}),
    # The recorded way from the speeds, where hardly anything was lost between them.
    (
        "edr-speed",
        {"f": (1e-9, 1e-6), "tau": (1e-7, 1e-6)},
        {"(SQRT((t_0*22/15)^2+2*f*g*0.00001)-t_0*22/15)/(f*g)": "cancellation"},
    ),
    # The law of cosines where both leave almost alike, without any energy, and a direction turned by 180° and back.
    (
        "momentum-energy",
        {
            "EES_1": (2, 4),
            "EES_2": (2, 4),
            "phi_1": (0, 1),
            "phi_2": (0, 1),
            "beta_1": (-1e-3, 1e-3),
            "s_1": (50, 50.001),
        }
        | {"alpha_1": (-1e-3, 1e-3), "beta_2": (-1e-3, 1e-3), "s_2": (50, 50.001), "f_1": (0.7, 0.70001)}
        | {"f_2": (0.7, 0.70001), "lane_2": 0},
        {
            "SQRT(V1_i^2+V1_f^2-2*V1_i*V1_f*COS(RADIANS(beta_1-alpha_1)))": "cancellation",
            "E_before-E_after": "cancellation",
            "lane_2+MOD(alpha_1+aside_2-lane_2+180,360)-180": "cancellation",
        },
    ),
    # A direction by its slope.
    ("momentum-energy", {}, {"MOD(alpha_1+DEGREES(ATAN(V2_across/V2_along)),360)": "quadrant"}),
    # Equation 16 as printed, approaches 11° apart and one of them near the pole of 1/cos.
    (
        "momentum",
        {"alpha_1": (280, 281), "alpha_2": (269.5, 269.999), "beta_1": (274, 276), "beta_2": (272, 274)},
        {
            "(m_1*V1_f*COS(RADIANS(beta_1))+m_2*V2_f*COS(RADIANS(beta_out_2))-m_1*V1_i*COS(RADIANS(alpha_1)))"
            "/(m_2*COS(RADIANS(alpha_2)))": "division",
        },
    ),
]


def with_naive_forms(path, template, given, forms):
    book = openpyxl.load_workbook(ROOT / "templates" / f"{template}.xlsx")
    sheet = book["Inputs"]
    rows = {sheet.cell(row, 3).value: row for row in range(1, sheet.max_row + 1)}
    for symbol, value in given.items():
        row = rows[symbol]
        if isinstance(value, tuple):
            for column in range(9, 17):  # from a distribution that is normal, or held
                sheet.cell(row, column).value = None
            for column, content in zip((4, 6, 7, 8), (sum(value) / 2, "Uniform", *value), strict=True):
                sheet.cell(row, column).value = content
        else:
            sheet.cell(row, 4).value = value
    cells = []
    for number, form in enumerate(forms, 1):
        book["Model"][f"{SPARE}{number}"] = f"={form}"
        cells.append(parse_address(f"{SPARE}{number}", "Model"))
    book.save(path)
    model = load(path)
    more = tuple(Forecast(form, cell, cell) for form, cell in zip(forms, cells, strict=True))
    return CompiledModel(model.workbook, replace(model.definitions, forecasts=(*model.forecasts, *more)), path)


@pytest.mark.parametrize(("template", "given", "forms"), CASES, ids=[f"{n} {c[0]}" for n, c in enumerate(CASES)])
def test_naive_forms_are_named_and_the_templates_are_not(template, given, forms, tmp_path, monkeypatch):
    monkeypatch.setattr(rounding_errors, "steady_form", lambda *_: None)  # see test_stable_forms.py
    model = with_naive_forms(tmp_path / "naive.xlsx", template, given, forms)
    result = stability(model, trials=300, seed=1)
    lost = {one.name: one for one in result.findings if one.kind in DIGITS and one.level is not Level.NOTE}
    assert {name: one.kind for name, one in lost.items()} == forms


@pytest.mark.parametrize("template", ["edr-speed", "video-speed"])
def test_the_templates_lose_no_digits_within_their_own_ranges(template):
    result = stability(load(ROOT / "templates" / f"{template}.xlsx"), trials=2_000, seed=1)
    assert {one.level for one in result.findings} <= {Level.NOTE}
