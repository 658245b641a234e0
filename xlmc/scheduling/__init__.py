"""Who runs the blocks: threads, processes, or the workers of a Dask cluster. Blocks come back in order from all."""

from xlmc.scheduling.cluster import by_cluster
from xlmc.scheduling.processes import by_processes
from xlmc.scheduling.recipe import Recipe, worker_of
from xlmc.scheduling.threads import in_order

__all__ = ["Recipe", "by_cluster", "by_processes", "in_order", "worker_of"]
