from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.analysis.results.statements.in_words import (
    distribution_text,
    evidence_text,
    limits_text,
    notes_text,
    parameters_text,
    plain_text,
)
from xlmc.analysis.results.statements.run_in_words import status
from xlmc.analysis.results.statements.scenarios_in_words import changes_text
from xlmc.excel.address import Area, Cell
from xlmc.montecarlo.definitions.definitions import Assumption, DataRange, Definitions, Filter, Forecast, StatedNumber
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.scenarios import (
    Band,
    Correlated,
    Drawn,
    Frozen,
    Limits,
    Measured,
    Numbers,
    Range,
    Scenario,
    Stated,
    Switched,
    Typed,
)
from xlmc.montecarlo.definitions.stating import Kind

HERE = Cell("Inputs", 7, 2)

LIMITS = [
    ({}, "TRUE"),
    ({"at_least": 0.0, "below": 1.0}, "at least 0 and below 1"),
    ({"above": 0.0}, "above 0"),
    ({"at_most": 0.25}, "at most 0.25"),
    ({"at_least": HERE, "at_most": 2.0}, "at least Inputs!B7 and at most 2"),
]


@pytest.mark.parametrize(("limits", "text"), LIMITS)
def test_limits(limits, text):
    assert limits_text(Filter("f", HERE, HERE, **limits)) == text


DISTRIBUTIONS = [
    ("Uniform", {"low": 6661.0, "high": 6861.0}, {}, "Uniform: Low 6,661, High 6,861"),
    (
        "Normal",
        {"mean": 0.77, "std_dev": HERE},
        {"lower_cutoff": 0.6},
        "Normal: Mean 0.77, Std dev Inputs!B7; cut off below 0.6",
    ),
    (
        "Triangular",
        {"low": 0.0, "likeliest": 1.0, "high": 3.0},
        {"lower_cutoff": 0.5, "upper_cutoff": HERE},
        "Triangular: Low 0, Likeliest 1, High 3; cut off below 0.5, above Inputs!B7",
    ),
]


@pytest.mark.parametrize(("family", "parameters", "cutoffs", "text"), DISTRIBUTIONS)
def test_distributions(family, parameters, cutoffs, text):
    assert distribution_text(Assumption("a", HERE, family, parameters | cutoffs, HERE)) == text


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({}, "Custom: Data Inputs!Q2:R9"),
        ({"cumulative": True}, "Custom: Data Inputs!Q2:R9, cumulative weights"),
        ({"bandwidth": 0.5}, "Custom: Data Inputs!Q2:R9, Bandwidth 0.5"),
        ({"bandwidth": HERE}, "Custom: Data Inputs!Q2:R9, Bandwidth Inputs!B7"),
    ],
)
def test_data(options, text):
    data = DataRange(Area("Inputs", 2, 17, 9, 18), (), **options)
    assert distribution_text(Assumption("a", HERE, "Custom", {}, HERE, data=data)) == text


@pytest.mark.parametrize(
    ("form", "stated", "text"),
    [
        (PLAIN, {}, "held at 6,100"),
        (PLAIN, {"low": StatedNumber(6100.0, "=Estimate!B2")}, "held at 6,100 (=Estimate!B2)"),
        (Form(Kind.CURRENCY, '"$"#,##0'), {}, "held at $6,100"),
    ],
)
def test_a_frozen_row_without_a_distribution_is_held_at_its_value(form, stated, text):
    parameters = {"low": 6100.0, "high": 6100.0}
    held = Assumption("a", HERE, "Uniform", parameters, HERE, base=6100.0, frozen=True, stated=stated, form=form)
    assert distribution_text(held) == text
    drawn = Assumption("a", HERE, "Uniform", parameters, HERE)
    assert distribution_text(drawn) == "Uniform: Low 6,100, High 6,100"


def test_parameters_stand_in_the_familys_order():
    assert parameters_text(Assumption("a", HERE, "Uniform", {"high": 2.0, "low": 1.0}, HERE)) == "Low 1, High 2"


@pytest.mark.parametrize(
    ("code", "parameters", "text"),
    [
        ("hh:mm", {"low": 0.25, "high": 0.75}, "Low 06:00, High 18:00"),
        ("[h]:mm", {"low": 0.5, "high": 1.25}, "Low 12:00, High 30:00"),
        ("yyyy-mm-dd", {"low": 0.25, "high": 46_000.0}, "Low 0.25, High 2025-12-09"),
    ],
)
def test_times_of_day_are_written_so(code, parameters, text):
    form = Form(Kind.DATE, code)
    assert parameters_text(Assumption("a", HERE, "Uniform", parameters, HERE, form=form)) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back_as_themselves(number):
    assert float(plain_text(number)) == number
    assert not plain_text(number).endswith(".0")


def test_notes():
    assert notes_text({"Symbol": "w1", "By": "JD"}) == "Symbol: w1; By: JD"
    assert notes_text({}) == ""


def test_status(model):
    result = {a.name: status(model, a.name, a.frozen) for a in model.assumptions}
    assert result == {"width": "drawn", "length": "drawn", "idle": "not needed", "held": "frozen", "late": "drawn"}


