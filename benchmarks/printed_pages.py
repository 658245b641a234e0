"""How many pages every shipped book takes on paper: `python benchmarks/printed_pages.py`.

Each book is run by the command, which writes the result workbook and the report. LibreOffice prints the workbook,
without its charts, on which no page depends, and with `--word` the report for Word; poppler counts. Names of books
limit it to these; `--sheets` adds the pages of each sheet. The bars: a result workbook prints on 25 pages at most, the
case study on 15, and a report has 5 to 10 pages. Exit code 1 says that a book is beyond a bar.

How wide columns are, and how large letters print, depends on the fonts there are: Excel has Calibri, and a machine
without letters as wide as its (Carlito) prints smaller ones. With `--fonts FOLDER` the workbooks are printed once more,
as if the fonts in FOLDER/fonts were installed.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from zipfile import ZipFile

__all__ = ["BOOKS", "CASE_STUDY", "Pages", "beyond", "counted", "main", "table"]

_HERE = Path(__file__).resolve().parents[1]
BOOKS = {path.stem: path for folder in ("templates", "examples") for path in sorted((_HERE / folder).glob("*.xlsx"))}
CASE_STUDY = "intersection"

MOST, MOST_OF_CASE = 25, 15
"""Pages of a result workbook."""
REPORT = range(5, 11)
"""Pages of a report."""

_AT_ONCE = 8
"""Files that LibreOffice prints in one call; it takes longer to start than to print a small one."""


@dataclass(frozen=True, slots=True)
class Pages:
    """Pages of what is made of a book.

    Attributes:
        workbooks: the printed workbook by sheet, with the fonts of the machine, then with further ones.
        report: the report as PDF.
        word: the report for Word; None where it was not printed.
    """

    workbooks: tuple[Counter[str], ...]
    report: int
    word: int | None = None


def counted(
    names: Sequence[str], folder: Path, *, trials: int, fonts: Path | None = None, word: bool = False
) -> dict[str, Pages]:
    """Run the books of these names and return their pages, by name.

    Args:
        names: of `BOOKS`.
        folder: where all files go.
        trials: of each run.
        fonts: a folder with a folder `fonts`, whose fonts LibreOffice is to have too.
        word: whether the report for Word is printed, too.
    """
    books, reports = [], []
    for name in names:
        files = [folder / f"{name}{end}" for end in (".xlsx", ".pdf", *["-word.docx"] * word)]
        outputs = [part for file in files for part in ("-o", str(file))]
        run = [sys.executable, "-m", "xlmc", "-q", "simulate", str(BOOKS[name]), "-n", str(trials), *outputs]
        done = subprocess.run([*run, "--overwrite"], check=False, capture_output=True, text=True)
        if not all(file.exists() for file in files):
            raise SystemExit(f"{name}: {done.stderr or done.stdout}")
        books.append(_without_charts(files[0], folder / "bare"))
        reports += files[2:]
    printed = [_print([*books, *reports], folder / "printed")]
    if fonts is not None:
        printed.append(_print(books, folder / "printed with fonts", {"XDG_DATA_HOME": str(fonts)}))
    return {
        name: Pages(
            tuple(_by_sheet(pdfs / f"{name}.pdf") for pdfs in printed),
            _count(folder / f"{name}.pdf"),
            _count(printed[0] / f"{name}-word.pdf") if word else None,
        )
        for name in names
    }


def _without_charts(book: Path, folder: Path) -> Path:
    """Write a workbook of the same name without its charts, which take most of the time to print."""
    folder.mkdir(exist_ok=True)
    bare = folder / book.name
    with ZipFile(book) as whole, ZipFile(bare, "w") as package:
        for name in whole.namelist():
            part = whole.read(name)
            if name.startswith("xl/worksheets/sheet"):
                part = re.sub(rb"<drawing r:id=[^>]*/>", b"", part)
            package.writestr(name, part)
    return bare


def _print(files: Sequence[Path], to: Path, own: Mapping[str, str] | None = None) -> Path:
    """Print files into a folder, which is returned, with a profile and variables of one's own."""
    profile = f"-env:UserInstallation={(to.parent / f'profile of {to.name}').as_uri()}"
    for first in range(0, len(files), _AT_ONCE):
        some = map(str, files[first : first + _AT_ONCE])
        command = ["soffice", profile, "--headless", "--convert-to", "pdf", "--outdir", str(to), *some]
        subprocess.run(command, check=True, capture_output=True, env={**os.environ, **(own or {})})
    return to


