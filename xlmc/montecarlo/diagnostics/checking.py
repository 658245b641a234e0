"""Whether the checks of a workbook hold: at the base case, and in the accepted trials of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import BLANK_RESULT, TEXT_RESULT
from xlmc.errors import ErrorCode
from xlmc.montecarlo.model.draw_binding import base_point
from xlmc.montecarlo.number_text import count_text, counted_text, exact_text, styled_text

if TYPE_CHECKING:
    from xlmc.engine.engine import Column
    from xlmc.excel.address import Cell
    from xlmc.montecarlo.definitions.definitions import Check
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "FAILING_SHARE",
    "LEAST_CHECKED",
    "BaseCheck",
    "CheckResult",
    "base_checks",
    "check_results",
    "checks_sentence",
]

LEAST_CHECKED: Final = 10_000
"""Accepted trials whose draws are kept for the checks, whatever else was asked for."""

MOST_CHECKED: Final = 1 << 16
"""Accepted trials that the checks are evaluated in: enough to see a failing share of 0.1 % to an eighth of it."""

FAILING_SHARE: Final = 0.001
"""If a larger share of the accepted trials fails a check, the answer must not be used as it is."""

_BLOCK: Final = 1 << 13

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class BaseCheck:
    """A check at the base case.

    Attributes:
        content: what its cell holds, in words; None if there is no base case.
    """

    definition: Check
    content: str | None

    @property
    def holds(self) -> bool | None:
        """Whether the check holds at the base case; None without a base case."""
        return None if self.content is None else self.content == "TRUE"

    @property
    def fault(self) -> str:
        """Why the check fails, as a sentence without a full stop; only if it fails."""
        check = self.definition
        return f"the base case fails the check {check.name!r}: {check.cell} is {self.content}{meaning(check)}"


@dataclass(frozen=True, slots=True)
class CheckResult:
    """What became of a check in a run.

    Attributes:
        base: at the base case.
        accepted: trials of the run.
        trials: accepted trials that it was evaluated in, from the first on.
        failed: how many of them failed it.
        value_text: what its cell held in the first of these, in words; empty where none failed.
    """

    base: BaseCheck
    accepted: int
    trials: int
    failed: int
    value_text: str

    @property
    def name(self) -> str:
        return self.base.definition.name

    @property
    def cell(self) -> Cell:
        return self.base.definition.cell

    @property
    def because(self) -> str:
        return self.base.definition.because

    @property
    def holds(self) -> bool | None:
        """Whether the check holds at the base case; None without a base case."""
        return self.base.holds

    @property
    def looked_at(self) -> str:
        """`the first 65,536 accepted trials`; without `the first` where they are all."""
        trials = counted_text(self.trials, "accepted trial")
        return f"{'the first ' if self.trials < self.accepted else ''}{trials}"

    @property
    def share(self) -> Estimate:
        """The share of the accepted trials that fail the check."""
        from xlmc.montecarlo.statistics import proportion  # the base case needs no statistics

        return proportion(self.failed, self.trials)

    @property
    def warnings(self) -> list[str]:
        """Why the answer must not be used as it is."""
        result = [] if self.holds in (None, True) else [self.base.fault]
        if self.failed > FAILING_SHARE * self.trials:
            check = self.base.definition
            value_text = "" if self.value_text == "FALSE" else f", first with {self.value_text}"
            result.append(
                f"{count_text(self.failed)} of {self.looked_at} "
                f"({styled_text(self.share.value, '.2%')}) fail the check "
                f"{check.name!r} ({check.cell}{value_text}){meaning(check)}"
            )
        return result


def meaning(check: Check) -> str:
    """Say what failing means, after a colon; empty where the workbook does not say."""
    text = check.because.strip().rstrip(".")
    if text.upper().startswith("FALSE:"):
        text = text[len("FALSE:") :].strip()
    return f": {text}" if text else ""


def base_checks(model: CompiledModel) -> tuple[BaseCheck, ...]:
    """Compute the checks at the base case; they are not read, as a file may hold no cached values, or stale ones."""
    if not model.checks:
        return ()
    known = base_point({a.name: a.base for a in model.checked})
    if known is None:
        return tuple(BaseCheck(check, None) for check in model.checks)
    columns = model.check_program().evaluator(1).filters(known, 1)
    return tuple(BaseCheck(check, _value_text(column, 0)) for check, column in zip(model.checks, columns, strict=True))


def check_results(model: CompiledModel, inputs: Mapping[str, Floats], accepted: int) -> tuple[CheckResult, ...]:
    """Judge the checks of a run, in the order of the workbook.

    Args:
        model: the workbook.
        inputs: assumption -> its accepted draws, `(m,)`; up to 65,536 of the first ones are looked at.
        accepted: how many trials were accepted.
    """
    if not model.checks:
        return ()
    draws = {a.name: inputs[a.name] for a in model.checked}
    trials = min(accepted, MOST_CHECKED, *(values.size for values in draws.values()))
    failed, value_text = _failures(model, draws, trials)
    return tuple(
        CheckResult(base, accepted, trials, int(count), first)
        for base, count, first in zip(base_checks(model), failed, value_text, strict=True)
    )


def checks_sentence(checks: Sequence[CheckResult]) -> str:
    """How many checks of a run hold, without a full stop; empty where the workbook has none."""
    if not checks:
        return ""
    where = [] if checks[0].holds is None else ["at the base case"]
    where += [f"in the {checks[0].looked_at.removeprefix('the ')}"] if checks[0].trials else []
    looked = f"looked at {' and '.join(where)}" if where else "not looked at: there is no base case and no trial"
    failing = sum(check.holds is False or check.failed > 0 for check in checks)
    if failing:
        return f"{failing} of {_counted(len(checks))} fail{'s' * (failing == 1)}; {looked}"
    one = len(checks) == 1
    verb = ("holds" if one else "hold") if where else ("was" if one else "were")
    return f"{_counted(len(checks))} {verb} {' and '.join(where) or looked}"


def _counted(checks: int) -> str:
    return "1 check" if checks == 1 else f"{checks} checks"


def _failures(model: CompiledModel, draws: Mapping[str, Floats], trials: int) -> tuple[NDArray[np.int64], list[str]]:
    """How many trials fail each check, and what the first of them holds."""
    from xlmc.montecarlo.loop.blocks import portions  # the base case needs no blocks

    failed, value_text = np.zeros(len(model.checks), np.int64), [""] * len(model.checks)
    program = model.check_program()
    size = min(_BLOCK, program.largest_block)
    evaluator = program.evaluator(size)
    for part, block in portions(draws, trials, size):
        for index, column in enumerate(evaluator.filters(block, part.stop - part.start)):
            fails = np.flatnonzero(_fails(column))
            failed[index] += fails.size
            if fails.size and not value_text[index]:
                value_text[index] = _value_text(column, int(fails[0]))
    return failed, value_text


def _fails(column: Column) -> NDArray[np.bool_]:
    fails = np.asarray(column.values) != 1.0
    return fails if column.codes is None else np.asarray(fails | (column.codes > 0))


def _value_text(column: Column, trial: int) -> str:
    """Write what the cell holds in a trial: `TRUE`, `FALSE`, `0.35, neither TRUE nor FALSE`, `#DIV/0!`, `blank` and so
    on.
    """
    code = 0 if column.codes is None else int(column.codes[trial])
    if code:
        return {TEXT_RESULT: "a text, not the logical TRUE", BLANK_RESULT: "blank"}.get(code) or ErrorCode(code).text
    value = float(column.values[trial])
    if value in (0.0, 1.0):
        return "TRUE" if value else "FALSE"
    shown = exact_text(value)
    return f"{repr(value) if shown in ('0', '-0', '1') else shown}, neither TRUE nor FALSE"
