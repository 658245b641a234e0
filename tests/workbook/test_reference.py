import pytest

from xlmc.address import Area
from xlmc.errors import WorkbookError
from xlmc.workbook.structure import area_of


@pytest.mark.parametrize(
    ("reference", "corners"), [("A1:B2", (1, 1, 2, 2)), ("B2:A1", (1, 1, 2, 2)), ("C3", (3, 3, 3, 3))]
)
def test_area_of(reference, corners):
    assert area_of(reference, "S", "a thing") == Area("S", *corners)


@pytest.mark.parametrize("reference", [None, "", "A:B", "A0", "#REF!"])
def test_complaint(reference):
    with pytest.raises(WorkbookError, match="a thing of sheet 'S' has no valid range"):
        area_of(reference, "S", "a thing")
