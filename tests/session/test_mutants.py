"""The list of planted defects fits the code: `python tests/session/mutants.py` plants them."""

from __future__ import annotations

from mutants import MUTANTS, ROOT, modules_with, room_of
from rooms import ROOMS


def test_each_text_stands_once():
    assert {name: len(modules_with(mutant.before)) for name, mutant in MUTANTS.items()} == dict.fromkeys(MUTANTS, 1)


def test_each_has_tests():
    missing = [
        (name, tests) for name, each in MUTANTS.items() for tests in each.tests if not (ROOT / "tests" / tests).exists()
    ]
    assert missing == []


def test_there_are_forty_or_more_and_few_rooms_have_none():
    assert len(MUTANTS) >= 40
    assert {*ROOMS} - {room_of(mutant) for mutant in MUTANTS.values()} <= {"errors", "api"}
