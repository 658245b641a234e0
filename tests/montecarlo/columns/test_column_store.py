from __future__ import annotations

import gc
import mmap
import os
import tempfile
from pathlib import Path

import numpy as np
import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.columns import ColumnStore, Folder, column_store, on_disk, release

TYPES = {"x": np.dtype(np.float64), "n": np.dtype(np.int64), "never": np.dtype(np.float64)}
NAMES = {"speed": "x", "trial": "n", "none": "never"}


def filled(blocks):
    keeper, expected = ColumnStore(TYPES), {"speed": [], "trial": [], "none": []}
    rng = np.random.default_rng(1)
    for _ in range(blocks):
        size = int(rng.integers(0, 400))
        x, n = rng.normal(size=size), rng.integers(0, 9, size)
        expected["speed"] += x.tolist()
        expected["trial"] += n.tolist()
        keeper.add("x", x)
        keeper.add("n", n)
        keeper.write_if_full()
    return keeper.columns(NAMES), expected


@pytest.mark.parametrize("blocks", [0, 1, 30])
@pytest.mark.parametrize("in_memory", [0, 5000, 1 << 27])
def test_columns_are_what_was_added(monkeypatch, blocks, in_memory):
    monkeypatch.setattr(column_store, "IN_MEMORY", in_memory)
    monkeypatch.setattr(column_store, "WRITTEN", 3000)
    result, expected = filled(blocks)
    assert list(result) == ["speed", "trial", "none"]
    assert len(result) == 3
    for name, values in expected.items():
        assert result[name].tolist() == values
        assert result[name].dtype == TYPES[NAMES[name]]
    assert on_disk(result["speed"]) == (16 * len(expected["speed"]) > in_memory)


def test_every_column_of_a_keeper_may_be_asked_for_twice():
    keeper = ColumnStore(TYPES)
    keeper.add("x", np.ones(3))
    keeper.add("x", np.zeros(1))
    assert keeper.columns({"a": "x"})["a"].tolist() == keeper.columns({"b": "x"})["b"].tolist() == [1, 1, 1, 0]


@pytest.mark.parametrize("expected", [{}, {"x": 4}, {"x": 1000}])
def test_what_was_written_to_the_room_is_there(expected):
    keeper = ColumnStore(TYPES, expected)
    keeper.add("x", np.arange(3.0))
    room = keeper.reserve("x", 4)
    room[:] = [3, 4, 5, 99]
    keeper.add("x", room[:3])
    keeper.add("x", keeper.reserve("x", 2)[:0])
    keeper.add("x", np.array([6.0]))
    assert keeper.columns({"a": "x"})["a"].tolist() == [0, 1, 2, 3, 4, 5, 6]


def test_one_part_of_the_room_may_be_two_columns():
    keeper = ColumnStore(TYPES)
    room = keeper.reserve("x", 2)
    room[:] = [1, 2]
    keeper.add("x", room)
    keeper.add("never", room)
    assert keeper.columns(NAMES)["none"].tolist() == keeper.columns(NAMES)["speed"].tolist() == [1, 2]


@pytest.mark.parametrize("in_memory", [0, 100, 1 << 27])
def test_a_column_that_was_given_away_stays_as_it_is(monkeypatch, in_memory):
    monkeypatch.setattr(column_store, "IN_MEMORY", in_memory)
    keeper, given = ColumnStore(TYPES, {"x": 40}), []
    for number in range(12):
        keeper.add("x", np.full(3, float(number)))
        keeper.write_if_full()
        given.append(keeper.columns({"a": "x"})["a"])
    for number, column in enumerate(given):
        assert column.tolist() == [float(each) for each in range(number + 1) for _ in range(3)]


