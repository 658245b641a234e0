"""What options take: whole numbers as people write them, and words in any case."""

from __future__ import annotations

from typing import Any

import click

__all__ = ["OneOf", "WholeNumber"]


class WholeNumber(click.ParamType):  # type: ignore[type-arg]  # no generic before click 8.2
    """A whole number from `least` to `most`: `200000`, `200,000`, `2e5` or `200k`."""

    name = "integer"

    def __init__(self, least: int, most: int | None = None) -> None:
        self._least, self._most = least, most

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """The number that was typed.

        Raises:
            BadParameter: it is none, or lies outside.
        """
        from xlmc.definitions.amounts import typed_whole_number

        found = value if isinstance(value, int) else typed_whole_number(value)
        if found is None:
            self.fail(f"{value!r} is no whole number. Type it like 200000, 200,000, 2e5 or 200k.", param, ctx)
        if found < self._least:
            self.fail(f"{found:,} is too small. Type {self._least:,} or more.", param, ctx)
        if self._most is not None and found > self._most:
            self.fail(f"{found:,} is too large. Type {self._most:,} or less.", param, ctx)
        return found


class OneOf(click.Choice):  # type: ignore[type-arg]
    """One of some words, in any case."""

    def __init__(self, *words: str) -> None:
        super().__init__(words, case_sensitive=False)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The word that was typed.

        Raises:
            BadParameter: it is another.
        """
        from xlmc.cli.near import did_you_mean

        words: dict[str, str] = {word.casefold(): word for word in self.choices}
        found = words.get(str(value).strip().casefold())
        if found is None:
            self.fail(f"{value!r} is none of {', '.join(self.choices)}.{did_you_mean(value, self.choices)}", param, ctx)
        return found
