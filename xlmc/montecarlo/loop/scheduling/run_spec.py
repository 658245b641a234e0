"""What another process needs to run blocks: the same model, the same settings, the same software."""

from __future__ import annotations

import pickle
import platform
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from xlmc.engine.engine import Program
from xlmc.engine.engines import ENGINES
from xlmc.errors import SimulationError
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.loop.blocks import ModelRunner
from xlmc.montecarlo.loop.version import __version__
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["RunSpec", "check_software", "model_runner", "software"]

LIBRARIES = ("numpy", "scipy", "formulas", *(engine.library for engine in ENGINES.values() if engine.library))
"""A result depends on them to its last bit; on those of an engine with that engine only."""


def model_runner(
    model: CompiledModel, program: Program, engine: str, seed: int, block: int, plan: SamplingPlan | None = None
) -> ModelRunner:
    """Make what runs the blocks of a model in this process, in one thread."""
    sampler, evaluator = model.sampler(seed, block, engine, plan), program.evaluator(block)
    return ModelRunner(sampler, evaluator, block, len(model.forecasts), model.fallible, model.categories)


@dataclass(frozen=True)
class RunSpec:
    """All that decides the blocks of a run, besides their trial numbers."""

    workbook: Workbook
    definitions: Definitions
    path: Path
    engine: str
    seed: int
    block: int
    plan: SamplingPlan | None = None

    @classmethod
    def of(
        cls,
        model: CompiledModel,
        engine: str,
        seed: int,
        block: int,
        plan: SamplingPlan | None = None,
    ) -> RunSpec:
        """Specify a run of this model."""
        bare = replace(model.workbook, parts={}, data=b"")  # the file as it was: only the result sheets need it
        needed = plan if plan is not None and plan.size else None  # independent trials may be any number
        definitions = replace(model.definitions, feeding=None)  # who feeds it is in its formulas by now
        return cls(bare, definitions, model.path, engine, seed, block, needed)

    def pack(self) -> bytes:
        """Pack the specification and the software that it was made with into bytes for `unpacked`."""
        return pickle.dumps((software(), pickle.dumps(self, protocol=5)), protocol=5)

    def model(self) -> CompiledModel:
        """Make the model again."""
        return CompiledModel(self.workbook, self.definitions, self.path)

    def runner(self) -> ModelRunner:
        """See `Portable`."""
        model = self.model()
        return self.runner_of(model, model.program(self.engine))

    def runner_of(self, model: CompiledModel, program: Program) -> ModelRunner:
        """Make what runs the blocks, given `model()` and its program."""
        return model_runner(model, program, self.engine, self.seed, self.block, self.plan)


def unpack(packed: bytes) -> RunSpec:
    """Unpack a specification. The bytes must come from a process of one's own: to unpickle them is to run what is in
    them.

    Raises:
        SimulationError: it was packed with other software than there is here.
    """
    theirs, inner = pickle.loads(packed)
    check_software(theirs, software(), "this worker")
    spec: RunSpec = pickle.loads(inner)
    return spec


@cache
def software() -> dict[str, str]:
    """Name -> version of what decides the last bits of a result here, and the processor's vector instructions."""
    import numpy

    result: dict[str, list[str]] = numpy.show_config(mode="dicts")["SIMD Extensions"]  # type: ignore[assignment]
    own = {"xlmc": __version__, "Python": platform.python_version()}
    features = [platform.machine(), *result.get("baseline", []), *result.get("found", [])]
    return own | {name: _version(name) for name in LIBRARIES} | {"processor": " ".join(features)}


def _version(library: str) -> str:
    from importlib.metadata import PackageNotFoundError, version

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
        text = theirs.get(name)
        if text != wanted:
            hint = "Results would depend on which worker ran which trials: use the same software on all"
            message = f"the software differs: {name} is {text or 'missing'} there and {wanted} here"
            raise SimulationError(message, where=where, hint=hint)
