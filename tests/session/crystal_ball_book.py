"""Workbooks as Crystal Ball saves them, written for tests: hidden pictures with packed objects, and defined names.

    save(path, {"Sheet1": {"B2": 100, "B5": "=2*B2"}}, [Drawn("Sheet1", "$B$2", "Skid", "Normal", {...}), ...])

Objects are written as .NET's BinaryFormatter lays them out ([MS-NRBF]): each object once, in the order in which it is
met, and referred to by its number; value types inside their owner.
"""

from __future__ import annotations

import io
import math
import re
import struct
import uuid
import zipfile
import zlib
from dataclasses import dataclass, field
from xml.sax.saxutils import escape

import openpyxl
from openpyxl.comments import Comment
from openpyxl.workbook.defined_name import DefinedName

CODES = {"Normal": 3, "LogNormal": 4, "Beta": 8, "DPoisson": 18}
SLOTS = {"Normal": (3, 4), "LogNormal": (5, 6), "Beta": (3, 4, 5, 6), "DPoisson": (3,)}
HIDDEN = "CB_DATA_"
SPACES = 'xmlns:v="urn:schemas-microsoft-com:vml" xmlns:x="urn:schemas-microsoft-com:office:excel"'


@dataclass(eq=False)
class Drawn:
    """An assumption; `references` are code of a parameter -> cell, `named_by` is the cell of its name."""

    sheet: str
    cell: str
    name: str
    family: str
    parameters: dict
    cuts: dict = field(default_factory=dict)
    references: dict = field(default_factory=dict)
    named_by: str = ""
    code: int | None = None
    slots: dict | None = None
    custom: bool = False


@dataclass(eq=False)
class Asked:
    """A forecast; `prefs` are members of its preferences that are not the usual ones, by class."""

    sheet: str
    cell: str
    name: str
    units: str = ""
    named_by: str = ""
    prefs: dict = field(default_factory=dict)


@dataclass(eq=False)
class Tied:
    """A correlation; its coefficient comes from `cell`, or is typed in where that is empty."""

    sheet: str
    cell: str
    first: Drawn
    second: Drawn
    coefficient: float


@dataclass(eq=False)
class Decided:
    """A decision variable; `steps` are its ends and the step, `kind` says how its values lie."""

    sheet: str
    cell: str
    name: str
    steps: tuple[float, float, float] = (0.0, 1.0, 0.05)
    kind: int = 1


# ---------------------------------------------------------------- objects and their bytes


class Thing:
    """An object of a class: its members in order; `inside` for a value type."""

    def __init__(self, name, inside=False, **members):
        self.name, self.inside, self.members = name, inside, members


class Str(str):
    """A text that is an object of its own."""

    __slots__ = ()


def stream(root):
    """The bytes of a graph of things, lists, texts, numbers and None."""
    out, numbers, queue, classes = bytearray(struct.pack("<Biiii", 0, 1, -1, 1, 0)), {}, [root], {}
    keep = [root]
    numbers[id(root)] = 1
    inside = [0]

    def text(value):
        data, length = value.encode(), len(value.encode())
        while length > 127:
            out.append(length & 127 | 128)
            length >>= 7
        out.append(length)
        out.extend(data)

    def kind(value):
        for of, code in ((bool, 1), (float, 6), (int, 8)):
            if type(value) is of:
                return 0, code
        return (1 if isinstance(value, str) else 2), None

    def member(value):
        if type(value) is int:
            out.extend(struct.pack("<BBi", 8, 8, value))
            return
        if value is None:
            out.append(10)
        elif isinstance(value, Thing) and value.inside:
            inside[0] -= 1
            thing(value, inside[0])
        else:
            known = id(value) in numbers
            number = numbers.setdefault(id(value), len(numbers) + 1)
            keep.append(value)
            if isinstance(value, str) and not known:
                out.extend(struct.pack("<Bi", 6, number))
                text(value)
                return
            if not known:
                queue.append(value)
            out.extend(struct.pack("<Bi", 9, number))

    def thing(value, number):
        kinds = [kind(each) for each in value.members.values()]
        key = value.name, tuple(value.members), tuple(kinds)
        if key in classes:
            out.extend(struct.pack("<Bii", 1, number, classes[key]))
        else:
            classes[key] = number
            out.extend(struct.pack("<Bi", 4, number))
            text(value.name)
            out.extend(struct.pack("<i", len(kinds)))
            for name in value.members:
                text(name)
            out.extend(of for of, _ in kinds)
            out.extend(code for _, code in kinds if code is not None)
        for each, (of, code) in zip(value.members.values(), kinds, strict=True):
            out.extend(struct.pack("<" + {1: "?", 6: "d", 8: "i"}[code], each)) if of == 0 else member(each)

    for value in queue:
        number = numbers[id(value)]
        if isinstance(value, Thing):
            thing(value, number)
        elif value and all(type(each) is float for each in value):
            out.extend(struct.pack("<BiiB", 15, number, len(value), 6) + struct.pack(f"<{len(value)}d", *value))
        else:
            out.extend(struct.pack("<Bii", 16, number, len(value)))
            for each in value:
                member(each)
    return bytes(out + b"\x0b")


