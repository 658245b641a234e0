"""Parts of a workbook that other programs write in other ways: external links, number formats, content types.

Every cell of what xlmc accepts is compared with what an independent reader sees, and after result sheets were written
into it again: the person's cells must read as before, and the results as they were built, each in its number format.
"""

from __future__ import annotations

import io
import posixpath
import random
import re
import zipfile
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Final
from urllib.parse import unquote
from xml.etree import ElementTree
from xml.sax.saxutils import escape

from fuzzing import hostile
from fuzzing.books import MAIN, OFFICE, PACKAGE, Sheet, Table, cell, packed, parts_of
from fuzzing.inputs import Disagreement, Input, Reached, steps_of
from fuzzing.second_reader import Cells, agreed, equal, second_reading
from fuzzing.xml_changes import changed
from fuzzing.zips import defined
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.injection.splice import as_utf8
from xlmc.excel.workbook.injection.strict import strict_part
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model

__all__ = ["FOCUSES", "book", "make", "run"]

TRIALS: Final = 16
_STEPS: Final = {"write": 0.4, "verify": 0.1, "simulate": 0.15}
_LINK, _STYLES, _TYPES = "xl/externalLinks/externalLink1.xml", "xl/styles.xml", "[Content_Types].xml"
_SPREADSHEET: Final = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_RELS: Final = "xl/_rels/workbook.xml.rels"
_SHEET: Final = "xl/worksheets/sheet1.xml"
_COMPATIBILITY: Final = 'xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006"'
_CODES: Final = (
    "General", "0", "0.000", "0%", "0.00E+00", "yyyy-mm-dd", "[h]:mm:ss", "d/m/yy h:mm", "@", ";;;", '"mph"0',
    "[Red]0.0", "# ?/?", "_(* #,##0_)", "\\d0", "[$-409]mmmm", "[<1]0.0;0", "", "0;-0;;@", "ss.000", "AM/PM", "x" * 300,
)  # fmt: skip


@cache
def book() -> dict[str, bytes]:
    """A book with links to another, dates, durations and percentages, shared texts, and tables of xlmc."""
    rows = {
        1: [cell(1, 1, 2.5), cell(1, 2, 142.0, "[1]Prices!$B$2"), _shared(1, 3, 0), _styled(1, 4, 2, 45000.75)],
        2: [cell(2, 1, 3.0), cell(2, 2, 7.5, "[1]Prices!A1+A1"), _shared(2, 3, 1), _styled(2, 4, 3, 1.25)],
        3: [cell(3, 1, True), cell(3, 2, 149.0, "SUM([1]Prices!A1:B3)"), cell(3, 3, "#N/A"), _styled(3, 4, 1, 0.5)],
        4: [cell(4, 1, "text"), cell(4, 2, 0.05, "[1]!Rate"), _styled(4, 4, 2, 1), _styled(4, 5, 3, -0.25)],
        5: [cell(5, 1, 1e15), cell(5, 2, 152.05, "B1+B2+A1"), _styled(5, 4, 2, 59), _styled(5, 5, 0, 1e-300)],
    }
    headings = ("Name", "Value", "Low", "High"), ("Name", "Value")
    tables = {
        1: [cell(1, n, heading) for n, heading in enumerate(headings[0], 1)],
        2: [cell(2, 1, "u"), cell(2, 2, 2.5, "S!A1"), cell(2, 3, 1.0), cell(2, 4, 3.0)],
        4: [cell(4, n, heading) for n, heading in enumerate(headings[1], 1)],
        5: [cell(5, 1, "y"), cell(5, 2, 152.05, "S!B5")],
    }
    made = Table("xlmc_assumptions", "A1:D2", headings[0]), Table("xlmc_forecasts", "A4:B5", headings[1])
    return _around(parts_of({"S": Sheet(rows), "In": Sheet(tables, made)}, {"area": "S!$A$1:$B$5"}))


