from __future__ import annotations

import hashlib
import io
import json
import tracemalloc
import zipfile
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.saved import is_saved_run, keep, open_run
from xlmc.analysis.results.saved.archive import RUN, WORKBOOK
from xlmc.api import Simulation
from xlmc.errors import SimulationError, WorkbookError, XlmcError
from xlmc.montecarlo.columns import on_disk
from xlmc.montecarlo.model.loading import load

RUNS = {
    "Monte Carlo": {},
    "Latin hypercube": {"sampling": "lhs"},
    "Sobol": {"sampling": "sobol"},
    "until accepted": {"until_accepted": 100},
    "precision": {"precision": "20%", "precision_of": "p50", "forecasts": "area", "time_limit": 60},
    "stable digits": {"adaptive": 1, "trials": 3000},
    "some draws kept": {"keep_inputs": 10},
    "no draws kept": {"keep_inputs": 0},
    "compiled": {"engine": "jit"},
    "slow reference": {"engine": "formulas", "trials": 10},
    "one trial": {"trials": 1},
    "rare": {"until_accepted": 100, "rare": "always"},
}


@pytest.fixture(scope="session")
def model(small_book):
    return load(small_book)


@pytest.fixture(scope="session")
def run(model):
    return simulated(model)


@pytest.fixture(scope="session")
def saved(run, tmp_path_factory):
    return keep(run, tmp_path_factory.mktemp("saved") / "run.xlmcrun")


def same(first, second):
    """Whether two runs are equal in every number that they hold."""
    for name in ("trial_index", "inputs", "prior", "forecasts"):
        one, other = getattr(first, name), getattr(second, name)
        columns = [("", one, other)] if name == "trial_index" else [(key, one[key], other[key]) for key in one]
        assert name == "trial_index" or list(one) == list(other)
        for key, mine, theirs in columns:
            assert mine.dtype == theirs.dtype, (name, key)
            assert np.array_equal(mine, theirs, equal_nan=mine.dtype.kind == "f"), (name, key)
    for field in fields(first.tally):
        one, other = getattr(first.tally, field.name), getattr(second.tally, field.name)
        assert np.array_equal(one, other), field.name
    for name in (
        "settings",
        "plan",
        "block",
        "trials",
        "faults",
        "invalid",
        "error_trials",
        "stopped",
        "rare",
    ):
        assert getattr(first, name) == getattr(second, name), name
    for name, result in first.results.items():
        assert repr(result.statistics) == repr(second[name].statistics)  # NaN is not equal to itself
    assert first.warnings == second.warnings
    assert make_record(first, "typed").as_dict() == make_record(second, "typed").as_dict()
    return True


@pytest.mark.parametrize("asked", RUNS.values(), ids=RUNS)
def test_a_saved_run_is_the_same_run_again(model, tmp_path, asked):
    run = simulated(model, **asked)
    Simulation(run).keep(tmp_path / "a.xlmcrun")
    again = open_run(tmp_path / "a.xlmcrun")
    assert same(run, again)
    Simulation(again).keep(tmp_path / "b.xlmcrun")
    assert (tmp_path / "a.xlmcrun").read_bytes() == (tmp_path / "b.xlmcrun").read_bytes()


def test_its_result_workbook_is_the_same_byte_for_byte(run, saved, tmp_path):
    Simulation(run).save(tmp_path / "a.xlsx")
    Simulation(open_run(saved)).save(tmp_path / "b.xlsx")
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "b.xlsx").read_bytes()


