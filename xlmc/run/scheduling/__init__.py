"""Who runs the blocks: threads, processes, or the workers of a Dask cluster. Blocks come back in order from all."""
