import pytest

from xlmc.errors import WorkbookError
from xlmc.workbook.lazy_sheets import naming_file


@pytest.mark.parametrize(("where", "told"), [(None, "book.xlsx"), ("Sheet1!B7", "Sheet1!B7")])
def test_a_complaint_without_a_place_gets_the_file(where, told):
    with pytest.raises(WorkbookError, match="what is wrong") as caught, naming_file("book.xlsx"):
        raise WorkbookError("what is wrong", where=where, hint="what to do")
    assert (caught.value.where, caught.value.hint) == (told, "what to do")
