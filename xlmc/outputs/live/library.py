"""Which workbooks a window may open: those given, dropped or copied from a template, opened before, or in the folder.

A page names a workbook by a key that was made here, never by a path.
"""

from __future__ import annotations

import hashlib
import os
import re
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from xlmc.errors import WorkbookError, XlmcError
from xlmc.excel.own_functions import OwnFunctions
from xlmc.excel.workbook.formats import other_format
from xlmc.excel.workbook.printable import printable
from xlmc.excel.workbook.target import refuse_existing, unused_path
from xlmc.excel.workbook.writer import write_workbook
from xlmc.outputs.live.stored_scenarios import Keeper

__all__ = ["Library", "Sample"]

_ENDINGS: Final = (".xlsx", ".xlsm", ".xls", ".xlsb", ".ods")
_MOST_LISTED: Final = 500
_LONGEST: Final = 120
_DEVICE: Final = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\.|$)")
"""Names that Windows gives to devices, whatever the ending."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A template that can be copied.

    Attributes:
        question: what it answers.
        path: where it lies.
        units: which of its editions it is; empty where there is one only.
    """

    name: str
    question: str
    path: Path
    units: str = ""


class Library:
    """See the module.

    Args:
        keeper: of what was opened before.
        book: the one workbook that was given.
        folder: whose workbooks may be opened, and where copies of templates go.
        samples: the templates.
        functions: a person's own, which formulas of all these workbooks may call.
    """

    def __init__(
        self,
        keeper: Keeper,
        *,
        book: Path | None = None,
        folder: Path | None = None,
        samples: Sequence[Sample] = (),
        functions: OwnFunctions | None = None,
    ) -> None:
        self.keeper, self.folder, self.functions = keeper, folder, functions
        self._paths: dict[str, Path] = {}
        self._samples: Mapping[str, Sample] = {_key(each.path): each for each in samples}
        self.trouble = ""
        self.only = None if book is None else self._add(book)

    def path(self, key: str) -> Path | None:
        """Return the workbook of a key; None if there is none, or if it may not be opened any more."""
        result = self._paths.get(key)
        if result is None or not self._is_inside(result):
            return None
        return result

    def books(self) -> list[dict[str, str]]:
        """Return the workbooks in the folder: name and key."""
        if self.folder is None:
            return []
        try:
            paths = sorted(each for each in self.folder.iterdir() if _is_book(each) and self._is_inside(each))
        except OSError as error:
            self.trouble = f"{self.folder}: {error.strerror or error}."
            return []
        return [{"name": printable(each.name), "key": self._add(each)} for each in paths[:_MOST_LISTED]]

    def recent(self) -> list[dict[str, str]]:
        """Return the workbooks that were opened before: name, folder and key."""
        try:
            paths = self.keeper.recent()
        except XlmcError as error:
            self.trouble = str(error)
            return []
        return [
            {"name": printable(each.name), "folder": printable(str(each.parent)), "key": self._add(each)}
            for each in paths
        ]

    def templates(self) -> list[dict[str, Any]]:
        """Return each template once: name, question, key, and its further editions with their units and keys."""
        rows: dict[str, dict[str, Any]] = {}
        for key, each in self._samples.items():
            if each.name in rows:
                rows[each.name]["editions"].append({"units": each.units, "key": key})
            else:
                rows[each.name] = {"name": each.name, "question": each.question, "key": key, "editions": []}
        return list(rows.values())

    def opened(self, path: Path) -> None:
        """Note that a workbook was opened."""
        try:
            self.keeper.opened(path)
        except XlmcError as error:
            self.trouble = str(error)

    def copy_template(self, key: str) -> str:
        """Copy a template into the folder, under a name that is free; returns the copy's key.

        Raises:
            WorkbookError: there is no such template, or it cannot be written.
        """
        sample = self._samples.get(key)
        if sample is None:
            raise WorkbookError("there is no such template")
        target = unused_path((self.folder or Path.cwd()) / sample.path.name)
        try:
            data = sample.path.read_bytes()
        except OSError as error:
            hint = "install xlmc again"
            raise WorkbookError(f"the template is missing: {error.strerror}", where=sample.path, hint=hint) from error
        write_workbook(target, data, lambda: refuse_existing(target))
        return self._add(target)

    def take(self, name: str, data: bytes) -> str:
        """Keep a workbook that was dropped, in a folder of the user's own; returns its key.

        Raises:
            WorkbookError: it is no workbook, or cannot be written.
        """
        plain = re.sub(r"[^\w .()+-]", "_", name.replace("\\", "/").rpartition("/")[2]).strip(" .")[-_LONGEST:]
        if not plain.casefold().endswith(_ENDINGS) or not (data[:2] == b"PK" or other_format(data) is not None):
            hint = "drop a workbook whose name ends in .xlsx, .xlsm, .xls, .xlsb or .ods"
            raise WorkbookError("this is not an Excel workbook", where=printable(plain) or None, hint=hint)
        folder = self.keeper.dropped / secrets.token_hex(8)
        target = folder / (f"_{plain}" if _DEVICE.match(plain) else plain)
        try:
            self.keeper.make_folder()
            self.keeper.dropped.mkdir(exist_ok=True, mode=0o700)
            folder.mkdir(mode=0o700)
            target.write_bytes(data)
        except OSError as error:
            raise WorkbookError(f"it cannot be kept: {error.strerror or error}", where=target) from error
        return self._add(target)

    def _add(self, path: Path) -> str:
        path = Path(os.path.abspath(path))
        key = _key(path)
        self._paths[key] = path
        return key

    def _is_inside(self, path: Path) -> bool:
        """Return whether a workbook of the folder truly lies in it, not by a link that leads out."""
        if self.folder is None or path.parent != Path(os.path.abspath(self.folder)):
            return True
        return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(self.folder))


def _is_book(path: Path) -> bool:
    return path.suffix.casefold() in _ENDINGS and not path.name.startswith("~$") and path.is_file()


def _key(path: Path) -> str:
    return hashlib.sha256(os.fsencode(path)).hexdigest()[:20]
