"""What may be written where: a file is replaced only where it is xlmc's own of the same workbook, and untouched."""

from __future__ import annotations

import hashlib
import os
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import FORMATS, other_format
from xlmc.excel.workbook.package import WORKBOOKS
from xlmc.excel.workbook.printable import label
from xlmc.excel.workbook.seal import ENDINGS, read_seal
from xlmc.excel.workbook.writer import TakenError, check_folder, refuse_if_open

__all__ = [
    "Target",
    "copy_ending",
    "free_target",
    "is_same_file",
    "refuse_existing",
    "refuse_folder",
    "refuse_into_other_format",
    "refuse_into_source",
    "refuse_other_copy",
    "refuse_other_ending",
    "refuse_read",
    "refuse_same_file",
    "same_name",
    "unused_path",
]

_SEALED = (*WORKBOOKS, *ENDINGS)


@dataclass(frozen=True, slots=True)
class Target:
    """A file that is to be written.

    Attributes:
        path: where to.
        book: the name of the workbook whose results it is to hold; empty where it holds none.
        overwrite: replace whatever file is there, but for those that are read.
        untouched: contents that xlmc hands out, and may replace too, such as templates.
        read: the files that are read, such as the workbook: none of them is ever replaced, by whatever name.
    """

    path: Path
    book: str
    overwrite: bool = False
    untouched: Iterable[Path] = field(default=())
    read: Sequence[Path] = ()

    def check(self) -> None:
        """Refuse what must not or cannot be written; nothing is touched. To be asked before a run, and when writing.

        Raises:
            TakenError: the file is not ours to replace, is one that is read, or a program has it open.
            WorkbookError: there is no folder, or the folder may not be written to.
        """
        refuse_read(self.path, self.read)
        check_folder(self.path)
        if self.path.suffix.casefold() in WORKBOOKS:
            refuse_if_open(self.path)
        reason = None if self.overwrite else self.foreign
        if reason is not None:
            hint = "Name another file, or replace it with --overwrite (in Python: overwrite=True)"
            raise TakenError(f"the file exists already, and {reason}", where=self.path, hint=hint)

    @property
    def foreign(self) -> str | None:
        """Why xlmc must not replace the file; None if it may, or if there is no file."""
        if not self.path.exists():
            return None
        ending = self.path.suffix.casefold()
        try:
            if any(self.path.read_bytes() == each.read_bytes() for each in self.untouched):
                return None
            seal = read_seal(self.path)
        except OSError as error:
            return f"cannot be read ({error.strerror or error})"
        if seal is None and ending not in _SEALED:
            return f"xlmc cannot tell who wrote a {ending or 'file without ending'}"
        if seal is None and not self.book:
            return "it may hold work of yours"  # copies of workbooks bear no mark, whoever wrote them
        if seal is None:
            return "xlmc did not write it, or another program has saved it since"
        if not same_name(seal.book, self.book):
            return f"it holds results of {seal.book!r}" + (f", not of {self.book!r}" if self.book else "")
        return None if seal.whole else "it was changed since xlmc wrote it"


def free_target(path: Path, book: str, *, after: Path | None = None) -> tuple[Path, str | None]:
    """Choose the path, or the first of `…-2`, `…-3`, … that is free or ours, and say why not the path itself.

    Args:
        path: the name that is wanted.
        book: the name of the workbook whose results it is to hold.
        after: a name that is not to be had, though it may look free.

    Raises:
        WorkbookError: there is no folder, or the folder may not be written to.
    """
    reason = None
    for each in _numbered(path):
        if each == after:
            continue
        try:
            Target(each, book).check()
        except TakenError as taken:
            reason = reason or taken.message
        else:
            return each, reason
    raise AssertionError("numbers do not end")


def unused_path(path: Path) -> Path:
    """Choose the path, or the first of `…-2`, `…-3`, … where nothing is."""
    return next(each for each in _numbered(path) if not (each.exists() or each.is_symlink()))


def refuse_read(path: Path, read: Iterable[Path], hint: str = "Name another file") -> None:
    """Refuse to replace a file that is read, also by a link to it.

    Raises:
        TakenError: it is one.
    """
    if any(is_same_file(path, each) for each in read):
        raise TakenError("this is the file that is read", where=path, hint=hint)


def refuse_existing(path: Path) -> None:
    """Refuse to replace a file that was made since an unused path was looked for.

    Raises:
        TakenError: there is one.
    """
    if path.exists():
        raise TakenError("the file exists already", where=path, hint="Try again")


def copy_ending(source: Path) -> str:
    """Return the ending of what is written of a workbook: its own, and `.xlsx` of an `.xls`, `.xlsb` or `.ods`."""
    return ".xlsx" if source.suffix.casefold() in {each.ending for each in FORMATS} else source.suffix


