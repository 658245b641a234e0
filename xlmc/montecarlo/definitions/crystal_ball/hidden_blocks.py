"""The blocks of objects that Crystal Ball hides in a workbook's drawings, unpacked.

A block is a script text: each character holds two hexadecimal digits; the digits are a zlib stream, and this is a
stream of objects. A damaged block costs itself alone, a damaged object only that object.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, field
from typing import Any, Final

from xlmc.excel.workbook.hidden_scripts import DamagedDrawing, hidden_scripts
from xlmc.excel.workbook.structure import read_structure
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.crystal_ball.object_stream import StreamError, read_stream
from xlmc.montecarlo.definitions.crystal_ball.stored_objects import Stored, StoredError, stored_object, stored_objects
from xlmc.montecarlo.number_text import count_text

__all__ = ["Blocks", "Damage", "read_blocks", "unpacked"]

_BLOCK: Final = re.compile(r"CB_Block_[0-9.]+(:[0-9]+)?")
_PREFERENCES: Final = "CB_Block_0"
_DIGITS: Final = re.compile(rb"(?:[0-9a-f]{2})*")

_LARGEST: Final = 16 << 20
"""Bytes of a block; genuine ones have 5 to 45 kB."""


@dataclass(frozen=True, slots=True)
class Damage:
    """A block, or an object of one, that cannot be read."""

    sheet: str
    shape: str
    reason: str

    def __str__(self) -> str:
        return f"the block {self.shape} of the sheet {self.sheet!r} is damaged: {self.reason}"


@dataclass(slots=True)
class Blocks:
    """What the blocks of a workbook hold.

    Attributes:
        objects: with the sheet of their block.
        damages: what cannot be read.
        present: whether there is a block at all, also one without objects.
    """

    objects: list[tuple[str, Stored]] = field(default_factory=list)
    damages: list[Damage] = field(default_factory=list)
    present: bool = False


def read_blocks(workbook: Workbook) -> Blocks:
    """Every block of a workbook, sheet by sheet."""
    blocks = Blocks()
    parts = workbook.parts or workbook.origin
    for script in hidden_scripts(parts, read_structure(parts)):
        if isinstance(script, DamagedDrawing):
            blocks.damages.append(Damage(script.sheet, "in its drawing", script.reason))
        elif script.shape.startswith("CB_Block"):
            blocks.present = True
            if script.shape != _PREFERENCES:
                _read_block(script.sheet, script.shape, script.text, blocks)
    return blocks


def _read_block(sheet: str, shape: str, text: str, blocks: Blocks) -> None:
    try:
        if not _BLOCK.fullmatch(shape):
            raise StoredError("its name is not that of a block")
        things = stored_objects(unpacked(text))
    except (StreamError, StoredError) as error:
        blocks.damages.append(Damage(sheet, shape, str(error)))
        return
    for thing in things:
        try:
            blocks.objects.append((sheet, stored_object(thing)))
        except StoredError as error:
            blocks.damages.append(Damage(sheet, shape, str(error)))


def unpacked(text: str) -> Any:
    """Return the root object of a block.

    Raises:
        StreamError: the text is not what it must be.
    """
    digits = text.strip().encode("utf-16-be", "surrogatepass")
    if not _DIGITS.fullmatch(digits):
        raise StreamError("its text is not made of hexadecimal digits")
    packed = zlib.decompressobj()
    try:
        data = packed.decompress(bytes.fromhex(digits.decode()), _LARGEST)
    except zlib.error as error:
        raise StreamError(f"it cannot be inflated ({error})") from None
    if not packed.eof:
        raise StreamError(
            "it is cut short" if not packed.unconsumed_tail else f"it is larger than {count_text(_LARGEST)} bytes"
        )
    if packed.unused_data:
        raise StreamError("something follows its compressed data")
    return read_stream(data)
