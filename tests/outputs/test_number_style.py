"""The setting `Number style`: the signs of thousands and decimals in every output for people, and in none for programs.

A style with signs that stand nowhere else shows what is not written in it: with these signs turned back, every output
is that of the usual style, and no number in it has a point or a comma.
"""

from __future__ import annotations

import io
import json
import re
import zipfile
from threading import Thread

import openpyxl
import pytest
from click.testing import CliRunner
from kinds_book import write_book

from xlmc.analysis.results.saved import open_run
from xlmc.api import load
from xlmc.cli import xlmc
from xlmc.errors import DefinitionError
from xlmc.montecarlo.definitions.number_styles import STYLES
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import load as load_model
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs import save
from xlmc.outputs.document import Wanted, document_bytes
from xlmc.outputs.document.build import build
from xlmc.outputs.json_document import document
from xlmc.outputs.live.session import Session
from xlmc.outputs.notebook import run_html
from xlmc.outputs.page import page_text
from xlmc.outputs.replay import replay

MARKED, THOUSANDS, DECIMAL = "1⁑234⁂5", "⁑", "⁂"
UNSTYLED = re.compile(r"\d[.,]\d")
NOT_NUMBERS = re.compile(
    r"\d+\.\d+\.\d+"  # versions
    r"|1\.96"  # in formulas of the sheet Certainty
    r"|=.*"  # formulas
    r"|book\.xlsx|v\d\.\d|[\w-]+\.(py|com|org)"
)


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    return write_book(tmp_path_factory.mktemp("style") / "book.xlsx", filtered=True)


