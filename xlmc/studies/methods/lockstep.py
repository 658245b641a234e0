"""Many searches side by side, each asking for one point at a time; their questions are answered together.

An answer for fifty points costs little more than one for a single point, so the searches take their steps together.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

__all__ = ["in_step"]

Asked = TypeVar("Asked")
Answered = TypeVar("Answered")
Found = TypeVar("Found")


def in_step(
    searches: Sequence[Callable[[Callable[[Asked], Answered]], Found]],
    answer: Callable[[list[Asked]], Sequence[Answered]],
) -> list[Found]:
    """Run every search in a thread of its own; each is given what answers one question, and waits for the others'.

    Args:
        searches: take the function to ask, give what they find.
        answer: takes one question of every search that goes on, in the order of the searches, gives their answers.

    Raises:
        Exception: whatever a search or an answer raised first.

    >>> def double(ask):
    ...     return ask(ask(1))
    >>> in_step([double, double], lambda questions: [2 * each for each in questions])
    [4, 4]
    """
    round_ = _Round(len(searches), answer)
    found: dict[int, Found] = {}

    def run(index: int) -> None:
        try:
            found[index] = searches[index](lambda question: round_.ask(index, question))
        except BaseException as error:
            round_.fail(error)
        finally:
            round_.leave()

    threads = [threading.Thread(target=run, args=(index,), daemon=True) for index in range(len(searches))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if round_.error is not None:
        raise round_.error
    return [found[index] for index in range(len(searches))]


class _Round(Generic[Asked, Answered]):
    """The questions that wait; the last search to ask, or to end, has them answered."""

    def __init__(self, going: int, answer: Callable[[list[Asked]], Sequence[Answered]]) -> None:
        self._going, self._answer = going, answer
        self._asked: dict[int, Asked] = {}
        self._answered: dict[int, Answered] = {}
        self._changed = threading.Condition()
        self.error: BaseException | None = None

    def ask(self, index: int, question: Asked) -> Answered:
        with self._changed:
            self._asked[index] = question
            self._answer_if_all()
            while index not in self._answered and self.error is None:
                self._changed.wait()
            if self.error is not None:
                raise self.error
            return self._answered.pop(index)

    def leave(self) -> None:
        with self._changed:
            self._going -= 1
            self._answer_if_all()

    def fail(self, error: BaseException) -> None:
        with self._changed:
            self.error = self.error or error
            self._changed.notify_all()

    def _answer_if_all(self) -> None:
        if self.error is not None or not self._asked or len(self._asked) < self._going:
            return
        indices = sorted(self._asked)
        try:
            answers = self._answer([self._asked[index] for index in indices])
            self._answered.update(zip(indices, answers, strict=True))
        except BaseException as error:
            self.error = error
        self._asked.clear()
        self._changed.notify_all()
