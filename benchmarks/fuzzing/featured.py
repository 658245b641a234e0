"""A book with what shipped books do not use: shared formulas, what-if tables, rich text, dates, external links."""

from __future__ import annotations

from fuzzing.books import MAIN, OFFICE, PACKAGE, Sheet, Table, cell, packed, parts_of

__all__ = ["featured"]

_LINKS = f'<Relationship Id="x" Type="{OFFICE}/externalLink" Target="externalLinks/externalLink1.xml"/>'
_STRINGS = f'<Relationship Id="z" Type="{OFFICE}/sharedStrings" Target="sharedStrings.xml"/>'
_STYLES = f'<Relationship Id="y" Type="{OFFICE}/styles" Target="styles.xml"/>'
_PROPERTIES = "http://schemas.openxmlformats.org/officeDocument/2006/extended-properties"


def featured() -> bytes:
    """Its bytes."""
    shared = ' t="shared" ref="C1:C4" si="0"'
    rows = {
        1: [cell(1, 1, 2.0), cell(1, 2, 4, "A1*2"), cell(1, 3, 6, "A1+B1", shared), _string(1, 4, 0)],
        2: [cell(2, 1, 3.0), cell(2, 2, 6, "A2*2"), _child(2, 3), _string(2, 4, 1)],
        3: [cell(3, 1, 5.0), cell(3, 2, 10, "SUM(INDIRECT(D1))", ' t="array" ref="B3"'), _child(3, 3), _rich(3, 4)],
        4: [cell(4, 1, 7.0), cell(4, 2, 14, "A4*2+[1]Other!A1*0"), _child(4, 3), _date(4, 4)],
        5: [
            cell(5, 1, 7.0),
            cell(5, 2, 1, "", ' t="dataTable" ref="B5:B6" dt2D="0" dtr="0" r1="A1"'),
            cell(5, 5, "#N/A"),
        ],
        6: [cell(6, 1, True), cell(6, 2, 1.0), cell(6, 3, "x", 'A1&"x"'), cell(6, 4, 1, "C1+C2*local")],
    }
    headings = ("Name", "Cell", "Distribution", "Low", "High", "Likeliest", "Lower cutoff", "Frozen", "Source")
    assumptions = {
        1: [cell(1, n, heading) for n, heading in enumerate(headings, 1)],
        2: [cell(2, 1, "u"), cell(2, 2, 2, "Main!A1"), cell(2, 4, 1.0), cell(2, 5, 3.0), cell(2, 9, "scale")],
        3: [
            cell(3, 1, "v"),
            cell(3, 2, "Main!A2"),
            cell(3, 3, "Triangular"),
            cell(3, 4, 1.0),
            cell(3, 5, 5.0),
            cell(3, 6, 2.0),
        ],
        4: [cell(4, 1, "w"), cell(4, 2, 5, "Main!A3"), cell(4, 4, 1.0), cell(4, 5, 9, "Main!A1+9")],
    }
    others = {
        6: [cell(6, 1, "Name"), cell(6, 2, "Cell"), cell(6, 3, "Units")],
        7: [cell(7, 1, "sum"), cell(7, 2, 1, "Main!D6"), cell(7, 3, "mph")],
        8: [cell(8, 1, "c3"), cell(8, 2, 1, "Main!C3")],
        10: [cell(10, 1, "Name"), cell(10, 2, "Cell"), cell(10, 3, "At least"), cell(10, 4, "Because")],
        11: [cell(11, 1, "f"), cell(11, 2, 1, "Main!C2"), cell(11, 3, 8.0), cell(11, 4, "witness")],
        13: [cell(13, 1, "Setting"), cell(13, 2, "Value")],
        14: [cell(14, 1, "Trials"), cell(14, 2, 500.0)],
        15: [cell(15, 1, "Sampling"), cell(15, 2, "mc")],
        17: [cell(17, 1, "First"), cell(17, 2, "Second"), cell(17, 3, "Correlation")],
        18: [cell(18, 1, "u"), cell(18, 2, "v"), cell(18, 3, 0.5)],
    }
    tables = (
        Table("xlmc_assumptions", "A1:I4", headings),
        Table("xlmc_forecasts", "A6:C8", ("Name", "Cell", "Units")),
        Table("xlmc_filters", "A10:D11", ("Name", "Cell", "At least", "Because")),
        Table("xlmc_settings", "A13:B15", ("Setting", "Value")),
        Table("xlmc_correlations", "A17:C18", ("First", "Second", "Correlation")),
    )
    merged = '<mergeCells count="1"><mergeCell ref="F1:G2"/></mergeCells>'
    parts = parts_of(
        {"Main": Sheet(rows, after=merged), "In & out": Sheet(assumptions | others, tables), "Empty": Sheet({})},
        {"local": "Main!$A$1", "f": "LAMBDA(x,x+1)", "const": "3.5", "area": "Main!$A$1:$C$4"},
    )
    return packed(_around(parts))