@pytest.mark.parametrize("in_memory", [0, 100, 1 << 27])
def test_columns_in_one_piece_of_memory_are_what_was_added(monkeypatch, in_memory):
    """Some as long as expected, one longer, one that has another length, one of which nothing was said."""
    monkeypatch.setattr(column_store, "IN_MEMORY", in_memory)
    types = {"a": np.dtype(np.float64), "b": np.dtype(np.int64), "c": np.dtype(np.float64), "d": np.dtype(np.int8)}
    keeper = ColumnStore({**types, "e": types["a"]}, {"a": 20, "b": 20, "c": 20, "d": 9})
    expected = {key: [] for key in "abcde"}
    for number in range(5):
        for key, numbers in expected.items():
            added = np.arange(4 if key != "c" else 7) + 100 * number
            room = keeper.reserve(key, added.size)
            room[:] = added
            keeper.add(key, room if number % 2 else room.copy())
            numbers += room.tolist()
        keeper.write_if_full()
    result = keeper.columns({key: key for key in expected})
    assert {key: column.tolist() for key, column in result.items()} == expected
    assert {key: column.dtype for key, column in result.items()} == {**types, "e": types["a"]}
    if in_memory > 100:
        assert result["a"].base is result["b"].base is not result["d"].base


REAL = np.dtype(np.float64)


