from __future__ import annotations

import re

import pytest

from xlmc.excel.workbook.injection.content_types import add_types, drop_types, types_of

XMLNS = 'xmlns="http://schemas.openxmlformats.org/package/2006/content-types"'
RELS, SHEET = "application/vnd.openxmlformats-package.relationships+xml", "application/x.sheet+xml"
HOST = (
    f'<Types {XMLNS}><Default Extension="rels" ContentType="{RELS}"/><Default Extension="xml" ContentType="t/xml"/>'
    f'<Default Extension="PNG" ContentType="image/png"/><Override PartName="/xl/Sheet1.xml" ContentType="{SHEET}"/>'
    "</Types>"
).encode()


def added(xml, host=HOST):
    """What stands in the new part and not in the old."""
    return [tag for tag in re.findall(r"<[^>]*>", xml.decode()) if tag not in host.decode()]


@pytest.mark.parametrize(
    ("name", "kind", "tags"),
    [
        ("xl/sheet2.xml", SHEET, [f'<Override PartName="/xl/sheet2.xml" ContentType="{SHEET}"/>']),
        ("xl/a.png", "image/png", []),
        ("xl/a.png", "image/x-png", ['<Override PartName="/xl/a.png" ContentType="image/x-png"/>']),
        ("xl/a.jpeg", "image/jpeg", ['<Default Extension="jpeg" ContentType="image/jpeg"/>']),
        ("xl/_rels/a.xml.rels", RELS, []),
    ],
)
def test_a_type_is_said_once_and_where_it_belongs(name, kind, tags):
    done = add_types(HOST, {name: kind})
    assert added(done) == tags
    assert types_of(done, [name]) == {name: kind}


def test_rels_without_a_default_are_named_one_by_one():
    host = HOST.replace(b'Default Extension="rels"', b'Override PartName="/_rels/.rels"')
    tag = f'<Override PartName="/xl/_rels/a.xml.rels" ContentType="{RELS}"/>'
    assert added(add_types(host, {"xl/_rels/a.xml.rels": RELS}), host) == [tag]


def test_a_prefix_is_kept():
    host = (
        f'<ct:Types {XMLNS.replace("xmlns", "xmlns:ct")}><ct:Default Extension="xml" ContentType="t/xml"/></ct:Types>'
    )
    done = add_types(host.encode(), {"a.xml": SHEET, "b.png": "image/png"}).decode()
    assert "<ct:Override " in done
    assert '<ct:Default Extension="png"' in done


def test_types_are_found_by_name_then_by_extension_whatever_their_case():
    assert types_of(HOST, ["xl/sheet1.XML", "b.xml", "c.png"]) == {
        "xl/sheet1.XML": SHEET,
        "b.xml": "t/xml",
        "c.png": "image/png",
    }


def test_dropping_undoes_adding():
    new = {"xl/sheet2.xml": SHEET, "xl/a.jpeg": "image/jpeg", "xl/b.png": "image/png"}
    kept = ["xl/Sheet1.xml", "xl/photo.png", "_rels/.rels"]
    assert drop_types(add_types(HOST, new), new, kept) == HOST
