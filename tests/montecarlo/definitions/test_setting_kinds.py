"""What a setting may be, how the record holds it, and how a command says it."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.setting_kinds import Names, Seconds, Switch, Whole, Word

TRIALS = Whole(1, 100, "{} trials were asked for", "Give 1 to 100")
SEED = Whole(0, None, "the seed {} is negative", "Give 0 or more", as_text=True)
ENGINE = Word(lambda: ("jit", "numpy"), "there is no engine {}")


@pytest.mark.parametrize(
    ("kind", "value"),
    [(TRIALS, 1), (TRIALS, 100), (TRIALS, np.int64(7)), (SEED, 0), (SEED, 2**63), (ENGINE, "jit"), (Seconds(), 1e-3)],
)
def test_what_a_setting_may_be(kind, value):
    kind.check(value)


@pytest.mark.parametrize(
    ("kind", "value", "message"),
    [
        (TRIALS, 0, "0 trials were asked for"),
        (TRIALS, 101, "101 trials were asked for"),
        (TRIALS, 2.0, "2.0 is no whole number"),
        (TRIALS, True, "True is no whole number"),
        (SEED, -1, "the seed -1 is negative"),
        (ENGINE, "JIT", "there is no engine 'JIT'"),
        (Seconds(), 0.0, "A time limit of 0.0 s"),
        (Seconds(), -1.0, "A time limit of -1.0 s"),
        (Seconds(), float("nan"), "A time limit of nan s"),
    ],
)
def test_what_it_may_not_be(kind, value, message):
    with pytest.raises(SimulationError) as caught:
        kind.check(value)
    assert message.lower() in str(caught.value).lower()
    assert caught.value.hint


@pytest.mark.parametrize(
    ("kind", "value", "entry", "arguments"),
    [
        (TRIALS, 7, 7, ["--x", "7"]),
        (SEED, 2**53 + 1, "9007199254740993", ["--x", "9007199254740993"]),
        (ENGINE, "jit", "jit", ["--x", "jit"]),
        (Switch(), True, True, ["--x"]),
        (Switch(), False, False, []),
        (Seconds(), 1.5, 1.5, ["--x", "1.5s"]),
        (Names(), ("a", "é, b"), '["a", "é, b"]', ["--x", "a", "--x", "é, b"]),
        (Names(), (), "[]", []),
    ],
)
def test_the_record_gives_a_setting_back_and_a_command_says_it(kind, value, entry, arguments):
    assert kind.entry(value) == entry
    assert kind.recorded(entry) == value
    assert kind.arguments("--x", value) == arguments


def test_a_sheet_may_hold_a_whole_number_as_a_float():
    result = TRIALS.recorded(7.0)
    assert (result, type(result)) == (7, int)
    for wrong in (7.5, "7"):
        with pytest.raises(ValueError, match="is not a whole number"):
            TRIALS.recorded(wrong)
    with pytest.raises(ValueError, match="invalid literal"):
        SEED.recorded(7.5)
