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
    "Solutions": "seek",
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

    def text(self, shown: Shown) -> str:
        """Return the title and the sentences, without tables."""
        from xlmc.outputs.document.parts import Bullets, Paragraph

        with in_style(_style(shown)):
            report = _report(shown)
            end = "" if report.title.endswith(("?", "!", ".")) else "."
            messages = [f"{report.title}{end} {report.below}."]
            for block in report.blocks:
                if isinstance(block, Paragraph):
                    messages.append(block.text)
                elif isinstance(block, Bullets):
                    messages += [f"- {each}" for each in block.texts]
            return "\n".join(messages)

    def html(self, shown: Shown) -> str:
        """Return the blocks of the study's page, in the colours of the notebook."""
        from xlmc.outputs.document.html_writer import blocks_html

        with in_style(_style(shown)):
            report = _report(shown)
            above = f"<h3>{escape(report.title)}</h3><p>{escape(report.below)}</p>"
            return f"{above}{blocks_html(report.blocks).source}"

    def save(self, shown: Shown, path: Path, *, overwrite: bool) -> Path:
        """Write the report; `Shown.save` says what that may raise."""
        from xlmc.outputs.study_report import TWO_LOOPS_NOT_KEPT, Files

        with in_style(_style(shown)):
            report = _report(shown)
            in_loops = report.run is not None and bool(report.run.plan.outer)
            files = Files(
                [path],
                _sources(shown),
                overwrite=overwrite,
                of_run=report.run is not None,
                not_kept=TWO_LOOPS_NOT_KEPT if in_loops else "",
            )
            files.check()
            for _, write in files.writers(report):
                path = write()
        return path


def _report(shown: Shown) -> StudyReport:
    command = _COMMANDS[type(shown).__name__]
    module = import_module(f"xlmc.outputs.studies.{command}")
    return cast("StudyReport", getattr(module, f"{command}_report")(shown))


def _models(value: Any) -> list[CompiledModel]:
    if hasattr(value, "first"):
        return [value.first.model, value.second.model]
    return [value.model if hasattr(value, "model") else value.run.model]


def _sources(value: Any) -> list[Path]:
    """Return the workbooks that were studied."""
    if hasattr(value, "workbook"):
        return [Path(value.workbook.name)]
    return [each.path for each in _models(value)]


def _style(value: Any) -> str:
    """Return how the workbook that was studied wants numbers written."""
    if hasattr(value, "number_style"):
        return str(value.number_style)
    return _models(value)[0].definitions.settings.number_style