def test_it_holds_the_workbook_as_it_was(saved, small_book):
    with zipfile.ZipFile(saved) as package:
        assert package.read(WORKBOOK) == small_book.read_bytes()
        assert {entry.compress_type for entry in package.infolist()} == {zipfile.ZIP_STORED}
        assert {entry.date_time for entry in package.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        columns = [np.load(io.BytesIO(package.read(name)), allow_pickle=False) for name in package.namelist()[1:-1]]
    assert {column.dtype.str for column in columns} == {"<f8", "<i8"}


def test_columns_on_disk_are_saved_and_opened_on_disk(model, tmp_path, saved, monkeypatch):
    monkeypatch.setattr("xlmc.montecarlo.columns.column_store.IN_MEMORY", 0)
    run = simulated(model)
    assert on_disk(run.trial_index)
    Simulation(run).keep(tmp_path / "a.xlmcrun")
    assert (tmp_path / "a.xlmcrun").read_bytes() == saved.read_bytes()
    again = open_run(saved)
    assert on_disk(again.trial_index)
    assert same(run, again)


def test_saving_takes_little_memory(run, tmp_path):
    n = 1_000_000
    large = replace(
        run,
        trials=n,
        settings=replace(run.settings, trials=n),
        plan=replace(run.plan, trials=n),
        accepted_index=np.arange(n),
        inputs=dict.fromkeys(run.inputs, np.ones(n)),
        forecasts=dict.fromkeys(run.forecasts, np.ones(n)),
    )
    tracemalloc.start()
    keep(large, tmp_path / "large.xlmcrun")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert (tmp_path / "large.xlmcrun").stat().st_size > 8 * 5 * n
    assert peak < 8 * n / 2  # half of one of five columns


def test_it_names_where_it_was_made(saved, monkeypatch):
    here = make_record(open_run(saved))
    monkeypatch.setattr("xlmc.analysis.results.record.make.versions", lambda engine: {"xlmc": "99"})
    again = make_record(open_run(saved))
    assert again["software.numpy"] == here["software.numpy"] == np.__version__
    assert again["processor.machine"] == here["processor.machine"]


def test_a_run_whose_workbook_is_no_file_is_refused(book, tmp_path):
    run = simulated(book({"A1": 1.0}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "A1"}), 100)
    with pytest.raises(SimulationError, match="was not read from a file"):
        Simulation(run).keep(tmp_path / "a.xlmcrun")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "message"),
    [("run.xlsx", "A saved run must end in .xlmcrun.*'run.xlmcrun'"), ("no/run.xlmcrun", "There is no folder")],
)
def test_where_it_cannot_be_written(run, tmp_path, name, message):
    with pytest.raises(WorkbookError, match=message):
        Simulation(run).keep(tmp_path / name)


