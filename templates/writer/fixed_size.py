"""Charts keep their size in every program.

XlsxWriter ties a chart to two cells, so that it is as wide as the columns between them: in a program that lacks the
workbook's font these are wider, and a plan view is stretched. Here it is tied to one cell and told its size.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from zipfile import ZipFile

__all__ = ["fix_chart_sizes"]

_EMU_PER_PIXEL = 9525
_TWO_CELLS = re.compile(
    r'<xdr:twoCellAnchor editAs="oneCell">(<xdr:from>.*?</xdr:from>)<xdr:to>.*?</xdr:to>(.*?)</xdr:twoCellAnchor>'
)


def fix_chart_sizes(path: Path, sizes: Sequence[tuple[int, int]]) -> None:
    """Give the charts of a workbook that XlsxWriter wrote, one a sheet, these widths and heights, in pixels."""
    extents = {
        f"xl/drawings/drawing{number}.xml": f'<xdr:ext cx="{width * _EMU_PER_PIXEL}" cy="{height * _EMU_PER_PIXEL}"/>'
        for number, (width, height) in enumerate(sizes, 1)
    }
    with ZipFile(path) as book:
        parts = [(info, book.read(info)) for info in book.infolist()]
    with ZipFile(path, "w") as book:
        for info, data in parts:
            if info.filename in extents:
                anchored = rf"<xdr:oneCellAnchor>\1{extents[info.filename]}\2</xdr:oneCellAnchor>"
                data = _TWO_CELLS.sub(anchored, data.decode()).encode()
            book.writestr(info, data, compress_type=info.compress_type)
