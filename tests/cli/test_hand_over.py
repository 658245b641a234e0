"""The options of `simulate` and `report` that write the report to hand over."""

from __future__ import annotations

import pytest
from committed_books import BOOKS

import xlmc as package

pytest.importorskip("typst")
docx = pytest.importorskip("docx")
pypdf = pytest.importorskip("pypdf")


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """A saved run of a few trials."""
    path = tmp_path_factory.mktemp("saved") / "case.xlmcrun"
    return package.load(BOOKS["intersection"]).simulate(5_000).keep(path)


def test_the_commands_write_reports(xlmc, case_study, tmp_path):
    found = xlmc(
        *("simulate", case_study, "-n", "20000", "-o", "out.xlsx", "--save-run", "case.xlmcrun", "--pdf", "a.pdf")
    )
    assert found.code == 0, found.err
    assert "The report is a.pdf" in found.out
    assert "Physics checks" in "".join(page.extract_text() for page in pypdf.PdfReader("a.pdf").pages)
    command = ["report", "case.xlmcrun", "--docx", "b.docx", "--sections", "answer, repeat", "--case", "number=7"]
    found = xlmc(*command)
    assert found.code == 0, found.err
    assert "The report is b.docx" in found.out
    assert not (tmp_path / "case-results.xlsx").exists()
    written = docx.Document("b.docx")
    heads = [paragraph.text for paragraph in written.paragraphs if paragraph.style.name == "Heading 1"]
    assert heads == ["Question and answer", "How to repeat it"]
    assert written.sections[0].header.paragraphs[0].text.startswith("7 ")
    found = xlmc(*command)
    assert found.code == 2
    assert "the file exists already" in found.err
    assert xlmc(*command, "--overwrite").code == 0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--case", "number"], "write FIELD=TEXT"),
        (["--case", "judge=N. N."], "a case has no 'judge'"),
        (["--sections", "answers"], "the report has no section 'answers'"),
        (["--forecasts", "Speed"], "there is no forecast 'Speed'"),
        (["--paper", "foolscap"], "there is no paper 'foolscap'"),
        (["--pdf", "report.txt"], "a report must end in .pdf or .docx"),
    ],
)
def test_what_cannot_be_had_is_refused_before_anything_is_written(xlmc, saved, options, said):
    found = xlmc("report", saved, *options)
    assert found.code == 2
    assert said in found.err
