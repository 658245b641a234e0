from __future__ import annotations

import pytest

from xlmc.montecarlo.definitions.definitions import Settings
from xlmc.montecarlo.definitions.stopping import LIMIT, AcceptedTrials, Precision, StableDigits, Stopping

NAME, VALUE = "Answers!A31", "Answers!B31"

MISTAKES = [
    ("Trails", 100, NAME, "There is no setting 'Trails'", "Did you mean Trials?"),
    (
        "Colour",
        "red",
        NAME,
        "There is no setting 'Colour'",
        "Engine, Lognorm, Evidence, Detailed forecasts, Number style, Range %",
    ),
    (None, 5, NAME, "Setting is blank", "Fill in Setting"),
    ("Seed", 5, "Answers!A32", "Seed is set twice", "Keep one of the two rows"),
    ("Trials", None, VALUE, "Trials has no value", "or delete the row"),
    ("Trials", 0, VALUE, "Trials must be a whole number from 1 to 1,000,000,000,000, not 0", "Correct"),
    ("Trials", 0.5, VALUE, "Trials must be a whole number", "Correct the number"),
    ("Trials", 1e13, VALUE, "Trials must be a whole number", "Correct the number"),
    (
        "Trials",
        "200.000",
        VALUE,
        "Trials is '200.000', which is not a whole number",
        "like 200000, 200,000, 2e5 or 200k",
    ),
    ("Trials", "many\x1b[2J", VALUE, "Trials is 'many\\\\x1b[2J', which is not a whole number", "Type it like 200000"),
    (
        "Trials",
        "2e13",
        VALUE,
        "Trials must be a whole number from 1 to 1,000,000,000,000, not 20,000,000,000,000",
        "Correct",
    ),
    ("Trials", "9" * 100, VALUE, "Trials must be a whole number from 1", "Correct"),
    ("Until accepted", "1", VALUE, "Until accepted must be a whole number from 2", "Correct the number"),
    ("Sampling", "dice", VALUE, "There is no sampling method 'dice'", "Use mc, "),
    ("Engine", "numpi", VALUE, "There is no engine 'numpi'", "Did you mean numpy?"),
    ("Until accepted", 1, VALUE, "Until accepted must be a whole number from 2", "Correct the number"),
    ("Until accepted", 2.5, VALUE, "Until accepted must be a whole number", "Correct the number"),
    ("Rare", "sometimes", VALUE, "'sometimes' is not a method to look for rare trials", "Use auto, never or always"),
    ("Precision", 0, VALUE, "Precision must be above 0, not 0", "Correct the number"),
    ("Precision", "1%", VALUE, "Precision holds the text '1%', not a number", "Type a number"),
    ("Precision %", 0.01, VALUE, "Precision % must be 0.1 or more, not 0.01", "Type 1 for 1 %"),
    ("Precision of", "median", VALUE, "'median' is not a number whose precision", "Choose from mean, sd, range"),
    ("Precision of", "mean", "Answers!A30", "no precision was given", "Give a precision too"),
    ("Confidence %", 200, VALUE, "'200.0' is not a confidence level", "such as 95"),
    ("Significant digits", 9, VALUE, "Significant digits must be a whole number from 1 to 6", "Correct"),
    (
        "Look at",
        "x",
        "Answers!A30",
        "orecasts are named, and no precision or stable digits are asked for of them",
        "stable digits too",
    ),
    ("Time limit", "soon", VALUE, "'soon' is not a length of time", "such as 60s"),
    ("Time limit", 1 / 288, VALUE, "Time limit must be 1 second or more", "not a clock time"),
    ("Lognorm", "mine", VALUE, "There is no RiskLognorm of a program 'mine'", "Use @RISK"),
    ("Arithmetic", "float32", VALUE, "There is no arithmetic 'float32': xlmc computes in float64", "Delete the row"),
    ("Range %", 100, VALUE, "Range % (100) must be above 0 and below 100", "such as 51"),
]


@pytest.mark.parametrize(("setting", "value", "where", "message", "hint"), MISTAKES)
def test_mistakes(only_problem, setting, value, where, message, hint):
    only_problem(where, message, hint, {NAME: setting, VALUE: value})


