"""What is known of a function that a formula calls, before it is lowered.

How many arguments it takes (Excel refuses any other number as the formula is typed; xlmc names the cell), the error for
a function that xlmc does not compute, and the function with the workbook's settings, where it depends on these.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache
from typing import Any, Final

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function
from xlmc.excel.functions.families import REGISTRY, function_named

__all__ = ["LEFT_OUT", "MOST", "SPECIAL", "check_count", "limits", "not_computed", "unknown_to_excel", "with_settings"]

MOST: Final = 255

SPECIAL: Final[Mapping[str, tuple[int, int]]] = {
    "IF": (2, 3),
    "IFS": (2, MOST),
    "SWITCH": (3, MOST),
    "CHOOSE": (2, MOST),
    "IFERROR": (2, 2),
    "IFNA": (2, 2),
    "SINGLE": (1, 1),
    "OFFSET": (3, 5),
    "INDIRECT": (1, 2),
    "INDEX": (2, 4),
    "ROW": (0, 1),
    "COLUMN": (0, 1),
    "ROWS": (1, 1),
    "COLUMNS": (1, 1),
    "AREAS": (1, 1),
    "ISREF": (1, 1),
    "ISFORMULA": (1, 1),
    "FORMULATEXT": (1, 1),
    "GETPIVOTDATA": (2, 254),
    "SHEET": (0, 1),
    "SHEETS": (0, 1),
    "CELL": (1, 2),
    "ANCHORARRAY": (1, 1),
    "MAP": (2, MOST),
    "REDUCE": (2, 3),
    "SCAN": (2, 3),
    "BYROW": (2, 2),
    "BYCOL": (2, 2),
    "MAKEARRAY": (3, 3),
    "ISOMITTED": (1, 1),
    "PERCENTOF": (2, 2),
}
"""The fewest and the most arguments of functions that are lowered in a way of their own."""

_GIVE: Final = "write code of a workbook or of an add-in in Python: --functions my_functions.py"
_CLOSE: Final = 0.75
"""Likeness above which a name may be meant for another one."""

_ADD_INS: Final = ("CB.", "RISK")
_CODE: Final = ("vbaproject", "macrosheets")
"""Words in the names of the parts of a file that hold the workbook's own functions."""

_WITHOUT_BODY: Final = (
    frozenset({"DBCS", "JIS", "PHONETIC", "BAHTTEXT", "EUROCONVERT", "INFO"})
    | {"REGEXTEST", "REGEXEXTRACT", "REGEXREPLACE", "TRANSLATE", "DETECTLANGUAGE", "COPILOT"}
    | {"FORECAST.ETS", "FORECAST.ETS.CONFINT", "FORECAST.ETS.SEASONALITY", "FORECAST.ETS.STAT"}
    | {"GROUPBY", "PIVOTBY", "TRIMRANGE", "FIELDVALUE", "STOCKHISTORY"}
    | {"CUBEKPIMEMBER", "CUBEMEMBER", "CUBEMEMBERPROPERTY", "CUBERANKEDMEMBER", "CUBESET", "CUBESETCOUNT", "CUBEVALUE"}
    | {"CALL", "REGISTER.ID", "RTD", "SQL.REQUEST", "WEBSERVICE", "FILTERXML", "IMAGE", "IMPORTCSV", "IMPORTTEXT"}
)
"""Functions of Excel that had no body when they were listed; a name may stay when its function gets one."""

LEFT_OUT: Final = _WITHOUT_BODY - REGISTRY.keys()
"""Functions of Excel that xlmc has no body for."""


def check_count(name: str, arguments: Sequence[object]) -> None:
    """Refuse too few and too many arguments; a function that is not known may have any number.

    Raises:
        FormulaError: it takes another number.
    """
    result = limits(name)
    if result is not None and not result[0] <= len(arguments) <= result[1]:
        raise FormulaError(f"{name} has {_count_arguments(len(arguments))}; it takes {_describe_limits(*result)}")


def limits(name: str) -> tuple[int, int] | None:
    """Return the fewest and the most arguments; None of a function that is not known."""
    if name in SPECIAL:
        return SPECIAL[name]
    function = function_named(name)
    return None if function is None else function.arity()


def _count_arguments(count: int) -> str:
    return f"{count} argument{'s' * (count != 1)}"


def _describe_limits(fewest: int, most: int) -> str:
    if most == MOST:
        return f"{fewest} or more"
    return str(fewest) if fewest == most else f"{fewest} to {most}"


def unknown_to_excel(call: ir.Call, parts: Iterable[str]) -> bool:
    """Whether a function is none of Excel's, of an add-in's or of the book's own code, as far as the file tells.

    The caller checks that the value Excel saved in the cell agrees: an unknown add-in may have been there.

    Args:
        call: of the function.
        parts: the names of the file's parts.
    """
    if call.foreign or call.name in LEFT_OUT or call.name.startswith(_ADD_INS):
        return False
    return not any(word in part.casefold() for part in parts for word in _CODE)


def not_computed(name: str, own: tuple[str, ...] = (), file: str = "") -> FormulaError:
    """Refuse a function without a body here.

    Args:
        name: of the function, in capitals.
        own: the names of the person's own functions, where a file of these is given.
        file: its name.
    """
    if name in LEFT_OUT:
        hint = f"replace it by functions that xlmc computes, which docs/functions.md lists, or {_GIVE}"
        return FormulaError(f"xlmc does not compute the function {name} of Excel", hint=hint)
    missing = f", and {file} does not define it" if file else ""
    return FormulaError(f"the function {name} is not known to xlmc{missing}", hint=_hint(name, own))


@cache
def _hint(name: str, own: tuple[str, ...]) -> str:
    """Say what to do about an unknown function. A workbook of another program calls each many times, and may have the
    rest computed: to look through all names takes longer than that.
    """
    known = {each.upper(): each for each in own}
    known |= {key: key for key in REGISTRY if key[0].isalpha() and ("." in key or "." not in name)}
    close = get_close_matches(name, known, n=1, cutoff=_CLOSE)
    return f"did you mean {known[close[0]]}?" if close else f"check its spelling; {_GIVE}"


@cache
def with_settings(function: Function, date1904: bool, macintosh: bool) -> Function:
    """Return the function with the settings of a workbook; the same object each time, so that nodes are shared."""
    if function.dated:
        return replace(function, body=_WithOption(function, "date1904", date1904))
    if macintosh and function.macintosh:
        return replace(function, body=_WithOption(function, "macintosh", macintosh))
    return function


@dataclass(frozen=True, slots=True)
class _WithOption:
    """The body of a row with one of its options given. It is pickled with the row, and the row as its name."""

    row: Function
    option: str
    value: bool

    def __call__(self, *arguments: Any) -> Any:
        return self.row.body(*arguments, **{self.option: self.value})
