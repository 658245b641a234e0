"""The kinds of values that settings have: what is possible, how the record holds them, how a command says them."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from numbers import Integral
from typing import Any

from xlmc.errors import SimulationError

__all__ = ["Kind", "Names", "Seconds", "Switch", "Whole", "Word"]


@dataclass(frozen=True, slots=True)
class Whole:
    """A setting that is a whole number from `least` to `most`.

    Attributes:
        least, most: the limits; `most` is None if there is none.
        fault: of a number beyond them, with `{}` for it.
        hint: what to give instead.
        as_text: whether the record holds it as text: a worksheet's numbers have 15 to 17 digits.
    """

    least: int
    most: int | None
    fault: str
    hint: str
    as_text: bool = False

    def check(self, value: int) -> None:
        """Refuse a number beyond the limits, and what is no whole number.

        Raises:
            SimulationError: it is.
        """
        if isinstance(value, bool) or not isinstance(value, Integral):
            raise SimulationError(f"{value!r} is no whole number", hint=self.hint)
        if value < self.least or (self.most is not None and value > self.most):
            raise SimulationError(self.fault.format(value), hint=self.hint)

    def entry(self, value: int) -> int | str:
        """Return the value of the record's entry."""
        return str(value) if self.as_text else value

    def recorded(self, value: Any) -> int:
        """Return the number that an entry of the record holds.

        Raises:
            ValueError: it holds another one.
        """
        if self.as_text:
            return int(str(value))
        if not isinstance(value, int | float) or value != int(value):
            raise ValueError(f"{value!r} is not a whole number")
        return int(value)

    def arguments(self, option: str, value: int) -> list[str]:
        """Return the arguments of a command that say it."""
        return [option, str(value)]


@dataclass(frozen=True, slots=True)
class Word:
    """A setting that is one of some words.

    Attributes:
        words: gives what may be said.
        fault: of another word, with `{}` for it.
        also: gives words that mean one of them in a cell.
        suggest: whether a message names the nearest word only, and not all.
        hint: what to write in a cell instead; empty for a list of the words.
        spelling: gives what two spellings of one word share; by default `plain` does.
    """

    words: Callable[[], Collection[str]]
    fault: str
    also: Callable[[], dict[str, str]] = dict
    suggest: bool = False
    hint: str = ""
    spelling: Callable[[str], str] | None = None

    def check(self, value: str) -> None:
        """Refuse another word.

        Raises:
            SimulationError: it is one.
        """
        if value not in self.words():
            raise SimulationError(self.fault.format(repr(value)), hint=f"Choose one of {', '.join(self.words())}")

    def entry(self, value: str) -> str:
        """Return the value of the record's entry."""
        return value

    def recorded(self, value: Any) -> str:
        """Return the word that an entry of the record holds."""
        return str(value)

    def arguments(self, option: str, value: str) -> list[str]:
        """Return the arguments of a command that say it."""
        return [option, value]


class Switch:
    """A setting that is asked for or not."""

    def check(self, value: bool) -> None:
        """Accept either."""

    def entry(self, value: bool) -> bool:
        """Return the value of the record's entry."""
        return value

    def recorded(self, value: Any) -> bool:
        """Return what an entry of the record holds."""
        return bool(value)

    def arguments(self, option: str, value: bool) -> list[str]:
        """Return the arguments of a command that say it."""
        return [option] if value else []


class Seconds:
    """A setting that is a length of time in seconds."""

    def check(self, value: float) -> None:
        """Refuse a time of none.

        Raises:
            SimulationError: it is.
        """
        if not value > 0:
            raise SimulationError(f"A time limit of {value} s was asked for", hint="Give seconds, such as 60")

    def entry(self, value: float) -> float:
        """Return the value of the record's entry."""
        return value

    def recorded(self, value: Any) -> float:
        """Return the seconds that an entry of the record holds.

        Raises:
            ValueError: it holds something else.
        """
        return float(value)

    def arguments(self, option: str, value: float) -> list[str]:
        """Return the arguments of a command that say it."""
        return [option, f"{value!r}s"]


class Names:
    """A setting that lists names."""

    def check(self, value: Sequence[str]) -> None:
        """Accept any names; a run looks for them."""

    def entry(self, value: Sequence[str]) -> str:
        """Return the value of the record's entry."""
        return json.dumps(list(value), ensure_ascii=False)

    def recorded(self, value: Any) -> tuple[str, ...]:
        """Return the names that an entry of the record holds.

        Raises:
            ValueError: it holds something else.
        """
        return tuple(str(name) for name in json.loads(str(value)))

    def arguments(self, option: str, value: Sequence[str]) -> list[str]:
        """Return the arguments of a command that say them."""
        return [part for name in value for part in (option, name)]


Kind = Whole | Word | Switch | Seconds | Names