@pytest.mark.parametrize("seed", [-1, 1.5, 1e16, "-1", "1e16"])
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
        ("Arithmetic", "Float64", Settings(seed=7)),
        ("Range %", 90, Settings(seed=7)),
    ],
)
def test_settings(read, setting, value, expected):
    result = read({NAME: setting, VALUE: value})
    assert result.problems == result.notices == ()
    assert result.settings == expected
    assert type(result.settings.trials) is type(result.settings.seed) is int


@pytest.mark.parametrize("written", ["200000", "200,000", "200 000", "2e5", "200k", "0.2M", " 200000 "])
def test_whole_numbers_written_as_text_are_read_as_on_the_command_line(read, written):
    for setting in ("Trials", "Until accepted"):
        result = read({NAME: setting, VALUE: written})
        assert result.problems == result.notices == ()
        read_as = result.settings.trials if setting == "Trials" else result.settings.stopping.accepted
        assert read_as == 200_000
        assert type(read_as) is int
    assert read({"Answers!B32": written}).settings.seed == 200_000


def test_a_seed_of_zero(read):
    assert read({"Answers!B32": 0}).settings.seed == 0


def test_a_range_below_1_is_a_share(read):
    result = read({NAME: "Range %", VALUE: 0.9})
    assert result.forecasts[0].central == 0.9
    assert [str(notice) for notice in result.notices] == ["Answers!B31: Range % 0.9 is read as 90 %"]


def test_two_tables(only_problem, blocks):
    copy = blocks("Copy!A1", [["Setting", "Value"], ["Trials", 6]])
    message = "xlmc_settings and xlmc_settings2 both hold settings"
    only_problem("Copy!A1", message, "came with a copied sheet", copy, tables={"xlmc_settings2": "Copy!A1:B2"})


@pytest.mark.parametrize(
    ("rows", "trials", "expected"),
    [
        ([["Until accepted", 500]], LIMIT, Stopping(AcceptedTrials(500))),
        ([["Until accepted", 500], ["Trials", 9000]], 9000, Stopping(AcceptedTrials(500))),
        ([["Until accepted", 500], ["Rare", "Never"]], LIMIT, Stopping(AcceptedTrials(500), rare="never")),
        ([["Precision %", 1]], LIMIT, Stopping(Precision(0.01, relative=True))),
        ([["precision", 0.25], ["Confidence %", 90]], LIMIT, Stopping(Precision(0.25, confidence=0.9))),
        (
            [["Precision", 2], ["Precision of", "SD, p75.5"], ["Look at", "Delta V; Speed ;"]],
            LIMIT,
            Stopping(Precision(2.0, numbers=("sd", "p75.5")), forecasts=("Delta V", "Speed")),
        ),
        ([["Significant digits", 2], ["Time limit", "5m"]], LIMIT, Stopping(StableDigits(2), seconds=300.0)),
        ([["Time limit", 90]], 200_000, Stopping(seconds=90.0)),
    ],
)
def test_when_the_run_ends(read, blocks, rows, trials, expected):
    table = blocks("End!A1", [["Setting", "Value"], *rows])
    result = read(table, tables={"xlmc_settings": f"End!A1:B{len(rows) + 1}"})
    assert result.problems == result.notices == ()
    assert (result.settings.trials, result.settings.stopping) == (trials, expected)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([["Precision %", 1], ["Precision", 1]], "Precision and Precision % are both set"),
        ([["Until accepted", 5], ["Precision", 1]], "accepted trials and a precision were both asked for"),
    ],
)
def test_settings_that_exclude_each_other(read, blocks, rows, message):
    result = read(blocks("End!A1", [["Setting", "Value"], *rows]), tables={"xlmc_settings": "End!A1:B3"})
    assert [(str(problem.where), problem.message) for problem in result.problems] == [("End!A1", message)]


def test_a_mistake_in_one_row_is_told_once(read, blocks):
    rows = [["Setting", "Value"], ["Precision", -1], ["Precision of", "mean"]]
    result = read(blocks("End!A1", rows), tables={"xlmc_settings": "End!A1:B3"})
    assert [problem.message for problem in result.problems] == ["Precision must be above 0, not -1"]


def test_a_precision_below_1_percent_is_told(read):
    result = read({NAME: "Precision %", VALUE: 0.5})
    assert [str(notice) for notice in result.notices] == ["Answers!B31: Precision % 0.5 is read as 0.5 %"]
    assert result.settings.stopping.goal.tolerance == 0.005
