"""Make the guide's pictures from the sheets themselves: `python docs/make_pictures.py`.

`examples/intersection.xlsx` is run, LibreOffice prints the result workbook as PDF, and each picture is cut out of its
page, from one text on the sheet to another. Needs LibreOffice, poppler (`pdftotext`, `pdftoppm`) and Pillow.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import unescape
from pathlib import Path
from tempfile import TemporaryDirectory

import openpyxl
from PIL import Image, ImageChops

import xlmc

HERE = Path(__file__).resolve().parent
CASE = HERE.parent / "examples" / "intersection.xlsx"
FOLDER = HERE / "pictures"

RESULTS, CONTRADICTION = "intersection-results.xlsx", "contradiction.xlsx"
WRONG_ANGLE = ("Inputs", "D8", 278)
"""What makes a case contradict itself: the Chevrolet's approach angle, near that of the Nissan and out of its range."""

_DPI = 160
_POINTS = 72
_MARGIN = 3
"""In points, above and beside what is cut out."""

_HEADER = 24
"""In points: what stands higher belongs to the page, not to the sheet."""

_COLOURS = 200
_FONTS = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig>
  <include ignore_missing="yes">/etc/fonts/fonts.conf</include>
  <alias binding="strong"><family>Calibri</family><prefer><family>Carlito</family><family>Liberation Sans</family>
  </prefer></alias>
  <alias binding="strong"><family>Consolas</family><prefer><family>Liberation Mono</family></prefer></alias>
</fontconfig>
"""
"""Fonts as wide as Excel's own, or nearly so: what LibreOffice takes otherwise is wider by a sixth."""


@dataclass(frozen=True, slots=True)
class Cut:
    """A part of a printed page.

    Attributes:
        book: the workbook.
        first: the text that the part begins with; the first page that has it is cut.
        last: the text that it ends with.
        page: a text that the page must have too, where `first` stands on several.
        below: how much more, in points, below `last`.
    """

    book: str
    first: str
    last: str
    page: str = ""
    below: float = 3


CUTS: Mapping[str, Cut] = {
    "inputs": Cut(RESULTS, "Intersection collision of a Chevrolet", "Orientation of tangent"),
    "inputs-fixed": Cut(RESULTS, "Held fixed", "Nissan width"),
    "model": Cut(RESULTS, "5 Restitution at the impact centre", "Restitution, tangential"),
    "scene": Cut(RESULTS, "Plan view of the base case", "X, ft", below=18),
    "inputs-red": Cut(CONTRADICTION, "Intersection collision of a Chevrolet", "Chevrolet departure angle"),
    "checks-red": Cut(CONTRADICTION, "9 Physics checks", "All checks hold"),
    "results-wanted": Cut(RESULTS, "Forecasts", "The Nissan was moving forward", page="What a run reports"),
    "results": Cut(RESULTS, "Results of the simulation", "Lost to errors"),
    "rejected": Cut(RESULTS, "Filters: a trial is accepted", "82"),
    "charts": Cut(RESULTS, "Forecast charts of the accepted trials", "from 22.021"),
    "curves": Cut(RESULTS, "Overlay of forecasts in mph", "Figure 5", below=10),
    "statistics": Cut(RESULTS, "Chevrolet delta-V", "25 %", page="Statistics of the accepted trials"),
    "certainty": Cut(RESULTS, "Certainty", "above 6.1 mph"),
    "own-range": Cut(RESULTS, "Certainty of a range of your own", "ends belong to the range", below=90),
    "scatter": Cut(RESULTS, "Chevrolet delta-V and Nissan delta-V", "Scatter chart 2", below=14),
    "assumptions": Cut(RESULTS, "Assumptions", "Table 1. Breadth", page="What this shows", below=1),
    "sensitivity": Cut(RESULTS, "Sensitivity: what the answers depend on", "Nissan delta-V (mph)", below=-14),
    "filter-limits": Cut(RESULTS, "Filter limits: how the answers move", "shares of trials accepted", below=142),
    "record": Cut(RESULTS, "Record of the run", "Lost to errors", below=0),
}
"""Picture -> where it is cut from."""


