"""What outlives a window: the scenarios of each workbook, and the workbooks that were opened last.

They lie in a folder of the user's own: `~/.local/state/xlmc/live`, on macOS in `~/Library/Application Support`, on
Windows in `%LOCALAPPDATA%`. A file that cannot be read counts as none, and is told; one that cannot be written is told.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from xlmc.errors import WorkbookError
from xlmc.outputs.live.adjustments import Adjustments

__all__ = ["Keeper", "state_folder"]

_MOST_RECENT: Final = 12
_MOST_BYTES: Final = 4 << 20


def state_folder() -> Path:
    """The folder in which scenarios are kept."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or str(Path.home() / "AppData" / "Local")
        return Path(base) / "xlmc" / "live"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "xlmc" / "live"
    return Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "xlmc" / "live"


class Keeper:
    """Reads and writes them.

    Args:
        folder: where they lie; it is made when something is written.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    @property
    def dropped(self) -> Path:
        """The folder of workbooks that were dropped onto the window."""
        return self._folder / "dropped"

    def scenarios(self, book: Path) -> tuple[dict[str, Adjustments], Adjustments]:
        """The scenarios of a workbook by name, and the state that was not kept under a name.

        Raises:
            WorkbookError: there is a file of them, and it cannot be read.
        """
        path = self._of(book)
        found = self._read(path)
        try:
            if found is None:
                return {}, Adjustments()
            named = {str(name): Adjustments.of_json(each) for name, each in found["scenarios"].items()}
            return named, Adjustments.of_json(found["unkept"])
        except (ValueError, TypeError, AttributeError, KeyError) as error:
            raise _unreadable(path) from error

    def keep(self, book: Path, scenarios: Mapping[str, Adjustments], unkept: Adjustments) -> None:
        """Write the scenarios of a workbook.

        Raises:
            WorkbookError: they cannot be written.
        """
        path = self._of(book)
        if not scenarios and not unkept:
            path.unlink(missing_ok=True)
            return
        named = {name: each.as_json() for name, each in scenarios.items()}
        self._write(path, {"book": str(book), "scenarios": named, "unkept": unkept.as_json()})

    def recent(self) -> list[Path]:
        """The workbooks that were opened last and are still there, the last first."""
        found = self._read(self._folder / "recent.json")
        books = found.get("books", []) if found else []
        return [path for each in books if isinstance(each, str) and (path := Path(each)).is_file()]

    def opened(self, book: Path) -> None:
        """Put a workbook first among them.

        Raises:
            WorkbookError: they cannot be written.
        """
        others = [each for each in self.recent() if each != book]
        kept = [str(each) for each in (book, *others)][:_MOST_RECENT]
        self._write(self._folder / "recent.json", {"books": kept})

    def _of(self, book: Path) -> Path:
        name = hashlib.sha256(os.fsencode(os.path.realpath(book))).hexdigest()[:32]
        return self._folder / f"{name}.json"

    def _read(self, path: Path) -> dict[str, Any] | None:
        """A file's contents; None where there is none.

        Raises:
            WorkbookError: it is no JSON object.
        """
        try:
            text = path.read_bytes()[:_MOST_BYTES]
        except FileNotFoundError:
            return None
        except OSError as error:
            raise _unreadable(path) from error
        try:
            found = json.loads(text)
        except ValueError as error:
            raise _unreadable(path) from error
        if not isinstance(found, dict):
            raise _unreadable(path)
        return found

    def _write(self, path: Path, found: Mapping[str, Any]) -> None:
        unfinished = path.with_suffix(f".{os.getpid()}-{time.monotonic_ns()}.tmp")
        try:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            unfinished.write_text(json.dumps(found, indent=1), encoding="utf-8")
            unfinished.replace(path)
        except OSError as error:
            unfinished.unlink(missing_ok=True)
            message = f"the scenarios cannot be kept: {error.strerror or error}"
            raise WorkbookError(message, where=path, hint="note them, and look at the folder's rights") from error


def _unreadable(path: Path) -> WorkbookError:
    return WorkbookError("this file of scenarios cannot be read", where=path, hint="move it away, or delete it")