DRAG = Cell("Inputs", 28, 4)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (Frozen("Friction", None), "Friction frozen"),
        (Frozen("Friction", 0.7), "Friction = 0.7"),
        (Frozen("Friction", 0.0), "Friction = 0"),
        (Drawn("Friction"), "Friction drawn"),
        (Range("Friction", 0.6, 0.8), "Friction from 0.6 to 0.8"),
        (Range("Friction", 0.6, None), "Friction at least 0.6"),
        (Range("Friction", None, 0.0), "Friction at most 0"),
        (Band("Friction", 5.0, 95.0), "Friction from P5 to P95"),
        (Numbers("Speed", {"mean": 3.0, "std_dev": 0.5}), "Speed mean 3 and std dev 0.5"),
        (Limits("Angle", {"at_least": 0.0, "below": None}), "Angle at least 0"),
        (Limits("Angle", {"at_least": None, "below": None}), "Angle without at least, below"),
        (Switched("Angle", used=True), "Angle used"),
        (Switched("Angle", used=False), "Angle not used"),
        (Correlated("a", "b", -0.5), "correlation of a and b -0.5"),
        (Typed(DRAG, -20.0), "Inputs!D28 = -20"),
        (Typed(DRAG, "wet"), "Inputs!D28 = wet"),
        (Typed(DRAG, None), "Inputs!D28 = nothing"),
        (Typed(DRAG, 3.5, named="Drag"), "Drag = 3.5"),
    ],
)
def test_what_a_scenario_changes(change, text):
    assert changes_text(Scenario("s", (change,)), Definitions()) == text


DATES = Form(Kind.DATE, "yyyy-mm-dd")
DATED = Definitions(
    forecasts=(
        Forecast("End", DRAG, DRAG, form=DATES),
        Forecast("Share", DRAG, DRAG, form=Form(Kind.PERCENT, "0.0%")),
        Forecast("Cost", DRAG, DRAG, form=Form(Kind.CURRENCY, '"$"#,##0')),
    ),
    filters=(Filter("Late", DRAG, DRAG, form=DATES),),
    evidence=(Evidence("Seen", DRAG, DRAG, 46110.0, "uniform", {"plus_minus": 9.0}, form=DATES),),
)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (Stated("End", {"threshold": 46130.0}), "End threshold 2026-04-18"),
        (Stated("End", {"threshold": None}), "End without threshold"),
        (Stated("End", {"central": 80.0}), "End central 80 %"),
        (Stated("Share", {"threshold": 0.1}), "Share threshold 10 %"),
        (Stated("Cost", {"threshold": 2e6}), "Cost threshold $2,000,000"),
        (Limits("Late", {"at_most": 46130.0}), "Late at most 2026-04-18"),
        (Measured("Seen", {"reading": 46111.0, "plus_minus": 9.0}), "Seen reading 2026-03-30 and plus minus 9"),
        (Typed(DRAG, 46130.0, named="t", of=("xlmc_forecasts", "end", "Threshold")), "t = 2026-04-18"),
        (Typed(DRAG, 80.0, named="t", of=("xlmc_forecasts", "end", "Range %")), "t = 80"),
        (Typed(DRAG, 46111.0, named="t", of=("xlmc_evidence", "seen", "Reading")), "t = 2026-03-30"),
        (Typed(DRAG, 9.0, named="t", of=("xlmc_evidence", "seen", "Plus or minus")), "t = 9"),
    ],
)
def test_changes_are_written_in_the_forms_of_their_cells(change, text):
    assert changes_text(Scenario("s", (change,)), DATED) == text


def test_a_reading_is_written_as_its_cell_shows_it():
    (seen,) = DATED.evidence
    assert evidence_text(seen) == "reads 2026-03-29, uniform (Plus or minus 9): from 2026-03-20 to 2026-04-07"


def test_several_changes_and_none():
    assert changes_text(Scenario("s", (Drawn("a"), Frozen("b", 1.0))), Definitions()) == "a drawn; b = 1"
    assert changes_text(Scenario("s", ()), Definitions()) == "nothing"


@pytest.mark.parametrize(
    ("error", "sizes", "more", "text"),
    [
        ("normal", {"std_dev": 0.6}, {}, "reads 12, normal (Std dev 0.6)"),
        ("instrument", {"percent": 10.0}, {}, "reads 12, instrument (Percent 10): from 10.9091 to 13.3333"),
        ("at least", {}, {}, "reads 12, at least: from 12"),
        ("at most", {"plus_minus": 1.0}, {}, "reads 12, at most (Plus or minus 1): to 13"),
        ("uniform", {"plus_minus": DRAG}, {}, "reads 12, uniform (Plus or minus Inputs!D28)"),
        ("normal", {"std_dev": 0.6}, {"weighed": True}, "reads 12, normal (Std dev 0.6), as weights"),
        ("normal", {"std_dev": 0.6}, {"unused": "Use is off"}, "not used: Use is off"),
    ],
)
def test_evidence(error, sizes, more, text):
    assert evidence_text(Evidence("y", DRAG, DRAG, 12.0, error, sizes, **more)) == text
