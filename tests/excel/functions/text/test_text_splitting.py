from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import ShapeVaries, constant, from_objects

VALUE, NA = ErrorCode.VALUE, ErrorCode.NA
HOOD = "Little red Riding Hood's red hood"

EDGES = [
    ("TEXTBEFORE", (HOOD, "red"), "Little "),
    ("TEXTBEFORE", (HOOD, "Red"), NA),
    ("TEXTBEFORE", (HOOD, "Red", None, 1), "Little "),
    ("TEXTBEFORE", (HOOD, "red", 2), "Little red Riding Hood's "),
    ("TEXTBEFORE", (HOOD, "red", -2), "Little "),
    ("TEXTBEFORE", (HOOD, "red", 3), NA),
    ("TEXTBEFORE", (HOOD, "red", 3, 0, 1), HOOD),
    ("TEXTBEFORE", (HOOD, "red", -3, 0, 1), ""),
    ("TEXTBEFORE", (HOOD, "red", 4, 0, 1), NA),
    ("TEXTBEFORE", (HOOD, "x", 1, 0, 0, "none"), "none"),
    ("TEXTBEFORE", (HOOD, ""), ""),
    ("TEXTBEFORE", (HOOD, "", -1), HOOD),
    ("TEXTBEFORE", (HOOD, [["Hood", "Riding"]]), "Little red "),
    ("TEXTBEFORE", (HOOD, "red", 0), VALUE),
    ("TEXTBEFORE", ("abc", "b", 4), VALUE),
    ("TEXTBEFORE", ("abc", "b", "x"), VALUE),
    ("TEXTBEFORE", ("abc", "b", 1, 2), VALUE),
    ("TEXTBEFORE", ("", "b"), ""),
    ("TEXTBEFORE", (NA, "b"), NA),
    ("TEXTBEFORE", ([["a-b", "c-d"]], "-"), [["a", "c"]]),
    ("TEXTAFTER", (HOOD, "red"), " Riding Hood's red hood"),
    ("TEXTAFTER", (HOOD, "red", 2), " hood"),
    ("TEXTAFTER", (HOOD, "red", -2), " Riding Hood's red hood"),
    ("TEXTAFTER", (HOOD, "hood", 2), NA),
    ("TEXTAFTER", (HOOD, "hood", 2, 1), ""),
    ("TEXTAFTER", ("Socrates", " ", None, None, 1), ""),
    ("TEXTAFTER", ("Socrates", " ", -1, None, 1), "Socrates"),
    ("TEXTAFTER", (HOOD, ""), HOOD),
    ("TEXTAFTER", (HOOD, "", -1), ""),
    ("TEXTAFTER", (12.5, "."), "5"),
    ("TEXTAFTER", ("a.*b", ".*"), "b"),
]
SPLITS = [
    (("To be or not", " "), [["To", "be", "or", "not"]]),
    (("1,2;3", ",", ";"), [["1", "2"], ["3", NA]]),
    (("1,2;3", ",", ";", False, 0, "-"), [["1", "2"], ["3", "-"]]),
    (("1;2", None, ";"), [["1"], ["2"]]),
    (("a,,b", ","), [["a", "", "b"]]),
    (("a,,b", ",", None, True), [["a", "b"]]),
    (("aXbxc", "x", None, None, 1), [["a", "b", "c"]]),
    (("a-b.c", [["-", "."]]), [["a", "b", "c"]]),
    (("abc", "-"), [["abc"]]),
    (("", ","), [[""]]),
    (("", ",", None, True), [[ErrorCode.CALC]]),
    (("abc", ""), [[VALUE]]),
    (("abc", None), [[VALUE]]),
    ((NA, ","), [[NA]]),
    (("a,b", ",", None, 0, 2), [[VALUE]]),
    (([["a,b"], ["c,d"]], ","), [["a"], ["c"]]),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), EDGES)
def test_before_and_after(check, name, arguments, expected):
    check(name, arguments, expected)


@pytest.mark.parametrize(("arguments", "expected"), SPLITS)
def test_splits(evaluate, arguments, expected):
    assert evaluate("TEXTSPLIT", *arguments) == expected


def _trials(*texts: str):
    return from_objects(np.array(texts, object))


def test_splits_of_one_shape_in_all_trials():
    split = function_named("TEXTSPLIT")([_trials("a,b", "c,d"), constant(",")])
    assert split.objects().tolist() == [[["a", "b"]], [["c", "d"]]]


def test_splits_of_several_shapes_ask_to_be_called_trial_by_trial():
    with pytest.raises(ShapeVaries):
        function_named("TEXTSPLIT")([_trials("a,b", "c"), constant(",")])


def test_delimiters_may_differ_between_trials():
    before = function_named("TEXTBEFORE")([constant("a-b.c"), _trials("-", ".")])
    assert before.objects().tolist() == ["a", "a-b"]
