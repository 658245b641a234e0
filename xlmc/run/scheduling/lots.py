"""A lot of tasks, run by a helper. It imports nothing: a process that is late brings little."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from xlmc.run.blocks import Block, Runner, Task

__all__ = ["run_lot"]


def run_lot(runner: Runner, tasks: Iterable[Task]) -> list[Block | Exception]:
    """The blocks, the last of which is what went wrong, if something did."""
    done: list[Block | Exception] = []
    try:
        done += (runner.run(task) for task in tasks)  # `map` would take a StopIteration of a block's for the end
    except Exception as error:  # whatever it is, it is told in the turn of its block
        done.append(error)
    return done
