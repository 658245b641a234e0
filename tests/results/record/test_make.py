from __future__ import annotations

import json
from pathlib import Path

import pytest

import xlmc
from xlmc.results.record import make_record
from xlmc.results.record.errors_met import errors_met
from xlmc.statistics import rank_correlation
from xlmc.workbook.inject import original_hash

EXAMPLE = Path(__file__).resolve().parents[3] / "examples/intersection.xlsx"


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
    assert rows["late"]["parameters"] == "Low 0, High S!D1"
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
    found = run["area"].statistics
    low, high = found.central
    assert area == {
        "name": "area",
        "cell": "S!B1",
        "units": "ft²",
        "range_share": 0.51,
        "threshold": 16.0,
        "trials": found.trials,
        "mean": found.mean.value,
        "standard_deviation": found.standard_deviation.value,
        "low": low.value,
        "high": high.value,
        "notes": "Symbol: A",
    }
    assert inverse["trials"] == run.accepted - run.faults["inverse"]["#DIV/0!"] < run.accepted


def test_correlations_warnings_and_notices(run, record):
    [pair] = record.rows("correlations")
    found = rank_correlation(run.inputs["width"], run.inputs["length"])
    assert pair == {
        "first": "width",
        "second": "length",
        "rank_correlation": 0.4,
        "used": pytest.approx(0.4),
        "accepted": found.value,
        "accepted_error": found.error,
        "cell": "S!A9",
    }
    assert [row["message"] for row in record.rows("warnings")] == run.warnings != []
    assert [row["message"] for row in record.rows("notices")] == [
        "book.xlsx: calculation is manual",
        "S!A3: no forecast or filter needs the assumption 'idle'",
        *(str(notice) for notice in run.notices_of_run),
    ]
    assert "'inverse' hang on a single trial" in str(run.notices_of_run[0])  # its denominator passes 0


def test_errors_are_told_by_definition_cell_and_code(run, record):
    rows = [tuple(row.values()) for row in record.rows("errors")]
    assert rows == [
        ("filter", "root", "S!C1", "#NUM!", run.tally.errors[0]["#NUM!"]),
        ("forecast", "inverse", "S!B2", "#DIV/0!", run.faults["inverse"]["#DIV/0!"]),
        ("assumption", "late", "S!A5", "parameters are no distribution", run.invalid["late"]),
    ]
    assert all(met.trials > 0 for met in errors_met(run))


def test_a_record_is_plain_and_the_same_for_the_same_run(model, run, record):
    found = json.dumps(record.as_dict(), allow_nan=False)
    again = make_record(model.simulate(jobs=2), "xlmc simulate 'my book.xlsx'")
    assert json.dumps(again.as_dict(), allow_nan=False) == found


def test_without_accepted_trials_there_is_no_mean_to_record(model):
    empty = next(run for seed in range(200) if (run := model.simulate(1, seed=seed)).accepted == 0)
    record = make_record(empty)
    assert record.rows("forecasts")[0]["mean"] is None
    json.dumps(record.as_dict(), allow_nan=False)


def test_a_file_is_known_by_two_hashes():
    model = xlmc.load(EXAMPLE)
    record = make_record(model.simulate(100))
    assert record["file.sha256"] == model.workbook.sha256
    assert record["file.original_sha256"] == original_hash(model.workbook.parts)
