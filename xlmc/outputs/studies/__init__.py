"""Documents of studies: what each command found, as blocks for every output."""

from __future__ import annotations

from html import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from xlmc.montecarlo.definitions.number_styles import in_style

if TYPE_CHECKING:
    from xlmc.analysis.studies.shown import Shown
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.outputs.study_report import StudyReport

__all__ = ["StudyDocuments"]

_COMMANDS: Final = {
    "Comparison": "compare",
    "Decided": "decide",
    "Found": "seek",
    "Optimised": "optimise",
    "Screening": "screen",
    "Stability": "stability",
    "Stressed": "stress",
    "Study": "methods",
    "TwoLoops": "uncertainty",
}
"""What a study found -> its command, after which the module here and the function `…_report` in it are called."""


class StudyDocuments:
    """Shows what studies found, in the words of their commands."""

    def text(self, found: Shown) -> str:
        """Return the title and the sentences, without tables."""
        from xlmc.outputs.document.parts import Bullets, Paragraph

        with in_style(_style(found)):
            report = _report(found)
            end = "" if report.title.endswith(("?", "!", ".")) else "."
            said = [f"{report.title}{end} {report.below}."]
            for block in report.blocks:
                if isinstance(block, Paragraph):
                    said.append(block.text)
                elif isinstance(block, Bullets):
                    said += [f"- {each}" for each in block.texts]
            return "\n".join(said)

    def html(self, found: Shown) -> str:
        """Return the blocks of the study's page, in the colours of the notebook."""
        from xlmc.outputs.document.html_writer import blocks_html

        with in_style(_style(found)):
            report = _report(found)
            above = f"<h3>{escape(report.title)}</h3><p>{escape(report.below)}</p>"
            return f"{above}{blocks_html(report.blocks).source}"

    def save(self, found: Shown, path: Path, *, overwrite: bool) -> Path:
        """Write the report; `Shown.save` says what that may raise."""
        from xlmc.outputs.study_report import TWO_LOOPS_NOT_KEPT, Files

        with in_style(_style(found)):
            report = _report(found)
            in_loops = report.run is not None and bool(report.run.plan.outer)
            files = Files(
                [path],
                _sources(found),
                overwrite=overwrite,
                of_run=report.run is not None,
                not_kept=TWO_LOOPS_NOT_KEPT if in_loops else "",
            )
            files.check()
            for _, write in files.writers(report):
                path = write()
        return path


def _report(found: Shown) -> StudyReport:
    command = _COMMANDS[type(found).__name__]
    module = import_module(f"xlmc.outputs.studies.{command}")
    return cast("StudyReport", getattr(module, f"{command}_report")(found))


def _models(found: Any) -> list[CompiledModel]:
    if hasattr(found, "first"):
        return [found.first.model, found.second.model]
    return [found.model if hasattr(found, "model") else found.run.model]


def _sources(found: Any) -> list[Path]:
    """Return the workbooks that were studied."""
    if hasattr(found, "workbook"):
        return [Path(found.workbook.name)]
    return [each.path for each in _models(found)]


def _style(found: Any) -> str:
    """Return how the workbook that was studied wants numbers written."""
    if hasattr(found, "number_style"):
        return str(found.number_style)
    return _models(found)[0].definitions.settings.number_style
