from __future__ import annotations

import pytest

from templates.build import TEMPLATES
from templates.description import GuideSection
from templates.editions import Edition, edition
from templates.filled import filled

ABOUT = GuideSection("This workbook", ("An example.",))


def test_numbers_are_held_and_the_rest_stays():
    template = edition(TEMPLATES["momentum"], Edition.IMPERIAL)
    made = filled(template, "Title", "Subtitle", {"f_1": 0.7, "g": 32.2}, "A book", ABOUT)
    rows = {given.symbol: given for given in made.inputs}
    assert (rows["f_1"].base, rows["f_1"].frozen, rows["f_1"].source) == (0.7, True, "A book")
    assert rows["f_1"].parameters == {"Low": 0.7, "High": 0.7}
    assert (rows["g"].base, rows["g"].parameters) == (32.2, {})
    before = {given.symbol: given for given in template.inputs}
    assert rows["f_2"] == before["f_2"]
    assert made.correlations == ()  # one of the pair does not vary
    assert made.guide[0] is ABOUT
    assert made.guide[1:] == template.guide[1:]


def test_an_unknown_input_is_refused():
    with pytest.raises(KeyError, match="f_3"):
        filled(edition(TEMPLATES["momentum"], Edition.SI), "", "", {"f_3": 1}, "", ABOUT)
