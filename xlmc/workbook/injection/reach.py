"""Which parts a part leads to, by following relationships."""

from __future__ import annotations

from collections.abc import Mapping

from xlmc.workbook.package import relationships

__all__ = ["pointed_to", "reached"]


def reached(parts: Mapping[str, bytes], *starts: str) -> list[str]:
    """The parts themselves and all they lead to, nearest first, each once. `""` is the package, and not in the list.

    Raises:
        WorkbookError: a rels part is not XML.
    """
    found = dict.fromkeys(starts)
    queue = list(starts)
    for part in queue:
        new = [target for target in pointed_to(parts, part) if target not in found]
        found |= dict.fromkeys(new)
        queue += new
    return [part for part in found if part]


def pointed_to(parts: Mapping[str, bytes], part: str) -> list[str]:
    """The parts in this package that one part points to, each once.

    Raises:
        WorkbookError: the rels part is not XML.
    """
    targets = (rel.target for rel in relationships(parts, part).values() if not rel.external)
    return list(dict.fromkeys(target for target in targets if target in parts))
