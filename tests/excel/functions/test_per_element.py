from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.per_element import object_text, per_object
from xlmc.excel.functions.values import constant, from_objects


def _trials(*items):
    box = np.empty(len(items), object)
    box[:] = items
    return from_objects(box)


def test_each_element_comes_as_what_it_is():
    """Kinds of the arguments, and a body that says them."""
    body = per_object(lambda item: type(item).__name__)
    assert body(_trials(1.0, True, "a", None)).objects().tolist() == ["float", "bool", "str", "NoneType"]


def test_the_first_error_of_the_arguments_is_the_result():
    body = per_object(lambda one, other: one)
    values = _trials(1.0, ErrorCode.NA, ErrorCode.NA), _trials(ErrorCode.REF, 2.0, ErrorCode.REF)
    assert body(*values).objects().tolist() == [ErrorCode.REF, ErrorCode.NA, ErrorCode.NA]


def test_ranges_and_trials_broadcast():
    range_ = from_objects(np.array([[["a", "b"]]], object))
    joined = per_object(lambda text, number, mark="!": f"{text}{number:.0f}{mark}")
    assert joined(range_, _trials(1.0, 2.0)).objects().tolist() == [[["a1!", "b1!"]], [["a2!", "b2!"]]]
    assert joined(constant("c"), constant(3.0), mark="?").objects().tolist() == ["c3?"]


def test_the_docstring_is_the_functions():
    def documented(item: object) -> object:
        """What it does."""
        return item

    assert per_object(documented).__doc__ == "What it does."


@pytest.mark.parametrize(
    ("item", "text"),
    [(None, ""), (True, "TRUE"), (False, "FALSE"), (1.5, "1.5"), ("a", "a"), (ErrorCode.DIV0, "#DIV/0!")],
)
def test_objects_as_texts(item, text):
    assert object_text(item) == text
