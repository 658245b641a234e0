"""Changes of a part's XML: attributes, elements, texts, namespaces; some leave it well-formed and some do not."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from typing import Final
from xml.sax.saxutils import escape

from fuzzing import hostile

__all__ = ["changed"]

_ATTRIBUTE: Final = re.compile(r'\s[\w:]+="[^"]*"')
_TEXT: Final = re.compile(r">([^<>]+)<")
_TAG: Final = re.compile(r"<[^!?<>][^<>]*>")
_ELEMENT: Final = re.compile(r"<(\w+)(?:\s[^<>]*)?(?:/>|>(?:[^<>]|<(?!/?\1\b))*</\1>)")
_POINTED: Final = re.compile(
    r'\b(r|ref|si|t|s|cm|vm|sqref|count|id|Id|Target|Type|PartName|ContentType|name|displayName|localSheetId|sheetId|headerRowCount|totalsRowCount|uniqueCount)="[^"]*"'
)
_MOST: Final = 400_000

_KINDS: Final = ("n", "s", "str", "b", "e", "d", "inlineStr", "shared", "array", "dataTable", "normal", "zz", "")
_NAMESPACES: Final = (
    "http://schemas.openxmlformats.org/spreadsheetml/2006/main",
    "http://purl.oclc.org/ooxml/spreadsheetml/main",
    "http://schemas.openxmlformats.org/officeDocument/2006/relationships",
    "http://schemas.openxmlformats.org/markup-compatibility/2006",
    "urn:x",
    "",
)
_BOMB: Final = (
    '<!DOCTYPE z [<!ENTITY a "aaaaaaaaaa">'
    + "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
    + "]>"
)
_OUTSIDE: Final = '<!DOCTYPE z [<!ENTITY a SYSTEM "file:///etc/hostname">]>'


def changed(rng: random.Random, xml: bytes) -> tuple[bytes, str]:
    """The part changed in one way, and which."""
    text = xml[:_MOST].decode("utf-8", "replace") if len(xml) <= _MOST else xml.decode("utf-8", "replace")
    name, change = rng.choices(list(_CHANGES.items()), _WEIGHTS)[0]
    return change(rng, text).encode("utf-8", "surrogatepass"), name


def _one(rng: random.Random, pattern: re.Pattern[str], text: str, change: Callable[[str], str]) -> str:
    """One match of the pattern, chosen at random, changed."""
    result = list(pattern.finditer(text))
    if not result:
        return text
    start, end = rng.choice(result).span()
    return text[:start] + change(text[start:end]) + text[end:]


def _value(rng: random.Random) -> str:
    """A hostile value for an attribute or a text, escaped; sometimes not, and sometimes what XML cannot hold."""
    made: str = rng.choice([hostile.number, hostile.text, hostile.address, lambda rng: rng.choice(_KINDS)])(rng)
    if rng.random() < 0.05:
        return rng.choice(
            ["&#0;", "&#1;", "&#x1B;", "&#xFFFE;", "&#xD800;", "&a;", "&lt", "<", "\x00", "\x1b[31m", "\ufffe"]
        )
    return escape(made, {'"': "&quot;"})


def _attribute_value(rng: random.Random, text: str) -> str:
    pattern = _POINTED if rng.random() < 0.7 else _ATTRIBUTE
    return _one(rng, pattern, text, lambda old: f'{old.partition("=")[0]}="{_value(rng)}"')


def _attribute_swapped(rng: random.Random, text: str) -> str:
    result = _POINTED.findall(text)
    if not result:
        return text
    same = rng.choice(result)
    values = re.findall(rf'\b{same}="([^"]*)"', text)
    return _one(rng, re.compile(rf'\b{same}="[^"]*"'), text, lambda _: f'{same}="{rng.choice(values)}"')


def _attribute_gone(rng: random.Random, text: str) -> str:
    return _one(rng, _ATTRIBUTE, text, lambda _: "")


def _attribute_added(rng: random.Random, text: str) -> str:
    added = rng.choice(
        ["t", "r", "si", "ref", "s", "cm", "hidden", "state", "Target", "TargetMode", "xml:space", "r:id"]
    )
    return _one(rng, re.compile(r"<\w+(?=[\s/>])"), text, lambda old: f'{old} {added}="{_value(rng)}"')


def _text_changed(rng: random.Random, text: str) -> str:
    return _one(rng, _TEXT, text, lambda _: f">{_value(rng)}<")


def _texts_many(rng: random.Random, text: str) -> str:
    return _TEXT.sub(lambda old: f">{_value(rng)}<" if rng.random() < 0.05 else old[0], text)


def _element_gone(rng: random.Random, text: str) -> str:
    return _one(rng, _ELEMENT, text, lambda _: "")


def _element_twice(rng: random.Random, text: str) -> str:
    return _one(rng, _ELEMENT, text, lambda old: old * 2)


def _element_moved(rng: random.Random, text: str) -> str:
    result = [match.span() for match in _ELEMENT.finditer(text)]
    if len(result) < 2:
        return text
    (a, b), (c, d) = sorted(rng.sample(result, 2))
    return text if c < b else text[:a] + text[c:d] + text[b:c] + text[a:b] + text[d:]


def _element_many(rng: random.Random, text: str) -> str:
    return _one(rng, _ELEMENT, text, lambda old: old * (200 if len(old) < 2000 else 3))


def _tag_renamed(rng: random.Random, text: str) -> str:
    names = re.findall(r"<(\w+)", text) or ["a"]
    new = rng.choice([*names, "x:y", "v", "f", "is", "t", "r", "c", "row"])
    return _one(rng, _TAG, text, lambda old: re.sub(r"^<(/?)[\w:]+", rf"<\g<1>{new}", old))


def _name_everywhere(rng: random.Random, text: str) -> str:
    names = sorted(set(re.findall(r"<(\w+)", text))) or ["a"]
    old, new = rng.choice(names), rng.choice([*names, "zz"])
    return re.sub(rf"<(/?){old}\b", rf"<\g<1>{new}", text)


def _namespace(rng: random.Random, text: str) -> str:
    return _one(
        rng,
        re.compile(r'xmlns(:\w+)?="[^"]*"'),
        text,
        lambda old: f'{old.partition("=")[0]}="{rng.choice(_NAMESPACES)}"',
    )


def _prefixed(_: random.Random, text: str) -> str:
    return re.sub(r"<(/?)(?=\w)", r"<\1x:", text).replace('xmlns="', 'xmlns:x="', 1)


def _bomb(rng: random.Random, text: str) -> str:
    declared = rng.choice([_BOMB, _OUTSIDE, "<!DOCTYPE z>"])
    head, result, rest = text.partition("?>")
    text = f"{head}{result}{declared}{rest}" if result else declared + text
    return _one(rng, _TEXT, text, lambda _: rng.choice([">&i;<", ">&a;<"]))


def _deep(rng: random.Random, text: str) -> str:
    depth = rng.choice([100, 3_000, 60_000])
    return _one(rng, _ELEMENT, text, lambda old: "<a>" * depth + old + "</a>" * depth)


def _long(rng: random.Random, text: str) -> str:
    return _one(rng, _ATTRIBUTE, text, lambda old: f'{old[:-1]}{rng.choice("aA1 ") * 100_000}"')


def _cut(rng: random.Random, text: str) -> str:
    return text[: rng.randrange(len(text) + 1)]


def _encoded(rng: random.Random, text: str) -> str:
    return f'<?xml version="1.0" encoding="{rng.choice(["UTF-16", "latin-1", "utf-7", "zzz", "ascii"])}"?>' + re.sub(
        r"^<\?.*?\?>", "", text
    )


_CHANGES: Final[dict[str, Callable[[random.Random, str], str]]] = {
    "an attribute's value": _attribute_value,
    "an attribute's value from another element": _attribute_swapped,
    "an attribute gone": _attribute_gone,
    "an attribute added": _attribute_added,
    "a text": _text_changed,
    "many texts": _texts_many,
    "an element gone": _element_gone,
    "an element twice": _element_twice,
    "two elements exchanged": _element_moved,
    "an element many times": _element_many,
    "a tag renamed": _tag_renamed,
    "a name changed everywhere": _name_everywhere,
    "another namespace": _namespace,
    "all names with a prefix": _prefixed,
    "a document type": _bomb,
    "deeply nested": _deep,
    "a long attribute": _long,
    "cut off": _cut,
    "another encoding": _encoded,
}
_WEIGHTS: Final = (12, 8, 5, 5, 8, 3, 6, 6, 5, 1, 4, 2, 2, 1, 1, 1, 0.5, 1, 1)
