"""One hostile input, and how far xlmc came with it."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

__all__ = ["Disagreement", "Input", "Kind", "Reached", "generator", "steps_of"]


@dataclass(frozen=True, slots=True)
class Input:
    """A file, and what to do with it.

    Attributes:
        name: of the file, as people would be told of it.
        data: its bytes.
        said: what was done to it, for the reader of a finding.
        steps: what else is asked of it than loading and running: see the `run` of its kind.
    """

    name: str
    data: bytes
    said: str
    steps: tuple[str, ...] = ()


class Reached(Enum):
    """How far an input came."""

    REFUSED = "refused"  # an XlmcError that a person can act on
    RAN = "ran"


class Disagreement(Exception):  # noqa: N818 - not an error of the harness
    """Two ways to compute one thing gave two answers."""


class Kind(NamedTuple):
    """A kind of input.

    Attributes:
        make: an input from a generator; everything random comes from it.
        run: gives the input to xlmc; files may be written into the folder. Raises what xlmc raises.
    """

    make: Callable[[random.Random], Input]
    run: Callable[[Input, Path], Any]


def generator(kind: str, seed: int, number: int) -> random.Random:
    """The generator of the input of that number; the same on every machine."""
    return random.Random(f"{kind}:{seed}:{number}")


def steps_of(rng: random.Random, often: Mapping[str, float]) -> tuple[str, ...]:
    """The steps asked of one input: each in its share of the inputs."""
    return tuple(step for step, share in often.items() if rng.random() < share)