def _around(parts: dict[str, bytes]) -> dict[str, bytes]:
    """The parts with a link, styles and shared texts."""
    kinds = {"x": ("externalLink", "externalLinks/externalLink1.xml"), "z": ("sharedStrings", "sharedStrings.xml")}
    kinds["y"] = "styles", "styles.xml"
    rels = "".join(
        f'<Relationship Id="{name}" Type="{OFFICE}/{kind}" Target="{to}"/>' for name, (kind, to) in kinds.items()
    )
    overrides = "".join(
        f'<Override PartName="/xl/{to}" ContentType="{_SPREADSHEET}.{kind}+xml"/>' for kind, to in kinds.values()
    )
    formats = "".join(f'<xf numFmtId="{number}" fontId="0" fillId="0" borderId="0"/>' for number in (0, 9, 14, 164))
    more = {
        _LINK: (
            f'<externalLink xmlns="{MAIN}" xmlns:r="{OFFICE}"><externalBook r:id="r"><sheetNames>'
            '<sheetName val="Prices"/><sheetName val="Other"/></sheetNames><definedNames>'
            '<definedName name="Rate" refersTo="=Prices!$C$3"/></definedNames><sheetDataSet><sheetData sheetId="0">'
            '<row r="1"><cell r="A1"><v>5</v></cell><cell r="B1" t="str"><v>each</v></cell></row>'
            '<row r="2"><cell r="B2"><v>142</v></cell><cell r="C2" t="b"><v>1</v></cell></row>'
            '<row r="3"><cell r="A3"><v>2</v></cell><cell r="C3"><v>0.05</v></cell>'
            '<cell r="D3" t="e"><v>#N/A</v></cell></row></sheetData><sheetData sheetId="1"/></sheetDataSet>'
            "</externalBook></externalLink>"
        ),
        "xl/externalLinks/_rels/externalLink1.xml.rels": (
            f'<Relationships xmlns="{PACKAGE}"><Relationship Id="r" Type="{OFFICE}/externalLinkPath" '
            'Target="prices.xlsx" TargetMode="External"/></Relationships>'
        ),
        _STYLES: (
            f'<styleSheet xmlns="{MAIN}"><numFmts count="1"><numFmt numFmtId="164" formatCode="[h]:mm:ss"/></numFmts>'
            '<fonts count="1"><font><sz val="11"/></font></fonts><fills count="2">'
            '<fill><patternFill patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill></fills>'
            '<borders count="1"><border/></borders>'
            f'<cellStyleXfs count="1"><xf/></cellStyleXfs><cellXfs count="4">{formats}</cellXfs></styleSheet>'
        ),
        "xl/sharedStrings.xml": (
            f'<sst xmlns="{MAIN}" count="2" uniqueCount="2"><si><t>wet</t></si>'
            "<si><r><t>ri</t></r><r><t>ch</t></r></si></sst>"
        ),
    }
    pointers = '<externalReferences><externalReference r:id="x"/></externalReferences>'
    parts[_RELS] = parts[_RELS].replace(b"</Relationships>", f"{rels}</Relationships>".encode())
    parts[_TYPES] = parts[_TYPES].replace(b"</Types>", f"{overrides}</Types>".encode())
    parts["xl/workbook.xml"] = parts["xl/workbook.xml"].replace(b"</sheets>", f"</sheets>{pointers}".encode())
    return parts | {name: xml.encode() for name, xml in more.items()}


def _shared(row: int, column: int, index: int) -> str:
    return f'<c r="{"ABCDE"[column - 1]}{row}" t="s"><v>{index}</v></c>'


def _styled(row: int, column: int, style: int, value: float) -> str:
    return f'<c r="{"ABCDE"[column - 1]}{row}" s="{style}"><v>{value}</v></c>'


_Edit = Callable[[random.Random, dict[str, bytes]], str]


def _replaced(rng: random.Random, parts: dict[str, bytes], part: str, pattern: str, new: Callable[[str], str]) -> str:
    """One match of the pattern in a part, chosen at random, becomes another text."""
    text = parts[part].decode("utf-8", "surrogatepass")
    result = [match.span() for match in re.finditer(pattern, text)]
    if not result:
        return "nothing"
    start, end = rng.choice(result)
    message = new(text[start:end])
    parts[part] = f"{text[:start]}{message}{text[end:]}".encode("utf-8", "surrogatepass")
    return f"{part}: {text[start:end][:60]!r} -> {message[:60]!r}"


def _value_of_cell(rng: random.Random, parts: dict[str, bytes]) -> str:
    """The text of a value, or the kind of a cell."""
    part = rng.choice([_SHEET, _SHEET, "xl/sharedStrings.xml"])
    new = escape(rng.choice([hostile.number, hostile.text])(rng)[:2_000])
    if rng.random() < 0.3:
        kind = rng.choice(["n", "s", "str", "b", "e", "d", "inlineStr", "", "zz"])
        return _replaced(rng, parts, _SHEET, '<c r="[A-Z]+[0-9]+"', lambda old: f'{old} t="{kind}"')
    return _replaced(rng, parts, part, r"(?<=<v>)[^<]*(?=</v>)|(?<=<t>)[^<]*(?=</t>)", lambda _: new)