@dataclass(frozen=True, slots=True)
class Word:
    """A word on a page, with its top and bottom in points."""

    text: str
    top: float
    bottom: float


def make(folder: Path) -> list[Path]:
    """Write every picture into `folder`; the paths written are returned."""
    folder.mkdir(exist_ok=True)
    with TemporaryDirectory() as name:
        work = Path(name)
        _write_books(work)
        pages = {book: _printed(work / book) for book in (RESULTS, CONTRADICTION)}
        return [_picture(cut, *pages[cut.book], folder / f"{name}.png") for name, cut in CUTS.items()]


def _write_books(folder: Path) -> None:
    run = xlmc.load(CASE).simulate()
    run.save(folder / RESULTS)
    sheet, cell, value = WRONG_ANGLE
    book = openpyxl.load_workbook(CASE)
    book[sheet][cell] = value
    book.save(folder / CONTRADICTION)


def _printed(book: Path) -> tuple[Path, list[list[Word]]]:
    """The workbook as PDF, and the words of each of its pages."""
    fonts = book.with_name("fonts.conf")
    fonts.write_text(_FONTS, encoding="utf-8")
    profile = f"-env:UserInstallation={book.with_name('profile').as_uri()}"
    command = ["soffice", profile, "--headless", "--convert-to", "pdf", "--outdir", str(book.parent), str(book)]
    subprocess.run(command, check=True, capture_output=True, env=os.environ | {"FONTCONFIG_FILE": str(fonts)})
    pdf = book.with_suffix(".pdf")
    boxes = subprocess.run(["pdftotext", "-bbox", str(pdf), "-"], check=True, capture_output=True, text=True).stdout
    return pdf, [list(_words(page)) for page in boxes.split("<page ")[1:]]


def _words(page: str) -> Iterator[Word]:
    for top, bottom, text in re.findall(r'<word [^>]*yMin="([\d.]+)"[^>]*yMax="([\d.]+)">(.*?)</word>', page):
        if float(top) > _HEADER:
            yield Word(unescape(text), float(top), float(bottom))


def _find(words: list[Word], text: str) -> Word | None:
    """The first word of the first place that begins as `text` does."""
    length = len(text.split())
    for at, word in enumerate(words):
        if " ".join(each.text for each in words[at : at + length]).startswith(text):
            return word
    return None


def _picture(cut: Cut, pdf: Path, pages: list[list[Word]], path: Path) -> Path:
    for number, words in enumerate(pages, 1):
        begins = _find(words, cut.first)
        if begins is None or (cut.page and _find(words, cut.page) is None):
            continue
        below = [word for word in words if word.top > begins.top + 1]
        ends = _find(below, cut.last)
        if ends is None:
            raise SystemExit(f"{path.stem}: {cut.last!r} does not stand below {cut.first!r} on page {number}")
        _save(_rendered(pdf, number), begins.top - _MARGIN, ends.bottom + cut.below, path)
        return path
    raise SystemExit(f"{path.stem}: no page has {cut.first!r}")


def _rendered(pdf: Path, number: int) -> Image.Image:
    out = pdf.with_name(f"page-{number}")
    pages = ["-f", str(number), "-l", str(number), "-singlefile"]
    subprocess.run(["pdftoppm", "-r", str(_DPI), *pages, "-png", str(pdf), str(out)], check=True)
    with Image.open(out.with_suffix(".png")) as image:
        return image.convert("RGB")


def _save(page: Image.Image, top: float, bottom: float, path: Path) -> None:
    """Save the part of a page between two heights, in points, without the white at its sides."""
    scale = _DPI / _POINTS
    part = page.crop((0, int(top * scale), page.width, int(bottom * scale)))
    left, _, right, _ = ImageChops.difference(part, Image.new("RGB", part.size, "white")).getbbox()
    margin = int(_MARGIN * scale)
    part = part.crop((max(left - margin, 0), 0, min(right + margin, part.width), part.height))
    part.quantize(_COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


if __name__ == "__main__":
    for path in make(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER):
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")