def test_a_failed_write_leaves_the_old_file(run, saved, tmp_path, monkeypatch):
    path = tmp_path / "run.xlmcrun"
    path.write_bytes(saved.read_bytes())
    monkeypatch.setattr("xlmc.analysis.results.saved.keeping.tally_document", lambda tally: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        Simulation(run).keep(path)
    assert [(each.name, each.read_bytes()) for each in tmp_path.iterdir()] == [("run.xlmcrun", saved.read_bytes())]


def repacked(saved, path, change, *, compression=zipfile.ZIP_STORED):
    """The saved run with other entries: `change` is given name -> bytes and the document, and alters both."""
    with zipfile.ZipFile(saved) as package:
        parts = {name: package.read(name) for name in package.namelist()}
    document = json.loads(parts[RUN])
    change(parts, document)
    if RUN in parts:
        parts[RUN] = json.dumps(document).encode()
    with zipfile.ZipFile(path, "w", compression) as package:
        for name, data in parts.items():
            package.writestr(name, data)
    return path


def with_column(number, values, **about):
    """A change that puts another column in, with its right digest."""

    def change(parts, document):
        written = io.BytesIO()
        np.save(written, values, allow_pickle=True)
        parts[f"columns/{number}.npy"] = written.getvalue()
        document["columns"][number] |= {
            "count": len(values),
            "sha256": hashlib.sha256(written.getvalue()).hexdigest(),
            **about,
        }

    return change


def changed(**result):
    return lambda parts, document: document.update(result)


FAULTS = {
    "a later version": (changed(version=3), "version 3, and this xlmc reads version 2"),
    "an earlier version": (changed(version=1), "version 1, and this xlmc reads version 2"),
    "another format": (changed(format="zip"), "its format"),
    "no columns": (changed(columns=[]), "its list of trials"),
    "more trials than were planned": (changed(trials=10**9), "its number of trials"),
    "no trials": (changed(trials=0), "its number of trials"),
    "a number that is a text": (changed(block="x"), "the size of its blocks"),
    "no tally": (lambda p, d: d.pop("tally"), "'tally'"),
    "filters of another book": (lambda p, d: d["tally"].update(rejected=[1, 2]), "its filters"),
    "unknown sampling": (lambda p, d: d["settings"].update(sampling="dice"), "no sampling method 'dice'"),
    "unknown setting": (lambda p, d: d["settings"].update(magic=1), "magic"),
    "two goals": (lambda p, d: d["settings"]["stopping"].update(accepted=3, digits=1), "were both asked for"),
    "unknown end": (lambda p, d: d["stopped"].update(by="boredom"), "its end"),
    "a column less": (lambda p, d: p.pop("columns/1.npy"), "lacks 'columns/1.npy'"),
    "a column that nobody lists": (lambda p, d: p.update({"columns/x.npy": b""}), "something else than xlmc"),
    "a path out of the package": (lambda p, d: p.update({"../evil": b""}), "something else than xlmc"),
    "no document": (lambda p, d: p.pop(RUN), "is not a saved run"),
    "another workbook": (lambda p, d: p.update({WORKBOOK: b"PK"}), "is not the one that was run"),
    "another column": (lambda p, d: p.update({"columns/1.npy": p["columns/2.npy"]}), "its SHA-256 is another"),
    "objects": (with_column(1, np.array([{}] * 3, dtype=object)), "differs from what the file says of it"),
    "fewer numbers than it says": (with_column(1, np.ones(5), count=9), "differs from what the file says of it"),
    "more numbers than it says": (with_column(1, np.ones(9), count=5), "differs from what the file says of it"),
    "columns of different lengths": (with_column(1, np.ones(9)), "columns of different lengths"),
    "trials beyond the run": (lambda p, d: with_column(0, np.arange(d["columns"][0]["count"]) + 10**12)(p, d), "trial"),
    "trials twice": (lambda p, d: with_column(0, np.zeros(d["columns"][0]["count"], int))(p, d), "its trial numbers"),
    "infinite results": (
        lambda p, d: with_column(6, np.full(d["columns"][6]["count"], np.inf))(p, d),
        "the forecast 'inverse'",
    ),
    "an order of what is not there": (changed(order=["nothing"]), "its order of dimensions"),
}


@pytest.mark.usefixtures("read_once")
@pytest.mark.parametrize(("change", "message"), list(FAULTS.values()), ids=list(FAULTS))
def test_what_is_no_saved_run_is_refused_in_words(saved, tmp_path, change, message):
    with pytest.raises(XlmcError, match=message):
        open_run(repacked(saved, tmp_path / "bad.xlmcrun", change))


GOALS = {
    "accepted": (
        {"until_accepted": 100, "rare": "never", "time_limit": "5m"},
        '{"accepted": 100, "precision": null, "digits": null, "forecasts": [], "seconds": 300.0, "rare": "never"}',
    ),
    "precision": (
        {"precision": "20%", "precision_of": "p50,mean", "forecasts": "area", "confidence": 90},
        '{"accepted": null, "precision": {"tolerance": 0.2, "relative": true, "numbers": ["p50", "mean"], '
        '"confidence": 0.9}, "digits": null, "forecasts": ["area"], "seconds": null, "rare": null}',
    ),
    "adaptive": (
        {"adaptive": 1, "trials": 3000},
        '{"accepted": null, "precision": null, "digits": 1, "forecasts": [], "seconds": null, "rare": null}',
    ),
}
"""Goal -> what asks for it, and the part `settings.stopping` of run.json as xlmc 0.4.0 wrote it."""


@pytest.mark.parametrize(("asked", "written"), GOALS.values(), ids=GOALS)
def test_goals_are_saved_and_opened_as_in_version_0_4(model, tmp_path, asked, written):
    run = simulated(model, **asked)
    path = Simulation(run).keep(tmp_path / "now.xlmcrun")
    with zipfile.ZipFile(path) as package:
        assert json.dumps(json.loads(package.read(RUN))["settings"]["stopping"]) == written

    def as_then(parts, document):
        document["settings"]["stopping"] = json.loads(written)

    again = open_run(repacked(path, tmp_path / "then.xlmcrun", as_then))
    assert (again.settings, again.stopped) == (run.settings, run.stopped)


@pytest.mark.usefixtures("read_once")
@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ({"accepted": 1}, "1 accepted trials were asked for"),
        ({"accepted": 2.5}, "its goal, accepted trials, number"),
        ({"accepted": True}, "its goal, accepted trials, number"),
        ({"digits": 7}, "7 significant digits were asked for"),
        ({"precision": {"tolerance": -1}}, "'-1' is not a precision"),
        ({"precision": {"tolerance": 1, "confidence": 95}}, "95 is not a confidence level"),
        ({"precision": {"tolerance": 1, "numbers": ["median"]}}, "'median' is not a number"),
        ({"precision": {"tolerance": 1, "key": "x"}}, "the unknown field key"),
        ({"precision": 1}, "its goal, a precision"),
        ({"goal": {"number": 5}}, "its end has the unknown field goal"),
        ({"goal": {}}, "its end has the unknown field goal"),
        ({"goal": None}, "its end has the unknown field goal"),
        ({"boredom": 5}, "the unknown field boredom"),
        ({"forecasts": ["area"]}, "orecasts are named, and no precision or stable digits"),
    ],
)
def test_a_goal_that_no_run_may_have_is_refused(saved, tmp_path, goal, message):
    path = repacked(saved, tmp_path / "bad.xlmcrun", lambda p, d: d["settings"]["stopping"].update(goal))
    with pytest.raises(WorkbookError, match=message):
        open_run(path)


