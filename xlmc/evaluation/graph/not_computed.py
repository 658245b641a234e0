"""What is said of a function that xlmc does not compute: that it is Excel's, or that nobody knows it."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Final

from xlmc.errors import FormulaError
from xlmc.formula import ir
from xlmc.functions.families import REGISTRY

__all__ = ["LEFT_OUT", "not_computed", "unknown_to_excel"]

_ADD_INS: Final = ("CB.", "RISK")
_CODE: Final = ("vbaproject", "macrosheets")
"""In the names of the parts that hold the functions of a book's own."""

LEFT_OUT: Final = (
    frozenset({"DBCS", "JIS", "PHONETIC", "BAHTTEXT", "EUROCONVERT", "INFO"})
    | {"REGEXTEST", "REGEXEXTRACT", "REGEXREPLACE", "TRANSLATE", "DETECTLANGUAGE", "COPILOT"}
    | {"FORECAST.ETS", "FORECAST.ETS.CONFINT", "FORECAST.ETS.SEASONALITY", "FORECAST.ETS.STAT"}
    | {"GROUPBY", "PIVOTBY", "TRIMRANGE", "GETPIVOTDATA", "FIELDVALUE", "STOCKHISTORY"}
    | {"CUBEKPIMEMBER", "CUBEMEMBER", "CUBEMEMBERPROPERTY", "CUBERANKEDMEMBER", "CUBESET", "CUBESETCOUNT", "CUBEVALUE"}
    | {"CALL", "REGISTER.ID", "RTD", "SQL.REQUEST", "WEBSERVICE", "FILTERXML", "IMAGE", "IMPORTCSV", "IMPORTTEXT"}
)
"""Functions of Excel that xlmc has no body for."""


def unknown_to_excel(call: ir.Call, parts: Iterable[str]) -> bool:
    """Whether a function is none of Excel's, of an add-in or of the book's own code, by all that the file tells.

    What Excel saved in the cell must say the same: the add-in may have been there.

    Args:
        call: of the function.
        parts: the names of the file's parts.
    """
    if call.foreign or call.name in LEFT_OUT or call.name.startswith(_ADD_INS):
        return False
    return not any(word in part.casefold() for part in parts for word in _CODE)


def not_computed(name: str) -> FormulaError:
    """The refusal of a function without a body here."""
    if name in LEFT_OUT:
        hint = "replace it by functions that xlmc computes: docs/functions.md lists them"
        return FormulaError(f"xlmc does not compute the function {name} of Excel", hint=hint)
    close = get_close_matches(name, [key for key in REGISTRY if key[0].isalpha()], n=1)
    hint = f"did you mean {close[0]}?" if close else "check its spelling, or replace it by functions xlmc knows"
    return FormulaError(f"the function {name} is not known to xlmc", hint=hint)