def _link(rng: random.Random, parts: dict[str, bytes]) -> str:
    """The stored values of a link, their kinds and places, its sheets and names, or whether it is broken."""
    flag = rng.choice(['refreshError="1"', 'refreshError="0"', 'refreshError="true"', 'refreshError="x"'])
    edits = (
        ("<sheetData", lambda old: f"{old} {flag}"),
        (r'sheetId="\d+"', lambda _: f'sheetId="{rng.choice(["0", "1", "2", "-1", "x", "99999999999"])}"'),
        (r"(?<=<v>)[^<]*", lambda _: escape(rng.choice([hostile.number, hostile.text])(rng)[:500])),
        (r'(?<=<cell r=")[^"]*', lambda _: escape(hostile.address(rng), {'"': "&quot;"})),
        ("<cell ", lambda old: f'{old}t="{rng.choice(["n", "s", "str", "b", "e", "zz"])}" '),
        (r'(?<=val=")[^"]*', lambda _: escape(hostile.text(rng)[:100], {'"': "&quot;"})),
        (
            r'(?<=refersTo=")[^"]*',
            lambda _: rng.choice(["=Prices!$B$2", "=Gone!A1", "=#REF!", "", "=1+1", "=Other!A1"]),
        ),
        (r"<sheetNames>.*</sheetNames>", lambda _: rng.choice(["", "<sheetNames/>"])),
        ("externalBook", lambda _: rng.choice(["ddeLink", "oleLink", "x:externalBook"])),
    )
    pattern, new = rng.choice(edits)
    return _replaced(rng, parts, _LINK, pattern, new)


def _format(rng: random.Random, parts: dict[str, bytes]) -> str:
    """Codes and numbers of formats, lists with several forms of one entry, styles of cells."""
    code = escape(rng.choice(_CODES), {'"': "&quot;"})

    def in_two_forms(old: str) -> str:
        return (
            f'<mc:AlternateContent {_COMPATIBILITY}><mc:Choice Requires="x14">{old}</mc:Choice>'
            f"<mc:Fallback>{old}</mc:Fallback></mc:AlternateContent>"
        )

    numbers = ["0", "9", "14", "22", "46", "163", "164", "165", "-1", "x", "4294967296", "99999999999999"]
    edits = (
        (_STYLES, r'(?<=formatCode=")[^"]*', lambda _: code),
        (_STYLES, r'(?<=numFmtId=")[^"]*', lambda _: rng.choice(numbers)),
        (_STYLES, r"<(?:xf|font|fill|border|numFmt)\b[^>]*?/>|<font>.*?</font>|<fill>.*?</fill>", in_two_forms),
        (_STYLES, r"<xf\b[^>]*/>", lambda old: rng.choice(["", old * 2, old * 70, f"<!-- {old} -->{old}"])),
        (_STYLES, r'(?<=count=")[^"]*', lambda _: rng.choice(["0", "1", "-1", "99", "x", "4294967296"])),
        (_STYLES, r"<(numFmts|fonts|fills|borders|cellXfs|cellStyleXfs)\b.*</\1>", lambda _: ""),
        (_SHEET, r'(?<= s=")\d+', lambda _: rng.choice(["0", "1", "2", "3", "4", "99", "-1", "x"])),
        (_SHEET, r'(?<=<c )r="[A-Z]+\d+"(?=><v)', lambda old: f'{old} s="{rng.randint(0, 4)}"'),
    )
    part, pattern, new = rng.choice(edits)
    return _replaced(rng, parts, part, pattern, new)


