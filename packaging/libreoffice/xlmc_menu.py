"""The menu *Monte Carlo* of LibreOffice Calc: it runs the command `xlmc` on the workbook in front.

LibreOffice runs this file with its own Python, so it uses nothing but the standard library and UNO. Nothing is
computed here: `xlmc` reads the saved file, as from a terminal, and its words are shown.
"""

import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import uno
import unohelper
from com.sun.star.awt.MessageBoxType import ERRORBOX, INFOBOX, QUERYBOX
from com.sun.star.task import XJobExecutor

TITLE = "Monte Carlo"
OK, OK_OR_CANCEL = 1, 2  # com.sun.star.awt.MessageBoxButtons
NO_PROGRAM = (
    "The program xlmc was not found. Install it from a terminal, in the folder of xlmc:\n"
    "    uv tool install .    or    pipx install .\n"
    "Then close LibreOffice, and open it again."
)
CELL = re.compile(r"(?<!\S)('(?:[^']|'')+'|[^\s'!:]+)!\$?([A-Z]{1,3})\$?([0-9]+)")
"""A cell in a message: `Sheet!B4` or `'A sheet'!B4`."""


class RefusedError(Exception):
    """What cannot be done, in words for the user."""


class Menu(unohelper.Base, XJobExecutor):
    """The entries of the menu, by the names with which `Addons.xcu` calls them: check, simulate, open."""

    running = False

    def __init__(self, context):
        self.context = context
        self.desktop = self._service("com.sun.star.frame.Desktop")

    def trigger(self, entry):
        """Run one entry on the workbook in front; a message says what it could not do."""
        if Menu.running:  # the window goes on to answer while xlmc runs
            return
        Menu.running = True
        self.document = self.desktop.getCurrentComponent()
        try:
            {"check": self.check, "simulate": self.simulate, "open": self.open_window}[entry]()
        except RefusedError as refused:
            self._select_cell_in(str(refused))
            self._show(str(refused), ERRORBOX)
        finally:
            Menu.running = False

    def check(self):
        """Say that the workbook has no problem, or show the first one and select its cell."""
        message, notices = self._run("check")
        self._show("\n".join([notices, *message.splitlines()[-2:]]).strip(), INFOBOX)

    def simulate(self):
        """Simulate the workbook and open the one with the results."""
        message, notices = self._run("simulate", "--quiet")
        results = re.search(r"^Results are in (.+)$", message, re.MULTILINE)
        if results is None:
            raise RefusedError(notices or message)
        path = Path(self._book().parent, results[1])
        hidden = tuple(each for each in self.document.getArgs() if each.Name == "Hidden")  # as the workbook itself
        opened = self.desktop.loadComponentFromURL(path.as_uri(), "_blank", 0, hidden)
        added = [each for each in opened.getSheets() if not self.document.getSheets().hasByName(each.getName())]
        opened.getCurrentController().setActiveSheet(added[0])
        if notices:
            self._show(notices, INFOBOX)

    def open_window(self):
        """Open the live window in the browser. It reads the workbook again when it is saved, until it is closed."""
        self._run("open", until_it_speaks=True)

    def _run(self, command, *options, until_it_speaks=False):
        """Run `xlmc command` on the workbook. Return what it printed, and its problems and notices.

        With `until_it_speaks` the command may go on by itself once it has printed something.

        Raises:
            RefusedError: the workbook has no file yet, there is no xlmc, or xlmc found a problem.
        """
        book = self._book()
        program = shutil.which(
            "xlmc", path=os.pathsep.join([os.environ.get("PATH", ""), str(Path.home() / ".local/bin")])
        )
        if program is None:
            raise RefusedError(NO_PROGRAM)
        kept = {
            name: value
            for name, value in os.environ.items()
            if name not in ("PYTHONHOME", "PYTHONPATH", "LD_LIBRARY_PATH")
        }
        kept |= {"NO_COLOR": "1", "COLUMNS": "400", "PYTHONIOENCODING": "utf-8", "PYTHONUNBUFFERED": "1"}
        hidden = {"creationflags": subprocess.CREATE_NO_WINDOW} if os.name == "nt" else {}
        with tempfile.TemporaryFile() as message, tempfile.TemporaryFile() as problems:
            process = subprocess.Popen(
                [program, command, *options, book.name],
                cwd=book.parent, env=kept, stdin=subprocess.DEVNULL, stdout=message, stderr=problems, **hidden,
            )  # fmt: skip
            code = self._wait(process, f"xlmc {command} {book.name}", message if until_it_speaks else None)
            texts = []
            for file in (message, problems):
                file.seek(0)
                texts.append(file.read().decode("utf-8", "replace").strip())
        if code not in (None, 0, 1):  # 1: computed, with something to look at
            raise RefusedError(texts[1] or texts[0])
        return texts

    def _wait(self, process, title, output):
        """Return the exit code, or None once the file `output` holds something; the window answers meanwhile."""
        indicator = self.document.getCurrentController().getFrame().createStatusIndicator()
        indicator.start(title, 0)
        begin = time.monotonic()
        try:
            while process.poll() is None and not (output and os.fstat(output.fileno()).st_size):
                indicator.setText(f"{title}: {time.monotonic() - begin:.0f} s")
                time.sleep(0.1)
        finally:
            indicator.end()
        return process.poll()

    def _book(self):
        """Return the path of the workbook in front, saved.

        Raises:
            RefusedError: there is no workbook, it has no file on this machine, or its changes are not to be saved.
        """
        document = self.document
        if document is None or not document.supportsService("com.sun.star.sheet.SpreadsheetDocument"):
            raise RefusedError("No workbook is open: open one, and choose the entry again.")
        if not document.hasLocation() or not document.getURL().startswith("file:"):
            raise RefusedError("The workbook is not saved on this machine: save it as Excel 2007-365 (.xlsx) first.")
        path = Path(uno.fileUrlToSystemPath(document.getURL()))
        if document.isModified():
            if self._show(f"xlmc reads the saved file. Save {path.name} now?", QUERYBOX, OK_OR_CANCEL) != 1:
                raise RefusedError(f"{path.name} was not saved, and nothing was run.")
            document.store()
        return path

    def _select_cell_in(self, message):
        """Select the first cell that a message names, if the workbook has it."""
        named = CELL.search(message)
        if named is None or self.document is None:
            return
        sheets, title = self.document.getSheets(), named[1]
        if title.startswith("'"):
            title = title[1:-1].replace("''", "'")
        if sheets.hasByName(title):
            cell = sheets.getByName(title).getCellRangeByName(named[2] + named[3])
            self.document.getCurrentController().select(cell)

    def _show(self, message, kind, buttons=OK):
        """Show a message over the workbook. Return the button: 1 for OK, 0 for Cancel."""
        frame = self.desktop.getCurrentFrame()
        window = None if frame is None else frame.getContainerWindow()
        box = self._service("com.sun.star.awt.Toolkit").createMessageBox(window, kind, buttons, TITLE, message)
        return box.execute()

    def _service(self, name):
        return self.context.ServiceManager.createInstanceWithContext(name, self.context)


g_ImplementationHelper = unohelper.ImplementationHelper()  # noqa: N816  # the name that LibreOffice looks for
g_ImplementationHelper.addImplementation(Menu, "xlmc.Menu", ("com.sun.star.task.Job",))