@pytest.fixture(scope="module")
def runs(book):
    """The run in the usual style and in one whose signs stand nowhere else, each with its model."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(STYLES, MARKED, (THOUSANDS, DECIMAL))
        result = []
        for style in (None, MARKED):
            model = load_model(book)
            result.append(run_model(model, RunOptions(trials=20_000, number_style=style)))
        yield result


def in_usual(text):
    return text.replace(THOUSANDS, ",").replace(DECIMAL, ".")


def plain_html(text):
    """The texts of HTML: what is between its tags, and what is said of its pictures."""
    shown = re.sub(r"<script.*?</script>|<style.*?</style>", "", text, flags=re.S)
    return [*re.split(r"<[^>]*>", shown), *re.findall(r'(?:aria-label|title)="([^"]*)"', shown)]


def sheets(run, folder):
    path = save(run, folder / "out.xlsx", overwrite=True)
    own = openpyxl.load_workbook(run.model.path).sheetnames
    written = [sheet for sheet in openpyxl.load_workbook(path) if sheet.title not in own]
    cells = [
        (f"{c.parent.title}!{c.coordinate}", c.value) for sheet in written for row in sheet.iter_rows() for c in row
    ]
    with zipfile.ZipFile(path) as package:
        drawn = [
            package.read(name).decode() for name in package.namelist() if "/charts/" in name or "/drawings/" in name
        ]
    message = [
        text for each in drawn for result in re.findall(r'<a:t>([^<]*)|descr="([^"]*)"', each) for text in result
    ]
    return [value for place, value in cells if isinstance(value, str) and not place.startswith("Record!")] + message


def word(run, _):
    packed = document_bytes(build(run, Wanted()), ".docx")
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        return re.findall(r"<w:t[^>]*>([^<]*)", package.read("word/document.xml").decode())


OUTPUTS = {
    "sheets": sheets,
    "word": word,
    "page": lambda run, _: plain_html(page_text(run).partition('id="record"')[0]),  # which holds cells as they are
    "notebook": lambda run, _: plain_html(run_html(run)),
}


@pytest.mark.parametrize("output", OUTPUTS)
def test_an_output_has_the_signs_of_the_style_and_differs_in_nothing_else(runs, tmp_path, output):
    usual, marked = (OUTPUTS[output](run, tmp_path) for run in runs)
    other = {*map(in_usual, marked)} ^ {*usual}
    assert [text for text in other if text not in ("Number style", "1,234.5") and "xlmc simulate" not in text] == []
    assert [text for text in marked if UNSTYLED.search(NOT_NUMBERS.sub("", text))] == []
    assert any(THOUSANDS in text for text in marked)
    assert any(DECIMAL in text for text in marked)


def test_programs_read_numbers_and_texts_in_the_usual_style(runs):
    usual, marked = map(document, runs)
    assert marked["record"]["settings"].pop("number_style") == MARKED
    own, repeat = (each["record"]["run"].pop("repeat") for each in (usual, marked))
    assert repeat == f'{own} --number-style "{MARKED}"'
    assert json.dumps(marked) == json.dumps(usual)


def test_a_thread_of_the_window_writes_in_the_style_of_the_workbook(tmp_path):
    model = load_model(write_book(tmp_path / "book.xlsx", filtered=True, settings=[["Number style", "1.234,5"]]))
    session, messages = Session(model), []

    def work():
        messages.extend(session.greeting())
        while (job := session.job()) is not None:
            messages.extend(session.finish(job, job.run(lambda: True, lambda _: None, lambda: 0.0)))

    thread = Thread(target=work)
    thread.start()
    thread.join()
    text = json.dumps(
        [{k: v for k, v in each.items() if k not in ("shapes",)} for each in messages], ensure_ascii=False
    )
    assert "4.000 trials" in text
    assert re.search(r"\d,\d+ ± \d", text)
    assert '"signs": {"thousands": ".", "decimal": ","}' in text


@pytest.mark.parametrize(
    ("typed", "style"),
    [("1.234,5", "1.234,5"), ("1\u202f234,5", "1 234,5"), ("1’234.5", "1'234.5"), ("1234,5", "1234,5")],
)
def test_a_workbook_says_its_style(tmp_path, typed, style):
    model = load_model(write_book(tmp_path / "book.xlsx", filtered=False, settings=[["Number style", typed]]))
    assert model.definitions.settings.number_style == style


@pytest.mark.parametrize("typed", [1234.5, "1;234", "1 234"])
def test_a_style_that_there_is_not_is_refused(tmp_path, typed):
    path = write_book(tmp_path / "book.xlsx", filtered=False, settings=[["Number style", typed]])
    with pytest.raises(DefinitionError, match="There is no number style") as error:
        load_model(path)
    assert "apostrophe" in error.value.hint


def test_a_saved_run_and_a_result_workbook_are_repeated_in_their_style(book, tmp_path):
    run = load(book).simulate(2_000, number_style="1.234,5")
    run.save(tmp_path / "out.xlsx")
    run.keep(tmp_path / "out.xlmcrun")
    for path in (tmp_path / "out.xlsx", tmp_path / "out.xlmcrun"):
        assert replay(path).to_the_last_bit
    assert "2.000 trials" in page_text(open_run(tmp_path / "out.xlmcrun"))


@pytest.mark.parametrize(
    "command",
    [
        ["simulate"],
        ["check"],
        ["screen"],
        ["stability"],
        ["uncertainty", "--uncertain", "Speed in", "--outer", "20"],
        ["compare"],
        ["verify"],
    ],
    ids=lambda command: command[0],
)
def test_a_command_prints_in_the_style_of_the_book(tmp_path, monkeypatch, command):
    monkeypatch.setitem(STYLES, MARKED, (THOUSANDS, DECIMAL))
    printed = []
    for name, settings in (("a", []), ("b", [["Number style", MARKED]])):
        folder = tmp_path / name
        folder.mkdir()
        path = write_book(folder / "book.xlsx", filtered=True, settings=settings)
        first, *more = command
        result = CliRunner().invoke(xlmc, [first, str(path), *([str(path)] if first == "compare" else []), *more])
        assert result.exit_code in (0, 1)
        assert result.exception is None or isinstance(result.exception, SystemExit)
        printed.append(result.stdout.replace(str(folder), "").splitlines())
    usual, marked = printed
    assert [line for line in marked if UNSTYLED.search(NOT_NUMBERS.sub("", line))] == []
    assert [" ".join(in_usual(line).split()) for line in marked] == [" ".join(line.split()) for line in usual]
