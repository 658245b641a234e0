"""Forecasts that are the same in every trial: a report tells of them once, with all of their names."""

from __future__ import annotations

import pytest

from xlmc.outputs.document.build import Wanted, build
from xlmc.outputs.document.material import same_answers
from xlmc.outputs.document.parts import Bullets, Figure, Table

CELLS = {"A1": 1.0, "B1": "=A1*2", "B2": "=IF(A1<9,B1,0)", "B3": "=A1*3", "B4": "=A1>0", "B5": "=A1>-1", "B6": "=2*2"}


@pytest.fixture
def simulate(make):
    def run(*forecasts):
        return make.simulate(CELLS, [make.uniform("a", "A1", 0, 1)], forecasts)

    return run


@pytest.mark.parametrize(
    ("first", "second", "more", "same"),
    [
        ("B1", "B2", {}, True),
        ("B1", "B3", {}, False),
        ("B1", "B2", {"units": "mph"}, False),
        ("B1", "B2", {"threshold": 1.0}, False),
        ("B4", "B5", {}, False),
        ("B6", "B6", {}, False),
    ],
    ids=["chosen", "other", "other units", "asked more", "yes/no", "constant"],
)
def test_same_answers(make, simulate, first, second, more, same):
    result = simulate(make.forecast("Chosen", first), make.forecast("Reading", second, **more))
    assert same_answers(result, result.results) == ({"Chosen": ("Reading",)} if same else {})


def test_a_report_tells_of_them_once_with_all_names(make, simulate):
    result = simulate(
        make.forecast("Chosen", "B1"),
        make.forecast("Reading", "B2"),
        make.forecast("Other", "B3"),
        make.forecast("Third", "B1"),
    )
    blocks = build(result, Wanted()).blocks
    called = "Chosen (the same in every trial: Reading; Third)"
    (message,) = [each for each in blocks if isinstance(each, Bullets) and each.leads]
    assert [text.partition(":")[0] for text in message.texts] == [called.partition(":")[0], "Other"]
    assert message.texts[0].startswith(f"{called}: ")
    answers = next(each for each in blocks if isinstance(each, Table))
    assert [row[0] for row in answers.rows] == [called, "Other"]
    captions = " ".join(each.caption for each in blocks if isinstance(each, Figure))
    assert captions.count(called) == 2
    assert captions.count("Other: mean") == 1


def test_one_that_is_asked_for_alone_is_told_by_its_own_name(make, simulate):
    result = simulate(make.forecast("Chosen", "B1"), make.forecast("Reading", "B2"))
    blocks = build(result, Wanted(forecasts=["reading"], sections=["answer"])).blocks
    (table,) = [each for each in blocks if isinstance(each, Table)]
    assert [row[0] for row in table.rows] == ["Reading"]
