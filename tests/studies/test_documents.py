from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_the_python_of_the_page_on_comparing_runs():
    block = re.search(r"```python\n(.*?)```", (ROOT / "docs" / "comparing.md").read_text(encoding="utf-8"), re.DOTALL)
    assert block is not None
    done = subprocess.run([sys.executable, "-c", block[1]], check=True, cwd=ROOT, capture_output=True, text=True)
    assert "is enough for Chevrolet delta-V to 1.5 mph" in done.stdout
    assert "Nissan yaw moment of inertia" in done.stdout
