from __future__ import annotations

import multiprocessing
import os
import stat
import sys

import pytest

pytest.importorskip("llvmlite")

from llvmlite import binding, ir
from simulated import simulated

from xlmc.engine.llvm import code_cache
from xlmc.engine.llvm.code_cache import SWITCH, code_key, load_code, save_code
from xlmc.engine.llvm.machine import this_machine

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such modes")


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path):
    """The folder, which is not there yet."""
    monkeypatch.setenv(SWITCH, "1")
    monkeypatch.setattr(code_cache, "_caches", lambda: tmp_path / "caches")
    return tmp_path / "caches" / "xlmc" / "code"


def only(folder):
    (path,) = folder.iterdir()
    return path


def test_what_was_saved_is_loaded(folder):
    assert load_code("a") is None
    save_code("a", b"one")
    save_code("b", b"two")
    save_code("a", b"three")
    assert load_code("a") == b"three"
    assert load_code("b") == b"two"
    assert sorted(path.name for path in folder.iterdir()) == ["a.code", "b.code"]


@POSIX
def test_the_folder_is_closed_to_others(folder):
    save_code("a", b"one")
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_a_key_is_of_all_its_texts():
    assert len({code_key(), code_key(""), code_key("ab"), code_key("a", "b"), code_key("b", "a")}) == 5


@pytest.mark.parametrize("change", [b"", b"x", b"xlmc code 1\n"])
def test_a_file_that_was_changed_is_not_read(folder, change):
    save_code("a", b"one")
    only(folder).write_bytes(change)
    assert load_code("a") is None


@pytest.mark.parametrize("at", [0, 12, 43, 44, -1])
def test_a_single_bit_is_enough(folder, at):
    save_code("a", b"one")
    held = bytearray(only(folder).read_bytes())
    held[at] ^= 1
    only(folder).write_bytes(held)
    assert load_code("a") is None


def test_a_file_of_another_key_is_not_read(folder):
    save_code("a", b"one")
    only(folder).rename(folder / "b.code")
    assert load_code("b") is None


@POSIX
@pytest.mark.parametrize("mode", [0o755, 0o770, 0o707])
def test_a_folder_that_is_open_to_others_is_not_used(folder, mode):
    save_code("a", b"one")
    folder.chmod(mode)
    assert load_code("a") is None
    save_code("b", b"two")
    assert [path.name for path in folder.iterdir()] == ["a.code"]


@POSIX
@pytest.mark.parametrize("mode", [0o620, 0o602])
def test_a_file_that_others_may_write_is_not_read(folder, mode):
    save_code("a", b"one")
    only(folder).chmod(mode)
    assert load_code("a") is None


@POSIX
def test_what_belongs_to_another_user_is_not_used(folder, monkeypatch):
    save_code("a", b"one")
    monkeypatch.setattr(os, "getuid", lambda: 4_000_000)
    assert load_code("a") is None


@POSIX
def test_no_link_is_followed(folder, tmp_path):
    save_code("a", b"one")
    only(folder).rename(tmp_path / "elsewhere")
    (folder / "a.code").symlink_to(tmp_path / "elsewhere")
    assert load_code("a") is None
    folder.rename(tmp_path / "moved")
    folder.symlink_to(tmp_path / "moved")
    save_code("b", b"two")
    assert not (tmp_path / "moved" / "b.code").exists()


def test_switched_off_nothing_is_read_or_written(folder, monkeypatch):
    save_code("a", b"one")
    monkeypatch.setenv(SWITCH, "0")
    assert load_code("a") is None
    save_code("b", b"two")
    assert [path.name for path in folder.iterdir()] == ["a.code"]


def test_without_a_place_for_a_folder_code_is_compiled(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setattr(code_cache, "_caches", lambda: tmp_path / "file")
    save_code("a", b"one")
    assert load_code("a") is None


def test_the_files_that_were_not_read_for_longest_go_first(folder, monkeypatch):
    monkeypatch.setattr(code_cache, "_MOST_BYTES", 3000)
    for age, key in enumerate("abcd"):
        save_code(key, b"x" * 900)
        os.utime(folder / f"{key}.code", (1000 + age, 1000 + age))
    assert load_code("b") is not None
    save_code("e", b"x" * 900)
    assert sorted(path.name for path in folder.iterdir()) == ["b.code", "d.code", "e.code"]


def test_what_a_killed_program_left_goes_after_an_hour(folder):
    save_code("a", b"one")
    for name, when in (("old.tmp", 1000), ("new.tmp", None)):
        (folder / name).write_bytes(b"half")
        if when is not None:
            os.utime(folder / name, (when, when))
    save_code("b", b"two")
    assert sorted(path.name for path in folder.iterdir()) == ["a.code", "b.code", "new.tmp"]


def test_a_full_disk_leaves_nothing_behind(folder, monkeypatch):
    save_code("a", b"one")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", full)
    save_code("b", b"two")
    assert [path.name for path in folder.iterdir()] == ["a.code"]


def _write_often(caches, text):
    code_cache._caches = lambda: caches
    os.environ[SWITCH] = "1"
    for _ in range(200):
        save_code("a", text * 5000)
        result = load_code("a")
        assert result is not None
        assert set(result) in ({ord("x")}, {ord("y")})


def test_two_programs_may_write_at_once(tmp_path):
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("fork" if "fork" in methods else "spawn")
    writers = [context.Process(target=_write_often, args=(tmp_path, text)) for text in (b"x", b"y")]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert [writer.exitcode for writer in writers] == [0, 0]


def _answer(number):
    """A function that gives a number."""
    long, address = ir.IntType(64), ir.IntType(8).as_pointer().as_pointer()
    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(long, [address, long]), "answer")
    ir.IRBuilder(function.append_basic_block("entry")).ret(long(number))
    return module


def test_kept_code_is_not_compiled_and_gives_the_same(folder, monkeypatch):
    assert this_machine().native(_answer(42), "answer")(None, 0) == 42
    assert this_machine().native(_answer(43), "answer")(None, 0) == 43
    assert len(list(folder.iterdir())) == 2
    monkeypatch.setattr(binding, "create_pass_builder", None)
    assert this_machine().native(_answer(42), "answer")(None, 0) == 42
    with pytest.raises(TypeError):
        this_machine().native(_answer(44), "answer")


def test_code_of_another_processor_is_not_used(folder):
    this_machine().native(_answer(42), "answer")
    other = this_machine()
    other._cpu = "generic"
    assert other.native(_answer(42), "answer")(None, 0) == 42
    assert len(list(folder.iterdir())) == 2


def test_code_that_was_spoiled_is_compiled_again(folder):
    this_machine().native(_answer(42), "answer")
    path = only(folder)
    path.write_bytes(path.read_bytes()[:-1] + b"\0\0")
    assert this_machine().native(_answer(42), "answer")(None, 0) == 42
    assert load_code(path.stem) is not None


def test_a_run_with_kept_code_gives_the_same_bits(book, folder):
    cells = {"A1": 1.0, "B1": "=EXP(A1)+SIN(A1)*MOD(A1,0.1)^1.5", "C1": "=B1>2"}
    runs = []
    for _ in range(2):
        model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B1"}, {"f": "C1"})
        from xlmc.engine.llvm import block_kernel, machine, uniforms

        for kept in (machine.machine, block_kernel.compile_kernel, uniforms._loop):
            kept.cache_clear()
        runs.append(simulated(model, 200_000, engine="jit"))
    assert runs[0].forecasts["x"].tobytes() == runs[1].forecasts["x"].tobytes()
    assert runs[0].accepted > 0
