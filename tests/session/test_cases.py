from __future__ import annotations

import pytest
from cases import cases

TESTS = """
import pytest
from cases import cases

@pytest.fixture(scope="session")
def limit():
    return 3

@cases("a", [1, 2, 3, 4], ids=["one", "two", "three", "four"])
@cases("b, c", [(0, 0), (1, 1)])
def test_sums(a, b, limit, c):
    assert b == c
    assert a + b <= limit

@cases(["word"], [("left",), pytest.param("right", id="the other")])
def test_words(word):
    if word == "right":
        pytest.fail("not right")
"""


def test_every_case_that_fails_is_named(run_tests):
    code, shown = run_tests(TESTS, plugin="cases")
    assert code == 1
    assert "2 failed" in shown
    assert "case three: a=3" in shown
    assert "case four: a=4" in shown
    assert "case two" not in shown
    assert "case 1: b=1, c=1" in shown
    assert "case 1: word='right'" in shown
    assert "case 0: word" not in shown


def test_apart_each_case_is_a_test(run_tests):
    code, shown = run_tests(TESTS, "--apart", "-k", "one or two or left", plugin="cases")
    assert code == 0, shown
    assert "5 passed" in shown


@pytest.mark.parametrize("values", [[], [(1,)], [(1, 2), (1, 2, 3)]])
def test_cases_are_complete(values):
    with pytest.raises(ValueError, match="each case needs values for a, b"):
        cases("a, b", values)
