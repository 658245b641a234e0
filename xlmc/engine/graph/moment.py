"""One recalculation: what the clock says and what is drawn, for formulas whose value Excel computes anew each time."""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from datetime import datetime

from xlmc.errors import ErrorCode
from xlmc.excel.formula import ir
from xlmc.excel.functions.dates.dates import serial_at

__all__ = ["Moment"]


@dataclass(frozen=True, slots=True)
class Moment:
    """A recalculation at one time: `NOW` is the same in all cells, each `RAND` is another number.

    Attributes:
        time: what `NOW` and `TODAY` tell.
        source: of the numbers that `RAND` and `RANDBETWEEN` give.
    """

    time: datetime = field(default_factory=datetime.now)
    source: random.Random = field(default_factory=random.Random)

    def formula(self, name: str, arguments: tuple[ir.Expression, ...], date1904: bool) -> ir.Expression | None:
        """Return what stands for a call at this time; None where the function has the same value at all times.

        Args:
            name: of the function.
            arguments: of the call.
            date1904: dates count from 1904.
        """
        match name, len(arguments):
            case "NOW", 0:
                return ir.Number(serial_at(self.time, date1904))
            case "TODAY", 0:
                return ir.Number(float(int(serial_at(self.time, date1904))))
            case "RAND", 0:
                return ir.Number(self.source.random())
            case "RANDBETWEEN", 2:
                return self._between(*arguments)
            case _:
                return None

    def _between(self, low: ir.Expression, high: ir.Expression) -> ir.Expression:
        """Return a whole number from the first one that is not below `low` to the last one that is not above `high`."""
        first, last = ir.Call("CEILING.MATH", (low,)), ir.Call("FLOOR.MATH", (high,))
        count = ir.Binary("+", ir.Binary("-", last, first), ir.Number(1.0))
        steps = ir.Call("INT", (ir.Binary("*", ir.Number(self.source.random()), count),))
        drawn = ir.Binary("+", first, steps)
        return ir.Call("IF", (ir.Binary(">", first, last), ir.ErrorLiteral(ErrorCode.NUM), drawn))
