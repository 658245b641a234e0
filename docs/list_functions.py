"""Write docs/functions.md from the registry: `python docs/list_functions.py`."""

from __future__ import annotations

from pathlib import Path

from xlmc.compile.choices import CHOICES
from xlmc.compile.lambdas import LAMBDAS
from xlmc.compile.places import PLACES
from xlmc.functions.families import REGISTRY

PAGE = Path(__file__).with_name("functions.md")


def names() -> list[str]:
    """Every function of Excel that xlmc computes, in alphabetical order."""
    internal = {"SINGLE", "ANCHORARRAY"}
    known = {*REGISTRY, *CHOICES, *PLACES, *LAMBDAS, "LET", "LAMBDA"} - internal
    return sorted(name for name in known if name[0].isalpha() and name == name.upper())


def page() -> str:
    """The page's text."""
    letters: dict[str, list[str]] = {}
    for name in names():
        letters.setdefault(name[0], []).append(name)
    lines = [
        "# Functions",
        "",
        f"xlmc computes these {len(names())} functions of Excel, for all trials at once. Where a formula uses another",
        "one, or `OFFSET` and `INDIRECT` with arguments that vary, `xlmc check` names its cell; where no assumption",
        "reaches that cell, the value that Excel saved is used, with a note.",
        "",
        "This page is written by `python docs/list_functions.py`.",
        "",
    ]
    lines += [f"**{letter}** {' '.join(f'`{name}`' for name in found)}\n" for letter, found in letters.items()]
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(page())
