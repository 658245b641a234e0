"""Whatever a workbook or a person writes, the terminal gets readable characters, and a run keeps its files."""

from __future__ import annotations

import ast
import codecs
import io
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import openpyxl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.cli import main, terminal
from xlmc.cli.printing import table_lines
from xlmc.workbook.printable import printable

pytestmark = pytest.mark.usefixtures("short_books")

ROOT = Path(__file__).resolve().parents[2]
FOUND = os.pathsep.join(map(str, (ROOT, ROOT / "tests" / "session")))
"""Where a program of its own finds xlmc, and `short_xlmc`."""
RAW = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
ENCODINGS = ["cp1252", "cp437", "ascii", "utf-8"]


@pytest.fixture(scope="module")
def greek(tmp_path_factory):
    """The case study with names that few code pages have."""
    book = openpyxl.load_workbook(ROOT / "examples" / "intersection.xlsx")
    for sheet in book:
        for row in sheet.iter_rows():
            for cell in row:
                if cell.value == 'vehicle_1&" delta-V"' or cell.value == '=vehicle_1&" delta-V"':
                    cell.value = "Chevrolet ΔV → 中"
    path = tmp_path_factory.mktemp("greek") / "case.xlsx"
    book.save(path)
    return path


@pytest.fixture
def typed(monkeypatch, tmp_path):
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
    ("fit", "case.xlsx", "Inputs!D6:D9"),
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
    code, shown = typed(arguments, encoding)
    assert code in (0, 1, 2)
    if "-n" in arguments and arguments[0] == "simulate":
        assert code == 0, shown
        assert ("Chevrolet ΔV" if encoding == "utf-8" else "Chevrolet delta-V") in shown
        assert (tmp_path / "case-results.xlsx").exists()


def test_a_closed_pipe_is_quiet_and_the_files_are_written(greek, tmp_path):
    shutil.copy(greek, tmp_path / "case.xlsx")
    where = {**os.environ, "PYTHONPATH": FOUND}
    command = [sys.executable, "-m", "short_xlmc", "simulate", "case.xlsx", "-n", "4000", "--json", "case.json"]
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(command, cwd=tmp_path, env=where, stdout=writing, stderr=subprocess.PIPE, check=False)
    os.close(writing)
    assert done.returncode == 0
    assert done.stderr == b""
    assert (tmp_path / "case-results.xlsx").exists()
    assert (tmp_path / "case.json").exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has a file that is always full")
def test_output_into_a_full_file_is_one_line_and_the_files_are_written(greek, tmp_path):
    shutil.copy(greek, tmp_path / "case.xlsx")
    with open("/dev/full", "wb") as full:
        where = {**os.environ, "PYTHONPATH": FOUND}
        command = [sys.executable, "-m", "short_xlmc", "simulate", "case.xlsx", "-n", "4000"]
        done = subprocess.run(
            command, cwd=tmp_path, env=where, stdout=full, stderr=subprocess.PIPE, check=False, text=True
        )
    assert done.returncode == 2
    assert done.stderr == "xlmc: the output cannot be written (No space left on device).\n"
    assert (tmp_path / "case-results.xlsx").exists()


def test_files_are_written_before_the_answer_is_printed(xlmc, case_study, tmp_path, monkeypatch):
    there = []
    said = terminal.put
    monkeypatch.setattr(
        "xlmc.cli.printing.put", lambda *args: (there.append((tmp_path / "r.xlsx").exists()), said(*args))
    )
    assert xlmc("simulate", case_study, "-n", 2000, "-o", "r.xlsx").code == 0
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


@pytest.mark.parametrize("columns", [60, 80])
@pytest.mark.parametrize("arguments", [("simulate", "case.xlsx", "-n", "4000"), ("check", "case.xlsx"), ("new",)])
def test_nothing_is_wider_than_the_terminal(case_study, tmp_path, on_a_terminal, arguments, columns):
    shutil.copy(case_study, tmp_path / "case.xlsx")
    shown = on_a_terminal(arguments, columns)
    assert max(map(len, shown.splitlines())) <= columns
    assert "…" not in shown
    if arguments[0] == "simulate":
        wide = on_a_terminal(arguments, 200)
        numbers = re.findall(r"\d[\d.,]*\d ± \d[\d.]*", wide)
        assert len(numbers) > 15
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


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo terminals of this kind")
@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_the_progress_bar_is_drawn_in_every_encoding(greek, tmp_path, encoding):
    """A terminal at stderr, a file at stdout: the bar has characters that few code pages hold."""
    import pty

    shutil.copy(greek, tmp_path / "case.xlsx")
    master, slave = pty.openpty()
    where = {**os.environ, "PYTHONPATH": FOUND, "PYTHONIOENCODING": encoding, "TERM": "xterm", "COLUMNS": "100"}
    command = [sys.executable, "-m", "short_xlmc", "simulate", "case.xlsx", "-n", "20000", "-j", "1"]
    running = subprocess.Popen(command, cwd=tmp_path, env=where, stdout=subprocess.PIPE, stderr=slave)
    os.close(slave)
    drawn = b""
    while True:
        try:
            piece = os.read(master, 65536)
        except OSError:  # how Linux says that the other end is closed
            break
        if not piece:
            break
        drawn += piece
    os.close(master)
    out, _ = running.communicate()
    assert running.returncode == 0, drawn
    shown = drawn.decode(encoding)
    assert "trials," in shown
    assert "Traceback" not in shown
    assert "Chevrolet" in out.decode(encoding)
    assert (tmp_path / "case-results.xlsx").exists()