def _around(parts: dict[str, bytes]) -> dict[str, bytes]:
    """The parts with strings, styles, an external link, and the settings of the workbook."""
    rels = parts["xl/_rels/workbook.xml.rels"]
    rels = rels.replace(b"</Relationships>", f"{_LINKS}{_STRINGS}{_STYLES}</Relationships>".encode())
    settings = b'<workbookPr date1904="1"/><sheets>'
    after = b'</definedNames><calcPr calcMode="manual" fullPrecision="0" iterate="1"/>'
    main = parts["xl/workbook.xml"].replace(b"<sheets>", settings).replace(b"</definedNames>", after)
    strings = (
        f'<sst xmlns="{MAIN}" count="2" uniqueCount="2"><si><t>A1:A4</t></si>'
        '<si><r><t>ri</t></r><r><rPr><b/></rPr><t xml:space="preserve">ch </t></r><rPh><t>no</t></rPh></si></sst>'
    )
    link = f'<externalLink xmlns="{MAIN}" xmlns:r="{OFFICE}"><externalBook r:id="r"/></externalLink>'
    links = (
        f'<Relationships xmlns="{PACKAGE}"><Relationship Id="r" Type="{OFFICE}/externalLinkPath" Target="o.xlsx" '
        'TargetMode="External"/></Relationships>'
    )
    styles = (
        f'<styleSheet xmlns="{MAIN}"><numFmts count="1"><numFmt numFmtId="164" formatCode="0.0"/></numFmts>'
        '<fonts count="1"><font><sz val="11"/></font></fonts><fills count="1"><fill/></fills>'
        '<borders count="1"><border/></borders><cellStyleXfs count="1"><xf/></cellStyleXfs>'
        '<cellXfs count="2"><xf/><xf numFmtId="14"/></cellXfs></styleSheet>'
    )
    more = {
        "xl/sharedStrings.xml": strings,
        "xl/styles.xml": styles,
        "xl/externalLinks/externalLink1.xml": link,
        "xl/externalLinks/_rels/externalLink1.xml.rels": links,
        "docProps/app.xml": f'<Properties xmlns="{_PROPERTIES}"><Application>Excel</Application></Properties>',
    }
    changed = {"xl/_rels/workbook.xml.rels": rels, "xl/workbook.xml": main}
    return parts | changed | {name: xml.encode() for name, xml in more.items()}


def _string(row: int, column: int, index: int) -> str:
    return f'<c r="{"ABCD"[column - 1]}{row}" t="s"><v>{index}</v></c>'


def _child(row: int, column: int) -> str:
    return f'<c r="{"ABCD"[column - 1]}{row}"><f t="shared" si="0"/><v>1</v></c>'


def _rich(row: int, column: int) -> str:
    return f'<c r="{"ABCD"[column - 1]}{row}" t="inlineStr"><is><r><t>in</t></r><r><t>line</t></r></is></c>'


def _date(row: int, column: int) -> str:
    return f'<c r="{"ABCD"[column - 1]}{row}" t="d" s="1"><v>2001-03-05T12:30:00</v></c>'
