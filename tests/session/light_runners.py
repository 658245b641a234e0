"""Blocks that are numbers: a process that runs them need not import what real ones are computed with."""

from __future__ import annotations

import os
from typing import NamedTuple

__all__ = ["Adding", "FailingLate", "NumberTask", "TwoWordsError"]


class NumberTask(NamedTuple):
    """A block, by its number."""

    start: int


class FailingLate:
    """Blocks as numbers, until one fails; made in another process by its name."""

    def __init__(self, first: int, kind: type[Exception], *words: str) -> None:
        self.first, self.kind, self.words = first, kind, words

    def runner(self) -> FailingLate:
        return self

    def run(self, task: NumberTask) -> int:
        if task.start >= self.first:
            raise self.kind(*self.words)
        return task.start


class TwoWordsError(Exception):
    """Its copy cannot be made from its message."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(f"{first} {second}")


class Adding:
    """A run of its own: its blocks are told from those of others; made in another process by its name."""

    def __init__(self, number: int) -> None:
        self.number, self.where = number, os.getpid()

    def runner(self) -> Adding:
        return Adding(self.number)

    def run(self, task: NumberTask) -> tuple[int, int]:
        return task.start + self.number, self.where
