"""A result never replaces what xlmc did not write."""

from __future__ import annotations

import os
import shutil
import zipfile
from functools import partial

import openpyxl
import pytest

import xlmc as package
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.seal import read_seal
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.simulation import simulate

pytestmark = pytest.mark.usefixtures("short_books")

ALL = ("--html", "a.html", "--json", "a.json", "--save-run", "a.xlmcrun", "--extract", "a.csv", "-o", "a.xlsx")
NAMED = ALL[1::2]


@pytest.fixture
def book(small_book, tmp_path):
    return shutil.copy(small_book, tmp_path / "book.xlsx")


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.fixture
def written(simulated, book):
    """`written(*options)`: the folder as after `xlmc simulate book.xlsx` with these options, which is run once."""
    return partial(simulated, book)


def save_again(path):
    """As another program does."""
    openpyxl.load_workbook(path).save(path)


def change_a_part(path):
    parts = read_parts(path.read_bytes())
    name = next(name for name in parts if name.startswith("xl/worksheets/sheet"))
    path.write_bytes(package_bytes(parts | {name: parts[name].replace(b"</worksheet>", b" </worksheet>")}))


def results_of_another_book(path):
    shutil.copy(path.with_name("book.xlsx"), path.with_name("other.xlsx"))
    package.load(path.with_name("other.xlsx")).simulate(50).save(path, overwrite=True)
    path.with_name("other.xlsx").unlink()


def become_a_folder(path):
    path.unlink()
    path.mkdir()


def become_a_link_to_nothing(path):
    path.unlink()
    path.symlink_to("nowhere.xlsx")


def be_held_open(path):
    path.with_name(f"~${path.name}").write_bytes(b"")


CHANGES = [
    (save_again, "xlmc did not write it, or another program has saved it since"),
    (change_a_part, "it was changed since xlmc wrote it"),
    (results_of_another_book, "it holds results of 'other.xlsx', not of 'book.xlsx'"),
    (lambda path: path.write_text("my notes", encoding="utf-8"), "xlmc did not write it"),
    (lambda path: path.chmod(0o444), "The file is read-only"),
    (become_a_folder, "This is a folder"),
    (become_a_link_to_nothing, "This is a link to"),
    (be_held_open, "Excel holds the workbook open"),
]


def test_a_second_run_replaces_its_own_result(xlmc, book, tmp_path):
    for seed in (1, 2):
        outcome = xlmc("simulate", book, "--seed", seed)
        assert "results go to" not in outcome.err
    assert sorted(contents(tmp_path)) == ["book-results.xlsx", "book.xlsx"]
    assert read_seal(tmp_path / "book-results.xlsx").whole


@pytest.mark.parametrize(("change", "reason"), CHANGES)
def test_what_became_somebodys_stays_and_results_go_to_the_next_number(xlmc, book, written, tmp_path, change, reason):
    written()
    change(tmp_path / "book-results.xlsx")
    before = contents(tmp_path)
    for seed in (1, 2) if change is change_a_part else (1,):  # the second time the number is our own
        outcome = xlmc("simulate", book, "--seed", seed, "--quiet")
        expected = [line for line in outcome.err.splitlines() if "results go to" in line]
        assert len(expected) == 1
        assert reason in expected[0]
        assert "book-results-2.xlsx" in expected[0]
        assert "Results are in" in outcome.out
        assert "book-results-2.xlsx" in outcome.out
    after = contents(tmp_path)
    assert after.pop("book-results-2.xlsx")
    assert after == before


@pytest.mark.parametrize(("change", "reason"), CHANGES)
def test_a_name_that_was_given_is_refused_before_the_run(xlmc, book, written, tmp_path, monkeypatch, change, reason):
    written("-o", "mine.xlsx")
    change(tmp_path / "mine.xlsx")
    before = contents(tmp_path)
    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.run_model", lambda *_, **__: 1 / 0)
    outcome = xlmc("simulate", book, "-o", "mine.xlsx", "--quiet")
    assert outcome.code == 2
    assert reason in outcome.err
    assert len(outcome.err.strip().splitlines()) == 1
    assert contents(tmp_path) == before


