"""What another process needs to run blocks: the same model, the same settings, the same software."""

from __future__ import annotations

import pickle
import platform
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from xlmc.definitions.model import Definitions
from xlmc.errors import SimulationError
from xlmc.evaluation.engine import Program
from xlmc.evaluation.engines import ENGINES
from xlmc.run.blocks import Worker
from xlmc.run.model import Model
from xlmc.run.version import __version__
from xlmc.sampling.plan import Plan
from xlmc.workbook import Workbook

__all__ = ["Recipe", "check_software", "software", "worker_of"]

LIBRARIES = ("numpy", "scipy", "formulas", *(engine.library for engine in ENGINES.values() if engine.library))
"""A result depends on them to its last bit; on those of an engine with that engine only."""


def worker_of(model: Model, program: Program, engine: str, seed: int, block: int, plan: Plan | None = None) -> Worker:
    """What runs blocks of a model in this process, in one thread."""
    sampler, evaluator = model.sampler(seed, block, engine, plan), program.evaluator(block)
    return Worker(sampler, evaluator, block, len(model.forecasts), model.fallible)


@dataclass(frozen=True)
class Recipe:
    """All that blocks are a function of, besides their trial numbers."""

    workbook: Workbook
    definitions: Definitions
    path: Path
    engine: str
    seed: int
    block: int
    plan: Plan | None = None

    @classmethod
    def of(
        cls,
        model: Model,
        engine: str,
        seed: int,
        block: int,
        plan: Plan | None = None,
    ) -> Recipe:
        """The recipe of a run."""
        bare = replace(model.workbook, parts={}, data=b"")  # the file as it was: only the result sheets need it
        needed = plan if plan is not None and plan.size else None  # independent trials may be any number
        return cls(bare, model.definitions, model.path, engine, seed, block, needed)

    def packed(self) -> bytes:
        """The recipe with the software it was made with, for `unpacked`."""
        return pickle.dumps((software(), pickle.dumps(self, protocol=5)), protocol=5)

    def model(self) -> Model:
        """The model again."""
        return Model(self.workbook, self.definitions, self.path)

    def runner(self) -> Worker:
        """See `Portable`."""
        model = self.model()
        return self.worker(model, model.program(self.engine))

    def worker(self, model: Model, program: Program) -> Worker:
        """What runs its blocks, given its model again and that model's program."""
        return worker_of(model, program, self.engine, self.seed, self.block, self.plan)


def unpacked(packed: bytes) -> Recipe:
    """The recipe that was packed. It must come from a process of one's own: to unpack is to run what is in it.

    Raises:
        SimulationError: it was packed with other software than there is here.
    """
    theirs, inner = pickle.loads(packed)
    check_software(theirs, software(), "this worker")
    recipe: Recipe = pickle.loads(inner)
    return recipe


@cache
def software() -> dict[str, str]:
    """Name -> version of what decides a result here, with the processor's vector instructions."""
    import numpy

    found: dict[str, list[str]] = numpy.show_config(mode="dicts")["SIMD Extensions"]  # type: ignore[assignment]
    own = {"xlmc": __version__, "Python": platform.python_version()}
    features = [platform.machine(), *found.get("baseline", []), *found.get("found", [])]
    return own | {name: _version(name) for name in LIBRARIES} | {"processor": " ".join(features)}


def _version(library: str) -> str:
    try:
        return version(library)
    except PackageNotFoundError:
        return "not installed"


def check_software(ours: Mapping[str, str], theirs: Mapping[str, str], where: str) -> None:
    """Refuse a worker whose numbers could differ in the last bit.

    Raises:
        SimulationError: a version differs.
    """
    for name, wanted in ours.items():
        found = theirs.get(name)
        if found != wanted:
            hint = "Results would depend on which worker ran which trials: use the same software on all"
            message = f"{name} is {found or 'missing'} there and {wanted} here"
            raise SimulationError(message, where=where, hint=hint)
