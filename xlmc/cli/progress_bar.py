"""What is running, on a terminal: a bar for a run, a line for the steps of a study."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from xlmc.cli.terminal import encodable, is_quiet, on_terminal, say
from xlmc.excel.workbook.printable import printable

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.stopping import Progress
    from xlmc.montecarlo.simulation.simulate import OnProgress

__all__ = ["errors_line", "plan_note", "progress_bar", "step_line", "trials_line"]


def trials_line(standing: Progress) -> str:
    """`65,536 trials, 1,150 accepted (1.75 %)`."""
    from xlmc.montecarlo.number_text import count_text, number_text

    if standing.searching:
        return f"{count_text(standing.trials)} trials, looking for accepted ones"
    share = 100.0 * standing.accepted / standing.trials
    return f"{count_text(standing.trials)} trials, {count_text(standing.accepted)} accepted ({number_text(share, 3)} %)"


def errors_line(standing: Progress) -> str:
    """Return the standard error of every forecast's mean so far: `± Chevrolet delta-V 0.013, Nissan delta-V 0.02`."""
    from xlmc.montecarlo.number_text import number_text

    known = [(name, mean.error) for name, mean in standing.means.items() if mean.error is not None]
    return f"± {', '.join(f'{name} {number_text(error, 2)}' for name, error in known)}" if known else ""


@contextmanager
def progress_bar() -> Iterator[OnProgress | None]:
    """Draw a bar and the standard errors below it on stderr while the trials run, if there is a terminal to draw on."""
    if is_quiet() or not on_terminal(err=True):
        yield None
        return
    from rich.console import Console, RenderableType
    from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as RichProgress
    from rich.text import Text

    class Bar(RichProgress):
        """A bar with a line below it."""

        below = ""

        def get_renderables(self) -> Iterator[RenderableType]:
            yield from super().get_renderables()
            yield Text(self.below, no_wrap=True, overflow="ellipsis")

    columns = BarColumn(), TextColumn("{task.description}"), TimeRemainingColumn()
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=1.0)

        def show(standing: Progress) -> None:
            bar.below = encodable(printable(errors_line(standing)), err=True)
            bar.update(task, completed=standing.share, description=trials_line(standing))

        yield show


@contextmanager
def step_line() -> Iterator[Callable[[str], None] | None]:
    """Show a line on stderr that says which step is running; gives None if there is no terminal to show it on."""
    if is_quiet() or not on_terminal(err=True):
        yield None
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True).status("", spinner="line") as status:
        yield lambda what: status.update(escape(encodable(printable(f"running: {what}"), err=True)))


def plan_note(what: str) -> None:
    """Say beforehand on stderr what a long study will do, and how long that takes, as a note."""
    say(f"note: {what}", err=True)
