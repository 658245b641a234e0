"""The objects that Crystal Ball stores, as far as a run needs them: assumptions, forecasts, correlations and the rest.

An object is known by its GUID, 32 hexadecimal digits; a defined name `CB_<GUID>` says which cell it belongs to. What an
object takes from a cell (a parameter, its name) has a GUID of its own, and a defined name `CBCR_<GUID>`.

The classes and members are those of blocks that Crystal Ball 11.1.2 wrote.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from xlmc.montecarlo.definitions.crystal_ball.object_stream import Thing

__all__ = [
    "NAME",
    "OF_COEFFICIENTS",
    "OF_NAMES",
    "OF_PARAMETERS",
    "CellReference",
    "ForecastFilter",
    "Precision",
    "Stored",
    "StoredAssumption",
    "StoredCorrelation",
    "StoredDecision",
    "StoredError",
    "StoredForecast",
    "StoredOther",
    "stored_object",
    "stored_objects",
]

OF_PARAMETERS: Final = "ParmControlId"
OF_NAMES: Final = ("AsmValueRefEnum", "FrcValueRefEnum", "DecVarValueRefEnum")
OF_COEFFICIENTS: Final = "CorrelationCoefRefEnum"
NAME: Final = 0
"""The member of `OF_NAMES` that says: the cell gives the name."""

_GUID: Final = (("_a", 8), ("_b", 4), ("_c", 4), *((f"_{letter}", 2) for letter in "defghijk"))
"""Members of a GUID, and their hexadecimal digits."""


class StoredError(ValueError):
    """An object is not what it must be."""


@dataclass(frozen=True, slots=True)
class CellReference:
    """What an object takes from a cell.

    Attributes:
        kind, code: what for: an enumeration and its value.
        key: the defined name that says from where.
    """

    kind: str
    code: int
    key: str


@dataclass(frozen=True, slots=True)
class StoredAssumption:
    """An assumption.

    Attributes:
        text: its distribution, `Normal,Mean=100,StdDev=15`.
        code: of its family.
        slots: the same numbers by another numbering; 1 and 2 are the cutoffs.
        extra: why the text does not say everything; empty where it does.
    """

    guid: str
    name: str
    text: str
    code: int
    slots: Mapping[int, float]
    references: tuple[CellReference, ...]
    extra: str = ""


@dataclass(frozen=True, slots=True)
class ForecastFilter:
    """Values of a forecast that are discarded: those inside the limits, or those outside, in it or in all forecasts."""

    inside: bool
    outside: bool
    low: float
    high: float
    everywhere: bool


@dataclass(frozen=True, slots=True)
class Precision:
    """How well numbers of a forecast must be known.

    Attributes:
        numbers: as xlmc calls them.
        absolute, relative: the widths that are asked for, in units and as a share; None for one that is not.
    """

    numbers: tuple[str, ...]
    absolute: float | None
    relative: float | None


@dataclass(frozen=True, slots=True)
class StoredForecast:
    """A forecast; `certainty` are the ends of the range that its certainty was last shown for."""

    guid: str
    name: str
    units: str
    filter: ForecastFilter | None
    precision: Precision | None
    certainty: tuple[float, float]
    references: tuple[CellReference, ...]


@dataclass(frozen=True, slots=True)
class StoredCorrelation:
    """A rank correlation; each end is the GUID of a sheet and that of an assumption."""

    guid: str
    ends: tuple[tuple[str, str], tuple[str, str]]
    coefficient: float
    references: tuple[CellReference, ...]


@dataclass(frozen=True, slots=True)
class StoredDecision:
    """A decision variable.

    Attributes:
        steps: its least and largest value and the step between values; None where they are of a kind that was not met.
    """

    guid: str
    name: str
    references: tuple[CellReference, ...]
    steps: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class StoredOther:
    """Something that a run does not need, such as a chart."""

    kind: str


Stored = StoredAssumption | StoredForecast | StoredCorrelation | StoredDecision | StoredOther


def stored_objects(root: Any) -> list[Thing]:
    """Return the things in the list that is the root of a block.

    Raises:
        StoredError: it is no such list.
    """
    return [_as_thing(each, "the list of objects") for each in _items(root)]


def stored_object(thing: Thing) -> Stored:
    """Read what a thing says.

    Raises:
        StoredError: it lacks a member, or one is of another type.
    """
    read = _READERS.get(thing.kind)
    return StoredOther(thing.kind) if read is None else read(thing)


def _assumption(thing: Thing) -> StoredAssumption:
    distribution = _thing(_thing(thing, "mVar"), "mDst")
    numbers = _thing(distribution, "DstParms")
    extra = "custom data (the field CustomData)" if _member(distribution, "CustomData") is not None else ""
    if _member(numbers, "e") is not None:
        extra = "alternate parameters (the field e)"
    return StoredAssumption(
        _guid(_thing(thing, "mGuid")),
        _text(thing, "mVarName"),
        _text(thing, "mDstParms"),
        _enumerated(_thing(numbers, "b")),
        _slots(numbers),
        _references(thing),
        extra,
    )


def _slots(numbers: Thing) -> dict[int, float]:
    keys, values = _list(numbers, "c"), _list(numbers, "d")
    if len(keys) != len(values) or not all(isinstance(each, float) for each in (*keys, *values)):
        raise StoredError("the numbers of a DstParmSet have no slots of their own")
    if not all(key.is_integer() for key in keys) or len({*keys}) < len(keys):
        raise StoredError("a DstParmSet has slots that are no numbers of slots")
    return {int(key): value for key, value in zip(keys, values, strict=True)}


def _forecast(thing: Thing) -> StoredForecast:
    preferences = _thing(thing, "mPreferences")
    certainty = _thing(preferences, "fCertaintyChartPrefs")
    return StoredForecast(
        _guid(_thing(thing, "mGuid")),
        _text(thing, "mVarName"),
        _text(_thing(preferences, "fWindowPrefs"), "fUnits"),
        _filter(_thing(preferences, "fFilterPrefs")),
        _precision(_thing(preferences, "fPrecisionPrefs")),
        (_number(certainty, "fCertaintyRangeMin"), _number(certainty, "fCertaintyRangeMax")),
        _references(thing),
    )


def _filter(thing: Thing) -> ForecastFilter | None:
    if not _flag(thing, "fUseFilter"):
        return None
    low, high = _number(thing, "fFilterMin"), _number(thing, "fFilterMax")
    inside, outside = _flag(thing, "fFilterInside"), _flag(thing, "fFilterOutside")
    if math.isnan(low) or math.isnan(high):
        raise StoredError("the limits of a filter are no numbers")
    return ForecastFilter(inside, outside, low, high, _flag(thing, "fFilterAllOnDiscard"))


def _precision(thing: Thing) -> Precision | None:
    if not _flag(thing, "fUsePrecision"):
        return None
    asked = [name for name, member in (("mean", "fUseMean"), ("sd", "fUseStdDev")) if _flag(thing, member)]
    if _flag(thing, "fUsePercentile"):
        asked.append(f"p{100 * _number(thing, 'fUsePercentileValue'):.12g}")
    absolute = _number(thing, "fAbsoluteUnits") if _flag(thing, "fAbsolute") else None
    relative = _number(thing, "fRelativePct") if _flag(thing, "fRelative") else None
    return Precision(tuple(asked), absolute, relative)


def _correlation(thing: Thing) -> StoredCorrelation:
    first, second = (
        (_guid(_thing(thing, f"mAssumption{end}WorksheetGuid")), _guid(_thing(thing, f"mAssumption{end}Guid")))
        for end in (1, 2)
    )
    coefficient, references = _number(thing, "mCoefficient"), _references(thing)
    return StoredCorrelation(_guid(_thing(thing, "mGuid")), (first, second), coefficient, references)


def _decision(thing: Thing) -> StoredDecision:
    return StoredDecision(_guid(_thing(thing, "mGuid")), _text(thing, "mVarName"), _references(thing), _steps(thing))


_IN_STEPS: Final = 1
"""The type of the one decision variable that was met, whose values lie a step apart."""


def _steps(thing: Thing) -> tuple[float, float, float] | None:
    """Read the bounds and the step of a decision variable: `a`, `c` and `d` of its DecVar; `b` is the base value."""
    variable = thing.members.get("mVar")
    if not isinstance(variable, Thing):
        return None
    context = variable.members.get("mContextData")
    if not isinstance(context, Thing):
        return None
    known = dict(zip(map(str, _list(context, "Keys")), _list(context, "Values"), strict=False))
    if known.get("_DecVarType") != _IN_STEPS or known.get("_CustomValues") is not None:
        return None
    low, high, step = (_number(variable, member) for member in "acd")
    return (low, high, step) if math.isfinite(low + high + step) and low < high and step > 0.0 else None


_READERS: Final[Mapping[str, Callable[[Thing], Stored]]] = {
    "AssumptionCellRef": _assumption,
    "ForecastCellRef": _forecast,
    "CorrelationRef": _correlation,
    "DecVarCellRef": _decision,
}


def _references(thing: Thing) -> tuple[CellReference, ...]:
    table = _thing(_thing(thing, "mExcelCellRefs"), "mFors")
    cell_references = []
    for value in _list(table, "Values"):
        reference = _as_thing(value, "a cell reference")
        use = _thing(reference, "ValueRef+mFor")
        cell_references.append(CellReference(use.kind, _enumerated(use), _text(reference, "ValueRef+mGuidKey")))
    return tuple(cell_references)


def _guid(thing: Thing) -> str:
    """32 hexadecimal digits, as defined names write them."""
    digits = ""
    for name, width in _GUID:
        value = _member(thing, name)
        if type(value) is not int:
            raise StoredError("a GUID lacks numbers")
        digits += f"{value % 16**width:0{width}x}"
    return digits


def _enumerated(thing: Thing) -> int:
    value = _member(thing, "value__")
    if type(value) is not int:
        raise StoredError(f"a value of {thing.kind} is not a whole number")
    return value


def _items(thing: Any) -> list[Any]:
    """Return the elements of an ArrayList, whose array may be longer than its contents."""
    top = _as_thing(thing, "the root")
    items, size = _list(top, "_items"), _member(top, "_size")
    if type(size) is not int or not 0 <= size <= len(items):
        raise StoredError("a list claims more than it holds")
    return items[:size]


def _member(thing: Thing, name: str) -> Any:
    if name not in thing.members:
        raise StoredError(f"{thing.kind} lacks {name}")
    return thing.members[name]


def _as_thing(value: Any, what: str) -> Thing:
    if not isinstance(value, Thing):
        raise StoredError(f"{what} is no object")
    return value


def _thing(thing: Thing, name: str) -> Thing:
    return _as_thing(_member(thing, name), f"{name} of {thing.kind}")


def _list(thing: Thing, name: str) -> list[Any]:
    value = _member(thing, name)
    if not isinstance(value, list):
        raise StoredError(f"{name} of {thing.kind} is no list")
    return value


def _text(thing: Thing, name: str) -> str:
    value = _member(thing, name)
    if value is None:
        return ""
    if not isinstance(value, str):
        raise StoredError(f"{name} of {thing.kind} is no text")
    return value


def _number(thing: Thing, name: str) -> float:
    value = _member(thing, name)
    if type(value) is not float:
        raise StoredError(f"{name} of {thing.kind} is no number")
    return value


def _flag(thing: Thing, name: str) -> bool:
    value = _member(thing, name)
    if type(value) is not bool:
        raise StoredError(f"{name} of {thing.kind} is neither TRUE nor FALSE")
    return value