def test_every_kind_of_output_replaces_its_own_but_tables(xlmc, book, written, tmp_path):
    written(*ALL)
    first = contents(tmp_path)
    assert set(NAMED) <= set(first)
    outcome = xlmc("simulate", book, "--seed", 5, *ALL)
    assert outcome.code == 2
    assert "a.csv: The file exists already, and xlmc cannot tell who wrote a .csv" in outcome.err
    assert contents(tmp_path) == first
    (tmp_path / "a.csv").unlink()
    xlmc("simulate", book, "--seed", 5, *ALL)
    assert all(contents(tmp_path)[name] != first[name] for name in NAMED)


@pytest.mark.parametrize("command", ["simulate", "report"])
def test_every_kind_of_output_spares_what_was_changed(xlmc, book, written, tmp_path, command):
    written(*ALL)
    (tmp_path / "run.xlmcrun").write_bytes((tmp_path / "a.xlmcrun").read_bytes())
    options = ALL if command == "simulate" else (*ALL[:4], *ALL[6:])
    source = book if command == "simulate" else "run.xlmcrun"
    changed = {name: (tmp_path / name).read_bytes().replace(b"a", b"b", 1) for name in options[1::2]}
    for name in NAMED:
        (tmp_path / name).unlink()
    for name, content in changed.items():
        (tmp_path / name).write_bytes(content)
        before = contents(tmp_path)
        outcome = xlmc(command, source, *options, "--quiet")
        assert outcome.code == 2
        assert f"xlmc: {name}: The file exists already, and" in outcome.err
        assert contents(tmp_path) == before
        (tmp_path / name).unlink()
    for name, content in changed.items():
        (tmp_path / name).write_bytes(content)
    xlmc(command, source, *options, "--overwrite")
    after = contents(tmp_path)
    assert [name for name, content in changed.items() if after[name] == content] == []


@pytest.mark.parametrize("spelling", ["book.xlsx", "./book.xlsx", "folder/../book.xlsx", "link.xlsx", "hard.xlsx"])
@pytest.mark.parametrize("overwrite", [(), ("--overwrite",)])
def test_the_book_itself_is_no_output(xlmc, book, tmp_path, spelling, overwrite):
    (tmp_path / "folder").mkdir(exist_ok=True)
    if not (tmp_path / "link.xlsx").exists():
        (tmp_path / "link.xlsx").symlink_to("book.xlsx")
        (tmp_path / "hard.xlsx").hardlink_to(book)
    before = contents(tmp_path)
    outcome = xlmc("simulate", book, "-o", spelling, *overwrite)
    assert outcome.code == 2
    assert "This is the file that is read. --in-place writes the result sheets into it" in outcome.err
    assert contents(tmp_path) == before


def test_a_book_with_its_results_in_place_is_never_taken_for_a_result(xlmc, book, tmp_path):
    xlmc("simulate", book, "--in-place")
    mine = contents(tmp_path)
    assert read_seal(book) is None
    (tmp_path / "copy").mkdir()
    shutil.copy(book, tmp_path / "copy" / "book.xlsx")
    outcome = xlmc("simulate", tmp_path / "copy" / "book.xlsx", "-o", book)
    assert outcome.code == 2
    assert contents(tmp_path) == mine


def test_a_result_that_is_run_in_place_is_the_persons_from_then_on(xlmc, book, written):
    written()
    xlmc("simulate", "book-results.xlsx", "--in-place")
    outcome = xlmc("simulate", book)
    assert "results go to" in outcome.err


@pytest.mark.parametrize("options", [("--extract", "a.csv", "--extract", each) for each in ("./a.csv", "A.csv")])
def test_two_outputs_in_one_file_are_refused(xlmc, book, tmp_path, options):
    outcome = xlmc("simulate", book, *options)
    assert outcome.code == 2
    assert "Two outputs would be written to this file" in outcome.err
    assert sorted(contents(tmp_path)) == ["book.xlsx"]


@pytest.mark.parametrize("option", ["-o", "--html", "--json", "--save-run", "--extract"])
def test_a_folder_is_refused_in_one_line(xlmc, book, tmp_path, option):
    outcome = xlmc("simulate", book, option, ".", "--quiet")
    assert outcome.code == 2
    assert len(outcome.err.strip().splitlines()) == 1
    assert sorted(contents(tmp_path)) == ["book.xlsx"]


