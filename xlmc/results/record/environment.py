"""The software and the processor of a run: what may move the last bit of a result."""

from __future__ import annotations

import platform
from importlib.metadata import version

from xlmc.evaluation.engines import ENGINES

__all__ = ["LIBRARIES", "processor", "versions"]

LIBRARIES = ("numpy", "scipy", "formulas", "XlsxWriter", "openpyxl")


def versions(engine: str = "numpy") -> dict[str, str]:
    """Name -> version of xlmc, of Python and of the libraries a result depends on, those of its engine among them."""
    from xlmc.run.version import __version__

    own = {"xlmc": __version__, "python": platform.python_version()}
    return own | {name: version(name) for name in (*LIBRARIES, *filter(None, [ENGINES[engine].library]))}


def processor() -> dict[str, str]:
    """The kind of machine and the vector instructions NumPy found: its sine may differ between them in the last bit."""
    import numpy

    found: dict[str, list[str]] = numpy.show_config(mode="dicts")["SIMD Extensions"]  # type: ignore[assignment]
    features = [*found.get("baseline", []), *found.get("found", [])]
    return {
        "machine": platform.machine(),
        "system": platform.system(),
        "vector_instructions": " ".join(features) or "none",
    }
