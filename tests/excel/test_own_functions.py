"""Functions of a person's own: what they are given, what they may give, and what is told where they fail."""

from __future__ import annotations

import hashlib
import re

import numpy as np
import pytest

from xlmc.errors import ErrorCode, FormulaError, WorkbookError
from xlmc.excel.functions.values import constant, from_objects
from xlmc.excel.own_functions import load_functions, numbers_given, the_same_functions

DIV0, NUM, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.NA


@pytest.fixture
def made(tmp_path):
    """`made("def F(x): return x")`: the functions of a file."""

    def load(text):
        path = tmp_path / "mine.py"
        path.write_text(f"import numpy as np\nfrom xlmc.excel.own_functions import scalar\n{text}", encoding="utf-8")
        return load_functions(path)

    return load


def column(*values):
    return from_objects(np.array(values, object))


def area(*trials):
    """A range of each trial."""
    return from_objects(np.array(trials, object))


def called(functions, *arguments, name="F"):
    return functions.named(name, len(arguments)).body(*arguments).objects().tolist()


@pytest.mark.parametrize(
    ("body", "arguments", "result"),
    [
        ("x + y", [column(1.0, 2.0), column(10.0, 20.0)], [11.0, 22.0]),
        ("x + y", [column(1.0, 2.0), constant(10.0)], [11.0, 12.0]),
        ("x + y", [column(None, True), constant(10.0)], [10.0, 11.0]),
        ("x > y", [column(1.0, 20.0), constant(10.0)], [False, True]),
        ("x / y", [column(1.0, 0.0), column(0.0, 0.0)], [NUM, NUM]),
        ("3.0", [column(1.0, 2.0), constant(1.0)], [3.0, 3.0]),
        ("[3.0]", [column(1.0, 2.0), constant(1.0)], [3.0, 3.0]),
        ("np.where(x > 1, 'big', 'small')", [column(1.0, 2.0), constant(1.0)], ["small", "big"]),
        ("x", [column("a", 2.0), constant(1.0)], ["a", 2.0]),
        ("x + y", [column(1.0, DIV0, NA), column(1.0, NA, 5.0)], [2.0, DIV0, NA]),  # the first error of a trial
        ("x + y", [constant(DIV0), column(1.0, 2.0)], [DIV0, DIV0]),
        ("x.sum(axis=(1, 2)) + y", [area([[1.0, 2.0]], [[3.0, None]]), constant(1.0)], [4.0, 4.0]),
        ("x.sum(axis=(1, 2)) + y", [area([[1.0, 2.0]], [[3.0, NUM]]), constant(1.0)], [4.0, NUM]),
        ("x + y", [area([[1.0]], [[3.0]]), constant(1.0)], [2.0, 4.0]),  # a range of one cell is its value
    ],
)
def test_functions_of_all_trials(made, body, arguments, result):
    assert called(made(f"def F(x, y): return {body}"), *arguments) == result


@pytest.mark.parametrize(
    ("body", "arguments", "result"),
    [
        ("x + y if x > 1 else 'none'", [column(1.0, 2.0), constant(10.0)], ["none", 12.0]),
        ("np.float64(x)", [column(1.0, 2.0), constant(1.0)], [1.0, 2.0]),
        ("np.array([x])", [column(1.0, 2.0), constant(1.0)], [1.0, 2.0]),
        ("x > y", [column(1.0, 2.0), constant(1.0)], [False, True]),
        ("float('inf')", [column(1.0), constant(1.0)], [NUM]),
        ("float('nan')", [column(1.0), constant(1.0)], [NUM]),
        ("x", [column("a", None, True), constant(1.0)], ["a", 0.0, True]),
        ("x + y", [column(1.0, DIV0), constant(1.0)], [2.0, DIV0]),
        ("float(x.sum()) + x.shape[1]", [area([[1.0, 2.0]], [[3.0, 4.0]]), constant(1.0)], [5.0, 9.0]),
        ("x[0, 1]", [area([[1.0, "b"]], [[3.0, "d"]]), constant(1.0)], ["b", "d"]),
    ],
)
def test_functions_of_one_trial(made, body, arguments, result):
    assert called(made(f"@scalar\ndef F(x, y): return {body}"), *arguments) == result


def test_a_function_without_arguments_gives_one_value(made):
    assert called(made("def F(): return 7")) == [7.0]
    assert called(made("@scalar\ndef F(): return 7")) == [7.0]


@pytest.mark.parametrize(
    ("signature", "counts", "takes"),
    [
        ("a, b", {1: False, 2: True, 3: False}, "takes 2"),
        ("a, b=1", {0: False, 1: True, 2: True, 3: False}, "takes 1 to 2"),
        ("a, *more", {0: False, 1: True, 9: True}, "takes 1 or more"),
        ("", {0: True, 1: False}, "takes 0"),
        ("a, /, b", {1: False, 2: True}, "takes 2"),
    ],
)
def test_numbers_of_arguments(made, signature, counts, takes):
    functions = made(f"def F({signature}): return 1.0")
    for count, right in counts.items():
        if right:
            assert functions.named("F", count) is not None
            continue
        with pytest.raises(FormulaError, match=takes) as caught:
            functions.named("F", count)
        assert f"the function F is given {count} argument{'' if count == 1 else 's'}, and" in caught.value.message


