"""Every command refuses a file that it cannot write, by its ending, before it runs anything."""

from __future__ import annotations

import pytest
from kinds_book import write_book

OF_A_RUN = ("xlsx", "html", "pdf", "docx", "json", "csv", "parquet", "xlmcrun")
OF_A_STUDY = ("xlsx", "html", "pdf", "docx", "json")
WRITES = {
    "simulate": OF_A_RUN,
    "compare": OF_A_STUDY,
    "screen": OF_A_RUN,
    "stability": OF_A_RUN,
    "stress": OF_A_RUN,
    "uncertainty": (*OF_A_STUDY, "csv", "parquet"),
    "verify": OF_A_STUDY,
    "seek": OF_A_STUDY,
    "fit": OF_A_STUDY,
    "methods": (*OF_A_STUDY, "png"),
    "calculate": ("xlsx", "json", "csv"),
    "prepare": ("xlsx",),
}
"""Command -> the endings that it writes."""

MORE = {
    "compare": ["{book}"],
    "seek": ["--cell", "Model!B11", "--to", "250000", "--by", "Model!B1"],
    "fit": ["Model!B1:B7"],
    "uncertainty": ["--uncertain", "Start"],
}


@pytest.mark.parametrize("command", WRITES)
def test_an_ending_that_a_command_does_not_write_is_refused_before_it_runs(xlmc, command, tmp_path):
    book = write_book(tmp_path / "book.xlsx", filtered=True)
    more = [each.format(book=book) for each in MORE.get(command, [])]
    for ending in ("txt", "xlsm", "ods", *(each for each in (*OF_A_RUN, "png") if each not in WRITES[command])):
        outcome = xlmc(command, book, *more, "-o", tmp_path / f"found.{ending}")
        assert outcome.code == 2, ending
        assert outcome.out == "", ending
        assert outcome.err.count("xlmc: ") == 1, outcome.err
        assert f"found.{ending}: " in outcome.err, outcome.err
    assert [path.name for path in tmp_path.iterdir()] == ["book.xlsx"]
