from __future__ import annotations

import csv
import gc
import json
import sys
import tracemalloc
from dataclasses import replace

import numpy as np
import pandas
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.api import Simulation
from xlmc.errors import SimulationError, WorkbookError
from xlmc.montecarlo.columns import on_disk
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.extract import safe_heading

parquet = pytest.importorskip("pyarrow.parquet")

PART = 512
"""Trials that are written at once, so that the files have several parts."""


@pytest.fixture(scope="session")
def model(small_book):
    return load(small_book)


@pytest.fixture
def few_at_once(monkeypatch):
    """Few trials are written at once."""
    monkeypatch.setattr("xlmc.outputs.extract.PART", PART)
    monkeypatch.setattr("xlmc.outputs.extract._ROW_GROUP", PART)


def read_csv(path):
    return pandas.read_csv(path, index_col="Trial")


def read_parquet(path):
    return pandas.read_parquet(path).set_index("Trial")


@pytest.mark.parametrize(("ending", "read"), [("csv", read_csv), ("parquet", read_parquet)])
@pytest.mark.usefixtures("few_at_once")
def test_it_reads_back_as_the_frame_to_the_last_bit(model, tmp_path, ending, read):
    many = simulated(model, 2_000)
    assert many.accepted > 2 * PART
    Simulation(many).extract(tmp_path / f"trials.{ending}")
    expected = many.frame()
    if ending == "csv":
        expected = expected.rename(columns=safe_heading)
    assert expected["inverse"].isna().any()
    pandas.testing.assert_frame_equal(read(tmp_path / f"trials.{ending}"), expected, check_exact=True)


