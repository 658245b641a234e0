from __future__ import annotations

import re
from pathlib import Path

from templates.build import TEMPLATES

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "templates.md").read_text(encoding="utf-8")


def test_every_template_is_on_the_page_in_the_order_of_the_ladder():
    rows = re.findall(r"^\| `([a-z-]+)` \|", PAGE, re.MULTILINE)
    assert rows == sorted(TEMPLATES, key=lambda name: (TEMPLATES[name].group, TEMPLATES[name].rung))


def test_every_example_is_on_the_page(builders):
    section = PAGE.partition("## Worked examples")[2].partition("\n## ")[0]
    assert set(re.findall(r"`([a-z0-9-]+)`", section)) == set(builders["examples"].EXAMPLES)