def _types(rng: random.Random, parts: dict[str, bytes]) -> str:
    """Content types and pointers of parts that are not there, twice, in another case or form; strict namespaces."""
    gone = rng.choice(["worksheets/sheet3.xml", "charts/chart1.xml", "tables/table3.xml", "styles2.xml", "media/a.png"])
    kind = rng.choice(["worksheet", "chart", "table", "styles", "zz"])
    kind = f"{_SPREADSHEET}.{kind}+xml"
    pointer = f'<Relationship Id="{rng.choice(["g", "x", "rId1"])}" Type="{OFFICE}/image" Target="{gone}"/>'
    if rng.random() < 0.08:
        for name, xml in parts.items():
            if name != _TYPES:
                parts[name] = strict_part(xml)
        return "strict"
    edits = (
        (_TYPES, "(?=</Types>)", lambda _: f'<Override PartName="/xl/{gone}" ContentType="{kind}"/>'),
        (_TYPES, r"<(?:Override|Default)[^>]*/>", lambda old: rng.choice(["", old * 2])),
        (_TYPES, r'(?<=PartName=")[^"]*', lambda old: rng.choice([old.upper(), old[1:], f"/{old}", old + "x", ""])),
        (_TYPES, r'(?<=ContentType=")[^"]*', lambda _: rng.choice([kind, "", "application/xml"])),
        (_TYPES, r'(?<=Extension=")[^"]*', lambda old: rng.choice([old.upper(), "png", "", "." + old])),
        (_RELS, "(?=</Relationships>)", lambda _: pointer),
        (_RELS, r'(?<=Target=")[^"]*', lambda old: rng.choice([f"/xl/{old}", f"./{old}", old.upper(), f"../xl/{old}"])),
        (
            _RELS,
            r'(?<=Target=")[^"]*',
            lambda old: rng.choice([old.replace("s", "%73"), old.replace("/", "\\"), "", "#a"]),
        ),
        (_RELS, r'(?<= Id=")[^"]*', lambda _: rng.choice(["x", "y", "s1", "w", ""])),
    )
    part, pattern, new = rng.choice(edits)
    return _replaced(rng, parts, part, pattern, new)


def _any_xml(part: str) -> _Edit:
    def change(rng: random.Random, parts: dict[str, bytes]) -> str:
        parts[part], message = changed(rng, parts[part])
        return f"{part}: {message}"

    return change


FOCUSES: Final[Mapping[str, tuple[_Edit, _Edit]]] = {
    "links": (_link, _any_xml(_LINK)),
    "formats": (_format, _any_xml(_STYLES)),
    "types": (_types, _any_xml(_TYPES)),
}
"""The parts that a kind of input is about, changed as programs do, and at random."""


def make(focus: str, rng: random.Random) -> Input:
    """The book with one to four changes in the parts that it is about, or in values of cells."""
    parts, message = dict(book()), []
    likely, at_random = FOCUSES[focus]
    for _ in range(rng.choice([1, 1, 2, 3, 4])):
        change = rng.choices([likely, _value_of_cell, at_random], [0.6, 0.25, 0.15])[0]
        message.append(change(rng, parts))
    if focus == "types" and rng.random() < 0.05:
        parts = {name.replace("/", "\\"): content for name, content in parts.items()}
        message.append("backslashes")
    return Input("fuzz.xlsx", packed(parts), "; ".join(message), steps_of(rng, _STEPS))


def run(given: Input, folder: Path) -> Reached:
    """Read the book, and compare all of its cells with those that an independent reader sees.

    Steps: `write` puts result sheets into it and reads these, and the book, again; `verify` recomputes its formulas;
    `simulate` runs it.

    Raises:
        Disagreement: two readers see two values, or what was written is not what it must be.
        XlmcError: as xlmc does.
    """
    workbook = read_workbook(given.data, given.name)
    for name in workbook.sheets:
        _ = workbook.sheets[name]
    cells = agreed(workbook, given.data)
    if "write" in given.steps:
        _write(given.data, cells)
    if {"verify", "simulate"} & {*given.steps}:
        calculated, definitions = defined(workbook, given.steps)
        if "simulate" in given.steps:
            run_model(CompiledModel(calculated, definitions, folder / given.name), RunOptions.of(trials=TRIALS))
    return Reached.RAN


@cache
def _results() -> tuple[dict[str, bytes], Cells, dict[str, dict[str, str]]]:
    """Result sheets as they are built: their parts, their cells, and the formats of these."""
    import xlsxwriter

    packed_sheets = io.BytesIO()
    with xlsxwriter.Workbook(packed_sheets, {"in_memory": True}) as book:
        for name in ("Results", "Trials"):
            sheet = book.add_worksheet(name)
            for row, code in enumerate(("0.000", "0.0%", '0.0 "km/h"', "General", "yyyy-mm-dd", "0.00E+00")):
                sheet.write_number(row, 0, 2.975 * 10**row, book.add_format({"num_format": code, "bold": row % 2}))
                sheet.write_string(row, 1, f"row {row}")
        book.get_worksheet_by_name("Trials").add_table("D1:D3", {"name": "Trials"})
    data = packed_sheets.getvalue()
    cells = second_reading(data)
    assert cells is not None
    return read_parts(data), cells, _formats(data)


