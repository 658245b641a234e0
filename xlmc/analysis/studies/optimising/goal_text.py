"""Goals and requirements as a person writes them.

goal         = sum
requirement  = sum (">=" | "<=" | ">" | "<") sum, and of decisions alone also "="
sum          = ["-"] term {("+" | "-") term}
term         = [number "*"] (statistic | decision) | number
statistic    = ("mean" | "median" | "SD" | "variance" | "CV" | "P" number) "of" forecast
| ("probability" | "certainty") ("of" | "that") forecast [limits]
limits       = "above" number | "below" number | "at least" number | "at most" number
| "between" number "and" number | ("is" | "=") text | (">" | ">=" | "<" | "<=") number, after "that"
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

import numpy as np

from xlmc.analysis.studies.optimising.measures import Goal, Measure, Requirement, Term
from xlmc.analysis.studies.optimising.pulled_statistics import (
    Bools,
    Floats,
    deviation,
    mean,
    quantile,
    share_of_hits,
    share_of_yes,
    variance,
    variation,
)
from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.definitions.forms import Form, kind_of_format
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key
from xlmc.montecarlo.loop.candidates import Column
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import number_text

__all__ = ["Reader"]

_NUMBER: Final = re.compile(r"(?:\d[\d,]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*%?")
_STATISTIC: Final = re.compile(
    r"(?:the\s+)?(?:(?P<mean>mean|average|expected value)|(?P<median>median)|(?P<sd>sd|std dev|standard deviation)"
    r"|(?P<variance>variance)|(?P<cv>cv|coefficient of variation)"
    r"|p(?P<percent>\d+(?:\.\d+)?)|(?P<percentile>\d+(?:\.\d+)?)(?:st|nd|rd|th)\s+percentile"
    r"|(?P<share>probability|certainty|chance))\s+(?P<link>of|that)\b\s*",
    re.IGNORECASE,
)
_RELATION: Final = re.compile(r">=|<=|=>|=<|≥|≤|>|<|==?")
_LIMIT: Final = re.compile(r"\s*(?P<word>above|over|below|under|at\s+least|at\s+most|between|is)\b\s*", re.IGNORECASE)
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
        measure = parsing.sum()
        parsing.end()
        if not measure.terms:
            raise SimulationError(f"{text!r} is a number, and nothing to choose by", hint=_EXAMPLE)
        return Goal(measure, maximise)

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
        terms = [Term(sign * each.factor, each.number, each.at) for each in left.terms]
        terms += [Term(-sign * each.factor, each.number, each.at) for each in right.terms]
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
        begin, terms, constant = self._at, list[Term](), 0.0
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
        match = self._match(_RELATION)
        spelt = "" if match is None else _SPELT.get(match[0], match[0])
        if not spelt:
            hint = "Write >= or <= between what is required and its limit, or = between decisions"
            raise self._wrong("a requirement is a comparison", hint)
        return "=" if spelt.startswith("=") else spelt

    def end(self) -> None:
        """See that nothing follows."""
        if self._text[self._at :].strip():
            raise self._wrong("this is not understood", _EXAMPLE)

    def _sign(self) -> str:
        match = self._match(re.compile(r"[+\-−–]"))
        return "" if match is None else "+" if match[0] == "+" else "-"

    def _term(self, sign: float) -> tuple[Term | None, float]:
        factor, statistic = sign, self._match(_STATISTIC)
        match = None if statistic is not None else self._match(_NUMBER)
        if match is not None:
            factor = sign * _number(match[0])
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
        return Term(factor, None, number), 0.0

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

    def _statistic(self, factor: float, match: re.Match[str]) -> Term:
        name = self._name()
        number = self._reader.forecast(name)
        if number is None:
            raise self._wrong(f"{self._reader.spelt(name)!r} is a decision, and not a forecast", _EXAMPLE)
        model = self._reader.model
        forecast, is_text = model.forecasts[number], number in model.categories
        code = model.formats[forecast.name]
        two = forecast.name in model.two_valued
        form = Form(Kind.YES_NO if two else kind_of_format(code) or Kind.NUMBER, code).beside_units(forecast.units)
        if match["share"] is not None:
            return self._share(factor, number, is_text, by_sign=match["link"].casefold() == "that")
        if is_text:
            hint = f'Ask for the probability of a text, such as "probability of {forecast.name} is Yes"'
            raise self._wrong(f"the answers of {forecast.name!r} are texts", hint)
        at = self._reader.column(number)
        if match["mean"] is not None:
            self._forms.append((form, False, forecast.units))
            return Term(factor, share_of_yes if two else mean, at)
        if match["sd"] is not None:
            self._forms.append((form, True, forecast.units))
            return Term(factor, deviation, at)
        if match["variance"] is not None or match["cv"] is not None:
            self._forms.append((Form(), False, ""))
            return Term(factor, variance if match["cv"] is None else variation, at)
        percent = 50.0 if match["median"] is not None else float(match["percent"] or match["percentile"])
        if not 0.0 < percent < 100.0:
            raise self._wrong(f"{number_text(percent)} is no percentile", "Percentiles lie above 0 and below 100")
        self._forms.append((form, False, forecast.units))
        return Term(factor, partial(quantile, share=percent / 100.0), at)

    def _share(self, factor: float, number: int, is_text: bool, *, by_sign: bool) -> Term:
        """Read the probability of a range, of a text, of a yes, or of being above the forecast's threshold."""
        forecast = self._reader.model.forecasts[number]
        self._forms.append((Form(Kind.YES_NO), False, ""))
        limit = self._match(_LIMIT)
        word = "" if limit is None else " ".join(limit["word"].casefold().split())
        sign = self._match(_RELATION) if by_sign and limit is None else None
        spelt = "" if sign is None else _SPELT.get(sign[0], sign[0])
        if word == "is" or spelt.startswith("="):
            text = self._text_of(forecast.name, is_text)
            return Term(factor, lambda x: share_of_hits(x == 1.0), self._reader.column(number, text))
        if is_text:
            hint = f'Say of which text, such as "probability of {forecast.name} is Yes"'
            raise self._wrong(f"the answers of {forecast.name!r} are texts", hint)
        at = self._reader.column(number)
        if word == "between":
            low = self._signed_number()
            if self._match(_AND) is None:
                raise self._wrong("a range has two ends", 'Such as "between 0 and 10"')
            high = self._signed_number()
            return Term(factor, lambda x: share_of_hits((x >= low) & (x <= high)), at)
        if word or spelt:
            bound, compare = self._signed_number(), _COMPARES[spelt or _SPELT_AT.get(word) or _SPELT[word]]
            return Term(factor, lambda x: share_of_hits(compare(x, bound)), at)
        if forecast.name in self._reader.model.two_valued or forecast.kind is Kind.YES_NO:
            return Term(factor, lambda x: share_of_hits(x != 0.0), at)
        if forecast.threshold is None:
            hint = f'Say of what, such as "probability of {forecast.name} above 0"'
            raise self._wrong(f"{forecast.name!r} is no yes or no, and has no Threshold", hint)
        threshold = forecast.threshold
        return Term(factor, lambda x: share_of_hits(x > threshold), at)

    def _text_of(self, name: str, is_text: bool) -> str:
        if not is_text:
            raise self._wrong(f"the answers of {name!r} are no texts", _EXAMPLE)
        match = self._match(re.compile(r"'([^']+)'|\"([^\"]+)\"|“([^”]+)”|([^<>=≤≥]+)"))
        if match is None:
            raise self._wrong("a text is missing", "Write it behind `is`")
        text: str = next(filter(None, match.groups()))
        return text.strip()

    def _signed_number(self) -> float:
        sign, match = self._sign(), self._match(_NUMBER)
        if match is None:
            raise self._wrong("a number is missing", _EXAMPLE)
        return (-1.0 if sign == "-" else 1.0) * _number(match[0])

    def _match(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        while self._text[self._at : self._at + 1].isspace():
            self._at += 1
        match = pattern.match(self._text, self._at)
        if match is not None:
            self._at = match.end()
        return match

    def _wrong(self, why: str, hint: str) -> SimulationError:
        before, after = self._text[: self._at].strip(), self._text[self._at :].strip()
        marked = f"{before} ⟨{after}⟩".strip() if after else before
        return SimulationError(f"In {marked!r}: {why}", hint=hint)


def _number(text: str) -> float:
    """Read a number.

    >>> [_number(text) for text in ("1,000", ".5", "90 %", "2e3")]
    [1000.0, 0.5, 0.9, 2000.0]
    """
    bare = text.replace(",", "").strip()
    return float(bare[:-1]) / 100.0 if bare.endswith("%") else float(bare)
