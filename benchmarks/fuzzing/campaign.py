"""Keep children at work on random inputs, and gather what they find."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from fuzzing.child import Outcome, serve
from fuzzing.inputs import Kind, Reached, generator
from fuzzing.verdict import Finding

__all__ = ["LONGEST", "Findings", "Summary", "campaign"]

LONGEST: Final = 30.0
"""Seconds of processor time that an input may take."""

_STARTING_ANEW: Final = 1500
"""Inputs a child; then another takes its place, so that what xlmc keeps for later runs does not grow."""

_TICKS: Final = os.sysconf("SC_CLK_TCK")
_WAITS: Final = 4.0


@dataclass(slots=True)
class Findings:
    """All findings of one key: how many, and the first."""

    first: Outcome
    count: int = 0


@dataclass(slots=True)
class Summary:
    """What a campaign did with one kind of input."""

    kind: str
    inputs: int = 0
    reached: Counter[Reached] = field(default_factory=Counter)
    slowest: tuple[float, int] = (0.0, -1)
    largest: tuple[int, int] = (0, -1)
    faults: dict[str, Findings] = field(default_factory=dict)

    def add(self, outcome: Outcome) -> None:
        """Count one outcome."""
        self.inputs += 1
        if outcome.reached is not None:
            self.reached[outcome.reached] += 1
        self.slowest = max(self.slowest, (outcome.seconds, outcome.number))
        self.largest = max(self.largest, (outcome.memory, outcome.number))
        if outcome.finding is not None:
            self.faults.setdefault(outcome.finding.key, Findings(outcome)).count += 1

    def line(self) -> str:
        """For the table at the end."""
        ran, refused = self.reached[Reached.RAN], self.reached[Reached.REFUSED]
        together = sum(result.count for result in self.faults.values())
        return (
            f"{self.kind:<10}{self.inputs:>10,}{ran:>10,}{refused:>10,}{together:>10,}{len(self.faults):>7,}"
            f"{self.slowest[0]:>9.2f} s (#{self.slowest[1]}){self.largest[0] >> 20:>7,} MB (#{self.largest[1]})"
        )


HEADINGS: Final = f"{'kind':<10}{'inputs':>10}{'ran':>10}{'refused':>10}{'findings':>10}{'kinds':>7}   slowest   memory"


def campaign(
    kind: str,
    how: Kind,
    seed: int,
    numbers: Iterable[int],
    until: float = float("inf"),
    result: Callable[[Outcome], None] = lambda _: None,
) -> Summary:
    """Run inputs until the numbers or the time (`time.monotonic`) are used up.

    Args:
        kind: the name of the kind, which seeds its inputs.
        how: makes and runs them.
        seed: of the campaign.
        numbers: of the inputs.
        until: when to stop.
        result: told of every outcome with a finding.
    """
    summary, left = Summary(kind), iter(numbers)
    while time.monotonic() < until and (batch := list(itertools.islice(left, _STARTING_ANEW))):
        while batch and time.monotonic() < until:
            for outcome in _children(kind, how, seed, batch, until):
                batch = batch[batch.index(outcome.number) + 1 :]
                summary.add(outcome)
                if outcome.finding is not None:
                    result(outcome)
    return summary


def _children(kind: str, how: Kind, seed: int, numbers: list[int], until: float) -> Iterator[Outcome]:
    """The outcomes of one child; the last one may be that it was killed, or died."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=serve, args=(kind, how, seed, numbers, theirs), daemon=True)
    child.start()
    theirs.close()
    number, began = numbers[0], _processor_time(child.pid)
    wall = time.monotonic()
    try:
        while time.monotonic() < until:
            if not ours.poll(min(0.5, LONGEST / 3)):
                spent = _processor_time(child.pid) - began
                if spent > LONGEST or time.monotonic() - wall > _WAITS * LONGEST:
                    yield _lost(how, kind, seed, number, "takes too long", spent)
                    return
                continue
            messages = ours.recv()
            if messages is None:
                return
            if isinstance(messages, int):
                number, began, wall = messages, _processor_time(child.pid), time.monotonic()
            else:
                yield messages
    except (EOFError, ConnectionResetError):
        child.join()
        yield _lost(how, kind, seed, number, f"died with {child.exitcode}", _processor_time(child.pid) - began)
    finally:
        child.kill()
        child.join()
        ours.close()


def _processor_time(pid: int | None) -> float:
    """Of a process so far, in seconds; 0 of one that is gone."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / _TICKS


def _lost(how: Kind, kind: str, seed: int, number: int, what: str, seconds: float) -> Outcome:
    given = how.make(generator(kind, seed, number))
    finding = Finding(f"the process {what}", given.said)
    return Outcome(number, None, max(0.0, seconds), 0, finding, given.said, given.name, given.data)
