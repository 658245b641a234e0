"""A number with its standard error, as the content of a cell: one text, or on a sheet cells of its own for each."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.statistics import Estimate, format_estimate
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import AT_LEAST, BLANK, NOISE, Shown
from xlmc.outputs.summary import share_text

__all__ = ["HEADS", "Measured", "counted_share"]

HEADS: Final = ("±", "95 % from", "to")
"""Headings of the columns of a sheet behind that of a number."""

_SHARES: Final = frozenset({"share", "points"})
_SPANS: Final = frozenset({"spread", "change"})
_SIGNED: Final = frozenset({"change", "points"})


@dataclass(frozen=True, slots=True)
class Measured:
    """A number with its standard error.

    Attributes:
        estimate: the number; None where there is none.
        what: `number`; `share` of trials; `spread`, a standard deviation; `change`, a difference of numbers; `points`,
            a difference of shares, in percentage points.
        form: how a number is written.
        look: of its cell on a sheet.
        interval: a sheet shows the ends of its 95 % interval, too.
        like: a number beside it, whose digits it takes if it has no error of its own.
        written: its text, where that is another than usual.
        nothing: what stands where there is no number.
        noise: it is no more than chance alone would show: the word stands in its place.
        at_least: it is a lower bound.
    """

    estimate: Estimate | None
    what: str = "number"
    form: Form = PLAIN
    look: str = "number"
    interval: bool = False
    like: Estimate | None = None
    written: str = ""
    nothing: str = ""
    noise: bool = False
    at_least: bool = False

    @property
    def text(self) -> str:
        """Write the number and its error: `11.799 ± 0.013`, `5.44 ± 0.32 %`, `+0.59 ± 0.03`."""
        estimate = self.estimate
        if self.noise and estimate is not None:
            return "noise"
        if estimate is None or math.isnan(estimate.value) or self.written:
            return self.written or self.nothing
        match self.what:
            case "share":
                text = share_text(estimate)
            case "points":
                text = format_estimate(
                    100.0 * estimate.value, None if estimate.error is None else 100.0 * estimate.error
                )
            case what:
                text = self.form.spread(estimate) if what in _SPANS else self.form.estimate(estimate)
        is_above = self.what in _SIGNED and estimate.value > 0.0 and re.search("[1-9]", text.partition("±")[0])
        least = "at least " if self.at_least and text else ""
        return f"+{text}" if is_above else f"{least}{text}" or self.nothing

    @property
    def shown(self) -> Sequence[Shown]:
        """Return its cells on a sheet: the number and its error, and the ends of its interval where they are shown."""
        value, *others = self._cells
        if self.noise and self.estimate is not None:
            value = replace(value, format=NOISE)
        elif self.at_least:
            value = replace(value, format=AT_LEAST + value.format)
        return value, *others

    @property
    def _cells(self) -> Sequence[Shown]:
        estimate = self.estimate
        count = 4 if self.interval else 2
        if estimate is None:
            return [Shown(self.nothing) if self.nothing else BLANK, *[BLANK] * (count - 1)]
        if self.what in _SHARES:
            if self.interval and estimate.error == 0.0 and estimate.value in (0.0, 1.0):
                return [Shown(estimate.value, "0%"), *[BLANK] * (count - 1)]
            ends = cells.interval(estimate, percent=True) if self.interval else []
            return [*cells.share(estimate, self.look), *ends]
        spread = self.what in _SPANS
        ends = cells.interval(estimate, form=self.form, spread=spread) if self.interval else []
        error = "second error" if self.look == "second number" else "error"
        return [*cells.estimate(estimate, self.look, error, like=self.like, form=self.form, spread=spread), *ends]


def counted_share(estimate: Estimate | None) -> Measured:
    """Return a share of trials; a sheet shows the ends of its interval, too."""
    return Measured(estimate, "share", interval=True)
