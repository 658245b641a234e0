"""What runs the blocks: threads, processes, or the workers of a Dask cluster. All give them in the same order."""