def pack(data):
    """Bytes as the script text of a picture: two hexadecimal digits a character."""
    return zlib.compress(data, 1).hex().encode().decode("utf-16-be")


# ---------------------------------------------------------------- Crystal Ball's classes


def guid(key):
    """The GUID of something, the same each time."""
    return uuid.uuid5(uuid.NAMESPACE_URL, key)


def _guid_thing(of):
    values = struct.unpack("<ihh8B", of.bytes_le)
    return Thing("System.Guid", True, **dict(zip([f"_{letter}" for letter in "abcdefghijk"], values, strict=True)))


def _list(items):
    return Thing("System.Collections.ArrayList", _items=[*items, None], _size=len(items), _version=1)


def _table(pairs):
    keys, values = [key for key, _ in pairs], [value for _, value in pairs]
    return Thing("System.Collections.Hashtable", LoadFactor=0.72, Keys=keys, Values=values)


def _enum(name, value, inside=True):
    return Thing(f"Decisioneering.CB.CBDomain.{name}", inside, value__=value)


def _class(name, **members):
    return Thing(f"Decisioneering.CB.CBObjectStore.CB7.{name}", **members)


def object_guid(item):
    return guid(f"{item.sheet} {item.cell} {type(item).__name__}")


def _wanted(item):
    """What an object takes from cells: enumeration, code, cell, GUID."""
    result = [("ParmControlId", code, cell) for code, cell in getattr(item, "references", {}).items()]
    if getattr(item, "named_by", ""):
        result.append(("AsmValueRefEnum" if isinstance(item, Drawn) else "FrcValueRefEnum", 0, item.named_by))
    if isinstance(item, Tied) and item.cell:
        result.append(("CorrelationCoefRefEnum", 0, item.cell))
    return [(*each, guid(f"{object_guid(item)} {each}")) for each in result]


def _references(item):
    rows = []
    for name, code, cell, key in _wanted(item):
        more = {"ValueRef+mGuidKey": Str(f"CBCR_{key.hex}"), "ValueRef+mAbsoluteRefersToOrRangeName": Str(f"={cell}")}
        reference = _class("ExcelCellRef", mIsRefersToARangeName=True, **more, **{"ValueRef+mFor": _enum(name, code)})
        rows.append((_enum(name, code, inside=False), reference))
    return _class("ExcelCellRefs", mGuidKeys=_table([]), mFors=_table(rows))


def _number(value):
    short = f"{value:.15G}"
    return short if float(short) == value else f"{value:.17G}"