def during_the_run(monkeypatch, act):
    run_model = simulate.run_model

    def acting(*arguments, **options):
        run = run_model(*arguments, **options)
        act()
        return run

    monkeypatch.setattr(simulate, "run_model", acting)


def test_files_that_appear_during_the_run_are_spared_and_no_result_is_lost(xlmc, book, tmp_path, monkeypatch):
    def appear():
        for name in NAMED:
            (tmp_path / name).write_text("mine", encoding="utf-8")

    during_the_run(monkeypatch, appear)
    outcome = xlmc("simulate", book, *ALL)
    for name in NAMED:
        assert (tmp_path / name).read_text(encoding="utf-8") == "mine"
        stem, _, ending = name.partition(".")
        assert (tmp_path / f"{stem}-2.{ending}").stat().st_size > 100
        assert f"{stem}-2.{ending} was written instead" in outcome.err
        assert f"in {stem}-2.{ending}" in outcome.out or "The page is a-2.html" in outcome.out


def test_an_output_that_becomes_the_book_during_the_run_spares_it(xlmc, book, tmp_path, monkeypatch):
    before = book.read_bytes()
    during_the_run(monkeypatch, lambda: (tmp_path / "a.json").symlink_to(book))
    outcome = xlmc("simulate", book, "--json", "a.json", "--overwrite")
    assert book.read_bytes() == before
    assert (tmp_path / "a-2.json").stat().st_size > 100
    assert "a.json: This is the file that is read; it stays as it is" in outcome.err


@pytest.mark.skipif(os.name == "nt", reason="Windows keeps the current folder")
def test_an_answer_is_told_though_the_current_folder_is_gone(xlmc, book, tmp_path, monkeypatch):
    started_in = tmp_path / "gone"
    started_in.mkdir()
    monkeypatch.chdir(started_in)
    during_the_run(monkeypatch, started_in.rmdir)
    outcome = xlmc("simulate", book, "-o", "a.xlsx", "--json", tmp_path / "a.json", "--quiet")
    assert outcome.code == 2
    assert "a.xlsx: The folder in which xlmc was started is not there any more" in outcome.err
    assert "51 % range" in outcome.out
    assert (tmp_path / "a.json").stat().st_size > 100


@pytest.mark.parametrize("change", [be_held_open, lambda path: path.write_bytes(path.read_bytes() + b"\0")])
def test_a_book_that_is_opened_or_changed_during_a_run_in_place_keeps_its_state(
    xlmc, book, tmp_path, monkeypatch, change
):
    during_the_run(monkeypatch, lambda: change(book))
    outcome = xlmc("simulate", book, "--in-place")
    assert "Results" not in openpyxl.load_workbook(book).sheetnames
    assert "Results" in openpyxl.load_workbook(tmp_path / "book-results.xlsx").sheetnames
    assert "book-results.xlsx was written instead" in outcome.err


def test_a_file_that_excel_holds_on_windows_is_spared_and_the_result_stands_beside_it(
    xlmc, book, written, tmp_path, monkeypatch
):
    """Which may say so in several ways, one after the other."""
    written("-o", "a.xlsx")
    before = (tmp_path / "a.xlsx").read_bytes()
    replace, naps, codes = os.replace, [], [5, 32, 33, 1224, 391]

    def held(source, target):
        if os.path.basename(target) == "a.xlsx":
            error = PermissionError(13, "The process cannot access the file")
            codes.append(codes.pop(0))
            error.winerror = codes[-1]
            raise error
        return replace(source, target)

    monkeypatch.setattr(os, "replace", held)
    monkeypatch.setattr("time.sleep", naps.append)
    outcome = xlmc("simulate", book, "--seed", 4, "-o", "a.xlsx")
    assert "a.xlsx: Another program holds the file; it stays as it is, and a-2.xlsx was written instead" in outcome.err
    assert (tmp_path / "a.xlsx").read_bytes() == before
    assert zipfile.is_zipfile(tmp_path / "a-2.xlsx")
    assert 2 < sum(nap for nap in naps if nap) < 10
    assert len([nap for nap in naps if nap]) >= len(codes)
    assert sorted(contents(tmp_path)) == ["a-2.xlsx", "a.xlsx", "book.xlsx"]


