"""Write the extension of LibreOffice: `python packaging/libreoffice/build.py` makes build/xlmc.oxt."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PARTS = ("META-INF/manifest.xml", "description.xml", "Addons.xcu", "xlmc_menu.py")


def build(target: Path) -> None:
    """Write the extension, with the version that pyproject.toml names."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    target.parent.mkdir(parents=True, exist_ok=True)
    with ZipFile(target, "w", ZIP_DEFLATED) as package:
        for part in PARTS:
            package.writestr(part, (HERE / part).read_text(encoding="utf-8").replace('"VERSION"', f'"{version}"'))


if __name__ == "__main__":
    build(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "xlmc.oxt")
