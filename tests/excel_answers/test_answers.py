"""Excel's certain answers to one-line formulas, by family: as they stand, and with every number drawn from a cell.

See `conftest.py` for the form of the tables. Where the numbers are drawn, each always comes out as itself, so that the
answer is the same; what is evaluated is not: trial by trial, by each engine, nothing known before the run.
"""

from __future__ import annotations

import re

import pytest

from xlmc.excel.functions.families import REGISTRY

UNSEEN = {"NOW", "TODAY"}
"""What has another answer each day."""


@pytest.fixture(scope="module")
def failures(answers):
    """`failures(way)`: the rows whose answers are not met, as lines."""

    def result(way):
        met = answers.by_way(way)
        return {
            row: f"{row} gives {met[row]!r}, not {row.answer!r}" for row in answers.rows if not row.is_met_by(met[row])
        }

    return result


def test_there_are_enough_of_them_of_every_family(answers):
    families = {row.family for row in answers.rows}
    assert len(answers.rows) >= 1500
    assert len({row.text for row in answers.rows}) >= 0.99 * len(answers.rows)
    assert len(families) >= 14


@pytest.mark.parametrize("ways", [("constant",), ("numpy", "jit")], ids=["constant", "drawn"])
def test_every_answer_is_met_and_what_is_expected_to_fail_still_fails(answers, failures, ways):
    for way in ways:
        expected, failed = answers.expected_failures(way), failures(way)
        unexpected = [f"{way}: {line}" for row, line in failed.items() if row not in expected]
        assert not unexpected, "\n".join(unexpected)
        mended = [str(row) for row in expected if row not in failed]
        assert not mended, f"take these out of expected_failures.txt, {way}:\n" + "\n".join(mended)


def test_every_function_of_the_registry_is_in_a_table(answers):
    called = set(re.findall(r"[A-Z][A-Z0-9.]*(?=\()", " ".join(row.text for row in answers.rows)))
    rows = {row for name, row in REGISTRY.items() if name.isupper() and name not in UNSEEN}
    missing = {row.name for row in rows} - {REGISTRY[name].name for name in called if name in REGISTRY}
    assert missing == set()
