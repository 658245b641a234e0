"""What xlmc writes of a run that was made from hostile input: every file must be whole."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from xml.parsers import expat

from fuzzing.inputs import Disagreement
from xlmc.api import Simulation
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.outputs.summary import summarise, summary_text

__all__ = ["examined"]


def examined(result: RunResult, folder: Path, steps: tuple[str, ...]) -> None:
    """Summarise the run with the step `summary`; `write` result workbook, page, JSON and run, and read them again.

    Raises:
        Disagreement: a file is not what it must be.
        XlmcError: as xlmc does.
    """
    if "summary" in steps:
        summary_text(summarise(result))
        _ = result.warnings, result.notices_of_run
    if "write" not in steps:
        return
    from xlmc.outputs.replay import replay

    book, page, document, run = (folder / f"out.{end}" for end in ("xlsx", "html", "json", "xlmcrun"))
    for path in (book, page, document, run):
        path.unlink(missing_ok=True)
    Simulation(result).save_json(document)
    json.loads(document.read_text("utf-8"), parse_constant=_refuse)
    Simulation(result).save_page(page)
    page.read_text("utf-8")
    Simulation(result).keep(run)
    Simulation(result).save(book)
    _whole(book, result.model.workbook.parts)
    for path in (book, run):
        if not replay(path).to_the_last_bit:
            raise Disagreement(f"replay of {path.suffix}: the repeat is not identical")


def _refuse(name: str) -> None:
    raise Disagreement(f"JSON: it holds {name}")


def _whole(book: Path, given: Mapping[str, bytes]) -> None:
    """Every XML part that xlmc made or changed is well-formed, and no name is there twice."""
    with zipfile.ZipFile(book) as package:
        names = package.namelist()
        if len(set(names)) < len(names):
            raise Disagreement("result workbook: a part is there twice")
        for name in names:
            content = package.read(name)
            if name.endswith((".xml", ".rels")) and content != given.get(name):
                try:
                    expat.ParserCreate().Parse(content, True)
                except expat.ExpatError as error:
                    raise Disagreement(f"result workbook: {name} is not well-formed, {error}") from error
