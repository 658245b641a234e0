"""The version of xlmc: runs name it, and processes that share one must have the same."""

__all__ = ["__version__"]

__version__ = "0.12.0"