def _thing(item):
    own = {"mExcelCellRefs": _references(item), "mGuid": _guid_thing(object_guid(item))}
    if isinstance(item, Drawn):
        words = [item.family, *(f"{key}={_number(value)}" for key, value in {**item.cuts, **item.parameters}.items())]
        slots = item.slots
        if slots is None:
            places = SLOTS.get(item.family, range(3, 3 + len(item.parameters)))
            ends = {1: item.cuts.get("LoCut", -1.11e307), 2: item.cuts.get("HiCut", 1.11e307)}
            slots = {0: 9e307, **ends, **dict(zip(places, item.parameters.values(), strict=False))}
        numbers = Thing(
            "Decisioneering.OCB.SimKernel.DstParmSet",
            b=Thing("Decisioneering.OCB.SimKernel.DstTypes", True, value__=item.code or CODES.get(item.family, 5)),
            c=[float(slot) for slot in slots],
            d=[float(value) for value in slots.values()],
            e=None,
        )
        custom = Str("x") if item.custom else None
        distribution = Thing("Decisioneering.OCB.SimKernel.Dst", DstParms=numbers, CustomData=custom)
        variable = Thing("Decisioneering.OCB.SimKernel.Asm", mDst=distribution)
        return _class(
            "AssumptionCellRef", mDstParms=Str(",".join(words)), mVarName=Str(item.name), mVar=variable, **own
        )
    if isinstance(item, Asked):
        usual = {
            "fWindowPrefs": {"fUnits": Str(item.units)},
            "fFilterPrefs": {
                "fUseFilter": False,
                "fFilterInside": False,
                "fFilterMin": -math.inf,
                "fFilterOutside": True,
                "fFilterMax": math.inf,
                "fFilterAllOnDiscard": False,
            },
            "fPrecisionPrefs": {
                "fUsePrecision": False,
                "fUseMean": True,
                "fUseStdDev": False,
                "fUsePercentile": False,
                "fUsePercentileValue": 0.95,
                "fAbsolute": True,
                "fAbsoluteUnits": 0.05,
                "fRelative": False,
                "fRelativePct": 0.05,
            },
            "fCertaintyChartPrefs": {"fCertaintyRangeMin": -math.inf, "fCertaintyRangeMax": math.inf},
        }
        space = "Decisioneering.CB.CBPrefs."
        held = {name: Thing(space + name, **{**usual[name], **item.prefs.get(name, {})}) for name in usual}
        return _class(
            "ForecastCellRef", mPreferences=Thing(space + "FrcChartPrefs", **held), mVarName=Str(item.name), **own
        )
    if isinstance(item, Decided):
        low, high, step = item.steps
        context = _table([(Str("_CustomValues"), None), (Str("_DecVarType"), item.kind)])
        variable = Thing(
            "Decisioneering.OCB.OptKernel.DecVar", a=low, b=0.25, c=high, d=step, e=-0.5, mContextData=context
        )
        return _class("DecVarCellRef", mVarName=Str(item.name), mVar=variable, **own)
    ends = {}
    for number, end in enumerate((item.first, item.second), 1):
        ends[f"mAssumption{number}WorksheetGuid"] = _guid_thing(guid(end.sheet))
        ends[f"mAssumption{number}Guid"] = _guid_thing(object_guid(end))
    return _class("CorrelationRef", **ends, mCoefficient=float(item.coefficient), **own)


def block(items):
    """The text of a block of objects."""
    return pack(stream(_list([_thing(item) for item in items])))


# ---------------------------------------------------------------- the workbook


def quoted(sheet):
    return "'" + sheet.replace("'", "''") + "'" if re.search(r"\W", sheet) else sheet


