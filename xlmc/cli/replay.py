"""`xlmc replay`: repeat a recorded run, and say that it is identical, or what differs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.check import failing_lines
from xlmc.cli.options import FilePath, functions_option, jobs_option, number_style_option
from xlmc.cli.terminal import say, say_json

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.excel.workbook.workbook import CellValue
    from xlmc.outputs.replay import CellDifference, Change, NumberChange, Replayed

__all__ = ["replay"]

DIFFERS = 1
_MOST = 20
"""Lines of one kind that are printed; JSON has them all."""
_LONGEST = 60
"""Characters of a text that are quoted."""


@click.command()
@click.argument("recorded", metavar="RESULTS", type=FilePath())
@click.option(
    "--book",
    "books",
    multiple=True,
    type=FilePath(),
    help="A workbook that fed the run, where it does not lie beside RESULTS; may be given several times.",
)
@jobs_option
@click.option("--json", "as_json", is_flag=True, help="Print the comparison as JSON.")
@number_style_option
@functions_option
def replay(
    recorded: Path,
    books: tuple[Path, ...],
    jobs: int,
    as_json: bool,
    functions: OwnFunctions | None,
) -> None:
    """Repeat the run recorded in RESULTS, a result workbook or a saved run, from the definitions in the same file."""
    from xlmc.cli.printing import use_number_style
    from xlmc.cli.progress_bar import progress_bar
    from xlmc.outputs import replay as replaying

    with progress_bar() as progress:
        result = replaying.replay(recorded, books=books, jobs=jobs, progress=progress, functions=functions)
    if result.repeated is not None:
        use_number_style(result.repeated.settings.number_style)
    if as_json:
        say_json(_as_json(result))
    else:
        for line in _lines(result, recorded):
            say(line)
    if not result.identical:
        raise click.exceptions.Exit(DIFFERS)


def _lines(result: Replayed, path: Path) -> Iterator[str]:
    from xlmc.analysis.results.record import changed_from_of

    record = result.record
    yield (
        f"{path.name} records a run of {record['file.name']}: {_figure(record['counts.trials'])} trials, "
        f"seed {record['settings.seed']}."
    )
    if (changed := changed_from_of(record)) is not None:
        yield changed.sentence
    if result.repeated is not None:
        yield from failing_lines(result.repeated)
    yield f"{_verdict(result)}."
    if not result.of_this_version and not result.to_the_last_bit:
        yield from _other_version(result)
    yield from _changes(result.changes, "Different from the record:")
    if result.fault is not None:
        yield f"The workbook cannot be run any more: {result.fault}"
    yield from _numbers(result.numbers)
    yield from _sheet_lines(result)
    if result.of_this_version and not result.changes and not result.identical:
        yield from _unexplained_lines(result)
    yield from _changes(result.environment, "Software and processor features that are not those of the recorded run:")


def _other_version(result: Replayed) -> Iterator[str]:
    """Which xlmc made the run, what has changed since, and how to repeat it as it was."""
    from xlmc.montecarlo.loop.version import __version__
    from xlmc.outputs.replay.versions import install

    made = f"xlmc {result.version}" if result.version else "A version of xlmc that did not record its number"
    yield f"{made} made this run, and this is xlmc {__version__}."
    if result.rules:
        yield "Rules of calculation that have changed since then, and that its formulas may depend on:"
        yield from (f"  {rule.sentence} ({rule.since})" for rule in result.rules)
    elif not result.identical:
        yield "As far as xlmc knows, no rule that its formulas depend on has changed since then."
    if result.version:
        yield "To repeat it as it was made, install that version beside this one, in a clone of xlmc's repository:"
        yield f"  {install(result.version)}"
        yield f"If the clone has no tag v{result.version}, CHANGELOG-archive.md names the last commit of that version."


def _verdict(result: Replayed) -> str:

    count = result.record["counts.accepted"]
    accepted = f"{_figure(count)} accepted trial{'s' * (count != 1)}"
    if result.to_the_last_bit:
        return f"identical: the same {accepted} to the last bit"
    if result.identical:
        return f"identical to 1e-12: the same {accepted}, their numbers equal but for rounding"
    if result.same_bits:
        return f"differs, although the {accepted} {'is' if count == 1 else 'are'} the same to the last bit"
    return "differs"


def _changes(changes: Sequence[Change], heading: str) -> Iterator[str]:
    if changes:
        yield heading
    for change in changes[:_MOST]:
        yield f"  {change.kind} {change.where}"
        yield f"    was  {change.old or ('blank, or not needed' if change.kind == 'cell' else 'nothing')}"
        yield f"    is   {change.new or ('blank' if change.kind == 'cell' else 'nothing')}"
    yield from _rest(changes)


def _numbers(numbers: Sequence[NumberChange]) -> Iterator[str]:
    if numbers:
        yield "Numbers that are different in the repeated run:"
    for number in numbers[:_MOST]:
        yield f"  {number.name}: recorded {_figure(number.recorded)}, repeated {_figure(number.repeated)}"
    yield from _rest(numbers)


def _sheet_lines(result: Replayed) -> Iterator[str]:
    """Yield what the result sheets show that the repeated run does not give."""
    from xlmc.montecarlo.number_text import count_text

    differences = result.shown.differences
    if differences:
        count = len(differences)
        yield (
            f"{count_text(count)} cell{'s' * (count != 1)} that {'do' if count != 1 else 'does'} not "
            "show what the run gives:"
        )
    for difference in differences[:_MOST]:
        yield f"  {difference.where} says {_value(difference.says)}, the run gives {_value(difference.gives)}"
    yield from _rest(differences)
    for name in result.shown.missing:
        yield f"The result sheet {name} is missing."
    for sentence in result.shown.left_out:
        yield f"Not compared: {sentence}."


def _value(value: CellValue) -> str:
    """Write a value as a sentence quotes it, whole where it is a number."""
    if value is None:
        return "nothing"
    if isinstance(value, str):
        return f'"{value if len(value) <= _LONGEST else value[: _LONGEST - 1] + "…"}"'
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    return repr(float(value)).removesuffix(".0") if isinstance(value, int | float) else value.text


def _difference_json(difference: CellDifference) -> dict[str, object]:
    says, gives = (
        value if value is None or isinstance(value, str | bool | int | float) else value.text
        for value in (difference.says, difference.gives)
    )
    return {"where": str(difference.where), "says": says, "gives": gives}


def _figure(number: object) -> str:
    from xlmc.montecarlo.number_text import fixed_text, styled_text

    if not isinstance(number, int | float):
        return "none"
    return fixed_text(number, 0) if float(number).is_integer() else styled_text(number, "")


def _rest(listed: Sequence[object]) -> Iterator[str]:
    from xlmc.montecarlo.number_text import count_text

    if len(listed) > _MOST:
        yield f"  … and {count_text(len(listed) - _MOST)} more"


def _unexplained_lines(result: Replayed) -> Iterator[str]:
    if result.same_bits and not result.numbers:
        return
    if result.same_bits:
        yield "Somebody edited the numbers in the record: nothing that the run depends on has changed."
    elif not result.environment:
        yield (
            "Every recorded cell, definition and setting is as it was, and so are the software and the processor: "
            "either somebody edited the record, or the run depends on something that xlmc does not record."
        )


def _as_json(result: Replayed) -> dict[str, object]:
    return {
        "identical": result.identical,
        "to_the_last_bit": result.to_the_last_bit,
        "same_accepted_trials": result.same_bits,
        "verdict": _verdict(result),
        "changes": [_change(change) for change in result.changes],
        "environment": [_change(change) for change in result.environment],
        "numbers": [
            {"name": n.name, "recorded": n.recorded, "repeated": n.repeated, "equal_to_1e-12": n.close}
            for n in result.numbers
        ],
        "result_sheets": {
            "compared": list(result.shown.sheets),
            "differences": [_difference_json(each) for each in result.shown.differences],
            "missing": list(result.shown.missing),
            "not_compared": list(result.shown.left_out),
        },
        "checks": [] if result.repeated is None else failing_lines(result.repeated),
        "made_by": result.version,
        "rules_since": [{"version": rule.since, "rule": rule.sentence} for rule in result.rules],
        "fault": None if result.fault is None else str(result.fault),
    }


def _change(change: Change) -> dict[str, str | None]:
    return {"kind": change.kind, "where": change.where, "was": change.old, "is": change.new}
