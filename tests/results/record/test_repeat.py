from __future__ import annotations

import shlex
from dataclasses import replace
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.definitions.model import Settings
from xlmc.results.record.repeat import quoted_argument, repeat_command
from xlmc.run.stopping.stopped import ALL_TRIALS

QUOTED = [
    ("book.xlsx", "book.xlsx"),
    ("my book.xlsx", '"my book.xlsx"'),
    ("O'Hara (2).xlsx", '"O\'Hara (2).xlsx"'),
    ("Größe.xlsx", "Größe.xlsx"),
    ("100% $a.xlsx", "'100% $a.xlsx'"),
    ('a"b.xlsx', "'a\"b.xlsx'"),
    ("a;b&c.xlsx", '"a;b&c.xlsx"'),
]


@pytest.mark.parametrize(("text", "expected"), QUOTED)
def test_quoting(text, expected):
    assert quoted_argument(text) == expected


@given(st.text(min_size=1))
def test_a_shell_reads_one_argument_the_same_as_written(text):
    assert shlex.split(quoted_argument(text)) == [text]


def test_trials_and_seed_are_always_said(run):
    assert repeat_command(run) == 'xlmc simulate "my book.xlsx" --trials 4000 --seed 5'


def test_other_settings_are_said_where_the_workbook_does_not_say_them():
    own = Settings(trials=10, seed=1, sampling="mc", engine="numpy")
    model = SimpleNamespace(definitions=SimpleNamespace(settings=own), workbook=SimpleNamespace(name="-b.xlsx"))
    used = replace(own, sampling="lhs", engine="jit")
    simulation = SimpleNamespace(settings=used, model=model, trials=20, stopped=ALL_TRIALS)
    command = "xlmc simulate ./-b.xlsx --trials 20 --seed 1 --sampling lhs --engine jit"
    assert repeat_command(simulation) == command


def test_the_settings_of_a_run_by_another_engine_are_said(model):
    assert repeat_command(model.simulate(10, engine="formulas")).endswith("--trials 10 --seed 5 --engine formulas")
