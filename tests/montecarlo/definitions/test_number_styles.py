from __future__ import annotations

from types import SimpleNamespace

import pytest

from xlmc.montecarlo.definitions.number_styles import STYLES, as_programs_read, in_style, in_style_of, style_asked
from xlmc.montecarlo.number_text import number_text

WRITTEN = {
    "1,234.5": "1,234.5",
    "1.234,5": "1.234,5",
    "1 234,5": "1\u00a0234,5",
    "1 234.5": "1\u00a0234.5",
    "1'234.5": "1'234.5",
    "1234.5": "1234.5",
    "1234,5": "1234,5",
}


@pytest.mark.parametrize("style", STYLES)
def test_a_style_writes_numbers_as_its_example(style):
    with in_style(style):
        assert number_text(1234.5) == WRITTEN[style]
    assert number_text(1234.5) == "1,234.5"


def test_what_a_command_asks_for_goes_before_the_workbook_and_programs_read_one_style():
    with in_style(""):
        assert number_text(1234.5) == "1,234.5"
    with style_asked("1.234,5"):
        with in_style("1'234.5"):
            assert number_text(1234.5) == "1.234,5"
        with as_programs_read():
            assert number_text(1234.5) == "1,234.5"
        assert number_text(1234.5) == "1.234,5"
    with in_style("1'234.5"):
        assert number_text(1234.5) == "1'234.5"


def test_a_function_may_write_in_the_style_of_its_first_argument():
    @in_style_of("settings.number_style")
    def written(run, number):
        return f"{run.name}: {number_text(number)}"

    run = SimpleNamespace(name="r", settings=SimpleNamespace(number_style="1.234,5"))
    assert written(run, 1234.5) == "r: 1.234,5"
    assert written.__name__ == "written"
