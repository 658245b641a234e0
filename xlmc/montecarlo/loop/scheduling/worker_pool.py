"""Choose what runs the blocks: threads, processes or a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.engine.engines import ENGINES
from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.blocks import Block, ModelRunner, Task
from xlmc.montecarlo.loop.scheduling.batches import by_threads
from xlmc.montecarlo.loop.scheduling.processes import by_processes
from xlmc.montecarlo.loop.scheduling.run_spec import RunSpec, model_runner

if TYPE_CHECKING:
    from xlmc.engine.engine import BlockMemory, Program
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["WorkerPool"]


@dataclass(frozen=True, slots=True)
class WorkerPool:
    """The threads, processes or Dask workers that a run was asked to use.

    Attributes:
        jobs: threads or processes.
        scheduler: `threads`, `processes`, `local`, or the address of a Dask scheduler; None to leave it open.
        workers: of a local cluster.

    Raises:
        SimulationError: the settings contradict each other, or name no scheduler.
    """

    jobs: int = 1
    scheduler: str | None = None
    workers: int | None = None

    def __post_init__(self) -> None:
        if self.jobs < 1:
            raise SimulationError(f"{self.jobs} jobs were asked for", hint="give 1 or more")
        if self.workers is not None and self.workers < 1:
            raise SimulationError(f"{self.workers} workers were asked for", hint="give 1 or more")
        if self.workers is not None and self.scheduler != "local":
            message = "the number of workers can be set for a local cluster only"
            raise SimulationError(message, hint="use --scheduler local")
        if self.scheduler not in (None, "threads", "processes", "local") and "://" not in self.scheduler:
            hint = "choose threads, processes or local, or give an address such as tcp://10.0.0.5:8786"
            raise SimulationError(f"there is no scheduler {self.scheduler!r}", hint=hint)

    def blocks(
        self,
        model: CompiledModel,
        program: Program,
        settings: Settings,
        plan: SamplingPlan,
        block: int,
        tasks: Iterator[Task],
        block_memory: Callable[[], BlockMemory],
    ) -> Generator[Block, None, None]:
        """Yield the blocks of a run, of `block` trials each, in the order of their tasks; copy what you keep of each.

        Where they are run one after another, the columns of the next block may be written to what `block_memory` gives.

        Raises:
            SimulationError: the workers cannot be had, or did not finish.
        """
        blocks = -(-plan.trials // block)
        jobs = min(self.jobs, blocks)
        scheduler = self.scheduler or _scheduler(settings.engine, jobs, blocks)
        if model.definitions.python:
            scheduler = _near_the_function(self.scheduler)

        def runner() -> ModelRunner:
            return model_runner(model, program, settings.engine, settings.seed, block, plan)

        if scheduler == "threads" and jobs == 1:
            own = runner()
            for task in tasks:
                yield own.borrow(task, block_memory)
            return
        if scheduler == "threads":
            yield from by_threads([runner() for _ in range(jobs)], blocks, tasks)
            return
        spec = RunSpec.of(model, settings.engine, settings.seed, block, plan)
        if scheduler == "processes":
            own = runner()
            portable = own if ENGINES[settings.engine].portable else spec
            yield from by_processes(portable, own, jobs - 1, blocks, tasks)
        else:
            from xlmc.montecarlo.loop.scheduling.cluster import by_cluster  # few runs need it

            yield from by_cluster(spec, scheduler, self.workers, blocks, tasks)


def _near_the_function(asked: str | None) -> str:
    """Choose the scheduler of a model that a function of Python computes.

    Raises:
        SimulationError: another one was asked for.
    """
    if asked not in (None, "threads"):
        message = "a function of Python is called in this process alone"
        raise SimulationError(message, hint="Use threads; they run side by side where NumPy does the work")
    return "threads"


def _scheduler(engine: str, jobs: int, blocks: int) -> str:
    """Choose the scheduler of a run that names none: processes where they save more time than they take to start."""
    return "processes" if jobs > 1 and blocks >= ENGINES[engine].process_blocks else "threads"
