"""The document on the page shows it as it is, and says what the code does."""

from __future__ import annotations

from pathlib import Path

from xlmc.outputs.page.payload import ALL_VALUES, MOST_VALUES

DOCS = Path(__file__).resolve().parents[3] / "docs"
MOST_BYTES = 150_000


def test_its_picture_is_a_small_png_that_the_script_makes():
    data = (DOCS / "page.png").read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    assert len(data) < MOST_BYTES
    assert "](page.png)" in (DOCS / "page.md").read_text(encoding="utf-8")
    assert 'PICTURE = HERE / "page.png"' in (DOCS / "make_page_picture.py").read_text(encoding="utf-8")


def test_it_says_how_many_trials_a_page_holds():
    text = " ".join((DOCS / "page.md").read_text(encoding="utf-8").split())
    assert f"*Few* is {MOST_VALUES:,} for a page with one or two forecasts, and {ALL_VALUES:,} divided by" in text
    assert f"{200 / MOST_VALUES:g} % of all for {MOST_VALUES:,}" in text