def _count(pdf: Path) -> int:
    shown = subprocess.run(["pdfinfo", str(pdf)], check=True, capture_output=True, text=True).stdout
    (count,) = re.findall(r"^Pages: +(\d+)$", shown, re.MULTILINE)
    return int(count)


def _by_sheet(pdf: Path) -> Counter[str]:
    """Return the pages of each sheet that is named in the foot, and of the others, those of the book, together."""
    shown = subprocess.run(["pdftotext", "-layout", str(pdf), "-"], check=True, capture_output=True, text=True).stdout
    feet = re.findall(r"^ *\S+\.xlsx +(.*?) *Page \d+ of \d+", shown, re.MULTILINE)
    return Counter(foot or "of the book" for foot in feet)


def beyond(name: str, pages: Pages) -> list[str]:
    """Return what is more or less than it may be, in words."""
    most = MOST_OF_CASE if name == CASE_STUDY else MOST
    counts = [each.total() for each in pages.workbooks]
    result = [f"{name} prints on {count} pages, of {most} at most" for count in counts if count > most]
    if pages.report not in REPORT:
        result.append(f"the report of {name} has {pages.report} pages, not {REPORT[0]} to {REPORT[-1]}")
    return result


def table(result: dict[str, Pages], *, sheets: bool = False) -> str:
    """Return the counts as a table in Markdown."""
    further = max((len(pages.workbooks) for pages in result.values()), default=1) - 1
    word = any(pages.word is not None for pages in result.values())
    heads = ["workbook, pages", *["with the fonts"] * further, "report, pages", *["Word, pages"] * word]
    lines = [f"| book | {' | '.join(heads)} |", f"|---|{'---:|' * len(heads)}"]
    for name, pages in result.items():
        counts = [*(each.total() for each in pages.workbooks), pages.report, *[pages.word] * word]
        lines.append(f"| {name} | {' | '.join(map(str, counts))} |")
        if sheets:
            names = dict.fromkeys(sheet for each in pages.workbooks for sheet in each)
            rows = ((sheet, " | ".join(str(each[sheet]) for each in pages.workbooks)) for sheet in names)
            lines += [f"| … {sheet} | {counts} |{' |' * (1 + word)}" for sheet, counts in rows]
    return "\n".join(lines)


def main() -> None:
    """Count, print the table, and say what is beyond the bars."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of a book; by default all templates and examples")
    parser.add_argument("--trials", type=int, default=20_000, help="of each run; default 20,000")
    parser.add_argument("--fonts", type=Path, metavar="FOLDER", help="print once more with those in FOLDER/fonts")
    parser.add_argument("--word", action="store_true", help="print the reports for Word, too")
    parser.add_argument("--sheets", action="store_true", help="add the pages of each sheet")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="leave all files in this folder")
    options = parser.parse_args()
    if unknown := set(options.names) - set(BOOKS):
        parser.error(f"there is no book {', '.join(sorted(unknown))}; there are {', '.join(BOOKS)}")
    if lacking := [each for each in ("soffice", "pdfinfo", "pdftotext") if shutil.which(each) is None]:
        raise SystemExit(f"It needs {', '.join(lacking)}: install LibreOffice and poppler.")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) if options.keep is None else options.keep.resolve()
        folder.mkdir(parents=True, exist_ok=True)
        result = counted(
            options.names or list(BOOKS), folder, trials=options.trials, fonts=options.fonts, word=options.word
        )
    print(table(result, sheets=options.sheets))
    found_beyond = [line for name, pages in result.items() for line in beyond(name, pages)]
    print("\n".join(["", *found_beyond]) if found_beyond else "\nAll books are within the bars.")
    raise SystemExit(bool(found_beyond))


if __name__ == "__main__":
    main()
