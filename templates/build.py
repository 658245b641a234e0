"""Build every template workbook: `python templates/build.py`."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
if __name__ == "__main__":
    sys.path.append(str(HERE.parent))

from templates.description import Template  # noqa: E402 (the path above makes a plain `python templates/build.py` work)
from templates.planar_impact import describe  # noqa: E402
from templates.planar_impact.example_scene import EXAMPLE  # noqa: E402
from templates.writer import write_book  # noqa: E402

__all__ = ["TEMPLATES", "build"]

TEMPLATES: dict[str, Template] = {"planar-impact": describe(EXAMPLE)}
"""File name without its ending -> what the workbook says."""


def build(folder: Path) -> list[Path]:
    """Write every template into `folder`; the paths written are returned."""
    written = []
    for name, template in TEMPLATES.items():
        path = folder / f"{name}.xlsx"
        write_book(template, path)
        written.append(path)
    return written


if __name__ == "__main__":
    build(HERE)
