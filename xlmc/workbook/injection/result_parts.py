"""Carry the parts of built sheets over to another package: each rewritten for its new place, its pointers too."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from xlmc.workbook.injection.built_book import BuiltBook
from xlmc.workbook.injection.part_numbers import TableNumbers
from xlmc.workbook.injection.result_sheet import Renames, at_home, renamed_in, with_differential
from xlmc.workbook.injection.splice import SplicedXml
from xlmc.workbook.injection.styles_merge import StyleMap
from xlmc.workbook.package import relationships, rels_part

__all__ = ["Carrier", "relative_target"]

_AXIS: Final = re.compile(rb"<c:(catAx|dateAx)>.*?</c:\1>", re.DOTALL)
_BEHIND_AXIS_FORMAT: Final = re.compile(rb"<c:(majorTickMark|minorTickMark|tickLblPos) ")
_GENERAL: Final = b'<c:numFmt formatCode="General" sourceLinked="1"/>'


@dataclass(frozen=True, slots=True)
class Carrier:
    """All that is new about the built parts: `names` and `types` (content types) by their old part names."""

    built: BuiltBook
    names: Mapping[str, str]
    types: Mapping[str, str]
    styles: StyleMap
    renames: Renames
    tables: TableNumbers

    def parts(self) -> dict[str, bytes]:
        """The new parts, each followed by its rels part."""
        carried = {}
        for old, new in self.names.items():
            carried[new] = self._rewritten(old)
            if rels_part(old) in self.built.parts:
                carried[rels_part(new)] = self._pointers(old)
        return carried

    def _rewritten(self, part: str) -> bytes:
        xml = self.built.parts[part]
        match self.types[part].rpartition(".")[2]:
            case "worksheet+xml":
                return renamed_in(at_home(xml, self.built.strings, self.styles), self.renames)
            case "table+xml":
                return renamed_in(with_differential(self._table(part), self.styles), self.renames)
            case "chart+xml":
                return renamed_in(_with_axis_format(xml), self.renames)
            case "drawing+xml":
                return renamed_in(xml, self.renames)
            case _:
                return xml

    def _table(self, part: str) -> bytes:
        document = SplicedXml(self.built.parts[part], part)
        document.set(document.root, "id", self.tables.ids[part])
        for attribute in ("name", "displayName"):
            name = document.root.attributes[attribute]
            document.set(document.root, attribute, self.tables.names.get(name.casefold(), name))
        return document.result()

    def _pointers(self, part: str) -> bytes:
        document = SplicedXml(self.built.parts[rels_part(part)], rels_part(part))
        targets = relationships(self.built.parts, part)
        for element in document.root.children:
            target = targets[element.attributes["Id"]].target
            raw = element.attributes["Target"]
            if raw.startswith("#"):  # a link to a place in the workbook
                document.set(element, "Target", "#" + self.renames.formula(raw[1:]))
            elif target in self.names:
                document.set(element, "Target", relative_target(self.names[part], self.names[target]))
        return document.result()


def relative_target(source: str, target: str) -> str:
    """How one part points to another: `xl/workbook.xml, xl/styles.xml -> styles.xml`."""
    return posixpath.relpath(f"/{target}", posixpath.dirname(f"/{source}"))


def _with_axis_format(xml: bytes) -> bytes:
    """The chart with a number format on every category axis: Excel writes one always, and some programs want it.

    Only the axes are looked at: a chart is one of XlsxWriter's, and mostly numbers.
    """
    return _AXIS.sub(lambda axis: _formatted(axis[0]), xml)


def _formatted(axis: bytes) -> bytes:
    if b"<c:numFmt " in axis:
        return axis
    return _BEHIND_AXIS_FORMAT.sub(lambda behind: _GENERAL + behind[0], axis, count=1)