def test_names(made):
    functions = made("def Power_Of(x): return x\ndef _own(x): return x\nclass Kept: pass\nNUMBER = 7\nlog = np.log")
    assert functions.names == ("Power_Of",)
    assert functions.named("POWER.OF", 1) is functions.named("POWER_OF", 1)
    assert functions.named("_OWN", 1) is functions.named("KEPT", 0) is functions.named("LOG2", 1) is None
    assert functions.file == "mine.py"
    assert functions.sha256 == hashlib.sha256(functions.source).hexdigest()
    assert made("__all__ = ['_own', 'cube']\ndef _own(x): return x\ncube = lambda x: x**3").names == ("_own", "cube")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1", "The file defines no function"),
        ("def Sum(x): return x", "The function Sum has the name of one of Excel"),
        ("def NORM_DIST(x): return x", "The function NORM_DIST has the name of one of Excel"),
        ("def a(x): return x\ndef A(x): return x", "The functions a and A have one name in Excel"),
        ("def F(x:\n    pass", r"The file is not Python: .* \(line 3\)"),
        ("__all__ = ['G']", "__all__ lists 'G', which is no function"),
        ("__all__ = ['G']\nG = 7", "__all__ lists 'G', which is no function"),
        ("1 / 0", r"The file fails when it is run: ZeroDivisionError: division by zero \(line 3\)"),
    ],
)
def test_files_that_are_refused(made, text, message):
    with pytest.raises(WorkbookError, match=message):
        made(text)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(WorkbookError, match="The file cannot be read"):
        load_functions(tmp_path / "none.py")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("def F(x): return None", "gives nothing"),
        ("def F(x): return x[:2]", r"gives the shape \(2,\) for 5 trials"),
        ("def F(x): return x + 1j", "gives complex numbers instead of real numbers"),
        ("def F(x): return np.ma.masked_less(x, 2)", "gives a masked array"),
        (
            "def F(x): return x - x.mean()",
            "gives -9.2, and -2.0 for the same values when it is called with fewer trials",
        ),
        ("def F(x): return np.where(x > x.mean(), 'a', 'b')", "gives 'b', and 'a' for the same values"),
        ("def F(x):\n    return 1.0 if x > 1 else 2.0", r"failed: ValueError: .* \(line 4\)"),
        ("@scalar\ndef F(x): return None", "gives nothing"),
        ("@scalar\ndef F(x): return [1.0, 2.0]", "gives a list"),
        ("@scalar\ndef F(x): raise KeyError(x)", "failed: KeyError"),
    ],
)
def test_functions_that_fail_are_told(made, text, message):
    with pytest.raises(FormulaError, match=f"The function F of mine.py {message}"):
        called(made(text), column(1.0, 5.0, 2.0, 3.0, 40.0))


def test_two_trials_are_called_a_second_time_and_only_once(made):
    functions = made("seen = []\ndef F(x):\n    seen.append(x.size)\n    return x * 2")
    body = functions.named("F", 1).body
    seen = body.function.__globals__["seen"]
    body(column(1.0, 2.0))
    assert seen == [2]  # as many as would be tried again
    body(column(1.0, 2.0, 3.0))
    body(column(1.0, 2.0, 3.0))
    assert seen == [2, 3, 2, 3]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def F(x, y): return 1 / None", r"arrays of the shape \(3, 1, 2\) and \(3,\), a value for each trial"),
        ("@scalar\ndef F(x, y): return 1 / None", r"one trial at a time: 1.0, array\(\[\[1., 2.\]\]\)"),
    ],
)
def test_what_a_function_was_called_with_is_told(made, text, words):
    with pytest.raises(FormulaError) as caught:
        called(made(text), column(1.0, 2.0, 3.0), area([[1.0, 2.0]]))
    assert re.search(words, caught.value.hint)


@pytest.mark.parametrize(
    ("given", "result"),
    [
        ([1, 2], [1.0, 2.0]),
        ([True, False], [True, False]),
        (np.array([1, 2.5], object), [1.0, 2.5]),
        (2**70, 2.0**70),
        (np.uint8(7), 7),
    ],
)
def test_numbers_that_are_given(given, result):
    assert numbers_given(given).tolist() == result


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["a"], "gives texts instead"),
        (np.array(["2026-01-01"], "datetime64[D]"), "gives dates instead"),
        (np.array([1], "timedelta64[s]"), "gives spans of time instead"),
        ([1j], "gives complex numbers instead"),
        ([b"a"], "gives bytes instead"),
        ([None], "gives objects instead"),
        ([[1.0], [1.0, 2.0]], "gives no array of numbers"),
    ],
)
def test_what_is_no_number(given, message):
    with pytest.raises(ValueError, match=message):
        numbers_given(given)


def test_a_recorded_run_wants_the_same_file(made, tmp_path):
    functions = made("def F(x): return x")
    assert the_same_functions(functions, "mine.py", functions.sha256, tmp_path) is functions
    with pytest.raises(WorkbookError, match=r"This is not the file 'mine.py' that the run was made with"):
        the_same_functions(functions, "mine.py", "0" * 64, tmp_path)
    with pytest.raises(WorkbookError, match=r"Formulas of this run call functions of 'mine.py'"):
        the_same_functions(None, "mine.py", functions.sha256, tmp_path)


def test_numbers_that_are_not_finite_are_num(made):
    functions = made("def F(x): return np.choose(x.astype(int), [np.inf, -np.inf, np.nan, 1.0])")
    assert called(functions, column(0.0, 1.0, 2.0, 3.0)) == [NUM, NUM, NUM, 1.0]
