"""A run from its model to its results."""
