from __future__ import annotations

import hashlib
import json
import shlex
import struct
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.record.errors_met import errors_met
from xlmc.analysis.results.record.make import fingerprint, quoted_argument, repeat_command
from xlmc.excel.workbook.inject import original_hash
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.run_settings import Settings
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.statistics import rank_correlation

EXAMPLE = Path(__file__).resolve().parents[4] / "examples/intersection.xlsx"

QUOTED = [
    ("book.xlsx", "book.xlsx"),
    ("my book.xlsx", '"my book.xlsx"'),
    ("O'Hara (2).xlsx", '"O\'Hara (2).xlsx"'),
    ("Größe.xlsx", "Größe.xlsx"),
    ("100% $a.xlsx", "'100% $a.xlsx'"),
    ('a"b.xlsx', "'a\"b.xlsx'"),
    ("a;b&c.xlsx", '"a;b&c.xlsx"'),
]


@pytest.fixture(scope="session")
def record(run):
    return make_record(run, "xlmc simulate 'my book.xlsx'")


def test_settings_and_counts(run, record):
    expected = {
        "sampling.trials": 4000,
        "sampling.seed": 5,
        "sampling.method": "mc",
        "sampling.engine": "numpy",
        "sampling.block": run.block,
        "counts.trials": 4000,
        "counts.accepted": run.accepted,
        "counts.acceptance": run.accepted / 4000,
        "counts.error_trials": run.error_trials,
        "counts.undecided": run.tally.by_error,
        "counts.invalid": sum(run.invalid.values()),
        "file.name": "my book.xlsx",
        "file.sha256": "ab" * 32,
        "run.command": "xlmc simulate 'my book.xlsx'",
        "run.repeat": 'xlmc simulate "my book.xlsx" --trials 4000 --seed 5',
        "conventions.percentiles": "linear between trials, as Excel's PERCENTILE.INC",
        "conventions.kurtosis": "3 for the normal distribution",
    }
    assert {key: record[key] for key in expected} == expected
    assert record["sampling.generator"].startswith("PCG64DXSM")


def test_a_run_from_python_has_no_command(run):
    with pytest.raises(KeyError):
        make_record(run)["run.command"]


def test_every_assumption_is_there_with_what_became_of_it(record):
    rows = {row["name"]: row for row in record.rows("assumptions")}
    assert rows["width"] == {
        "name": "width",
        "cell": "S!A1",
        "status": "drawn",
        "distribution": "Uniform",
        "parameters": "Low 1, High 3",
        "cutoffs": "",
        "base": 2.0,
        "units": "ft",
        "source": "tape",
        "notes": "By: JD; Day: 3",
    }
    assert rows["length"]["cutoffs"] == "below 2"
    assert rows["late"]["parameters"] == "Low 0, High 1.5 (S!D1: =A1*2-2.5)"
    assert [row["status"] for row in rows.values()] == ["drawn", "drawn", "not needed", "frozen", "drawn"]


def test_filters_with_reasons_and_counts(run, record):
    tally = run.tally
    assert record.rows("filters") == [
        {
            "name": "root",
            "cell": "S!C1",
            "limits": "at most 1.2",
            "because": "seen",
            "rejected": tally.rejected[0],
            "only": tally.only[0],
            "errors": tally.errors[0]["#NUM!"],
            "notes": "",
        }
    ]


def test_forecasts_with_results_at_full_precision(run, record):
    area, inverse, _ = record.rows("forecasts")
    result = run["area"].statistics
    low, high = result.central
    assert area == {
        "name": "area",
        "cell": "S!B1",
        "units": "ft²",
        "range_share": 0.51,
        "threshold": 16.0,
        "trials": result.trials,
        "mean": result.mean.value,
        "standard_deviation": result.standard_deviation.value,
        "low": low.value,
        "high": high.value,
        "notes": "Symbol: A",
    }
    assert inverse["trials"] == run.accepted - run.faults["inverse"]["#DIV/0!"] < run.accepted


