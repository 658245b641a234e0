"""What people can type or see, and whether a page describes it.

`python tests/session/described.py` prints what no page describes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from xlmc.engine.engines import ENGINES
from xlmc.excel.functions.families import REGISTRY
from xlmc.montecarlo.definitions.run_settings import SETTINGS
from xlmc.montecarlo.definitions.stopping import GOALS
from xlmc.montecarlo.definitions.tables.settings import _settings
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.outputs.document import SECTIONS
from xlmc.outputs.sheets.book import SHEETS

__all__ = ["undescribed"]

OF_EARLIER_BOOKS = {"Arithmetic"}
"""Settings that do nothing any more, and are read so that older books run."""

DOCS = Path(__file__).resolve().parents[2] / "docs"


def undescribed() -> list[str]:
    """`docs/sampling.md: sobol` for each name that a page lacks: of sampling methods, engines, sheets, options, …"""
    texts = {page.name: page.read_text(encoding="utf-8") for page in DOCS.glob("*.md")}
    return [f"docs/{page}: {name}" for page, name, text in _expected() if text not in texts[page]]


def _expected() -> Iterator[tuple[str, str, str]]:
    """Page, what it must describe, and the text that does."""
    for method in METHODS:
        yield from ((page, method, f"`{method}`") for page in ("sampling.md", "command-line.md", "workbooks.md"))
    for engine in ENGINES:
        yield from ((page, engine, f"`{engine}`") for page in ("engines.md", "command-line.md", "workbooks.md"))
    for sheet in SHEETS:
        yield "guide.md", sheet.name, f"**{sheet.name}**"
    for section in SECTIONS:
        yield "report.md", section, f"| `{section}` |"
    for option in (option for goal in GOALS.values() for option in goal.options):
        typed = f"--{option.name.replace('_', '-')}"
        yield "command-line.md", typed, f"`{typed}`"
    for row in SETTINGS.values():
        yield from (("command-line.md", option, f"`{option}`") for option in row.options)
    for setting in _settings(ENGINES).values():
        if setting.name not in OF_EARLIER_BOOKS:
            yield "workbooks.md", setting.name, f"`{setting.name}`"
    for family in FAMILIES.values():
        yield "distributions.md", family.name, f"\n## {family.name}\n"
    for function in {each.name for each in REGISTRY.values() if each.name[0].isalpha() and each.name.isupper()}:
        yield "functions.md", function, f"`{function}`"


if __name__ == "__main__":
    for line in undescribed():
        print(line)
