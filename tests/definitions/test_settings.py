from __future__ import annotations

import pytest

from xlmc.definitions.model import Settings

NAME, VALUE = "Answers!A31", "Answers!B31"

MISTAKES = [
    ("Trails", 100, NAME, "There is no setting 'Trails'", "Did you mean Trials?"),
    ("Colour", "red", NAME, "There is no setting 'Colour'", "Use one of Trials, Seed, Sampling, Engine, Range %"),
    (None, 5, NAME, "Setting is blank", "Fill in Setting"),
    ("Seed", 5, "Answers!A32", "Seed is set twice", "Keep one of the two rows"),
    ("Trials", None, VALUE, "Trials has no value", "or delete the row"),
    ("Trials", 0, VALUE, "Trials must be a whole number from 1 to 1,000,000,000,000, not 0", "Correct"),
    ("Trials", 0.5, VALUE, "Trials must be a whole number", "Correct the number"),
    ("Trials", 1e13, VALUE, "Trials must be a whole number", "Correct the number"),
    ("Trials", "200,000", VALUE, "Trials holds the text '200,000', not a number", "Type it again as a number"),
    ("Sampling", "dice", VALUE, "There is no sampling method 'dice'", "Use mc, lhs, lhs500 or sobol"),
    ("Engine", "numpi", VALUE, "There is no engine 'numpi'", "Did you mean numpy?"),
    ("Range %", 100, VALUE, "Range % (100) must be above 0 and below 100", "such as 51"),
]


@pytest.mark.parametrize(("setting", "value", "where", "message", "hint"), MISTAKES)
def test_mistakes(only_problem, setting, value, where, message, hint):
    only_problem(where, message, hint, {NAME: setting, VALUE: value})


@pytest.mark.parametrize("seed", [-1, 1.5, 1e16])
def test_bad_seeds(only_problem, seed):
    only_problem("Answers!B32", "Seed must be a whole number from 0", "Correct", {"Answers!B32": seed})


@pytest.mark.parametrize(
    ("setting", "value", "expected"),
    [
        ("Trials", 1, Settings(trials=1, seed=7)),
        (" TRIALS ", ("=10^6", 1e6), Settings(trials=1_000_000, seed=7)),
        ("Trials", 1e12, Settings(trials=10**12, seed=7)),
        ("Sampling", "MC", Settings(seed=7)),
        ("sampling", "Monte Carlo", Settings(seed=7)),
        ("Sampling", "LHS", Settings(seed=7, sampling="lhs")),
        ("Sampling", "Latin hypercube", Settings(seed=7, sampling="lhs")),
        ("Sampling", "lhs 500", Settings(seed=7, sampling="lhs500")),
        ("Sampling", "Scrambled Sobol", Settings(seed=7, sampling="sobol")),
        ("Engine", "NumPy", Settings(seed=7)),
        ("Engine", "formulas", Settings(seed=7, engine="formulas")),
        ("Engine", "JIT", Settings(seed=7, engine="jit")),
        ("Range %", 90, Settings(seed=7)),
    ],
)
def test_settings(read, setting, value, expected):
    found = read({NAME: setting, VALUE: value})
    assert found.problems == found.notices == ()
    assert found.settings == expected
    assert type(found.settings.trials) is type(found.settings.seed) is int


def test_a_seed_of_zero(read):
    assert read({"Answers!B32": 0}).settings.seed == 0


def test_a_range_below_1_is_a_share(read):
    found = read({NAME: "Range %", VALUE: 0.9})
    assert found.forecasts[0].central == 0.9
    assert [str(notice) for notice in found.notices] == ["Answers!B31: Range % 0.9 is read as 90 %"]


def test_two_tables(only_problem, blocks):
    copy = blocks("Copy!A1", [["Setting", "Value"], ["Trials", 6]])
    message = "xlmc_settings and xlmc_settings2 both hold settings"
    only_problem("Copy!A1", message, "came with a copied sheet", copy, tables={"xlmc_settings2": "Copy!A1:B2"})