def refuse_other_copy(path: Path, source: Path, what: str = "a copy", beside: str = "") -> None:
    """Refuse an ending that is not that of a workbook's copies, and a folder.

    Excel opens no file whose ending says that it has macros when it has none, or the other way round.

    Args:
        path: where the copy is to go.
        source: the workbook.
        what: is to be written, for the message.
        beside: further words of the hint.

    Raises:
        WorkbookError: the ending is another, or the path leads to a folder.
    """
    ending = copy_ending(source)
    if path.suffix.casefold() != ending.casefold():
        refuse_folder(path)
        hint = f"Name it {path.with_suffix(ending).name!r}{beside}"
        raise WorkbookError(f"{what} of a {source.suffix} workbook must end in {ending}", where=path, hint=hint)


def refuse_into_other_format(path: Path) -> None:
    """Refuse to write into a workbook in another format (`.xls`, `.xlsb`, `.ods`), whatever it is called.

    Raises:
        WorkbookError: it is one.
    """
    form = other_format(path.read_bytes())
    if form is not None:
        hint = "Name another file, which ends in .xlsx; or save the workbook as .xlsx"
        raise WorkbookError(f"this is {form.noun}, and xlmc does not write into it", where=path, hint=hint)


def refuse_into_source(path: Path, sha256: str, hint: str) -> None:
    """Refuse to write into a workbook that was read, where that cannot be done or something would be lost.

    Args:
        path: of the workbook.
        sha256: of the file as it was read.
        hint: what to do where it has changed since.

    Raises:
        TakenError: a program has it open, or it has changed since it was read.
        WorkbookError: it is a workbook in another format (`.xls`, `.xlsb`, `.ods`).
    """
    refuse_into_other_format(path)
    refuse_if_open(path)
    if hashlib.sha256(path.read_bytes()).hexdigest() != sha256:
        raise TakenError("the workbook has changed since it was read", where=path, hint=hint)


def refuse_same_file(outputs: Iterable[Path]) -> None:
    """Refuse two outputs that are one file, also by links or, on Windows and macOS, by names in another case.

    Raises:
        WorkbookError: two are.
    """
    seen: dict[str, Path] = {}
    for path in outputs:
        for other in seen.values():
            if is_same_file(path, other):
                raise _twice(path, other)
        key = unicodedata.normalize("NFC", os.path.realpath(path)).casefold()
        if key in seen:
            raise _twice(path, seen[key])
        seen[key] = path


def refuse_other_ending(path: Path, endings: Sequence[str], noun: str = "") -> None:
    """Refuse an output whose ending says none of the kinds of file that are written.

    Args:
        path: the output.
        endings: those that are written, the usual one first.
        noun: the only kind that is written.

    Raises:
        WorkbookError: the ending is another, or the path leads to a folder.
    """
    refuse_folder(path)
    ending = path.suffix.casefold()
    if ending in endings:
        return
    if noun:
        hint = f"Name it '{label(path.stem) or 'results'}{endings[0]}'"
        raise WorkbookError(f"{noun} must end in {' or '.join(endings)}", where=path, hint=hint)
    message = (
        f"this command writes no file that ends in {label(ending)}" if ending else "the name of the file has no ending"
    )
    raise WorkbookError(message, where=path, hint=f"The ending says what is written: {', '.join(endings)}")


def refuse_folder(path: Path) -> None:
    """Refuse a folder where a file is to be written.

    Raises:
        WorkbookError: the path leads to one.
    """
    if os.path.isdir(path):
        raise WorkbookError("this is a folder, not a file", where=path, hint="Name a file")


def is_same_file(path: Path, other: Path) -> bool:
    """Whether two paths lead to one file, also by links; not where either is missing or may not be looked at."""
    try:
        return path.samefile(other)
    except (OSError, ValueError):  # what must be written or read says why it cannot be
        return False


def same_name(first: str, second: str) -> bool:
    """Whether two names of files are one on systems that ignore case: `Book.xlsx` and `book.XLSX`.

    Either may be given as the workbook knows it, which writes characters that steer a screen as Python does.
    """
    folded = [unicodedata.normalize("NFC", label(name)).casefold() for name in (first, second)]
    return folded[0] == folded[1]


def _numbered(path: Path) -> Iterator[Path]:
    yield path
    number = 2
    while True:
        yield path.with_name(f"{path.stem}-{number}{path.suffix}")
        number += 1


def _twice(path: Path, other: Path) -> WorkbookError:
    also = "" if str(path) == str(other) else f" (as {str(other)!r})"
    hint = "Give each output a name of its own; Windows and macOS do not tell capitals from small letters"
    return WorkbookError(f"two outputs would be written to this file{also}", where=path, hint=hint)
