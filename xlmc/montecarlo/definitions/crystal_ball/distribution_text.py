"""The text that says an assumption's distribution, `Normal,LoCut=-1,Mean=100,StdDev=15`, and the numbers beside it.

The families of genuine workbooks are Normal, LogNormal, Beta and DPoisson; their codes and slots are known, and text
and numbers must agree. Of other families the text must name exactly the parameters that Crystal Ball documents, and no
number beside it may be one that the text lacks.

Source: six workbooks that Crystal Ball 11.1.2 wrote; for the other families Oracle Crystal Ball User's Guide.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from xlmc.montecarlo.definitions.crystal_ball.object_names import UnreadableError
from xlmc.montecarlo.definitions.crystal_ball.stored_objects import StoredAssumption
from xlmc.montecarlo.distributions.spelling import plain

__all__ = ["Distribution", "distribution_of"]

_NUMBER: Final = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")

_LOWER, _UPPER = "lower_cutoff", "upper_cutoff"
_CUTOFFS: Final = {"LoCut": (_LOWER, 1, -1.11e307), "HiCut": (_UPPER, 2, 1.11e307)}
"""Word of the text -> cutoff, its slot, and what stands there where there is none."""

_FIRST_OF_FAMILY: Final = 3
"""Slots below hold the cutoffs and a number without a meaning for a run."""


@dataclass(frozen=True, slots=True)
class _Words:
    """How a text names a family's parameters.

    Attributes:
        family: as `xlmc.montecarlo.distributions.FAMILIES` spells it.
        keys: word of the text -> parameter.
        code, slots: those of genuine workbooks: word -> slot; None of a family that was not met in one.
        may_lack: words that have no slot while their number is 0.
    """

    family: str
    keys: Mapping[str, str]
    code: int | None = None
    slots: Mapping[str, int] = field(default_factory=dict)
    may_lack: tuple[str, ...] = ()


_LOW_HIGH: Final = {"Min": "low", "Max": "high"}
_PEAKED: Final = {"Min": "low", "Likeliest": "likeliest", "Max": "high"}
_PLACED: Final = {"Location": "location", "Scale": "scale", "Shape": "shape"}
_EXTREME: Final = {"Likeliest": "likeliest", "Scale": "scale"}

_MET: Final = {
    "Normal": _Words("Normal", {"Mean": "mean", "StdDev": "std_dev"}, 3, {"Mean": 3, "StdDev": 4}),
    "LogNormal": _Words(
        "Lognormal",
        {"Mean": "mean", "StdDev": "std_dev", "Location": "location"},
        4,
        {"Mean": 5, "StdDev": 6},
        ("Location",),
    ),
    "Beta": _Words(
        "Beta",
        {**_LOW_HIGH, "Alpha": "alpha", "Beta": "beta"},
        8,
        {"Min": 3, "Max": 4, "Alpha": 5, "Beta": 6},
    ),
    "DPoisson": _Words("Poisson", {"Rate": "rate"}, 18, {"Rate": 3}),
}

_DOCUMENTED: Final = {
    "Uniform": _Words("Uniform", _LOW_HIGH),
    "Triangular": _Words("Triangular", _PEAKED),
    "BetaPERT": _Words("BetaPERT", _PEAKED),
    "Exponential": _Words("Exponential", {"Rate": "rate"}),
    "Gamma": _Words("Gamma", _PLACED),
    "Weibull": _Words("Weibull", _PLACED),
    "Logistic": _Words("Logistic", {"Mean": "mean", "Scale": "scale"}),
    "Pareto": _Words("Pareto", {"Location": "location", "Shape": "shape"}),
    "StudentsT": _Words("Student's t", {"Midpoint": "midpoint", "Scale": "scale", "DegFreedom": "degrees"}),
    "MaxExtreme": _Words("Maximum Extreme", _EXTREME),
    "MinExtreme": _Words("Minimum Extreme", _EXTREME),
    "DUniform": _Words("Discrete Uniform", _LOW_HIGH),
    "DBinomial": _Words("Binomial", {"Prob": "probability", "Trials": "trials"}),
    "DYesNo": _Words("Yes-No", {"Prob": "probability"}),
    "DGeometric": _Words("Geometric", {"Prob": "probability"}),
    "DNegBinomial": _Words("Negative Binomial", {"Prob": "probability", "Shape": "shape"}),
    "DHypergeometric": _Words("Hypergeometric", {"Success": "success", "Trials": "trials", "Population": "population"}),
}

_ALSO: Final = {
    "Pert": "BetaPERT",
    "StudentT": "StudentsT",
    "MaximumExtreme": "MaxExtreme",
    "MinimumExtreme": "MinExtreme",
    "DiscreteUniform": "DUniform",
    "Binomial": "DBinomial",
    "YesNo": "DYesNo",
    "Geometric": "DGeometric",
    "NegBinomial": "DNegBinomial",
    "NegativeBinomial": "DNegBinomial",
    "DNegativeBinomial": "DNegBinomial",
    "Hypergeometric": "DHypergeometric",
    "Poisson": "DPoisson",
}
"""Other spellings of families that were not met."""

_ALSO_WORDS: Final = {
    "Minimum": "Min",
    "Maximum": "Max",
    "Mode": "Likeliest",
    "Probability": "Prob",
    "Degrees": "DegFreedom",
    "DegreesOfFreedom": "DegFreedom",
}
"""Other spellings of their parameters."""

_CODES: Final = {words.code: name for name, words in _MET.items()}


@dataclass(frozen=True, slots=True)
class Distribution:
    """What a text says.

    Attributes:
        family: as `xlmc.montecarlo.distributions.FAMILIES` spells it.
        parameters: key of a parameter -> number.
        cutoffs: key of a cutoff -> number.
        met: whether genuine workbooks have shown how such a text is meant.
    """

    family: str
    parameters: Mapping[str, float]
    cutoffs: Mapping[str, float]
    met: bool


def distribution_of(stored: StoredAssumption) -> Distribution:
    """Return the distribution of an assumption.

    Raises:
        UnreadableError: its text is not understood, or the numbers beside it say something else.
    """
    if stored.extra:
        raise UnreadableError(f"it has {stored.extra}")
    name, given = _split(stored.text)
    words, numbers = _words(name, given)
    cutoffs = {_CUTOFFS[word][0]: value for word, value in numbers.items() if word in _CUTOFFS}
    own = {word: value for word, value in numbers.items() if word not in _CUTOFFS}
    if {*own} != {*words.keys}:
        raise UnreadableError(f"{name} needs {', '.join(words.keys)}, and the text gives {', '.join(own) or 'nothing'}")
    _compare_cutoffs(stored.slots, cutoffs)
    slots = {slot: value for slot, value in stored.slots.items() if slot >= _FIRST_OF_FAMILY}
    if words.code is None:
        _refuse_other(stored.code, name, slots, own)
        met = False
    else:
        met = _compare(stored.code, name, words, slots, own)
    return Distribution(words.family, {words.keys[word]: value for word, value in own.items()}, cutoffs, met)


def _split(text: str) -> tuple[str, list[tuple[str, float]]]:
    name, *parts = text.split(",")
    result = []
    for part in parts:
        word, _, number = part.partition("=")
        if not _NUMBER.fullmatch(number):
            raise UnreadableError(f"{part!r} is not a parameter and its number")
        result.append((word, float(number)))
    return name, result


def _words(name: str, given: list[tuple[str, float]]) -> tuple[_Words, dict[str, float]]:
    """How the family is described, and its numbers by the words of that."""
    if name in _MET:
        words, spelt = _MET[name], dict(given)
    else:
        also = {plain(each): each for each in (*_DOCUMENTED, *_MET)} | {plain(k): v for k, v in _ALSO.items()}
        known = also.get(plain(name))
        if known is None:
            raise UnreadableError(f"the distribution {name!r} is not known")
        words = _DOCUMENTED[known] if known in _DOCUMENTED else _MET[known]
        also_words = {plain(each): each for each in (*words.keys, *_CUTOFFS)}
        also_words |= {plain(also): word for also, word in _ALSO_WORDS.items() if word in words.keys}
        spelt = {also_words.get(plain(word), word): value for word, value in given}
        if known in _MET:
            words = _Words(words.family, words.keys)
    if len(spelt) < len(given):
        raise UnreadableError("a parameter is given twice")
    return words, spelt


def _compare_cutoffs(slots: Mapping[int, float], cutoffs: Mapping[str, float]) -> None:
    """Compare the cutoffs of the text with those of the slots.

    Raises:
        UnreadableError: they differ.
    """
    for word, (key, slot, none) in _CUTOFFS.items():
        if slots.get(slot, none) != cutoffs.get(key, none):
            raise UnreadableError(f"text and numbers disagree on {word}")


def _compare(code: int, name: str, words: _Words, slots: Mapping[int, float], own: Mapping[str, float]) -> bool:
    """Compare text and numbers of a family that was met; whether all of it was.

    Raises:
        UnreadableError: they differ.
    """
    if code != words.code:
        raise UnreadableError(f"the text says {name}, and the code {code} {_CODES.get(code, 'something else')}")
    for word, value in own.items():
        if word in words.slots and slots.get(words.slots[word]) != value:
            raise UnreadableError(f"text and numbers disagree on {word}")
    beyond = [own[word] for word in words.may_lack]
    if any(value not in beyond for slot, value in slots.items() if slot not in words.slots.values()):
        raise UnreadableError("there are numbers that the text lacks")
    return not any(beyond)


def _refuse_other(code: int, name: str, slots: Mapping[int, float], own: Mapping[str, float]) -> None:
    """Refuse a family that was not met where what stands beside the text speaks against it.

    Raises:
        UnreadableError: the code is that of another family, or there are numbers that the text lacks.
    """
    if code in _CODES:
        raise UnreadableError(f"the text says {name}, and the code {code} {_CODES[code]}")
    if any(value not in own.values() for value in slots.values()):
        raise UnreadableError("there are numbers that the text lacks")
