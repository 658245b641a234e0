"""The gallery: a card for each worked book, with a picture of its own run; the build runs them all.

In a page, `<!-- gallery -->` stands for the cards.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

    import xlmc

_MARK = "<!-- gallery -->"
ROOT = Path(__file__).resolve().parents[1]

BOOKS = {
    "examples/intersection.xlsx": "An intersection: momentum, rotation and restitution, the paper's case study",
    "examples/intersection-momentum.xlsx": "The same intersection by momentum alone",
    "examples/nearly-head-on.xlsx": "A nearly head-on collision with evidence from recorders and damage",
    "examples/rest-positions.xlsx": "Impact speeds searched from where the vehicles came to rest",
    "examples/barrier-corner.xlsx": "The corner of a barrier: one vehicle, planar impact",
    "examples/collinear-equal-cars.xlsx": "Two equal cars in one line",
    "examples/collinear-head-on.xlsx": "Head-on in one line",
    "examples/textbook-claim.xlsx": "A textbook's claim, held against the equations",
    "examples/bumper-test.xlsx": "A bumper test at 5.5 mph: both delta-V",
    "examples/motorcycle-head-on.xlsx": "A motorcycle head-on into a car",
    "examples/thrown-body.xlsx": "A body thrown by a vehicle: its speed from where it lay",
    "examples/crossing-pedestrian.xlsx": "A pedestrian who walked 20 ft: how far away the car was",
    "examples/crush-balance.xlsx": "Damage energy of two vehicles",
    "examples/skid-100-ft.xlsx": "A skid of 100 feet, and the way before it",
    "examples/yaw-mark.xlsx": "The critical speed of a yaw mark",
    "examples/airborne-amy.xlsx": "A vehicle that took off",
    "examples/edr-hard-braking.xlsx": "Hard braking, from a recorder's samples",
    "examples/video-two-frames.xlsx": "The speed between two frames of a video",
    "examples/left-turn.xlsx": "A left turn: time, distance, and the driver at the limit",
    "templates/pedestrian.xlsx": "A pedestrian: throw and vehicle together",
    "templates/beam.xlsx": "A beam with uncertain load and strength: does it fail in 50 years?",
    "templates/tolerance-stack.xlsx": "A tolerance stack that expands with temperature",
    "templates/mass-calibration.xlsx": "The calibration of a weight: quantities that act only together",
    "templates/project.xlsx": "A project: cost, finish date, register of risks",
    "templates/warranty.xlsx": "A warranty: Weibull life, claims of a year",
}
"""Book -> what it is about."""

_TRIALS = 20_000
_ACCEPTED = 3_000


def setup(app: Sphinx) -> dict[str, bool]:
    """Run the books when a page asks for the gallery."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _fill(app: Sphinx, name: str, source: list[str]) -> None:
    if _MARK not in source[0]:
        return
    folder = Path(app.doctreedir) / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    cards = [_card(Path(app.srcdir), folder, book, title) for book, title in BOOKS.items()]
    grid = "\n".join(("::::{grid} 1 2 2 3", ":gutter: 3", "", *cards, "::::"))
    source[0] = source[0].replace(_MARK, grid)


def _card(pages: Path, folder: Path, book: str, title: str) -> str:
    """Run a book, draw its answer, and return the card."""
    import xlmc

    model = xlmc.load(ROOT / book)
    run = model.simulate(_TRIALS)
    if run.accepted < _TRIALS / 10:
        run = model.simulate(until_accepted=_ACCEPTED)
    shown = _shown(run)
    image: tuple[str, ...] = ()
    if shown is not None:
        picture = folder / f"{Path(book).stem}.png"
        run.plot(shown, "histogram").savefig(picture, dpi=80)
        image = (
            f":img-top: {os.path.relpath(picture, pages).replace(os.sep, '/')}",
            f":img-alt: Histogram of {shown}",
        )
    message = next((each for each in run.sentences if shown is None or each.startswith(f"{shown}:")), run.sentences[0])
    link = os.path.relpath(ROOT / book, pages).replace(os.sep, "/")
    return "\n".join(
        (
            f":::{{grid-item-card}} {title}",
            *image,
            "",
            f"{message}.",
            "",
            f"{len(run.model.live)} ranges, {len(run.model.filters)} filters; {{download}}`{Path(book).name} <{link}>`",
            ":::",
        )
    )


def _shown(run: xlmc.Simulation) -> str | None:
    """Return the first forecast that varies and is stated; otherwise None."""
    stated = {each.partition(":")[0] for each in run.sentences}
    return next((name for name in run.results if name in stated and run[name].standard_deviation.value > 0), None)