def test_a_file_that_onedrive_holds_for_a_moment_is_replaced(xlmc, book, written, tmp_path, monkeypatch):
    written()
    before = (tmp_path / "book-results.xlsx").read_bytes()
    replace, left = os.replace, [3]

    def held(source, target):
        if left[0]:
            left[0] -= 1
            error = PermissionError(13, "The cloud operation was not completed")
            error.winerror = 32
            raise error
        return replace(source, target)

    monkeypatch.setattr(os, "replace", held)
    monkeypatch.setattr("time.sleep", lambda _: None)
    outcome = xlmc("simulate", book, "--seed", 4)
    assert "written instead" not in outcome.err
    assert (tmp_path / "book-results.xlsx").read_bytes() != before
    assert sorted(contents(tmp_path)) == ["book-results.xlsx", "book.xlsx"]


def test_new_replaces_an_untouched_template_and_nothing_else(xlmc, tmp_path):
    assert xlmc("new", "skid", "case.xlsx").code == 0
    assert xlmc("new", "momentum", "case.xlsx").code == 0
    save_again(tmp_path / "case.xlsx")
    before = contents(tmp_path)
    outcome = xlmc("new", "skid", "case.xlsx")
    assert outcome.code == 2
    assert "exists already" in outcome.err
    assert contents(tmp_path) == before
    assert xlmc("new", "skid", "case.xlsx", "--overwrite").code == 0
    assert contents(tmp_path) != before


def test_new_writes_nothing_through_a_link_to_nothing(xlmc, tmp_path):
    (tmp_path / "case.xlsx").symlink_to("elsewhere.xlsx")
    outcome = xlmc("new", "skid", "case.xlsx")
    assert outcome.code == 2
    assert "This is a link to" in outcome.err
    assert not (tmp_path / "elsewhere.xlsx").exists()


def test_in_python_the_same_holds(book, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = package.load(book).simulate(50)
    writers = {
        "a.xlsx": run.save,
        "a.html": run.save_page,
        "a.json": run.save_json,
        "a.xlmcrun": run.keep,
        "a.csv": run.extract,
    }
    for name, write in writers.items():
        assert str(write(name)) == name
        if name != "a.csv":
            write(name)
        (tmp_path / name).write_text("mine", encoding="utf-8")
        with pytest.raises(WorkbookError, match="overwrite=True"):
            write(name)
        assert (tmp_path / name).read_text(encoding="utf-8") == "mine"
        write(name, overwrite=True)
        assert (tmp_path / name).stat().st_size > 10


OUTPUTS = {
    "book": ("save", (), "case-results.xlsx"),
    "page": ("save_page", ("--html", "o.html"), "o.html"),
    "JSON": ("save_json", ("--json", "o.json"), "o.json"),
    "run": ("keep", ("--save-run", "o.xlmcrun"), "o.xlmcrun"),
    "report": ("save_report", ("--docx", "o.docx"), "o.docx"),
    "trials": ("extract", ("--extract", "o.csv"), "o.csv"),
}


@pytest.mark.parametrize("failing", OUTPUTS)
def test_a_fault_in_one_output_costs_no_other_and_not_the_answer(xlmc, plain_book, monkeypatch, failing):
    method, _, lost = OUTPUTS[failing]

    def fail(*_, **__):
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr(f"xlmc.api.Simulation.{method}", fail)
    done = xlmc("simulate", plain_book, "-n", 500, *(text for _, options, _ in OUTPUTS.values() for text in options))
    assert done.code == 2
    assert "accepted trials" in done.out
    message = [line for line in done.err.splitlines() if line.startswith("xlmc: ")]
    assert len(message) == 1
    assert "xlmc has failed (ZeroDivisionError: float division by zero)" in message[0]
    written = {path.name for path in plain_book.parent.iterdir()} - {"case.xlsx"}
    assert written == {name for _, _, name in OUTPUTS.values()} - {lost}
