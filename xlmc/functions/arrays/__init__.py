"""Functions that give arrays."""
