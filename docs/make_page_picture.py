"""Make the picture of the results page: `python docs/make_page_picture.py`.

`examples/intersection.xlsx` is run, its page written, and Chromium asked for what it shows first. Needs Chromium and
Pillow.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

import xlmc

HERE = Path(__file__).resolve().parent
CASE = HERE.parent / "examples" / "intersection.xlsx"
PICTURE = HERE / "page.png"

_SIZE = (1120, 1660)
_COLOURS = 128


def make(picture: Path) -> Path:
    """Write the picture; its path is returned."""
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None:
        raise SystemExit("Chromium is needed, and is not installed")
    with TemporaryDirectory() as name:
        page, shot = Path(name, "page.html"), Path(name, "shot.png")
        xlmc.load(CASE).simulate().save_page(page)
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--virtual-time-budget=2000"]
        options += [f"--user-data-dir={name}/profile", f"--window-size={_SIZE[0]},{_SIZE[1]}", f"--screenshot={shot}"]
        subprocess.run([browser, *options, page.as_uri()], check=True, capture_output=True)
        with Image.open(shot) as image:
            image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)
    return picture


if __name__ == "__main__":
    path = make(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURE)
    print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")
