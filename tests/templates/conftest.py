from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))

_CACHED = re.compile(r"(<f>[^<]*</f>)<v>[^<]*</v>")


def _script(path):
    spec = importlib.util.spec_from_file_location(f"{path.parent.name}_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def builders():
    """Folder -> its build script, loaded."""
    return {folder: _script(ROOT / folder / "build.py") for folder in ("templates", "examples")}


@pytest.fixture(scope="session")
def book_path():
    """Name -> the committed workbook."""
    return {"planar-impact": ROOT / "templates/planar-impact.xlsx", "intersection": ROOT / "examples/intersection.xlsx"}


@pytest.fixture(scope="session")
def described(builders):
    """Name -> what the workbook was built from."""
    return builders["templates"].TEMPLATES | builders["examples"].EXAMPLES


@pytest.fixture(scope="session")
def recalculated(book_path, tmp_path_factory):
    """Name -> the workbook as LibreOffice computes it from formulas alone: the cached values are removed first."""
    soffice = shutil.which("soffice")
    if soffice is None:
        pytest.skip("LibreOffice is not installed")
    folder = tmp_path_factory.mktemp("libreoffice")
    bare = [_without_cached_values(path, folder) for path in book_path.values()]
    profile = f"-env:UserInstallation={(folder / 'profile').as_uri()}"
    command = [soffice, "--headless", profile, "--convert-to", "xlsx", "--outdir", str(folder / "out"), *map(str, bare)]
    subprocess.run(command, check=True, capture_output=True, timeout=240)
    return {name: folder / "out" / path.name for name, path in book_path.items()}


def _without_cached_values(path, folder):
    target = folder / path.name
    with zipfile.ZipFile(path) as book, zipfile.ZipFile(target, "w") as bare:
        for name in book.namelist():
            part = book.read(name)
            if name.startswith("xl/worksheets/sheet"):
                part = _CACHED.sub(r"\1", part.decode()).encode()
            bare.writestr(name, part)
    return target