@pytest.mark.parametrize("reader", ["pandas", "polars"])
@pytest.mark.usefixtures("few_at_once")
def test_trials_on_disk_go_to_parquet_by_parts_that_others_read_one_by_one(model, tmp_path, reader):
    frames = pytest.importorskip(reader)
    run = simulated(model, 4_000, in_memory=1 << 12)
    assert on_disk(run.forecasts["area"])
    path = tmp_path / "trials.parquet"
    Simulation(run).extract(path)
    file = parquet.ParquetFile(path)
    sizes = [file.metadata.row_group(part).num_rows for part in range(file.num_row_groups)]
    assert sizes == [PART] * (run.accepted // PART) + [run.accepted % PART]
    columns = {"Trial": run.trial_index, **run.inputs, **run.forecasts}
    start = 0
    for part, size in enumerate(sizes):
        if reader == "pandas":
            result = file.read_row_group(part).to_pandas()
        else:
            result = frames.scan_parquet(path).slice(start, size).collect()
        for name, values in columns.items():
            read = np.asarray(result[name].to_numpy(), values.dtype)
            np.testing.assert_array_equal(read, values[start : start + size], strict=True)
        start += size


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_the_same_run_gives_the_same_bytes(model, tmp_path, ending):
    for name in ("a", "b"):
        Simulation(simulated(model)).extract(tmp_path / f"{name}.{ending}")
    assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


def test_headings_are_no_formulas_and_missing_numbers_are_blank(model, tmp_path):
    run = simulated(model)
    Simulation(run).extract(tmp_path / "trials.csv")
    with (tmp_path / "trials.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["Trial", "width", "'=length", "area", "inverse"]
    assert [row[4] == "" for row in rows[1:]] == np.isnan(run.forecasts["inverse"]).tolist()
    assert rows[1][1] == repr(float(run.inputs["width"][0]))


@given(st.text(max_size=8))
def test_no_heading_begins_a_formula(name):
    safe = safe_heading(name)
    assert not safe.startswith(("=", "+", "-", "@", "\t", "\r", "\n"))
    assert safe.removeprefix("'") == name.removeprefix("'")


def test_names_beyond_ascii_have_a_byte_order_mark_for_excel(make, tmp_path):
    run = make.simulate({"A1": 1.0, "B1": "=A1"}, [make.uniform("μ", "A1", 0.0, 1.0)], [make.forecast("ΔV", "B1")])
    Simulation(run).extract(tmp_path / "trials.csv")
    assert (tmp_path / "trials.csv").read_bytes().startswith("\ufeffTrial,μ,ΔV\r\n".encode())
    assert list(read_csv(tmp_path / "trials.csv")) == ["μ", "ΔV"]


def test_an_assumption_with_the_name_of_a_forecast(make, tmp_path):
    run = make.simulate({"A1": 1.0, "B1": "=A1"}, [make.uniform("v", "A1", 0.0, 1.0)], [make.forecast("v", "B1")])
    Simulation(run).extract(tmp_path / "trials.csv")
    assert list(read_csv(tmp_path / "trials.csv")) == ["v (assumption)", "v"] == list(run.frame())


@pytest.mark.parametrize(("ending", "read"), [("csv", read_csv), ("parquet", read_parquet)])
@pytest.mark.parametrize("kept", [0, 100])
def test_draws_that_were_not_kept_are_blank(model, tmp_path, ending, read, kept):
    run = simulated(model, keep_inputs=kept)
    Simulation(run).extract(tmp_path / f"trials.{ending}")
    result = read(tmp_path / f"trials.{ending}")
    assert result["width"].notna().tolist() == [index < kept for index in range(run.accepted)]
    assert np.array_equal(result["area"], run.forecasts["area"])


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_no_accepted_trial_is_a_table_without_rows(model, tmp_path, ending):
    Simulation(simulated(model, 1)).extract(tmp_path / f"trials.{ending}")
    read = read_csv if ending == "csv" else read_parquet
    result = read(tmp_path / f"trials.{ending}")
    assert result.empty
    assert len(result.columns) == 4


def test_parquet_knows_the_record_and_the_units(model, tmp_path):
    run = simulated(model)
    Simulation(run).extract(tmp_path / "trials.parquet")
    schema = parquet.read_schema(tmp_path / "trials.parquet")
    assert json.loads(schema.metadata[b"xlmc"]) == json.loads(json.dumps(make_record(run).as_dict()))
    assert schema.field("width").metadata == {b"kind": b"assumption", b"units": b"ft", b"cell": b"Inputs!B2"}
    assert schema.field("area").metadata == {b"kind": b"forecast", b"units": "ft²".encode(), b"cell": b"Model!A2"}
    table = parquet.read_table(tmp_path / "trials.parquet")
    assert table["inverse"].null_count == int(np.isnan(run.forecasts["inverse"]).sum())


def test_columns_on_disk_give_the_same_files(model, tmp_path, monkeypatch):
    Simulation(simulated(model)).extract(tmp_path / "a.csv")
    monkeypatch.setattr("xlmc.montecarlo.columns.column_store.IN_MEMORY", 0)
    Simulation(simulated(model)).extract(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


@pytest.mark.usefixtures("few_at_once")
@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_it_takes_no_more_memory_for_more_trials(model, tmp_path, ending, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.extract.make_record", lambda *_: _Empty())
    run = simulated(model, 50)
    peaks = []
    for n in (8 * PART, 8 * PART, 200 * PART):  # the first one pays for what is imported and kept
        large = replace(
            run,
            accepted_index=np.arange(n),
            inputs=dict.fromkeys(run.inputs, np.full(n, 0.1)),
            forecasts=dict.fromkeys(run.forecasts, np.full(n, 0.1)),
        )
        gc.collect()
        tracemalloc.start()
        Simulation(large).extract(tmp_path / f"trials.{ending}", overwrite=True)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    column = 8 * 192 * PART  # bytes of what each column has more
    assert peaks[2] - peaks[1] < column / 2


class _Empty:
    """No record, whose statistics sort whole columns: here the table alone is looked at."""

    def as_dict(self):
        return {}


@pytest.mark.parametrize("name", ["trials.xlsx", "trials", "no/trials.csv"])
def test_where_it_cannot_be_written(model, tmp_path, name):
    with pytest.raises(WorkbookError):
        Simulation(simulated(model, 5)).extract(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_parquet_without_pyarrow_is_a_message(model, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr("xlmc.outputs.extract.find_spec", lambda name: None)
    with pytest.raises(SimulationError, match=r"need pyarrow, which is not installed.*pip install .pyarrow>=16"):
        Simulation(simulated(model, 5)).extract(tmp_path / "trials.parquet")


def test_a_failed_write_leaves_the_old_file(model, tmp_path, monkeypatch):
    path = tmp_path / "trials.csv"
    path.write_bytes(b"old")
    monkeypatch.setattr("xlmc.outputs.extract._fields", lambda values, labels: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        Simulation(simulated(model)).extract(path, overwrite=True)
    assert [(each.name, each.read_bytes()) for each in tmp_path.iterdir()] == [("trials.csv", b"old")]


@pytest.mark.parametrize("whose", ["assumption", "forecast"])
def test_nothing_else_is_called_as_the_trials_are(make, tmp_path, whose):
    names = {"assumption": "width", "forecast": "area", whose: "Trial"}
    run = make.simulate(
        {"A1": 2.0, "B1": "=A1*2"},
        [make.uniform(names["assumption"], "A1", 1.0, 3.0, base=2.0)],
        [make.forecast(names["forecast"], "B1")],
        trials=50,
    )
    expected = run.frame()
    assert f"Trial ({whose})" in expected.columns
    for ending, read in (("csv", read_csv), ("parquet", read_parquet)):
        Simulation(run).extract(tmp_path / f"trials.{ending}")
        pandas.testing.assert_frame_equal(read(tmp_path / f"trials.{ending}"), expected, check_exact=True)


@pytest.mark.parametrize(
    ("name", "field"),
    [
        (";=1+1", ";'=1+1"),
        ("speed; @SUM(A1)", "speed; '@SUM(A1)"),
        ('a;"+1', "a;\"'+1"),
        ("=1;-2", "'=1;'-2"),
        ("a;b", "a;b"),
        ("x - y", "x - y"),
    ],
)
def test_a_name_is_no_formula_where_semicolons_separate_fields_either(name, field):
    assert safe_heading(name) == field
