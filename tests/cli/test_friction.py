"""Where a person begins, what can be kept quiet, and colours of messages."""

from __future__ import annotations

import openpyxl
import pytest
from click.shell_completion import BashComplete

from xlmc.cli import xlmc as command

COMMANDS = ("xlmc prepare", "xlmc new blank", "xlmc check", "xlmc simulate", "xlmc calculate")


@pytest.mark.parametrize("arguments", [[], ["help"]], ids=["alone", "help"])
def test_xlmc_alone_and_help_say_where_to_begin(xlmc, arguments):
    outcome = xlmc(*arguments)
    assert outcome.code == 0
    assert all(each in outcome.out for each in COMMANDS)


def test_help_of_a_command_is_its_own(xlmc):
    assert xlmc("help", "calculate").out == xlmc("calculate", "--help").out
    outcome = xlmc("help", "simulat")
    assert outcome.code == 2
    assert "Did you mean simulate?" in outcome.err


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_is_printed_for_each_shell(xlmc, shell):
    outcome = xlmc("completion", shell)
    assert outcome.code == 0
    assert "_XLMC_COMPLETE" in outcome.out


def test_quiet_prints_no_notes_and_all_problems(xlmc, tmp_path):
    made = openpyxl.Workbook()
    made.active["A1"] = "=NOSUCHFUNCTION(1)"
    made.save(tmp_path / "book.xlsx")
    assert "note:" in xlmc("calculate", "book.xlsx").err
    for words in (
        ("-q", "calculate", "book.xlsx"),
        ("calculate", "-q", "book.xlsx"),
        ("calculate", "book.xlsx", "--quiet"),
    ):
        outcome = xlmc(*words, "--overwrite")
        assert "note:" not in outcome.err
        assert outcome.code == 1
    assert "xlmc:" in xlmc("-q", "check", "none.xlsx").err
    assert "note:" in xlmc("calculate", "book.xlsx", "--overwrite").err


def test_a_problem_is_red_and_its_cure_green_on_a_terminal(on_a_screen, monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    outcome = on_a_screen("check", "none.xlsx")
    assert "\x1b[31mxlmc: \x1b[0m" in outcome.err
    assert "\x1b[32mCheck its name and folder\x1b[0m" in outcome.err


def test_no_color_is_obeyed(on_a_screen, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[31m" not in on_a_screen("check", "none.xlsx").err


def test_an_option_of_xlmc_behind_a_command_is_told_where_it_stands(xlmc):
    outcome = xlmc("simulate", "book.xlsx", "--no-kept-code")
    assert (outcome.code, outcome.err.count("\n")) == (2, 1)
    assert "--no-kept-code stands before the command: xlmc --no-kept-code simulate" in outcome.err


@pytest.mark.parametrize(("typed", "result"), [("war", ["warranty"]), ("Bl", ["blank"]), ("nothing", [])])
def test_templates_are_completed(typed, result):
    completion = BashComplete(command, {}, "xlmc", "_XLMC_COMPLETE")
    assert [each.value for each in completion.get_completions(["new"], typed)] == result
