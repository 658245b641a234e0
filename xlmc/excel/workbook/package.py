"""The zip package of a workbook: its parts, how they refer to each other, and their fingerprint.

A part is a file in the zip; a relationship is one part's named pointer to another. The file is untrusted, so every
size is bounded before anything is unpacked, and a name that could mean two things is refused.
"""

from __future__ import annotations

import hashlib
import io
import posixpath
import re
import struct
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from urllib.parse import unquote

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import is_encrypted_package, other_format
from xlmc.excel.workbook.safe_xml import REPAIR, tree

__all__ = [
    "CONTENT_TYPES",
    "LIMITS",
    "SAVE_AS",
    "SMALLER",
    "WORKBOOKS",
    "Limits",
    "Relationship",
    "content_type",
    "folded_names",
    "hash_parts",
    "read_parts",
    "relationships",
    "relative_target",
    "rels_part",
    "stored_part",
    "unpacked",
]

SAVE_AS = "Open it in Excel and save it as an Excel Workbook (.xlsx)"
SMALLER = "Remove from it what the model does not need"

CONTENT_TYPES = "[Content_Types].xml"

WORKBOOKS = (".xlsx", ".xlsm", ".xltx", ".xltm")
"""Endings of workbooks that are packages: plain ones, with macros, and their templates."""

_ZIP = b"PK"
_MARKUP = re.compile(rb"<(!doctype|html|\?xml|table|head|meta)")
_ENCRYPTED_FLAG = 0x1
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
# What zipfile raises on a damaged file.
_DAMAGE = (zipfile.BadZipFile, zlib.error, struct.error, EOFError, OSError, OverflowError, RuntimeError, ValueError)


@dataclass(frozen=True, slots=True)
class Limits:
    """How much xlmc unpacks. Sizes are bytes; `ratio` is unpacked to packed size, for parts over `ratio_from`."""

    entries: int = 10_000
    part: int = 128 << 20
    total: int = 512 << 20
    ratio: int = 250
    ratio_from: int = 16 << 20


LIMITS = Limits()


@dataclass(frozen=True, slots=True)
class Relationship:
    """A part's pointer to `target`: another part by name, or an address outside the package where `external`."""

    type: str
    target: str
    external: bool = False

    @property
    def kind(self) -> str:
        """The last word of the type (`worksheet`, `table`): the same in transitional and strict files."""
        return self.type.rpartition("/")[2]


def read_parts(data: bytes, limits: Limits = LIMITS) -> dict[str, bytes]:
    """Every part of the package in its order, name -> bytes.

    Raises:
        WorkbookError: not a zip, encrypted, damaged, larger than the limits, or with a name no package may hold; or a
            workbook in another format.
    """
    _check_container(data)
    return unpacked(data, limits)