def test_correlations_warnings_and_notices(run, record):
    [pair] = record.rows("correlations")
    result = rank_correlation(run.inputs["width"], run.inputs["length"])
    assert pair == {
        "first": "width",
        "second": "length",
        "rank_correlation": 0.4,
        "used": pytest.approx(0.4),
        "accepted": result.value,
        "accepted_error": result.error,
        "cell": "S!A9",
    }
    assert [row["message"] for row in record.rows("warnings")] == run.warnings != []
    assert [row["message"] for row in record.rows("notices")] == [
        "book.xlsx: Calculation is manual",
        "S!A3: No forecast or filter needs the assumption 'idle'",
        *(str(notice) for notice in run.notices_of_run),
    ]
    assert "'inverse' depend on a single trial" in str(run.notices_of_run[0])  # its denominator passes 0


def test_errors_are_told_by_definition_cell_and_code(run, record):
    rows = [tuple(row.values()) for row in record.rows("errors")]
    assert rows == [
        ("filter", "root", "S!C1", "#NUM!", run.tally.errors[0]["#NUM!"]),
        ("forecast", "inverse", "S!B2", "#DIV/0!", run.faults["inverse"]["#DIV/0!"]),
        ("assumption", "late", "S!A5", "parameters are not a distribution", run.invalid["late"]),
    ]
    assert all(met.trials > 0 for met in errors_met(run))


def test_a_record_is_plain_and_the_same_for_the_same_run(model, run, record):
    result = json.dumps(record.as_dict(), allow_nan=False)
    again = make_record(simulated(model, jobs=2), "xlmc simulate 'my book.xlsx'")
    assert json.dumps(again.as_dict(), allow_nan=False) == result


def test_without_accepted_trials_there_is_no_mean_to_record(model):
    empty = next(run for seed in range(200) if (run := simulated(model, 1, seed=seed)).accepted == 0)
    record = make_record(empty)
    assert record.rows("forecasts")[0]["mean"] is None
    json.dumps(record.as_dict(), allow_nan=False)


def test_a_file_is_known_by_two_hashes():
    model = load(EXAMPLE)
    record = make_record(simulated(model, 100))
    assert record["file.sha256"] == model.workbook.sha256
    assert record["file.original_sha256"] == original_hash(model.workbook.parts)


def _run(index, inputs, forecasts):
    return SimpleNamespace(
        trial_index=np.array(index),
        inputs={str(n): np.array(values) for n, values in enumerate(inputs)},
        forecasts={str(n): np.array(values) for n, values in enumerate(forecasts)},
    )


def test_it_is_the_hash_of_indices_inputs_and_forecasts():
    expected = hashlib.sha256(struct.pack("<2q", 3, 8) + struct.pack("<4d", 0.5, 1.5, -1.0, np.nan)).hexdigest()
    assert fingerprint(_run([3, 8], [[0.5, 1.5]], [[-1.0, np.nan]])) == expected


def test_every_missing_number_counts_the_same():
    other = struct.unpack("<d", struct.pack("<Q", 0xFFF8_0000_0000_0001))[0]
    assert fingerprint(_run([1], [[other]], [[0.0]])) == fingerprint(_run([1], [[np.nan]], [[0.0]]))


def test_it_depends_on_the_seed_and_not_on_the_threads(model, run):
    assert fingerprint(simulated(model, jobs=2)) == fingerprint(run)
    assert fingerprint(simulated(model, seed=6)) != fingerprint(run)


def test_one_bit_changes_it():
    assert fingerprint(_run([1], [[1.0]], [])) != fingerprint(_run([1], [[np.nextafter(1.0, 2.0)]], []))


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
    definitions = SimpleNamespace(settings=own, feeding=None, python=None)
    model = SimpleNamespace(definitions=definitions, workbook=SimpleNamespace(name="-b.xlsx", functions=None))
    used = replace(own, trials=20, sampling="lhs", engine="jit")
    repeating = RunOptions.repeating(used, trials=20, by="trials", weighable=False)
    simulation = SimpleNamespace(repeating=repeating, model=model, changed_from=None)
    command = "xlmc simulate ./-b.xlsx --trials 20 --seed 1 --sampling lhs --engine jit"
    assert repeat_command(simulation) == command


def test_the_settings_of_a_run_by_another_engine_are_said(model):
    assert repeat_command(simulated(model, 10, engine="formulas")).endswith("--trials 10 --seed 5 --engine formulas")
