"""LibreOffice, which converts the cells of a workbook in another format, where it is installed.

It gets a copy of the file in a folder of its own, and a profile that runs no macro and follows no link.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import OtherFormat

__all__ = ["converted_to_xlsx"]

_PROGRAMS: Final = ("soffice", "libreoffice")
_ELSEWHERE: Final = (
    Path("/Applications/LibreOffice.app/Contents/MacOS/soffice"),
    Path(os.environ.get("PROGRAMFILES", r"C:\Program Files"), "LibreOffice", "program", "soffice.exe"),
)
_SECONDS: Final = 600
"""How long a conversion may take; a book of a megabyte takes some seconds."""

_PROFILE: Final = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry">
<item oor:path="/org.openoffice.Office.Common/Security/Scripting"><prop oor:name="MacroSecurityLevel" oor:op="fuse">
<value>3</value></prop></item>
<item oor:path="/org.openoffice.Office.Common/Security/Scripting"><prop oor:name="DisableMacrosExecution" oor:op="fuse">
<value>true</value></prop></item>
<item oor:path="/org.openoffice.Office.Calc/Content/Update"><prop oor:name="Link" oor:op="fuse">
<value>2</value></prop></item>
</oor:items>
"""
"""Settings: run no macro, and never update links (2)."""


def converted_to_xlsx(data: bytes, form: OtherFormat) -> bytes:
    """Convert the file with LibreOffice to `.xlsx`.

    Raises:
        WorkbookError: LibreOffice is not installed, or cannot convert the file.
    """
    program = _program()
    if program is None:
        message = (
            f"the file is {form.noun}, which xlmc reads with the help of LibreOffice, and LibreOffice is not installed"
        )
        raise WorkbookError(message, hint=f"Install LibreOffice (libreoffice.org). Or: {form.hint}")
    try:
        with TemporaryDirectory(prefix="xlmc-", ignore_cleanup_errors=True) as folder:
            old, new = Path(folder, f"book{form.ending}"), Path(folder, "book.xlsx")
            old.write_bytes(data)
            settings = Path(folder, "profile", "user", "registrymodifications.xcu")
            settings.parent.mkdir(parents=True)
            settings.write_text(_PROFILE, encoding="utf-8")
            output = _run(program, folder, old, form)
            if new.is_file():
                return new.read_bytes()
    except OSError as error:
        message = f"{form.name} cannot be converted by LibreOffice: {error.strerror or error}"
        raise WorkbookError(message, hint="Free space on the disk that temporary files go to, and try again") from error
    message = f"LibreOffice could not convert {form.name}{f' ({output})' if output else ''}"
    raise WorkbookError(message, hint=form.hint)


def _program() -> str | None:
    result = (shutil.which(name) for name in _PROGRAMS)
    there = (str(path) for path in _ELSEWHERE if path.is_file())
    return next((each for each in (*result, *there) if each), None)


def _run(program: str, folder: str, old: Path, form: OtherFormat) -> str:
    """Run it to its end; the last line that it wrote.

    Raises:
        WorkbookError: it cannot be started, or does not end.
    """
    profile = Path(folder, "profile").as_uri()
    command = [program, f"-env:UserInstallation={profile}", "--headless", "--norestore", "--nolockcheck"]
    # A session of its own, as the program is a script that starts others: Ctrl-C reaches xlmc, which ends them all.
    try:
        process = subprocess.Popen(
            [*command, "--convert-to", "xlsx", "--outdir", folder, str(old)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=os.name == "posix",
        )
    except OSError as error:
        message = f"LibreOffice ({program}) cannot be started: {error.strerror or error}"
        raise WorkbookError(message, hint=form.hint) from error
    try:
        _, output = process.communicate(timeout=_SECONDS)
    except subprocess.TimeoutExpired:
        message = f"LibreOffice has not converted {form.name} in {_SECONDS // 60} minutes"
        raise WorkbookError(message, hint=form.hint) from None
    finally:
        if process.returncode is None:
            _end(process)
    lines = output.decode("utf-8", "replace").split("\n")
    return next((line.strip() for line in reversed(lines) if line.strip()), "")


def _end(process: subprocess.Popen[bytes]) -> None:
    """End it, and what it has started."""
    with suppress(OSError):
        if os.name == "posix":
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    process.communicate()  # reads what is left, and closes the pipe
