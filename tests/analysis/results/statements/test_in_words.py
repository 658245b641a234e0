from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.analysis.results.statements.in_words import (
    distribution_text,
    limits_text,
    notes_text,
    parameters_text,
    plain_text,
    status,
)
from xlmc.excel.address import Area, Cell
from xlmc.montecarlo.definitions.definitions import Assumption, DataRange, Filter

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


def test_parameters_stand_in_the_familys_order():
    assert parameters_text(Assumption("a", HERE, "Uniform", {"high": 2.0, "low": 1.0}, HERE)) == "Low 1, High 2"


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back_as_themselves(number):
    assert float(plain_text(number)) == number
    assert not plain_text(number).endswith(".0")


def test_notes():
    assert notes_text({"Symbol": "w1", "By": "JD"}) == "Symbol: w1; By: JD"
    assert notes_text({}) == ""


def test_status(model):
    found = {a.name: status(model, a.name, a.frozen) for a in model.assumptions}
    assert found == {"width": "drawn", "length": "drawn", "idle": "not needed", "held": "frozen", "late": "drawn"}
