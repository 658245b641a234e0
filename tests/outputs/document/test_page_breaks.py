"""Where pages of a printed table end: no row of it stands alone."""

from __future__ import annotations

import io

import pytest

from xlmc.outputs.document import document_bytes
from xlmc.outputs.document.parts import Document, Paragraph, Table

pypdf = pytest.importorskip("pypdf")
pytest.importorskip("typst")

ROWS = tuple((f"row {number}", "value") for number in range(1, 16))


@pytest.mark.parametrize("above", range(24, 38))
def test_no_row_of_a_table_stands_alone_on_a_page(above):
    blocks = (*(Paragraph(f"line {number}") for number in range(above)), Table("", ("Name", "Value"), ROWS))
    data = document_bytes(Document("Title", "", None, "", "", (), blocks), ".pdf")
    pages = [page.extract_text().count("row ") for page in pypdf.PdfReader(io.BytesIO(data)).pages]
    assert sum(pages) == len(ROWS)
    assert 1 not in pages