def unpacked(data: bytes, limits: Limits = LIMITS) -> dict[str, bytes]:
    """Every part of a zip in its order, name -> bytes, whatever it holds.

    Raises:
        WorkbookError: damaged, larger than the limits, or with a name no package may hold.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as package:
            entries = [entry for entry in package.infolist() if not entry.filename.endswith(("/", "\\"))]
            names = {entry.filename: _with_slashes(entry.filename) for entry in entries}
            _check_entries(entries, limits)
            return {names[entry.filename]: _unpack(package, entry) for entry in entries}
    except _DAMAGE as error:
        reason = str(error) or "it ends too early"
        raise WorkbookError(f"the file is damaged ({reason})", hint="Fetch or copy it again") from error


def relationships(
    parts: Mapping[str, bytes], part: str = "", names: Mapping[str, str] | None = None
) -> dict[str, Relationship]:
    """Return the relationships of one part by their id; those of the package itself for `""`. None if it has no rels
    part.

    Targets are names as in `parts`, also where the file writes them in another case; a target that does not exist
    is given as the file means it.

    Args:
        parts: of the package.
        part: whose relationships.
        names: `folded_names(parts)`, for callers that ask for many parts.

    Raises:
        WorkbookError: the rels part is not XML.
    """
    rels = stored_part(parts, rels_part(part), names)
    if rels is None:
        return {}
    folder = posixpath.join("/", posixpath.dirname(part))
    pointers = dict(_pointers(parts[rels], rels, folder))
    if all(meant.external or meant.target in parts for meant in pointers.values()):
        return pointers
    stored = folded_names(parts) if names is None else names
    return {pointer: _in_package(stored, meant) for pointer, meant in pointers.items()}


def content_type(parts: Mapping[str, bytes], part: str) -> str:
    """Return the content type that the package gives to one part by its name; empty where it gives none.

    Raises:
        WorkbookError: the part that holds the content types is not XML.
    """
    if CONTENT_TYPES not in parts:
        return ""
    named = tree(parts[CONTENT_TYPES], CONTENT_TYPES).findall("{*}Override")
    result = (
        each.get("ContentType", "") for each in named if each.get("PartName", "").casefold() == f"/{part}".casefold()
    )
    return next(result, "")


def relative_target(source: str, target: str) -> str:
    """How one part points to another: `xl/workbook.xml, xl/styles.xml -> styles.xml`."""
    return posixpath.relpath(f"/{target}", posixpath.dirname(f"/{source}"))


def rels_part(part: str) -> str:
    """`xl/workbook.xml -> xl/_rels/workbook.xml.rels`; `"" -> _rels/.rels`."""
    folder, name = posixpath.split(part)
    return posixpath.join(folder, "_rels", f"{name}.rels")


def folded_names(parts: Mapping[str, bytes]) -> dict[str, str]:
    """Return the names of all parts by their folded names: part names match whatever their case."""
    return {name.casefold(): name for name in parts}


def stored_part(parts: Mapping[str, bytes], name: str, names: Mapping[str, str] | None = None) -> str | None:
    """Return the name of a part as the package writes it; see `relationships`."""
    if name in parts:
        return name
    folded = name.casefold()
    if names is not None:
        return names.get(folded)
    return next((stored for stored in parts if stored.casefold() == folded), None)


def hash_parts(parts: Mapping[str, bytes]) -> str:
    """SHA-256 of exactly these parts, whatever their order and packing, as lower-case hex.

    In the order of their names' UTF-8 bytes, each part contributes its name, a zero byte, its length as eight
    big-endian bytes, and its content.
    """
    digest = hashlib.sha256()
    for name, content in sorted((name.encode(), content) for name, content in parts.items()):
        digest.update(name + b"\0" + len(content).to_bytes(8, "big"))
        digest.update(content)
    return digest.hexdigest()


def _check_container(data: bytes) -> None:
    if is_encrypted_package(data):
        raise WorkbookError("the workbook is encrypted", hint="Remove its password in Excel (File > Info) and save it")
    form = other_format(data)
    if form is not None:
        raise WorkbookError(f"the file is {form.noun}", hint=form.hint)
    if not data:
        raise WorkbookError("the file is empty", hint="Fetch or copy it again")
    if not data.startswith(_ZIP):
        if _MARKUP.match(data[:1_024].lstrip(b"\xef\xbb\xbf \t\r\n").lower()):
            raise WorkbookError("the file is a web page or another XML file, not an Excel workbook", hint=SAVE_AS)
        if b"\0" not in data[:4_096]:
            raise WorkbookError("the file is plain text (such as .csv), not an Excel workbook", hint=SAVE_AS)
        raise WorkbookError("the file is not an Excel workbook (.xlsx or .xlsm)", hint=SAVE_AS)


def _check_entries(entries: list[zipfile.ZipInfo], limits: Limits) -> None:
    if len(entries) > limits.entries:
        raise WorkbookError(f"the file holds {len(entries):,} parts; xlmc reads up to {limits.entries:,}", hint=SMALLER)
    seen: set[str] = set()
    for entry in entries:
        _check_name(_with_slashes(entry.filename), seen)
        _check_size(entry, limits)
    if sum(entry.file_size for entry in entries) > limits.total:
        raise WorkbookError(f"the file unpacks to more than {limits.total >> 20} MB", hint=SMALLER)


def _with_slashes(name: str) -> str:
    """Return the name of a part: some programs on Windows write backslashes, which Excel reads as slashes."""
    return name.replace("\\", "/")


def _check_name(name: str, seen: set[str]) -> None:
    folded = name.casefold()
    if folded in seen:
        raise WorkbookError(f"the file holds the part {name!r} twice", hint=REPAIR)
    if not all(name.split("/")) or {".", ".."} & set(name.split("/")):
        raise WorkbookError(f"the file holds a part with the unsafe name {name!r}", hint=REPAIR)
    seen.add(folded)


def _check_size(entry: zipfile.ZipInfo, limits: Limits) -> None:
    name, size = entry.filename, entry.file_size
    if entry.flag_bits & _ENCRYPTED_FLAG:
        raise WorkbookError(f"the part {name!r} is encrypted", hint="Pack the file again without a password")
    if entry.compress_type not in _METHODS:
        raise WorkbookError(f"the part {name!r} is packed in a way Excel does not use", hint=REPAIR)
    if size > limits.part:
        raise WorkbookError(f"the part {name!r} unpacks to more than {limits.part >> 20} MB", hint=SMALLER)
    if size > limits.ratio_from and size > limits.ratio * entry.compress_size:
        raise WorkbookError(
            f"the part {name!r} is packed more than {limits.ratio} times, as a zip bomb is", hint=REPAIR
        )


def _unpack(package: zipfile.ZipFile, entry: zipfile.ZipInfo) -> bytes:
    # Asked for a size, zipfile never unpacks beyond it, so a size that lies in the directory cannot exhaust memory.
    with package.open(entry) as handle:
        content = handle.read(entry.file_size)
    if len(content) != entry.file_size:
        raise zipfile.BadZipFile(f"{entry.filename} is cut short")
    return content


@lru_cache(maxsize=128)
def _pointers(xml: bytes, rels: str, folder: str) -> tuple[tuple[str, Relationship], ...]:
    """Return the pointers of a rels part by their id, with targets as it means them; one injection asks some times for
    each.

    Raises:
        WorkbookError: the part is not XML.
    """
    return tuple((e.get("Id", ""), _meant(folder, e.attrib)) for e in tree(xml, rels).findall("{*}Relationship"))


def _meant(folder: str, attributes: Mapping[str, str]) -> Relationship:
    kind, target = attributes.get("Type", ""), attributes.get("Target", "")
    if attributes.get("TargetMode") == "External":
        return Relationship(kind, target, external=True)
    return Relationship(kind, posixpath.normpath(posixpath.join(folder, target)).lstrip("/"))


def _in_package(stored: Mapping[str, str], meant: Relationship) -> Relationship:
    """Return the pointer with its target by the name that the part has, which may be percent-encoded in the pointer.

    Args:
        stored: the names of all parts, by what they are in lower case.
        meant: the pointer as its rels part has it.
    """
    if meant.external:
        return meant
    text = stored.get(meant.target.casefold()) or stored.get(unquote(meant.target).casefold())
    return meant if text is None else replace(meant, target=text)