FIELDS = ["settings", "stopped", "tally", "faults", "invalid", "columns", "order", "origin", "block", "trials"]


@pytest.mark.usefixtures("read_once")
@pytest.mark.parametrize("value", [None, -1, 1e308, "x", [], [[]], {}, True])
@pytest.mark.parametrize("field", FIELDS)
def test_an_edited_field_opens_as_a_run_or_is_refused_naming_the_file(tiny, tmp_path, field, value):
    path = repacked(tiny, tmp_path / "edited.xlmcrun", changed(**{field: value}))
    try:
        result = open_run(path)
    except XlmcError as error:
        text = str(error)
    else:
        text = f"{path} {result.stopped.sentence} {result.accepted}"
    assert str(path) in text


@pytest.mark.parametrize("words", [{"because": 1}, {"because": None}, {"because": "a", "goal": [1]}], ids=repr)
def test_an_end_that_is_no_words_is_refused(saved, tmp_path, words):
    path = repacked(saved, tmp_path / "edited.xlmcrun", changed(stopped={"by": "trials", **words}))
    with pytest.raises(XlmcError, match="its end"):
        open_run(path)


@pytest.mark.usefixtures("read_once")
@pytest.mark.parametrize("value", [None, -1, "x", {}, float("nan"), 10**30])
@pytest.mark.parametrize("part", ["settings", "settings.stopping", "stopped"])
def test_an_edited_field_inside_a_part_opens_as_a_run_or_is_refused(tiny, tmp_path, part, value):
    def inside(document):
        for key in part.split("."):
            document = document[key]
        return document

    with zipfile.ZipFile(tiny) as package:
        names = list(inside(json.loads(package.read(RUN))))
    for name in names:
        path = repacked(tiny, tmp_path / "edited.xlmcrun", lambda p, d, name=name: inside(d).update({name: value}))
        try:
            text = f"{path} {make_record(open_run(path), 'typed').as_dict()}"
        except XlmcError as error:
            text = str(error)
        assert str(path) in text


def test_an_edited_saved_run_is_answered_in_words_with_exit_code_2(saved, tmp_path, monkeypatch, capsys):
    from xlmc.cli import main

    path = repacked(saved, tmp_path / "edited.xlmcrun", changed(settings=[[]], stopped=None))
    monkeypatch.setattr("sys.argv", ["xlmc", "report", str(path), "-o", str(tmp_path / "out.xlsx")])
    with pytest.raises(SystemExit) as ended:
        main()
    text = capsys.readouterr()
    assert ended.value.code == 2, text
    assert "edited.xlmcrun" in "".join(text.err.split())
    assert "Traceback" not in text.err


def test_packed_entries_are_refused(saved, tmp_path):
    """A zip bomb must be packed: entries that are stored are no longer than the file."""
    bomb = repacked(saved, tmp_path / "bomb.xlmcrun", lambda p, d: None, compression=zipfile.ZIP_DEFLATED)
    with pytest.raises(WorkbookError, match="packed by something else"):
        open_run(bomb)


@pytest.mark.parametrize(
    ("data", "message"),
    [(b"", "damaged"), (b"PK\x03\x04", "damaged"), (b"no zip", "damaged"), (None, "There is no such file")],
)
def test_what_is_no_file_of_ours(tmp_path, data, message):
    path = tmp_path / "bad.xlmcrun"
    if data is not None:
        path.write_bytes(data)
    assert not is_saved_run(path)
    with pytest.raises(WorkbookError, match=message):
        open_run(path)


@pytest.fixture(scope="session")
def tiny(model, tmp_path_factory):
    """A saved run of few trials, for many faults."""
    return keep(simulated(model, 20), tmp_path_factory.mktemp("tiny") / "tiny.xlmcrun")


@pytest.mark.usefixtures("read_once")
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_damaged_file_is_a_message_or_does_no_harm(tiny, tmp_path, data):
    whole = tiny.read_bytes()
    place = data.draw(st.integers(0, len(whole) - 1))
    if data.draw(st.booleans()):
        broken = whole[:place]
    else:
        broken = whole[:place] + bytes([whole[place] ^ data.draw(st.integers(1, 255))]) + whole[place + 1 :]
    path = tmp_path / "broken.xlmcrun"
    path.write_bytes(broken)
    try:
        result = open_run(path)
    except XlmcError as error:
        message = str(error)  # anything else would be a traceback
        event(message.rpartition(": ")[2][:40])
    else:
        assert same(result, open_run(tiny))
