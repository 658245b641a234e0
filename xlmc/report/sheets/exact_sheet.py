"""A worksheet that writes every number so that it reads back as the same number."""

from __future__ import annotations

from collections.abc import Sequence

from xlsxwriter.worksheet import Worksheet

__all__ = ["ExactSheet"]


class ExactSheet(Worksheet):  # type: ignore[misc]  # the library has no types
    """XlsxWriter writes 16 digits; a double needs up to 17, and a trial must be repeatable to the last bit."""

    def _xml_number_element(self, number: float, attributes: Sequence[tuple[str, str]] = ()) -> None:
        written = "".join(
            [f' {key}="{value}"' for key, value in attributes]
        )  # a reference and a style: nothing to escape
        self.fh.write(f"<c{written}><v>{repr(float(number)).removesuffix('.0')}</v></c>")