def save(path, cells, blocks, *, comments=(), names=None, hide=True, spoil=lambda shape, text: text):
    """Write a workbook with Crystal Ball's data.

    Args:
        path: of the file.
        cells: sheet -> cell -> what it holds.
        blocks: lists of objects, one a block, each of one sheet.
        comments: (sheet, cell, text): they lie in the same drawings.
        names: changes defined names: name -> what it stands for, or None to drop it.
        hide: with the hidden sheet.
        spoil: changes the texts of pictures: name, text -> text.
    """
    book = openpyxl.Workbook()
    book.remove(book.active)
    for title in [*([HIDDEN] if hide else []), *cells]:
        sheet = book.create_sheet(title)
        for address, value in cells.get(title, {}).items():
            sheet[address] = value
    if hide:
        book[HIDDEN].sheet_state, book.active = "hidden", 1
    for title, cell, text in comments:
        book[title][cell].comment = Comment(text, "Someone")
    changed = names or {}
    for title, name, refers in _names(cells, blocks):
        refers = changed.get(name, refers)
        if refers is not None:
            book[title].defined_names[name] = DefinedName(name, attr_text=refers, hidden=True)
    stream_ = io.BytesIO()
    book.save(stream_)
    parts = _parts(stream_.getvalue())
    for place, title in enumerate(book.sheetnames, 1):
        shapes = [("CB_Block_0", pack(stream(_list([]))))]
        mine = [items for items in blocks if items[0].sheet == title]
        shapes += [(f"CB_Block_7.0.0.0_x003a_{number}", block(items)) for number, items in enumerate(mine, 1)]
        add_shapes(parts, place, [(name, spoil(name, text)) for name, text in shapes])
    write_parts(path, parts)


def _names(cells, blocks):
    for title in cells:
        yield title, "CBx_Sheet_Guid", f'"\'{guid(title)}"'
    for item in (item for items in blocks for item in items):
        if item.cell:
            yield item.sheet, f"CB_{object_guid(item).hex}", f"{quoted(item.sheet)}!{item.cell}"
        for _, _, cell, key in _wanted(item):
            yield item.sheet, f"CBCR_{key.hex}", cell if re.search("[!&]", cell) else f"{quoted(item.sheet)}!{cell}"


def _parts(data):
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def read_parts(path):
    """Name -> bytes of each part of a file."""
    return _parts(path.read_bytes())


def write_parts(path, parts):
    """Write a file of these parts."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in parts.items():
            archive.writestr(name, data)


def shape(name, text):
    """A hidden picture with a script text."""
    return (
        f'<v:shape {SPACES} id="{name}" type="#_x0000_t75" style="visibility:hidden"><x:ClientData ObjectType="Pict">'
        f"<x:ScriptText>{escape(text)}</x:ScriptText><x:ScriptLanguage>4</x:ScriptLanguage></x:ClientData></v:shape>"
    )


def add_shapes(parts, place, shapes):
    """Put pictures into the legacy drawing of a sheet, by its number; it may hold comments."""
    relations = f"xl/worksheets/_rels/sheet{place}.xml.rels"
    new = "".join(shape(*each) for each in shapes).encode()
    target = re.search(rb'Target="([^"]*\.vml)"', parts.get(relations, b""))
    if target:
        part = target[1].decode().lstrip("/")
        parts[part] = parts[part].replace(b"</xml>", new + b"</xml>")
        return
    parts[f"xl/drawings/vmlDrawing{place}.vml"] = b"<xml>" + new + b"</xml>"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    relation = f'<Relationship Id="rCB" Type="{office}/vmlDrawing" Target="/xl/drawings/vmlDrawing{place}.vml"/>'
    empty = b'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"></Relationships>'
    held = parts.get(relations, empty)
    parts[relations] = held.replace(b"</Relationships>", relation.encode() + b"</Relationships>")
    sheet = f"xl/worksheets/sheet{place}.xml"
    drawing = f'<legacyDrawing xmlns:r="{office}" r:id="rCB"/></worksheet>'.encode()
    parts[sheet] = parts[sheet].replace(b"</worksheet>", drawing)
    types = "[Content_Types].xml"
    if b'Extension="vml"' not in parts[types]:
        default = b'<Default Extension="vml" ContentType="application/vnd.openxmlformats-officedocument.vmlDrawing"/>'
        parts[types] = re.sub(rb"(<Types[^>]*>)", lambda result: result[1] + default, parts[types], count=1)
