from __future__ import annotations

import pytest

from xlmc.functions.ordering import order_key

RISING = ["", " ", "!", "#", "_", "~", "+", "=", "0", "9", "a", "A2", "ab", "é", "ef", "Z", "Zo", "zö", "zz"]


def test_symbols_digits_letters():
    assert sorted(RISING[::2] + RISING[1::2], key=order_key) == RISING


@pytest.mark.parametrize(("left", "right"), [("abc", "ABC"), ("É", "é")])
def test_case_does_not_count(left, right):
    assert order_key(left) == order_key(right)


@pytest.mark.parametrize(("left", "right"), [("coop", "co-op"), ("its", "it's"), ("e", "é")])
def test_marks_count_between_equals_only(left, right):
    assert order_key(left) != order_key(right)
    assert order_key(right)[0] == order_key(left)[0]


def test_hyphens_do_not_part_a_word_from_its_like():
    assert sorted(["co-op", "cooper", "coop", "con"], key=order_key) == ["con", "co-op", "coop", "cooper"]
