"""Whatever a workbook or a person writes, the terminal gets readable characters, and a run keeps its files."""

from __future__ import annotations

import ast
import codecs
import io
import json
import os
import re
import shutil
import sys
from pathlib import Path

import openpyxl
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated import simulated

from xlmc.cli import main, terminal
from xlmc.cli.printing import table_lines
from xlmc.excel.workbook.printable import printable
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation import simulate

pytestmark = pytest.mark.usefixtures("short_books")

ROOT = Path(__file__).resolve().parents[2]
RAW = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
ENCODINGS = ["cp1252", "cp437", "ascii", "utf-8"]


@pytest.fixture(scope="module")
def greek(plain_original, tmp_path_factory):
    """A book with a name that few code pages have."""
    book = openpyxl.load_workbook(plain_original)
    book["Wanted"]["A2"] = "ΔV → 中"
    path = tmp_path_factory.mktemp("greek") / "case.xlsx"
    book.save(path)
    return path


@pytest.fixture
def typed(fitted_once, monkeypatch, tmp_path):
    """A command as typed on a terminal of that encoding: exit code, and what it shows."""

    def run(arguments, encoding):
        monkeypatch.chdir(tmp_path)
        out, err = (io.TextIOWrapper(io.BytesIO(), encoding) for _ in range(2))
        monkeypatch.setattr(sys, "stdout", out)
        monkeypatch.setattr(sys, "stderr", err)
        monkeypatch.setattr(sys, "argv", ["xlmc", *map(str, arguments)])
        with pytest.raises(SystemExit) as stopped:
            main()
        return stopped.value.code or 0, "".join(each.buffer.getvalue().decode(encoding) for each in (out, err))

    return run


COMMANDS = [
    ("simulate", "case.xlsx", "-n", "4000"),
    ("check", "case.xlsx"),
    ("verify", "case.xlsx"),
    ("compare", "case.xlsx", "case.xlsx", "-n", "1000", "--no-causes", "--quiet"),
    ("fit", "case.xlsx", "Inputs!B2:C3"),
    ("new",),
    ("simulate", "ΔV中.xlsx"),
    ("simulate", "case.xlsx", "--for", "ΔV"),
    ("simulate", "case.xlsx", "--ΔV"),
    ("ΔV",),
    ("new", "ΔV"),
]


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_no_encoding_stops_a_command(greek, tmp_path, typed, arguments, encoding):
    shutil.copy(greek, tmp_path / "case.xlsx")
    (tmp_path / "case-results.xlsx").unlink(missing_ok=True)
    code, shown = typed(arguments, encoding)
    assert code in (0, 1, 2)
    if "-n" in arguments and arguments[0] == "simulate":
        assert code == 0, shown
        assert ("ΔV" if encoding == "utf-8" else "delta-V") in shown
        assert (tmp_path / "case-results.xlsx").exists()


@pytest.fixture
def into(xlmc, plain_book, monkeypatch):
    """A run that prints into this file, which is flushed and closed at the end, as Python does before it exits."""

    def run(file, *options):
        with open(file, "w", encoding="utf-8") as stream, monkeypatch.context() as patch:
            patch.setattr(sys, "stdout", stream)
            return xlmc("simulate", plain_book, *options)

    return run


def test_a_closed_pipe_is_quiet_and_the_files_are_written(into, tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    done = into(writing, "--json", "case.json")
    assert (done.code, done.err) == (0, "")
    assert (tmp_path / "case-results.xlsx").exists()
    assert (tmp_path / "case.json").exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has a file that is always full")
def test_output_into_a_full_file_is_one_line_and_the_files_are_written(into, tmp_path):
    done = into("/dev/full")
    assert (done.code, done.err) == (2, "xlmc: The output cannot be written (No space left on device).\n")
    assert (tmp_path / "case-results.xlsx").exists()


def test_files_are_written_before_the_answer_is_printed(xlmc, plain_book, tmp_path, monkeypatch):
    there = []
    message = terminal.put
    monkeypatch.setattr(
        "xlmc.cli.printing.put", lambda *args: (there.append((tmp_path / "r.xlsx").exists()), message(*args))
    )
    assert xlmc("simulate", plain_book, "-o", "r.xlsx").code == 0
    assert there == [True, True]


@given(st.text(st.characters()))
def test_printable_text_steers_no_terminal(text):
    assert not RAW.search(printable(text))
    assert printable(printable(text)) == printable(text)


@given(st.text(st.characters(exclude_categories=["Cs"])))
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_every_text_has_a_form_in_every_encoding(encoding, text):
    shown = text.encode(encoding, "xlmc").decode(encoding)
    if all(ord(one) < 128 for one in text):
        assert shown == text


def test_letters_degrade_to_what_can_be_read():
    assert "ΔV ± 3 ≤ φ₀ é …".encode("ascii", "xlmc").decode() == "delta-V +/- 3 <= phi0 e ..."
    assert "中".encode("cp1252", "xlmc") == rb"\u4e2d"
    with pytest.raises(UnicodeDecodeError):
        b"\xff".decode("utf-8", "xlmc")
    assert codecs.lookup_error("xlmc")


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_json_on_the_terminal_is_the_same_json(monkeypatch, encoding):
    value = {"name": "a\x1b[2J\x9b\u202e\udcff ΔV 中", "number": [1.5, float("nan")], "nothing": None}
    packed = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(packed, encoding))
    terminal.prepare()
    terminal.say_json(value)
    text = packed.getvalue().decode(encoding)
    assert not RAW.search(text)
    assert json.loads(text) == {**value, "number": [1.5, None]}


