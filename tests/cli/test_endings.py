"""Every command writes what a file's ending says, or refuses the file, by its ending, before it runs anything."""

from __future__ import annotations

import openpyxl
import pytest
from kinds_book import write_full_book

from xlmc import load

OF_A_RUN = ("xlsx", "html", "pdf", "docx", "json", "csv", "parquet", "xlmcrun")
OF_A_STUDY = ("xlsx", "html", "pdf", "docx", "json")
WRITES = {
    "simulate": OF_A_RUN,
    "report": OF_A_RUN,
    "compare": OF_A_STUDY,
    "screen": OF_A_RUN,
    "decide": OF_A_RUN,
    "optimise": OF_A_RUN,
    "stability": OF_A_RUN,
    "stress": OF_A_RUN,
    "uncertainty": (*OF_A_STUDY, "csv", "parquet"),
    "verify": OF_A_STUDY,
    "seek": OF_A_STUDY,
    "fit": OF_A_STUDY,
    "methods": (*OF_A_STUDY, "png"),
    "calculate": ("xlsx", "json", "csv"),
    "prepare": ("xlsx",),
    "scenario": ("xlsx",),
    "convert": ("xlsx",),
}
"""Command -> the endings that it writes."""

MORE = {
    "calculate": ["--cells", "Model!B10:B21"],
    "compare": ["{book}", "-n", "200"],
    "decide": ["-n", "200"],
    "fit": ["Model!H1:H40"],
    "optimise": ["--maximise", "mean of Cost", "-n", "200", "--runs", "2"],
    "scenario": ["slower"],
    "screen": ["-n", "300"],
    "seek": ["--cell", "Model!B11", "--to", "250000", "--by", "Model!B1"],
    "simulate": ["-n", "200"],
    "stability": ["-n", "200"],
    "stress": ["-n", "1000"],
    "uncertainty": ["--uncertain", "Start", "--outer", "20", "--inner", "20"],
}
"""Command -> its further arguments."""

ENDINGS = (*OF_A_RUN, "png")


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """Command -> what it is given: a workbook, a run of it, or one without xlmc's tables."""
    folder = tmp_path_factory.mktemp("source")
    book = write_full_book(folder / "book.xlsx", filtered=True)
    load(book).simulate(200).keep(folder / "kept.xlmcrun")
    plain = openpyxl.Workbook()
    plain.active["A1"], plain.active["B1"], plain.active["B2"] = 5, "=A1*2", "=RiskOutput()+RiskUniform(1,2)"
    plain.save(folder / "calls.xlsx")
    del plain.active["B2"]
    plain.save(folder / "plain.xlsx")
    others = {"convert": "calls.xlsx", "prepare": "plain.xlsx", "report": "kept.xlmcrun"}
    return {command: folder / others.get(command, book) for command in WRITES}


def words(command, source):
    """A command with what it is given."""
    book = source["simulate"]
    return [command, source[command], *(each.format(book=book) for each in MORE.get(command, ()))]


@pytest.mark.parametrize("command", WRITES)
def test_an_ending_that_a_command_does_not_write_is_refused_before_it_runs(xlmc, source, command, tmp_path):
    for ending in ("txt", "xlsm", "ods", *(each for each in ENDINGS if each not in WRITES[command])):
        outcome = xlmc(*words(command, source), "-o", tmp_path / f"found.{ending}")
        assert outcome.code == 2, ending
        assert outcome.out == "", ending
        assert outcome.err.count("xlmc: ") == 1, outcome.err
        assert f"found.{ending}: " in outcome.err, outcome.err
    assert [*tmp_path.iterdir()] == []


@pytest.mark.parametrize("command", sorted(WRITES.keys() - {"methods"}))  # whose tests write its files, and take long
def test_a_command_writes_what_its_endings_say(xlmc, source, command, tmp_path):
    """Each file is of its kind by its first bytes."""
    first = {
        "xlsx": b"PK",
        "docx": b"PK",
        "html": b"<!",
        "pdf": b"%PDF",
        "json": b"{",
        "parquet": b"PAR1",
        "png": b"\x89PNG",
    }
    files = [tmp_path / f"found.{ending}" for ending in WRITES[command]]
    outcome = xlmc(*words(command, source), *(part for each in files for part in ("-o", each)))
    assert outcome.code in (0, 1), outcome.err
    assert {*tmp_path.iterdir()} == {*files}
    for each in files:
        assert each.read_bytes().startswith(first.get(each.suffix[1:], b"")), each
        assert each.stat().st_size > 20, each


def test_replay_writes_no_file(xlmc, source, tmp_path):
    outcome = xlmc("replay", source["report"], "-o", tmp_path / "found.json")
    assert (outcome.code, outcome.out, outcome.err.count("xlmc: ")) == (2, "", 1)
    assert "-o" in outcome.err
