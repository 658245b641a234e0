"""What is made large or small, and what is required: sums of statistics of forecasts and of decisions, in words.

    goal         = sum
    requirement  = sum (">=" | "<=" | ">" | "<") sum, and of decisions alone also "="
    sum          = ["-"] term {("+" | "-") term}
    term         = [number "*"] (statistic | decision) | number
    statistic    = ("mean" | "median" | "SD" | "variance" | "CV" | "P" number) "of" forecast
                 | ("probability" | "certainty") ("of" | "that") forecast [limits]
    limits       = "above" number | "below" number | "at least" number | "at most" number
                 | "between" number "and" number | ("is" | "=") text | (">" | ">=" | "<" | "<=") number, after "that"

Each is measured on the trials of a candidate, with what every single trial adds to it. Of two candidates over the same
trials the error of the difference then comes from the differences trial by trial, whatever the statistic is.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.definitions.forms import Form, kind_of_format
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key
from xlmc.montecarlo.loop.candidates import Column, Values
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import number_text
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.proportions import least_error

__all__ = ["Goal", "Measure", "Measured", "Reader", "Requirement", "apart"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Number = Callable[[Floats], tuple[float, Floats, float]]
"""Takes a column without trials that have no number, `(m,)`; gives a number, what each trial pulls it by, `(m,)`, and
the least error that it has."""

_LEAST_TRIALS: Final = 2

_NOISE: Final = 1e-13
"""Differences that are rounding, as a share of the numbers."""

_SLACK: Final = 1e-12
"""By how much decisions may miss what is required of them, by rounding, as a share of its terms."""

_NUMBER: Final = re.compile(r"(?:\d[\d,]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*%?")
_STATISTIC: Final = re.compile(
    r"(?:the\s+)?(?:(?P<mean>mean|average|expected value)|(?P<median>median)|(?P<sd>sd|std dev|standard deviation)"
    r"|(?P<variance>variance)|(?P<cv>cv|coefficient of variation)"
    r"|p(?P<percent>\d+(?:\.\d+)?)|(?P<percentile>\d+(?:\.\d+)?)(?:st|nd|rd|th)\s+percentile"
    r"|(?P<share>probability|certainty|chance))\s+(?P<link>of|that)\b\s*",
    re.IGNORECASE,
)
_RELATION: Final = re.compile(r">=|<=|=>|=<|≥|≤|>|<|==?")
_LIMIT: Final = re.compile(r"\s*(?P<word>above|over|below|under|at least|at most|between|is)\b\s*", re.IGNORECASE)
_AND: Final = re.compile(r"\s*(?:and|to)\s+", re.IGNORECASE)
_SPELT: Final = {"=>": ">=", "=<": "<=", "≥": ">=", "≤": "<=", "above": ">", "over": ">", "below": "<", "under": "<"}
_SPELT_AT: Final = {"at least": ">=", "at most": "<="}
_COMPARES: Final[dict[str, Callable[[Floats, float], Bools]]] = {
    ">": np.greater,
    ">=": np.greater_equal,
    "<": np.less,
    "<=": np.less_equal,
}
_NO_STATISTIC: Final = re.compile(r"(?:the\s+)?(?P<name>\w[\w .%-]*?)\s+of\b", re.IGNORECASE)
_WITHOUT_OF: Final = re.compile(
    r"(?P<name>mean|average|median|sd|std dev|variance|cv|p\d+(?:\.\d+)?|probability|certainty)\s+(?!of\b|that\b)"
    r"(?P<rest>.+)",
    re.IGNORECASE,
)
_STATISTICS: Final = "There are mean, median, SD, variance, CV, any percentile such as P5, and probability"
_EXTREMES: Final = ("maximum", "max", "largest value", "minimum", "min", "smallest value")
_EXAMPLE: Final = 'Such as "mean of NPV", "P5 of NPV", "SD of NPV", "probability of NPV above 0", or "2*A + B"'


@dataclass(frozen=True, slots=True)
class Measured:
    """A number of one candidate.

    Attributes:
        value: of it; NaN where the trials do not give it.
        pulls: `(n,)` what each trial adds to its deviation, in its unit; None for a number without an error.
        least: the least error, where the number moves in steps.
    """

    value: float
    pulls: Floats | None = None
    least: float = 0.0

    @property
    def error(self) -> float:
        """The standard error; infinite where too few trials give the number."""
        if self.pulls is None:
            return 0.0 if math.isfinite(self.value) else math.inf
        return max(_error(self.pulls), self.least)


def _error(pulls: Floats) -> float:
    n = pulls.size
    return float(np.sqrt(np.sum(pulls * pulls) * n / max(n - 1, 1)))


def apart(first: Measured, second: Measured) -> tuple[float, float]:
    """Return how far the second lies above the first over the same trials, and the standard error of that."""
    difference = second.value - first.value
    noise = _NOISE * max(abs(first.value), abs(second.value))
    if abs(difference) <= noise:
        difference = 0.0
    if first.pulls is None or second.pulls is None:
        return difference, math.hypot(first.error, second.error)
    pulls = second.pulls - first.pulls
    error = _error(pulls)
    if error <= noise:
        return difference, 0.0
    return difference, max(error, min(first.least, second.least))


@dataclass(frozen=True, slots=True)
class _Term:
    """A statistic of a column, or a decision by its number, times a factor."""

    factor: float
    number: Number | None
    at: int

    def of(self, columns: Floats, values: Values) -> Measured:
        if self.number is None:
            return Measured(self.factor * values[self.at])
        column = columns[self.at]
        known = ~np.isnan(column)
        count = int(np.count_nonzero(known))
        if count < _LEAST_TRIALS:
            return Measured(math.nan)
        whole = count == column.size
        value, found, least = self.number(column if whole else column[known])
        pulls = found if whole else np.zeros(column.size)
        if not whole:
            pulls[known] = found
        if self.factor != 1.0:
            pulls = self.factor * pulls
        return Measured(self.factor * value, pulls, abs(self.factor) * least)


@dataclass(frozen=True, slots=True)
class Measure:
    """A sum of statistics and decisions.

    Attributes:
        text: as it was said.
        terms: of the sum.
        constant: that is added.
        form: how it is written.
        spread: whether it is a spread, in the unit of its forecast.
        units: of the forecast that it is a number of.
    """

    text: str
    terms: tuple[_Term, ...]
    constant: float
    form: Form
    spread: bool = False
    units: str = ""

    @property
    def exact(self) -> bool:
        """Whether decisions alone give it."""
        return all(each.number is None for each in self.terms)

    def of(self, columns: Floats, values: Values) -> Measured:
        """Measure it on the columns of a candidate, `(columns, n)`."""
        found = [each.of(columns, values) for each in self.terms]
        pulls = [each.pulls for each in found if each.pulls is not None]
        value = self.constant + sum(each.value for each in found)
        total = None if not pulls else np.sum(pulls, axis=0) if len(pulls) > 1 else pulls[0]
        return Measured(value, total, math.fsum(each.least for each in found))

    def shown(self, found: Estimate) -> str:
        """Write a value of it."""
        text = self.form.spread(found) if self.spread else self.form.estimate(found)
        return f"{text} {self.units}" if self.units else text


@dataclass(frozen=True, slots=True)
class Goal:
    """What is made as large as can be, or as small."""

    measure: Measure
    maximise: bool

    @property
    def sign(self) -> float:
        """The factor with which larger is better."""
        return 1.0 if self.maximise else -1.0

    @property
    def words(self) -> str:
        """`largest mean of NPV`."""
        return f"{'largest' if self.maximise else 'smallest'} {self.measure.text}"


@dataclass(frozen=True, slots=True)
class Requirement:
    """A sum, the limit moved to its side, that must be 0 or more.

    Attributes:
        text: as it was said.
        slack: how far it holds.
        left: the sum on its left, where the right side is a number; else the slack.
        strict: whether it must be above 0.
        equal: whether it must be 0; only of decisions.
    """

    text: str
    slack: Measure
    left: Measure
    strict: bool
    equal: bool = False

    def holds_for(self, values: Values) -> bool:
        """Whether decisions alone decide it, and meet it; True where statistics decide it."""
        if not self.slack.exact:
            return True
        found = self.slack.of(np.empty((0, 0)), values).value
        scale = _SLACK * (abs(self.slack.constant) + sum(abs(t.factor * values[t.at]) for t in self.slack.terms))
        if self.equal:
            return abs(found) <= scale
        return found > scale if self.strict else found >= -scale

    def measured(self, columns: Floats, values: Values) -> Measured:
        """Measure how far it holds: 0 or more where it does."""
        found = self.slack.of(columns, values)
        if not self.slack.exact:
            return found
        if self.holds_for(values):
            return Measured(0.0 if self.equal else max(found.value, 0.0))
        return Measured(-abs(found.value) or -_SLACK)


class Reader:
    """Reads goals and requirements of one workbook.

    Args:
        model: whose forecasts are meant.
        decisions: that are meant.

    Attributes:
        columns: of the trials, that what was read needs, in order.
    """

    def __init__(self, model: CompiledModel, decisions: Sequence[Decision]) -> None:
        self._model, self._chosen = model, decisions
        self._forecasts = {name_key(each.name): number for number, each in enumerate(model.forecasts)}
        self._decisions = {name_key(each.name): number for number, each in enumerate(decisions)}
        self.columns: list[Column] = []

    def goal(self, text: str, *, maximise: bool) -> Goal:
        """Read what is to be largest or smallest.

        Raises:
            SimulationError: it is none.
        """
        parsing = _Parsing(self, text)
        found = parsing.sum()
        parsing.end()
        if not found.terms:
            raise SimulationError(f"{text!r} is a number, and nothing to choose by", hint=_EXAMPLE)
        return Goal(found, maximise)

    def requirement(self, text: str) -> Requirement:
        """Read what is required.

        Raises:
            SimulationError: it is none.
        """
        parsing = _Parsing(self, text)
        left = parsing.sum()
        relation = parsing.relation()
        right = parsing.sum()
        parsing.end()
        if relation == "=" and not (left.exact and right.exact):
            message = f"In {text!r} a statistic is to be one number, which no trials can tell"
            raise SimulationError(message, hint="Give two requirements, one by >= and one by <=")
        if not left.terms and not right.terms:
            raise SimulationError(f"{text!r} asks for nothing of the workbook", hint=_EXAMPLE)
        sign = -1.0 if relation.startswith("<") else 1.0
        terms = [_Term(sign * each.factor, each.number, each.at) for each in left.terms]
        terms += [_Term(-sign * each.factor, each.number, each.at) for each in right.terms]
        constant = sign * (left.constant - right.constant)
        cleaned = " ".join(text.split())
        slack = Measure(cleaned, tuple(terms), constant, left.form, left.spread, left.units)
        if not right.terms and left.form.kind is Kind.YES_NO and not 0.0 <= right.constant <= 1.0:
            message = f"In {cleaned!r} a probability is compared with {number_text(right.constant)}"
            raise SimulationError(message, hint=f"Write {number_text(right.constant)}%, or a number from 0 to 1")
        return Requirement(cleaned, slack, slack if right.terms else left, "=" not in relation, relation == "=")

    def forecast(self, name: str) -> int | None:
        """Return the number of a forecast."""
        return self._forecasts.get(name_key(name))

    def decision(self, name: str) -> int | None:
        """Return the number of a decision."""
        return self._decisions.get(name_key(name))

    def holds_texts(self, number: int) -> bool:
        """Whether the values of a decision are no numbers."""
        return bool(self._chosen[number].contents)

    def spelt(self, key: str) -> str:
        """Return a name as the workbook writes it."""
        names = (*(each.name for each in self._model.forecasts), *(each.name for each in self._chosen))
        return next(name for name in names if name_key(name) == name_key(key))

    @property
    def names(self) -> list[str]:
        """Every name that may be meant, the longest first."""
        return sorted((*self._forecasts, *self._decisions), key=len, reverse=True)

    @property
    def model(self) -> CompiledModel:
        """The model."""
        return self._model

    def column(self, number: int, text: str | None = None) -> int:
        """Return where the trials of a forecast are found, or those in which it says a text."""
        wanted = number, text
        if wanted not in self.columns:
            self.columns.append(wanted)
        return self.columns.index(wanted)


class _Parsing:
    """One text, from left to right."""

    def __init__(self, reader: Reader, text: str) -> None:
        self._reader, self._text, self._at = reader, text, 0
        self._forms: list[tuple[Form, bool, str]] = []

    def sum(self) -> Measure:
        """Read a sum."""
        begin, terms, constant = self._at, list[_Term](), 0.0
        self._forms = []
        sign = self._sign()
        while True:
            term, number = self._term(-1.0 if sign == "-" else 1.0)
            constant += number
            if term is not None:
                terms.append(term)
            sign = self._sign()
            if not sign:
                break
        text = " ".join(self._text[begin : self._at].split())
        alone = len(self._forms) == 1 and len(terms) == 1 and terms[0].factor == 1.0 and not constant
        form, spread, units = self._forms[0] if alone else (Form(), False, "")
        return Measure(text, tuple(terms), constant, form, spread, units)

    def relation(self) -> str:
        """Read what stands between the sides of a requirement."""
        found = self._match(_RELATION)
        spelt = "" if found is None else _SPELT.get(found[0], found[0])
        if not spelt:
            hint = "Write >= or <= between what is required and its limit, or = between decisions"
            raise self._wrong("a requirement is a comparison", hint)
        return "=" if spelt.startswith("=") else spelt

    def end(self) -> None:
        """See that nothing follows."""
        if self._text[self._at :].strip():
            raise self._wrong("this is not understood", _EXAMPLE)

    def _sign(self) -> str:
        found = self._match(re.compile(r"[+\-−–]"))
        return "" if found is None else "+" if found[0] == "+" else "-"

    def _term(self, sign: float) -> tuple[_Term | None, float]:
        factor, statistic = sign, self._match(_STATISTIC)
        found = None if statistic is not None else self._match(_NUMBER)
        if found is not None:
            factor = sign * _number(found[0])
            if self._match(re.compile(r"[*·×]")) is None:  # the sign of multiplication
                return None, factor
            statistic = self._match(_STATISTIC)
        if statistic is not None:
            return self._statistic(factor, statistic), 0.0
        name = self._name()
        number = self._reader.decision(name)
        if number is None:
            raise self._wrong(
                f"{self._reader.spelt(name)!r} is a forecast, and a statistic of it is asked for", _EXAMPLE
            )
        if self._reader.holds_texts(number):
            hint = "Only decisions that are numbers can be required or added"
            raise self._wrong(f"the values of {self._reader.spelt(name)!r} are texts", hint)
        self._forms.append((Form(), False, ""))
        return _Term(factor, None, number), 0.0

    def _name(self) -> str:
        """Read a name as the workbook has it, in quotation marks or not."""
        quoted = self._match(re.compile(r"'([^']+)'|\"([^\"]+)\"|“([^”]+)”"))
        if quoted is not None:
            name: str = next(filter(None, quoted.groups()))
            if self._reader.forecast(name) is None and self._reader.decision(name) is None:
                raise self._wrong(f"there is no forecast or decision {name!r}", self._known())
            return name
        rest = self._text[self._at :].lstrip()
        for name in self._reader.names:
            beyond = rest[len(name) :][:1]
            if name_key(rest[: len(name)]) == name and not (beyond.isalnum() or beyond == "_"):
                self._at = len(self._text) - len(rest) + len(name)
                return name
        raise self._unknown(rest)

    def _unknown(self, rest: str) -> SimulationError:
        """Say what may have been meant by words that name nothing."""
        known, without = _NO_STATISTIC.match(rest), _WITHOUT_OF.match(rest)
        if known is not None and _STATISTIC.match(rest) is None:
            if " ".join(known["name"].casefold().split()) in _EXTREMES:
                hint = "It moves with the number of trials: ask for a percentile, such as P99 or P1"
                return self._wrong(f"the {known['name']} has no error that trials could tell", hint)
            return self._wrong(f"there is no statistic {known['name']!r}", _STATISTICS)
        if without is not None and self._begins_with_name(without["rest"]):
            return self._wrong("a word is missing", f'Write "{without["name"]} of {without["rest"].strip()}"')
        return self._wrong("there is no such statistic, forecast or decision", self._known(rest))

    def _begins_with_name(self, text: str) -> bool:
        return any(name_key(text).startswith(name) for name in self._reader.names)

    def _known(self, rest: str = "") -> str:
        model = self._reader.model
        names = [*(each.name for each in model.forecasts), *(each.name for each in model.definitions.decisions)]
        word = re.split(r"[<>=*+]", rest)[0].strip()
        return did_you_mean(word, names) if word else f"There are {', '.join(map(repr, names))}"

    def _statistic(self, factor: float, found: re.Match[str]) -> _Term:
        name = self._name()
        number = self._reader.forecast(name)
        if number is None:
            raise self._wrong(f"{self._reader.spelt(name)!r} is a decision, and not a forecast", _EXAMPLE)
        model = self._reader.model
        forecast, is_text = model.forecasts[number], number in model.categories
        code = model.formats[forecast.name]
        two = forecast.name in model.two_valued
        form = Form(Kind.YES_NO if two else kind_of_format(code) or Kind.NUMBER, code)
        if found["share"] is not None:
            return self._share(factor, number, is_text, by_sign=found["link"].casefold() == "that")
        if is_text:
            hint = f'Ask for the probability of a text, such as "probability of {forecast.name} is Yes"'
            raise self._wrong(f"the answers of {forecast.name!r} are texts", hint)
        at = self._reader.column(number)
        if found["mean"] is not None:
            self._forms.append((form, False, forecast.units))
            return _Term(factor, _yes if two else _mean, at)
        if found["sd"] is not None:
            self._forms.append((form, True, forecast.units))
            return _Term(factor, _deviation, at)
        if found["variance"] is not None or found["cv"] is not None:
            self._forms.append((Form(), False, ""))
            return _Term(factor, _variance if found["cv"] is None else _variation, at)
        percent = 50.0 if found["median"] is not None else float(found["percent"] or found["percentile"])
        if not 0.0 < percent < 100.0:
            raise self._wrong(f"{number_text(percent)} is no percentile", "Percentiles lie above 0 and below 100")
        self._forms.append((form, False, forecast.units))
        return _Term(factor, partial(_quantile, share=percent / 100.0), at)

    def _share(self, factor: float, number: int, is_text: bool, *, by_sign: bool) -> _Term:
        """Read the probability of a range, of a text, of a yes, or of being above the forecast's threshold."""
        forecast = self._reader.model.forecasts[number]
        self._forms.append((Form(Kind.YES_NO), False, ""))
        limit = self._match(_LIMIT)
        word = "" if limit is None else " ".join(limit["word"].casefold().split())
        sign = self._match(_RELATION) if by_sign and limit is None else None
        if word == "is" or (sign is not None and sign[0].startswith("=")):
            text = self._text_of(forecast.name, is_text)
            return _Term(factor, lambda x: _share(x == 1.0), self._reader.column(number, text))
        if is_text:
            hint = f'Say of which text, such as "probability of {forecast.name} is Yes"'
            raise self._wrong(f"the answers of {forecast.name!r} are texts", hint)
        at = self._reader.column(number)
        if word == "between":
            low = self._signed_number()
            if self._match(_AND) is None:
                raise self._wrong("a range has two ends", 'Such as "between 0 and 10"')
            high = self._signed_number()
            return _Term(factor, lambda x: _share((x >= low) & (x <= high)), at)
        if word or sign is not None:
            spelt = _SPELT_AT.get(word) or _SPELT.get(word) or ("" if sign is None else _SPELT.get(sign[0], sign[0]))
            bound, compare = self._signed_number(), _COMPARES[spelt]
            return _Term(factor, lambda x: _share(compare(x, bound)), at)
        if forecast.name in self._reader.model.two_valued or forecast.kind is Kind.YES_NO:
            return _Term(factor, lambda x: _share(x != 0.0), at)
        if forecast.threshold is None:
            hint = f'Say of what, such as "probability of {forecast.name} above 0"'
            raise self._wrong(f"{forecast.name!r} is no yes or no, and has no Threshold", hint)
        threshold = forecast.threshold
        return _Term(factor, lambda x: _share(x > threshold), at)

    def _text_of(self, name: str, is_text: bool) -> str:
        if not is_text:
            raise self._wrong(f"the answers of {name!r} are no texts", _EXAMPLE)
        found = self._match(re.compile(r"'([^']+)'|\"([^\"]+)\"|“([^”]+)”|([^<>=≤≥]+)"))
        if found is None:
            raise self._wrong("a text is missing", "Write it behind `is`")
        text: str = next(filter(None, found.groups()))
        return text.strip()

    def _signed_number(self) -> float:
        sign, found = self._sign(), self._match(_NUMBER)
        if found is None:
            raise self._wrong("a number is missing", _EXAMPLE)
        return (-1.0 if sign == "-" else 1.0) * _number(found[0])

    def _match(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        while self._text[self._at : self._at + 1].isspace():
            self._at += 1
        found = pattern.match(self._text, self._at)
        if found is not None:
            self._at = found.end()
        return found

    def _wrong(self, why: str, hint: str) -> SimulationError:
        marked = f"{self._text[: self._at].rstrip()} ⟨{self._text[self._at :].strip()}⟩".strip()
        return SimulationError(f"In {marked!r}: {why}", hint=hint)


def _number(text: str) -> float:
    """Read a number.

    >>> [_number(text) for text in ("1,000", ".5", "90 %", "2e3")]
    [1000.0, 0.5, 0.9, 2000.0]
    """
    bare = text.replace(",", "").strip()
    return float(bare[:-1]) / 100.0 if bare.endswith("%") else float(bare)


def _mean(x: Floats) -> tuple[float, Floats, float]:
    """Return the mean; a trial pulls it by (x − mean)/m."""
    mean = float(x.mean())
    return mean, (x - mean) / x.size, 0.0


def _deviation(x: Floats) -> tuple[float, Floats, float]:
    """Return the standard deviation s; a trial pulls it by ((x − mean)² − s²)/(2 s m)."""
    squares = (x - x.mean()) ** 2
    s = math.sqrt(float(squares.sum()) / (x.size - 1))
    return s, (squares - s * s) / (2.0 * s * x.size) if s else np.zeros(x.size), 0.0


def _variance(x: Floats) -> tuple[float, Floats, float]:
    """Return the variance s²; a trial pulls it by ((x − mean)² − s²)/m."""
    squares = (x - x.mean()) ** 2
    variance = float(squares.sum()) / (x.size - 1)
    return variance, (squares - variance) / x.size, 0.0


def _variation(x: Floats) -> tuple[float, Floats, float]:
    """Return the coefficient of variation s/mean, as results tell it; its pulls are those of s and of the mean."""
    s, pulls_s, _ = _deviation(x)
    mean, pulls, _ = _mean(x)
    if not mean:
        return math.nan, np.zeros(x.size), 0.0
    return s / mean, pulls_s / mean - s / mean**2 * pulls, 0.0


def _quantile(x: Floats, share: float) -> tuple[float, Floats, float]:
    """Return the quantile q at p, as PERCENTILE.INC; a trial pulls it by (p − [x ≤ q])/(m f).

    The density f at q comes from the order statistics that lie a standard error of their rank to both sides. Where
    hardly a trial crosses q the pulls say nothing: its least error is a step from one order statistic to the next.
    """
    last = x.size - 1
    rank = share * last
    aside = math.sqrt(share * (1.0 - share) * x.size)
    ranks = [math.floor(rank), math.ceil(rank), max(0, round(rank - aside)), min(last, round(rank + aside))]
    ordered = np.partition(x, sorted(set(ranks)))
    low, high, left, right = (float(ordered[each]) for each in ranks)
    value = low + (high - low) * (rank - ranks[0])
    step = (right - left) / max(ranks[3] - ranks[2], 1)
    below = x <= value
    return value, (below.mean() - below) * step, step


def _yes(x: Floats) -> tuple[float, Floats, float]:
    """Return the share of yes, which is any number but 0."""
    return _share(x != 0.0)


def _share(hits: Bools) -> tuple[float, Floats, float]:
    """Return the share of hits; a trial pulls it by (hit − share)/m."""
    share = float(hits.mean())
    return share, (hits - share) / hits.size, least_error(hits.size)
