import pytest

from xlmc.workbook.lazy_sheets import dynamic_array_marks

ARRAY = '<ext><d:dynamicArrayProperties xmlns:d="urn:xda" fDynamic="{}" fCollapsed="0"/></ext>'
SPILLS, DOES_NOT = (f"<bk><extLst>{ARRAY.format(flag)}</extLst></bk>" for flag in "10")


def metadata(types, future, cells):
    names = "".join(f'<metadataType name="{name}"/>' for name in types)
    blocks = ["".join(f'<rc t="{t}" v="{v}"/>' for t, v in block) for block in cells]
    records = "".join(f"<bk>{block}</bk>" for block in blocks)
    return (
        '<metadata xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
        f"<metadataTypes>{names}</metadataTypes>{future}<cellMetadata>{records}</cellMetadata></metadata>"
    ).encode()


XLDAPR = '<futureMetadata name="XLDAPR">{}</futureMetadata>'.format
RICH = '<futureMetadata name="XLRICHVALUE"><bk/></futureMetadata>'


@pytest.mark.parametrize(
    ("types", "future", "cells", "marks"),
    [
        (["XLDAPR"], XLDAPR(SPILLS), [[(1, 0)]], {"1"}),
        (["XLDAPR"], XLDAPR(DOES_NOT), [[(1, 0)]], set()),
        (["XLDAPR"], XLDAPR(DOES_NOT + SPILLS), [[(1, 0)], [(1, 1)]], {"2"}),
        (["XLRICHVALUE", "XLDAPR"], RICH + XLDAPR(SPILLS), [[(1, 0)], [(2, 0)], [(1, 0), (2, 0)]], {"2", "3"}),
        (["XLRICHVALUE"], RICH, [[(1, 0)]], set()),
        ([], "", [], set()),
    ],
)
def test_marks(types, future, cells, marks):
    assert dynamic_array_marks(metadata(types, future, cells), "xl/metadata.xml") == marks
