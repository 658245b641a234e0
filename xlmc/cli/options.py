"""Options that several commands share, and the kinds of values that options take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import click

from xlmc.montecarlo.definitions.run_settings import SETTINGS, Setting
from xlmc.montecarlo.definitions.setting_kinds import Names, Seconds, Switch, Whole, Word
from xlmc.montecarlo.definitions.stopping import GOALS, Option

__all__ = [
    "FilePath",
    "OneOf",
    "WholeNumber",
    "chance_option",
    "detailed_option",
    "engine_option",
    "feed_option",
    "functions_option",
    "jobs_option",
    "number_style_option",
    "run_options",
    "seed_option",
    "tolerance_option",
    "trials_option",
]

F = TypeVar("F", bound=Callable[..., Any])

_MOST_JOBS = 1024


class WholeNumber(click.ParamType):  # type: ignore[type-arg]  # no generic before click 8.2
    """A whole number from `least` to `most`: `200000`, `200,000`, `2e5` or `200k`."""

    name = "integer"

    def __init__(self, least: int, most: int | None = None) -> None:
        self._least, self._most = least, most

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """Return the number that was typed.

        Raises:
            BadParameter: it is none, or lies outside.
        """
        from xlmc.montecarlo.definitions.amounts import typed_whole_number
        from xlmc.montecarlo.number_text import count_text

        result = value if isinstance(value, int) else typed_whole_number(value)
        if result is None:
            self.fail(f"{value!r} is not a whole number. Type it like 200000, 200,000, 2e5 or 200k.", param, ctx)
        if result < self._least:
            self.fail(f"{count_text(result)} is too small. Type {count_text(self._least)} or more.", param, ctx)
        if self._most is not None and result > self._most:
            self.fail(f"{count_text(result)} is too large. Type {count_text(self._most)} or less.", param, ctx)
        return result


class FilePath(click.Path):
    """The path of a file, which may be missing; whoever reads or writes it says why it cannot."""

    def __init__(self) -> None:
        super().__init__(readable=False, path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the path that was typed.

        Raises:
            BadParameter: it is empty, as a variable of a script is that was never set.
        """
        if value == "":
            self.fail("The name of the file is empty. Type one.", param, ctx)
        return super().convert(value, param, ctx)


class OneOf(click.Choice):  # type: ignore[type-arg]  # likewise
    """One of some words, in any case."""

    def __init__(self, *words: str) -> None:
        super().__init__(words, case_sensitive=False)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the word that was typed.

        Raises:
            BadParameter: it is another.
        """
        from xlmc.cli.mistakes import did_you_mean

        words: dict[str, str] = {word.casefold(): word for word in self.choices}
        text = words.get(str(value).strip().casefold())
        if text is None:
            known = ", ".join(self.choices)
            self.fail(f"{value!r} is not one of {known}.{did_you_mean(value, self.choices)}", param, ctx)
        return text


jobs_option = click.option(
    "-j",
    "--jobs",
    type=WholeNumber(1, _MOST_JOBS),
    default=1,
    show_default=True,
    help="Threads or processes to use.",
)
"""The option for threads or processes; the result does not depend on it."""


feed_option = click.option(
    "--feed",
    multiple=True,
    metavar="A=OTHER!B",
    help="'A=other.xlsx!B': in each trial the assumption A takes what the workbook other.xlsx gives for its forecast B;"
    " may be given several times, and in a row: 'other.xlsx!C=third.xlsx!D'.",
)
"""The option for workbooks whose answers feed assumptions."""


class _FunctionsFile(FilePath):
    """A file of functions, which is run."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the functions.

        Raises:
            WorkbookError: the file cannot be read or run, or defines none.
        """
        from xlmc.excel.own_functions import load_functions

        return load_functions(super().convert(value, param, ctx))


functions_option = click.option(
    "--functions",
    type=_FunctionsFile(),
    metavar="FILE.py",
    help="Run this file of Python, whose functions compute what formulas call by their names: code of VBA, add-ins.",
)
"""The option for a person's own functions."""


def _use_style(context: click.Context, _option: click.Parameter, style: str | None) -> str | None:
    """Write all numbers in the style that was typed until the command ends."""
    from xlmc.montecarlo.definitions.number_styles import style_asked

    if style is not None:
        context.with_resource(style_asked(style))
    return style


def number_style_option(command: F) -> F:
    """Add the option for the style of numbers to a command that does not run with settings."""
    (name,), words, setting = SETTINGS["number_style"].options, SETTINGS["number_style"].kind, SETTINGS["number_style"]
    assert isinstance(words, Word)
    option = click.option(
        name, type=OneOf(*words.words()), help=setting.help, callback=_use_style, is_eager=True, expose_value=False
    )
    return option(command)


def _setting_option(setting: Setting) -> Callable[[F], F]:
    """Make the option of a setting."""
    names = (*setting.options, setting.key) if setting.recorded_as else setting.options
    match setting.kind:
        case Whole(least=least):
            return click.option(*names, type=WholeNumber(least), help=setting.help)
        case Word() as kind:
            # notices are written while the workbook is read, before the command itself knows the style
            used = _use_style if setting.key == "number_style" else None
            words = OneOf(*kind.words())
            return click.option(*names, type=words, help=setting.help, callback=used, is_eager=used is not None)
        case Switch():
            return click.option(*names, is_flag=True, help=setting.help)
        case Names():
            return click.option(*names, multiple=True, metavar="FORECAST", help=setting.help)
        case Seconds():
            return click.option(*names, metavar="TIME", help=setting.help)


def trials_option(of: str, default: str = "the book's, else 200000") -> Callable[[F], F]:
    """Make the option for the trials of `a run`, `each run`."""
    return click.option("-n", "--trials", type=WholeNumber(1), help=f"Trials of {of}.  [default: {default}]")


def seed_option(of: str, default: str = "the book's, else 999") -> Callable[[F], F]:
    """Make the option for the seed of `the run`, `each run`."""
    return click.option("--seed", type=WholeNumber(0), help=f"Seed of {of}.  [default: {default}]")


engine_option = _setting_option(SETTINGS["engine"])

detailed_option = _setting_option(SETTINGS["detailed"])

tolerance_option = click.option(
    "--tolerance",
    multiple=True,
    help="The largest difference that counts as none: 0.5, '0.5 mph', '10 %' of the SD, 'Name=0.5 mph'; may be given"
    " several times.  [default: 10 %]",
)

chance_option = click.option(
    "--chance",
    type=float,
    help="The largest difference that counts as none, in percentage points, of the probability of being above a"
    " forecast's threshold.  [default: a tenth of it or of the probability below, at least 0.1]",
)


def _goal_option(option: Option) -> Callable[[F], F]:
    kind = WholeNumber(*option.takes) if isinstance(option.takes, tuple) else str
    return click.option(f"--{option.name.replace('_', '-')}", type=kind, metavar=option.metavar, help=option.help)


def _run_options() -> Iterator[Callable[[F], F]]:
    """Yield the options of all settings, and of goals after the number of trials."""
    for setting in SETTINGS.values():
        if setting.options:
            yield _setting_option(setting)
        if setting.key == "trials":
            yield from (_goal_option(option) for goal in GOALS.values() for option in goal.options)


_RUN_OPTIONS: tuple[Callable[[Any], Any], ...] = tuple(_run_options())


def run_options(command: F) -> F:
    """Add the options of all settings, under the names that `Model.simulate` has for them."""
    for option in reversed(_RUN_OPTIONS):
        command = option(command)
    return command