def _write(data: bytes, before: Cells | None) -> None:
    """Write the result sheets into the book, twice, and read it again."""
    sheets, cells, formats = _results()
    parts = read_parts(data)
    made = parts
    for _ in range(2):
        made = inject(made, sheets)
        written = checked_bytes(made, parts)
    after = second_reading(written)
    if before is None:
        return
    if after is None:
        raise Disagreement("result workbook: calamine cannot read it")
    names = [name for name in after if name not in before]
    if len(names) != len(cells) or any(not _alike(after[name], held) for name, held in before.items()):
        raise Disagreement(f"result workbook: calamine reads other cells, sheets {[*after]}")
    for name, (built, held) in zip(names, cells.items(), strict=True):
        if not _alike(after[name], held):
            raise Disagreement(f"result workbook: calamine reads other results, {built!r}")
    _same_formats(_formats(data), formats, _formats(written), names)


def _alike(cells: Mapping[tuple[int, int], object], others: Mapping[tuple[int, int], object]) -> bool:
    """Whether two sheets hold the same; a number may be shown as a date (calamine counts no style in several forms)."""
    return cells.keys() == others.keys() and all(equal(value, others[at]) for at, value in cells.items())


def _same_formats(before: _Formats, built: _Formats, after: _Formats, names: Sequence[str]) -> None:
    """The person's cells are shown as before, and the results as they were built."""
    for name, expected in [*before.items(), *zip(names, built.values(), strict=True)]:
        shown = {at: after[name].get(at) for at in expected}
        if shown != expected:
            different = {at: (code, shown[at]) for at, code in expected.items() if shown[at] != code}
            raise Disagreement(f"number formats: of {name!r} was, is: {different}")


_Formats = Mapping[str, Mapping[str, str]]
_BUILT_IN: Final = {"0": "General", "1": "0", "9": "0%", "11": "0.00E+00"}


def _formats(data: bytes) -> dict[str, dict[str, str]]:
    """The code of the number format of each cell with a style, by sheet; read without xlmc."""
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        entries = {name.replace("\\", "/").casefold(): package.read(name) for name in package.namelist()}
    rels = _parsed(entries[_RELS])
    targets = {each.get("Id"): (each.get("Type", ""), each.get("Target", "")) for each in rels}
    styles = (to for kind, to in targets.values() if kind.endswith("/styles"))
    xml = next((entries[place] for to in styles if (place := _place(to)) in entries), b"<none/>")
    root = _parsed(xml)
    codes = {each.get("numFmtId"): each.get("formatCode", "") for each in root.iterfind("{*}numFmts//{*}numFmt")}
    entry_numbers = [_number(entry) for entry in root.find("{*}cellXfs") or ()]
    result = {}
    for sheet in _parsed(entries["xl/workbook.xml"]).iterfind("{*}sheets/{*}sheet"):
        pointer = next(value for key, value in sheet.items() if key.endswith("}id"))
        cells = _parsed(entries[_place(targets[pointer][1])]).iterfind(".//{*}c[@s]")
        styles_of = {at: s for each in cells if (at := each.get("r", "")) and (s := each.get("s", "")).isdecimal()}
        of = {at: entry_numbers[int(s)] if int(s) < len(entry_numbers) else "0" for at, s in styles_of.items()}
        result[sheet.get("name", "")] = {
            at: codes.get(number) or _BUILT_IN.get(number, f"built-in {number}") for at, number in of.items()
        }
    return result


def _parsed(xml: bytes) -> ElementTree.Element:
    return ElementTree.fromstring(as_utf8(xml, "a part"))


def _place(target: str) -> str:
    absolute = posixpath.normpath(posixpath.join("/xl", unquote(target).replace("\\", "/")))
    return absolute.lstrip("/").casefold()


def _number(entry: ElementTree.Element) -> str:
    """The number of the format of an entry of a list of styles; one in several forms counts once."""
    first = entry if entry.tag.endswith("}xf") else next(entry.iterfind(".//{*}xf"), entry)
    return first.get("numFmtId", "0")