def stored_files(monkeypatch, tmp_path, expected, rows, blocks=4):
    """Columns of `rows` numbers each, whose store has room for one block alone; and the sizes of its files."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(column_store, "WRITTEN", 0)
    keys = range(len(expected))
    store = ColumnStore(dict.fromkeys(keys, REAL), dict(zip(keys, expected, strict=True)), in_memory=0)
    for part in np.array_split(np.arange(float(rows)), blocks):
        for key in keys:
            store.add(key, part + 1e6 * key)
        store.write_if_full()
    result = store.columns({str(key): key for key in keys})
    assert all(np.array_equal(result[str(key)], np.arange(float(rows)) + 1e6 * key) for key in keys)
    (folder,) = tmp_path.iterdir()
    return {file.name: file.stat().st_size for file in folder.iterdir()}


def test_short_columns_lie_in_one_file(monkeypatch, tmp_path):
    files = stored_files(monkeypatch, tmp_path, [10_000] * 300, 10_000)
    assert list(files) == ["columns"]
    assert 300 * 80_000 <= files["columns"] <= 300 * (80_000 + mmap.ALLOCATIONGRANULARITY)


@pytest.mark.parametrize(
    ("expected", "own"),
    [
        pytest.param([10_000, 2_000_000], {"1.column"}, id="one-that-will-be-long"),
        pytest.param([10_000, 200_000], {"1.column"}, id="one-of-which-most-is-not-accepted"),
        pytest.param([10_000, 0], {"1.column"}, id="one-of-which-nothing-is-known"),
        pytest.param([10_000, 5_000], {"1.column"}, id="one-that-gets-longer-than-it-should"),
        pytest.param([4_999, 2_500], {"0.column", "1.column"}, id="all-get-longer"),
    ],
)
def test_other_columns_have_files_of_their_own(monkeypatch, tmp_path, expected, own):
    files = stored_files(monkeypatch, tmp_path, expected, 10_000)
    assert files.keys() - {"columns"} == own
    assert {files[name] for name in own} == {80_000}


def test_a_column_that_moves_to_its_own_file_stays_where_it_was_given_away(monkeypatch):
    monkeypatch.setattr(column_store, "WRITTEN", 0)
    store, given = ColumnStore({"x": REAL, "y": REAL}, {"x": 6, "y": 100}, in_memory=0), []
    for number in range(5):
        for key in "xy":
            store.add(key, np.full(3, float(number)))
        store.write_if_full()
        given.append(store.columns({"x": "x", "y": "y"}))
    for number, columns in enumerate(given):
        for column in columns.values():
            assert column.tolist() == [float(each) for each in range(number + 1) for _ in range(3)]


def test_a_column_without_numbers_needs_no_file(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    store = ColumnStore(TYPES, {"x": 100, "never": 100}, in_memory=0)
    store.add("x", np.arange(100.0))
    store.write_if_full()
    assert store.columns(NAMES)["none"].tolist() == []
    (folder,) = tmp_path.iterdir()
    assert [file.name for file in folder.iterdir()] == ["columns"]


@pytest.mark.parametrize("rows", [0, 2, 5, None])
def test_first_rows_of_columns_of_different_lengths(rows):
    store = ColumnStore(TYPES, {"x": 4, "n": 3}, in_memory=0)
    store.add("x", np.arange(4.0))
    store.add("n", np.arange(3))
    store.write_if_full()
    result = store.columns(NAMES, rows)
    assert result["speed"].tolist() == [0, 1, 2, 3][:rows]
    assert result["trial"].tolist() == [0, 1, 2][:rows]


def test_files_grow_at_their_end():
    folder = Folder()
    folder.append("a", [np.arange(3.0), np.arange(2.0)])
    folder.append("b", [np.arange(5)])
    folder.append("a", [np.array([7.0])])
    assert folder.array("a", REAL).tolist() == [0, 1, 2, 0, 1, 7]
    assert folder.array("b", np.dtype(np.int64)).tolist() == [0, 1, 2, 3, 4]


def test_nothing_written_is_an_empty_column():
    folder = Folder()
    folder.append("a", [])
    assert folder.array("a", REAL).size == 0


def test_a_column_cannot_be_changed(stored):
    with pytest.raises(ValueError, match="read-only"):
        stored(np.arange(3.0))[0] = 1.0


def test_the_folder_goes_with_its_last_use_and_the_numbers_stay():
    folder = Folder()
    folder.append("a", [np.arange(4.0)])
    path, column = folder.path, folder.array("a", REAL)
    del folder
    assert not path.exists()
    assert column.tolist() == [0, 1, 2, 3]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_child_leaves_the_folder():
    folder = Folder()
    child = os.fork()
    if child == 0:
        folder._end()
        os._exit(0)
    os.waitpid(child, 0)
    assert folder.path.exists()


def test_a_file_can_be_removed_while_it_is_mapped():
    folder = Folder()
    folder.append("a", [np.arange(4.0)])
    column = folder.array("a", REAL)
    folder.remove("a")
    folder.remove("never written")
    assert column.sum() == 6.0


def test_what_is_on_disk(stored):
    column = stored(np.arange(9.0))
    assert on_disk(column)
    assert on_disk(column[2:5])
    assert on_disk(column[::2].reshape(5, 1))
    assert not on_disk(column + 1)
    assert not on_disk(np.arange(3.0)[1:])


def test_released_numbers_are_read_again(stored):
    column = stored(np.arange(100_000.0))
    release(column[5:])
    assert column.sum() == np.arange(100_000.0).sum()


def test_the_memory_of_others_is_not_released(tmp_path):
    """A copy-on-write map would lose what was written to it."""
    np.arange(100.0).tofile(tmp_path / "theirs")
    theirs = np.memmap(tmp_path / "theirs", mode="c")
    theirs[:] = 1
    release(theirs)
    assert not on_disk(theirs)
    assert (theirs == 1).all()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_disk_is_told():
    folder = Folder()
    (folder.path / "a").symlink_to("/dev/full")
    with pytest.raises(SimulationError, match="no space left on the disk") as caught:
        folder.append("a", [np.zeros(100_000)])
    assert caught.value.where == str(folder.path)
    assert "TMPDIR" in caught.value.hint


def test_a_folder_that_cannot_be_made_is_told(monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", "/there/is/none")
    with pytest.raises(SimulationError, match=r"temporary folder: .*No such file"):
        Folder()


def test_a_signal_as_soon_as_there_is_a_folder_leaves_none(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    make = Path.mkdir

    def end_afterwards(path, mode):
        make(path, mode)
        raise SystemExit(143)

    monkeypatch.setattr(Path, "mkdir", end_afterwards)
    with pytest.raises(SystemExit):
        Folder()
    gc.collect(1)  # what a traceback kept is young
    assert list(tmp_path.iterdir()) == []


def test_a_column_that_is_gone_is_told():
    with pytest.raises(SimulationError, match="No such file"):
        Folder().array("never written", REAL)
