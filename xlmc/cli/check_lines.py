"""What the terminal says of a run before its answers, checks that fail and errors; all checks, below the filters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from xlmc.cli.terminal import paragraph, say
from xlmc.errors import sentence

if TYPE_CHECKING:
    from xlmc.run.checking import CheckResult
    from xlmc.run.simulation import Simulation

__all__ = ["check_table", "failing_lines", "show_first"]


def failing_lines(run: Simulation) -> list[str]:
    """One line a check that fails, at the base case or in too many accepted trials."""
    return [sentence(f"{warning[0].upper()}{warning[1:]}") for check in run.checks for warning in check.warnings]


def show_first(run: Simulation) -> None:
    """Print the checks that fail, then the cells that trials were lost in."""
    from xlmc.results.record.errors_met import lost_sentences

    name = run.model.workbook.name
    _show(f"{name}: checks that fail", failing_lines(run))
    _show(f"{name}: trials lost to errors", [f"{sentence}." for sentence in lost_sentences(run)])


def _show(title: str, lines: Sequence[str]) -> None:
    if not lines:
        return
    say(f"{title}\n")
    for line in lines:
        say(paragraph(line, hanging="  "))
    say()


def check_table(run: Simulation) -> None:
    """Print how many accepted trials fail each check; only how many checks there are where no trial fails one."""
    from xlmc.cli.printing import table
    from xlmc.run.checking import checks_sentence

    if not run.checks:
        return
    if all(check.holds and not check.failed for check in run.checks):
        say(paragraph(f"{checks_sentence(run.checks)}.") + "\n")
        return
    rows = [(check.name, check.base.found or "", f"{check.failed:,}", _share(check)) for check in run.checks]
    title = f"Checks, in {run.checks[0].looked_at}"
    table(title, ("Check", "Base case", "Failing", "Share"), rows, right=(2, 3))


def _share(check: CheckResult) -> str:
    from xlmc.report.summary import share_text

    return share_text(check.share)
