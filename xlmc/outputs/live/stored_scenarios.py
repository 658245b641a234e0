"""What outlives a window: the scenarios of each workbook, and the workbooks that were opened last.

They lie in a folder of the user's own: `~/.local/state/xlmc/live`, on macOS in `~/Library/Application Support`, on
Windows in `%LOCALAPPDATA%`. A file that cannot be read counts as none, and is reported, as is one that cannot be
written.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, Final

from xlmc.errors import WorkbookError
from xlmc.outputs.live.adjustments import Adjustments

__all__ = ["Keeper", "state_folder"]

_MOST_RECENT: Final = 12
_MOST_BYTES: Final = 64 << 20
"""Bytes of a file of scenarios: many thousands of large ones. More is not written, since it would not be read back."""

_PATIENCE: Final = 5.0
"""Seconds after which a lock is that of a program that died: a file is written within milliseconds."""


def state_folder() -> Path:
    """Return the folder in which scenarios are kept."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or str(Path.home() / "AppData" / "Local")
        return Path(base) / "xlmc" / "live"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "xlmc" / "live"
    return Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "xlmc" / "live"


class Keeper:
    """Load and store the scenarios and the last workbooks of a user.

    Several windows of several programs may be open on one workbook: what each has kept since it read the file last is
    put into what the file holds by then, so that none takes the other's scenarios away.

    Args:
        folder: where they lie; it is made when something is written.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._seen: dict[Path, dict[str, Adjustments]] = {}

    @property
    def dropped(self) -> Path:
        """Return the folder of workbooks that were dropped onto the window."""
        return self._folder / "dropped"

    def make_folder(self) -> None:
        """Make the folder, for its owner's eyes alone.

        Raises:
            OSError: it cannot be made.
        """
        self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        self._folder.chmod(0o700)

    def scenarios(self, book: Path) -> tuple[dict[str, Adjustments], Adjustments]:
        """Return the scenarios of a workbook by name, and the state that was not kept under a name.

        Raises:
            WorkbookError: there is a file of them, and it cannot be read; it is set aside.
        """
        path = self._of(book)
        named, unkept = self._scenarios(path)
        self._seen[path] = dict(named)
        return named, unkept

    def _scenarios(self, path: Path) -> tuple[dict[str, Adjustments], Adjustments]:
        result = self._read(path)
        try:
            if result is None:
                return {}, Adjustments()
            named = {str(name): Adjustments.of_json(each) for name, each in result["scenarios"].items()}
            return named, Adjustments.of_json(result["unkept"])
        except (ValueError, TypeError, AttributeError, KeyError, OverflowError) as error:
            raise _set_aside(path) from error

    def keep(self, book: Path, scenarios: Mapping[str, Adjustments], unkept: Adjustments) -> dict[str, Adjustments]:
        """Write the scenarios of a workbook, and return all of them: also those that another window kept meanwhile.

        Raises:
            WorkbookError: they cannot be written.
        """
        path = self._of(book)
        try:
            with self._alone(path):
                theirs, _ = self._scenarios(path)
                stored = _merged(self._seen.get(path, {}), scenarios, theirs)
                if stored or unkept:
                    named = {name: each.as_json() for name, each in stored.items()}
                    self._write(path, {"book": str(book), "scenarios": named, "unkept": unkept.as_json()})
                else:
                    path.unlink(missing_ok=True)
        except OSError as error:
            raise _unwritable(path, error) from error
        self._seen[path] = dict(stored)
        return stored

    def recent(self) -> list[Path]:
        """Return the workbooks that were opened last and are still there, the last first.

        Raises:
            WorkbookError: the list cannot be read; it is set aside.
        """
        path = self._folder / "recent.json"
        result = self._read(path)
        books = result.get("books", []) if result else []
        if not isinstance(books, list):
            raise _set_aside(path)
        return [Path(each) for each in books if isinstance(each, str) and _is_file(each)]

    def opened(self, book: Path) -> None:
        """Put a workbook first among them.

        Raises:
            WorkbookError: they cannot be written.
        """
        others = [each for each in self.recent() if each != book]
        stored = [str(each) for each in (book, *others)][:_MOST_RECENT]
        path = self._folder / "recent.json"
        try:
            self._write(path, {"books": stored})
        except OSError as error:
            raise _unwritable(path, error) from error

    def _of(self, book: Path) -> Path:
        name = hashlib.sha256(os.fsencode(os.path.realpath(book))).hexdigest()[:32]
        return self._folder / f"{name}.json"

    def _read(self, path: Path) -> dict[str, Any] | None:
        """Return a file's contents; otherwise None.

        Raises:
            WorkbookError: it is no JSON object; it is set aside.
        """
        try:
            with path.open("rb") as file:
                text = file.read(_MOST_BYTES + 1)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise WorkbookError(
                f"This file of scenarios cannot be read ({error.strerror or error})",
                where=path,
                hint="Look at its rights",
            ) from error
        try:
            value = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise _set_aside(path) from error
        if not isinstance(value, dict):
            raise _set_aside(path)
        return value

    def _write(self, path: Path, result: Mapping[str, Any]) -> None:
        text = json.dumps(result, indent=1)
        if len(text) > _MOST_BYTES:
            raise OSError(errno.EFBIG, "there are too many")
        unfinished = path.with_suffix(f".{os.getpid()}-{time.monotonic_ns()}.tmp")
        try:
            self.make_folder()
            unfinished.write_text(text, encoding="utf-8")
            unfinished.replace(path)
        except OSError:
            unfinished.unlink(missing_ok=True)
            raise

    @contextmanager
    def _alone(self, path: Path) -> Iterator[None]:
        """Keep other programs from the file meanwhile; one that died holds it up for some seconds."""
        self.make_folder()
        lock, until = path.with_suffix(".lock"), time.monotonic() + _PATIENCE
        while True:
            try:
                os.close(os.open(lock, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
                break
            except FileExistsError:
                if time.monotonic() > until:
                    lock.unlink(missing_ok=True)
                time.sleep(0.01)
        try:
            yield
        finally:
            lock.unlink(missing_ok=True)


def _merged(
    seen: Mapping[str, Adjustments], ours: Mapping[str, Adjustments], theirs: Mapping[str, Adjustments]
) -> dict[str, Adjustments]:
    """Merge what two windows keep, each of which began with what was seen last; one name with two contents is two."""
    result = {name: each for name, each in theirs.items() if name in ours or name not in seen}
    for name, each in ours.items():
        changed_here, changed_there = seen.get(name) != each, theirs.get(name) != seen.get(name)
        if not changed_here and name in seen and name not in theirs:
            continue  # forgotten in the other window
        if changed_here and changed_there and name in theirs and theirs[name] != each:
            free = (f"{name} ({number})" for number in count(2))
            result[next(other for other in free if other not in ours and other not in theirs)] = theirs[name]
        if changed_here or name not in theirs:
            result[name] = each
    return result


def _is_file(path: str) -> bool:
    """Return whether there is such a file; a name that no file can have, or that may not be looked at, is none."""
    try:
        return Path(path).is_file()
    except (OSError, ValueError):
        return False


def _set_aside(path: Path) -> WorkbookError:
    """Move a damaged file out of the way, so that nothing writes over it, and say where it is."""
    aside = next(
        other for number in count(1) if not (other := path.with_suffix(f".damaged{number}{path.suffix}")).exists()
    )
    try:
        path.rename(aside)
    except OSError as error:
        return WorkbookError(
            f"This file of scenarios is damaged, and cannot be set aside ({error.strerror or error})",
            where=path,
            hint="Move it away",
        )
    return WorkbookError("This file of scenarios is damaged", where=path, hint=f"It was set aside as {aside.name}")


def _unwritable(path: Path, error: OSError) -> WorkbookError:
    message = f"the scenarios cannot be kept: {error.strerror or error}"
    return WorkbookError(message, where=path, hint="note them, and look at the folder's rights")
