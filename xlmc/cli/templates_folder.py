"""The templates people start from: in the wheel beside the package, in a checkout beside it one folder up."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from xlmc.errors import WorkbookError
from xlmc.workbook.package import read_parts

__all__ = ["UNITS", "Template", "templates"]

UNITS: Final = {"imperial": "", "si": "-si"}
"""Units of an edition -> what its file name has after the template's name."""

_DUBLIN_CORE = "{http://purl.org/dc/elements/1.1/}"
_CATEGORY = "{http://schemas.openxmlformats.org/package/2006/metadata/core-properties}category"


_NO_TEMPLATE: Final = re.compile(r"^~\$|-results(-\d+)?$")
"""What else may lie in the folder of a checkout: Excel's mark of a book that it has open, and results."""


@dataclass(frozen=True, slots=True)
class Template:
    """One template, as its document properties describe it.

    Attributes:
        editions: units -> file.
        question: what it answers.
        needs: the inputs it needs.
        rung: its place on the ladder of models, such as `rung 1`; the simplest come first.
    """

    editions: Mapping[str, Path]
    question: str
    needs: str
    rung: str


def templates() -> dict[str, Template]:
    """Every template by name, the simplest first.

    Raises:
        WorkbookError: the folder is missing from the installation.
    """
    package = Path(__file__).parents[1]
    for folder in (package / "templates", package.parent / "templates"):
        books = {path.stem: path for path in folder.glob("*.xlsx") if not _NO_TEMPLATE.search(path.stem)}
        names = [name for name in books if not any(end and name.endswith(end) for end in UNITS.values())]
        if names:
            found = {name: _template(name, books) for name in names}
            return dict(sorted(found.items(), key=lambda item: (item[1].rung, item[0])))
    raise WorkbookError("the templates are missing", where=package, hint="install xlmc again")


def _template(name: str, books: Mapping[str, Path]) -> Template:
    editions = {units: books[name + end] for units, end in UNITS.items() if name + end in books}
    core = read_parts(books[name].read_bytes()).get("docProps/core.xml", b"<none/>")
    properties = ElementTree.fromstring(core)
    question, needs = (properties.findtext(_DUBLIN_CORE + key, default="") for key in ("subject", "description"))
    return Template(editions, question, needs, properties.findtext(_CATEGORY, default=""))