def test_only_the_terminal_module_prints():
    """`click.echo` and `print` neither escape nor degrade: xlmc.cli.terminal.say does both."""
    for path in (ROOT / "xlmc" / "cli").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
            assert called not in ("click.echo", "print", "click.secho"), f"{path.name}:{node.lineno}: use say"


ANSWERS = (
    ["Forecast", "Units", "Mean", "51 % range"],
    [
        ["Chevrolet delta-V", "mph", "11.799 ± 0.013", "11.253 ± 0.023 to 12.375 ± 0.016"],
        ["averylongnamewithoutanyblank" * 2, "mph", "4.717 ± 0.034", "3.275 ± 0.052 to 6.074 ± 0.041"],
    ],
)


@pytest.mark.parametrize("width", [36, 40, 60, 70, 80, 100, 200])
def test_tables_fit_the_width_and_cut_no_number(width):
    headings, rows = ANSWERS
    lines = list(table_lines(headings, rows, (2, 3), width, "-"))
    assert max(map(len, lines)) <= width
    text = " ".join(" ".join(lines).split())
    for number in ("11.799 ± 0.013", "4.717 ± 0.034"):
        assert number in text
    for number in ("11.253 ± 0.023", "12.375 ± 0.016", "3.275 ± 0.052", "6.074 ± 0.041"):
        assert number in text
    assert "…" not in text
    together = "".join("".join(lines).split())
    assert together.count("averylongname") >= 1
    assert sum(line.count("averylong") for line in lines) >= 1


def test_a_table_with_room_has_a_line_for_each_row():
    headings, rows = ANSWERS
    assert len(list(table_lines(headings, rows, (2, 3), 160, "-"))) == 2 + len(rows)


@pytest.fixture
def on_a_terminal(xlmc, monkeypatch):
    """What a terminal of so many columns is given."""

    def shown(arguments, columns):
        monkeypatch.setenv("COLUMNS", str(columns))
        for module in ("terminal", "printing"):
            monkeypatch.setattr(f"xlmc.cli.{module}.on_terminal", lambda err=False: not err)
        return re.sub("\x1b\\[[0-9]*m", "", xlmc(*arguments).out)

    return shown


@pytest.mark.parametrize("arguments", [("simulate", "case.xlsx", "-n", "4000"), ("check", "case.xlsx"), ("new",)])
def test_nothing_is_wider_than_the_terminal(case_study, tmp_path, on_a_terminal, monkeypatch, arguments):
    shutil.copy(case_study, tmp_path / "case.xlsx")
    once = simulated(load(tmp_path / "case.xlsx"), 4_000) if arguments[0] == "simulate" else None
    monkeypatch.setattr(simulate, "run_model", lambda *_, **__: once)
    narrow = {columns: on_a_terminal(arguments, columns) for columns in (60, 80)}
    wide = on_a_terminal(arguments, 200) if arguments[0] == "simulate" else ""
    numbers = re.findall(r"\d[\d.,]*\d ± \d[\d.]*", wide)
    assert len(numbers) > 15 or not wide
    for columns, shown in narrow.items():
        assert max(map(len, shown.splitlines())) <= columns
        assert "…" not in shown
        joined = " ".join(shown.split())
        assert all(number in joined for number in numbers)


NOTE = "The workbook holds names as long as this one, " * 6 + "see /a/path/that/" + "stays/in/one/piece/" * 4


@pytest.mark.parametrize("columns", [30, 60, 200])
def test_notes_wrap_to_the_width_of_the_terminal_behind_stderr(monkeypatch, capsys, columns):
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setattr("xlmc.cli.terminal.on_terminal", lambda *, err=False: err)
    terminal.say(f"note: {NOTE}", err=True)
    lines = capsys.readouterr().err.splitlines()
    assert " ".join(line.strip() for line in lines) == f"note: {NOTE}"
    assert all(len(line) <= columns or " " not in line.strip() for line in lines)
    assert all(line.startswith("  ") for line in lines[1:])
    assert len(lines) > 1


def test_notes_in_a_file_stay_on_their_line(capsys):
    terminal.say(f"note: {NOTE}", err=True)
    assert capsys.readouterr().err == f"note: {NOTE}\n"


@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_the_progress_bar_is_drawn_in_every_encoding(greek, on_a_screen, tmp_path, encoding):
    """The bar has characters that few code pages hold."""
    outcome = on_a_screen("simulate", greek, "-o", "r.xlsx", encoding=encoding)
    assert outcome.code == 0
    assert "trials," in outcome.err
    assert ("± ΔV" if encoding == "utf-8" else "+/- delta-V") in outcome.err
    assert (tmp_path / "r.xlsx").exists()


@pytest.mark.parametrize("columns", range(20, 45))
def test_no_line_ends_between_a_number_and_its_percent_sign(monkeypatch, columns):
    text = "Of all trials 52.90 % lie below € 4,660 ± 12 and another 9 % above 5 € or so, in 1,587 trials (52.9 %)."
    monkeypatch.setattr(terminal, "PIPE_WIDTH", columns)
    monkeypatch.delenv("COLUMNS", raising=False)
    lines = terminal.paragraph(text).split("\n")
    assert " ".join(lines) == text
    assert max(map(len, lines)) <= columns
    assert not [line for line in lines if line.startswith(("%", "€ or")) or line.endswith(("±", "below €"))]
    cells = list(table_lines(["Name", "Text"], [("x", text)], (), columns, "-"))
    assert not [line for line in cells if line.strip().startswith("%")]
