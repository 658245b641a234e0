from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def test_the_python_of_the_page_on_comparing_runs(monkeypatch, capsys):
    block = re.search(r"```python\n(.*?)```", (ROOT / "docs" / "comparing.md").read_text(encoding="utf-8"), re.DOTALL)
    assert block is not None
    monkeypatch.chdir(ROOT)
    assert block[1].count("100_000") == 2
    exec(block[1].replace("100_000", "10_000"), {})
    printed = capsys.readouterr().out
    assert "is enough for Chevrolet delta-V to 1.5 mph" in printed
    assert "Nissan yaw moment of inertia" in printed
