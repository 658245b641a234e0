"""The profile `fixed` draws the same examples whatever ran or was imported before; `explore` draws others, and more."""

from __future__ import annotations

import json

import example_profiles
import pytest

TESTS = """
import json, os
from hypothesis import given, settings, strategies as st

drawn = []

@given(st.floats() | st.integers() | st.text(" acdehinorstux"))
@settings(max_examples=15)
def test_own_number(x): drawn.append(repr(x))

@given(st.integers())
def test_number_of_the_profile(x): drawn.append(repr(x))

def test_written():
    first = drawn[:]
    drawn.clear()
    test_own_number()
    number = test_number_of_the_profile._hypothesis_internal_use_settings.max_examples
    with open(os.environ["DRAWN"], "w") as file: json.dump([first, drawn, number], file)
"""


@pytest.fixture
def drawn(run_tests, tmp_path):
    """`drawn(*arguments, before="", **environment)`: of one run with `before` as source in front of it, the examples,
    those of the first test when it is called again, and how many the second is to have.
    """

    def run(*arguments, before="", **environment):
        given = environment | {"DRAWN": str(tmp_path / "d")}
        sources = {"test_given.py": before + TESTS}
        code, shown = run_tests(tmp_path, sources, *arguments, plugins=["example_profiles"], **given)
        assert code == 0, shown
        return json.loads((tmp_path / "d").read_text(encoding="utf-8"))

    return run


def test_the_default_examples_are_the_same_everywhere_and_the_option_wins_over_the_variable(drawn, tmp_path):
    first, again, number = drawn(PYTHONHASHSEED="2", CI="true")
    assert number == 20  # a fifth of 100, and of 15; hypothesis may draw a simple one or two more
    assert 3 + 20 <= len(first) < 32
    assert again == first[: len(again)] != []
    constants = ", ".join(str(2.5 + n) for n in range(300))
    (tmp_path / "local.py").write_text(f"A = [{constants}, 'a text that stands in the source']", encoding="utf-8")
    asked = {"PYTHONHASHSEED": "1", "HYPOTHESIS_PROFILE": "explore"}
    assert drawn("--hypothesis-profile", "fixed", before="import local", **asked)[0] == first


def test_explore_draws_ten_times_as_many_and_others_each_time(drawn):
    first, again, number = drawn("-k", "not number_of_the_profile", HYPOTHESIS_PROFILE="explore", CI="true")
    assert min(len(first), len(again)) >= 10 * 15
    assert number == 10 * 100
    assert first != again


def test_other_profiles_are_refused(pytestconfig, monkeypatch):
    monkeypatch.setattr(pytestconfig.option, "hypothesis_profile", None)
    monkeypatch.setenv("HYPOTHESIS_PROFILE", "dsek")
    with pytest.raises(pytest.UsageError, match="no hypothesis profile 'dsek': choose fixed or explore"):
        example_profiles.pytest_configure(pytestconfig)
