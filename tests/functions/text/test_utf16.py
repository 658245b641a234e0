from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.functions.text.text_parts import in_units, units, whole


@given(st.text())
def test_units_join_again(text):
    assert whole(units(text)) == text
    assert len(units(text)) == len(text.encode("utf-16-le")) // 2


@pytest.mark.parametrize(("text", "shown"), [("\ud83d", "\ufffd"), ("a\ude00b", "a\ufffdb"), ("é", "é"), ("", "")])
def test_half_a_pair_is_unknown(text, shown):
    assert whole(text) == shown


def test_functions_count_in_units():
    assert in_units(lambda text, place: text[place:])("😀b", 2) == "b"
    assert in_units(len)("😀b") == 3
