"""Which workbooks xlmc cannot read by itself, and LibreOffice converts: `.xls`, `.xlsb`, `.ods`."""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from typing import Final

__all__ = ["FORMATS", "ODS", "XLS", "XLSB", "OtherFormat", "is_encrypted_package", "other_format"]


@dataclass(frozen=True, slots=True)
class OtherFormat:
    """A kind of workbook that LibreOffice converts.

    Attributes:
        noun: with its article and its ending, for messages.
        ending: of its files.
        saved: who saved the values of formulas, "what Excel saved".
        program: that saved them; empty where several write such files.
        hint: what to do where LibreOffice cannot help.
    """

    noun: str
    ending: str
    saved: str
    program: str
    hint: str

    @property
    def name(self) -> str:
        """The noun with "the": `the old Excel workbook (.xls)`."""
        return f"the {self.noun.partition(' ')[2]}"


XLS: Final = OtherFormat(
    "an old Excel workbook (.xls)",
    ".xls",
    "what Excel saved",
    "Excel",
    "Open it in Excel and save it as an Excel Workbook (.xlsx); if it was made with Crystal Ball, load Crystal Ball "
    "first, or its definitions are lost",
)
XLSB: Final = OtherFormat(
    "a binary Excel workbook (.xlsb)",
    ".xlsb",
    "what Excel saved",
    "Excel",
    "Open it in Excel and save it as an Excel Workbook (.xlsx)",
)
ODS: Final = OtherFormat(
    "an OpenDocument spreadsheet (.ods)",
    ".ods",
    "the values saved in it",
    "",
    "Open it in LibreOffice or Excel and save it as an Excel Workbook (.xlsx)",
)
FORMATS: Final = (XLS, XLSB, ODS)

_OLE: Final = bytes.fromhex("D0CF11E0A1B11AE1")
_ENCRYPTED_STREAM: Final = "EncryptedPackage".encode("utf-16-le")
_OPEN_DOCUMENT: Final = b"application/vnd.oasis.opendocument.spreadsheet"
_BINARY_PART: Final = "xl/workbook.bin"


def other_format(data: bytes) -> OtherFormat | None:
    """Return the format of a file that LibreOffice converts; otherwise None."""
    if data.startswith(_OLE):
        return None if is_encrypted_package(data) else XLS
    if not data.startswith(b"PK"):
        return None
    if data[30:38] == b"mimetype" and _OPEN_DOCUMENT in data[:256]:
        return ODS
    return XLSB if _BINARY_PART.encode() in data and _BINARY_PART in _names(data) else None


def is_encrypted_package(data: bytes) -> bool:
    """Whether a file is a new workbook with a password, which looks like an old one."""
    return data.startswith(_OLE) and _ENCRYPTED_STREAM in data


def _names(data: bytes) -> list[str]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as package:
            return package.namelist()
    except Exception:  # damaged in any of zipfile's ways: whoever reads the file says how
        return []
