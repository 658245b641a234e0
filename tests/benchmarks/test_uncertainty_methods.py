from __future__ import annotations

import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "uncertainty-methods.md").read_text(encoding="utf-8")


def test_the_committed_errors_are_those_of_theory():
    """The bar: within 20 % of theory over at least 200 replicates, every number of every forecast and run length."""
    table = PAGE.partition("<!-- theory -->")[2].partition("<!-- /theory -->")[0]
    rows = [line.strip("| ").split(" | ") for line in table.splitlines() if "±" in line]
    assert len(rows) == 12
    for cell in (cell for row in rows for cell in row[2:]):
        assert float(cell.partition(" ±")[0]) == pytest.approx(1.0, abs=0.2)


def test_the_page_and_the_results_are_of_one_run():
    result = json.loads((ROOT / "benchmarks" / "results" / "uncertainty-methods.json").read_text(encoding="utf-8"))[
        "found"
    ]
    assert f"Reference: {result['reference']['trials']:,} trials" in PAGE
    for message in result["recommendation"]:
        assert message in PAGE
