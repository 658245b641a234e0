"""`xlmc open`: the live window in a browser."""

from __future__ import annotations

import os
import signal
import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.new import templates
from xlmc.cli.options import FilePath, WholeNumber, functions_option
from xlmc.cli.terminal import say
from xlmc.errors import WorkbookError

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.outputs.live.library import Library
    from xlmc.outputs.live.server import LiveServer

__all__ = ["open_window"]

_LAST_PORT = 65_535


@click.command(name="open")
@click.argument("book", required=False, type=FilePath(), metavar="[BOOK|FOLDER]")
@click.option("--no-browser", is_flag=True, help="Print the link, and open no browser.")
@click.option("--port", type=WholeNumber(1, _LAST_PORT), help="Port of the window.  [default: a free one]")
@click.option("--memory", type=WholeNumber(50, None), help="MB that runs of a workbook may take.  [default: 500]")
@functions_option
def open_window(
    book: Path | None, no_browser: bool, port: int | None, memory: int | None, functions: OwnFunctions | None
) -> None:
    """Open the live window on BOOK, or on the workbooks of FOLDER: move ranges, and see the answers change."""
    import webbrowser

    from xlmc.outputs.live.server import LiveServer, bound_socket
    from xlmc.outputs.live.session import MEMORY

    library = _library(book, functions)
    server = LiveServer(bound_socket(port or 0), library, memory=memory or MEMORY)
    link = server.link
    say(f"The window is at {link}")
    say("The link is good for one browser, for a minute. Ctrl-C ends the window; so does closing it for ten minutes.")
    with tempfile.TemporaryDirectory(prefix="xlmc-open-") as folder:
        if not no_browser:
            address = _leading_to(link, Path(folder))
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        _serve(server)
    say("The window is closed. Scenarios are kept.")


def _leading_to(link: str, folder: Path) -> str:
    """Return the address of a page in the folder, closed to others, that goes on to the link.

    A browser is started with an address that every user of this machine can read in the list of processes.
    """
    page = folder / "xlmc.html"
    text = (
        f'<!doctype html><meta charset="utf-8"><title>xlmc</title><meta http-equiv="refresh" content="0;url={link}">\n'
    )
    with open(os.open(page, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
        file.write(text)
    return page.as_uri()


def _library(book: Path | None, functions: OwnFunctions | None) -> Library:
    from xlmc.outputs.live.library import Library, Sample
    from xlmc.outputs.live.stored_scenarios import Keeper, state_folder

    samples = [
        Sample(name, template.question, path, units.upper() if units != "imperial" else "")
        for name, template in templates().items()
        for units, path in template.editions.items()
    ]
    keeper = Keeper(state_folder())
    if book is None or os.path.isdir(book):
        return Library(keeper, folder=book or Path.cwd(), samples=samples, functions=functions)
    if not os.path.exists(book):
        raise WorkbookError("there is no such file", where=book, hint="xlmc open alone shows what there is")
    return Library(keeper, book=book, samples=samples, functions=functions)


def _serve(server: LiveServer) -> None:
    """Serve the window until Ctrl-C, or until no window has been open for some minutes."""
    import asyncio

    def end(*_: object) -> None:
        server.end()

    before = signal.signal(signal.SIGINT, end)
    try:
        asyncio.run(server.serve())
    finally:
        signal.signal(signal.SIGINT, before)
