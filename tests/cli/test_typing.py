"""What people type: numbers with commas, words in any case, slips, nonsense. Every answer is one line that helps."""

from __future__ import annotations

import pytest

from xlmc.engine.engines import ENGINES

pytestmark = pytest.mark.usefixtures("short_books")

BOOK = "case.xlsx"


@pytest.fixture
def one_line(xlmc):
    """The one line that answers what cannot be done."""

    def refused(*arguments):
        outcome = xlmc(*arguments)
        assert outcome.code == 2
        assert outcome.out == ""
        assert outcome.err.startswith("xlmc: ")
        assert outcome.err.count("\n") == 1
        return outcome.err

    return refused


@pytest.mark.parametrize(
    ("option", "typed"), [("--trials", "2,000"), *(("-n", each) for each in ("2e3", "2k", "0.002M", "2_000", "2 000"))]
)
def test_trials_as_people_write_them(xlmc, plain_book, monkeypatch, option, typed):
    monkeypatch.setattr("xlmc.api.Simulation.save", lambda *_, **__: None)
    outcome = xlmc("simulate", plain_book, "-o", "r.xlsx", option, typed)
    assert outcome.code == 0
    assert "of 2,000 trials" in outcome.out


def test_other_counts_and_seeds_too(xlmc, plain_book):
    options = ("--until-accepted", "1,000", "-n", "1e6", "--seed", "1e3", "--rare", "NEVER", "--engine", "NumPy")
    outcome = xlmc("simulate", plain_book, "-o", "r.xlsx", *options, "--sampling", "MC", "-j", "1")
    assert outcome.code == 0
    assert "1,000 trials were accepted" in outcome.out
    assert "seed 1000" in outcome.out


@pytest.mark.parametrize("typed", ["200.000", "many", "1.5", "", "2,00", "0,200", "1e-3", "1e400", "9" * 500, "nan"])
def test_a_number_that_could_mean_two_or_none(one_line, typed):
    assert "not a whole number. Type it like 200000" in one_line("simulate", BOOK, "-n", typed)


@pytest.mark.parametrize(("typed", "message"), [("0", "too small. Type 1 or more."), ("-5", "too small")])
def test_a_number_out_of_range(one_line, typed, message):
    assert message in one_line("simulate", BOOK, "-n", typed)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("simulat", BOOK), "There is no command 'simulat'. Did you mean simulate?"),
        ((BOOK,), f"type: xlmc simulate {BOOK}"),
        (("simulate", BOOK, "--trails", 3), "There is no option --trails. Did you mean --trials?"),
        (("--seed", 3), "There is no option --seed. See xlmc --help."),
        (
            ("simulate", BOOK, "--engine", "nmpy"),
            f"--engine: 'nmpy' is not one of {', '.join(ENGINES)}. Did you ",
        ),
        (("simulate",), "BOOK is missing. Type: xlmc simulate BOOK"),
        (("fit",), "SOURCE is missing. Type: xlmc fit SOURCE [RANGE]"),
        (("compare", "a.xlsx"), "SECOND is missing. Type: xlmc compare FIRST SECOND"),
        (("check", "a.xlsx", "b.xlsx"), "'b.xlsx' does not belong here. Type: xlmc check BOOK"),
        (("simulate", BOOK, "-n"), "Option '-n' requires an argument."),
        (("new", "planar-imapct"), "Did you mean planar-impact?"),
        (("new", "zzzz"), "There are blank, skid, "),
        (("new", "skid", "x.xls"), "x.xls: A template is an Excel workbook, whose name ends in .xlsx. Name it x.xlsx."),
        (("new", "skid", "x.xlsm"), "ends in .xlsx"),
        (("new", "skid", "x"), "Name it x.xlsx"),
        (("screen", BOOK, "--acceptance", "-1"), "--acceptance: "),
        (("simulate", BOOK, "-j", "1e9"), "--jobs: 1,000,000,000 is too large."),
        (("simulate", ""), "BOOK: The name of the file is empty"),
        (("simulate", "."), "folder"),
    ],
)
def test_slips(one_line, arguments, message):
    assert message in one_line(*arguments)


@pytest.mark.parametrize("units", ["SI", "Si", "si"])
def test_units_in_any_case(xlmc, tmp_path, units):
    assert xlmc("new", "Skid", f"{units}.xlsx", "--units", units).code == 0
    assert (tmp_path / f"{units}.xlsx").exists()


def test_no_argument_at_all_is_answered_by_the_help(xlmc):
    outcome = xlmc()
    assert outcome.code == 0
    assert outcome.out == xlmc("--help").out


COMMANDS = [
    "new",
    "prepare",
    "check",
    "convert",
    "fit",
    "verify",
    "calculate",
    "seek",
    "simulate",
    "scenario",
    "open",
    "report",
    "replay",
    "compare",
    "screen",
    "decide",
    "optimise",
    "methods",
    "stability",
    "stress",
    "uncertainty",
    "help",
    "completion",
]


def test_the_list_of_commands_is_whole(xlmc):
    text = xlmc("--help").out
    assert "..." not in text.partition("Commands:")[2]
    listed = text.partition("Commands:\n")[2].partition("\n\n")[0].splitlines()
    assert [line.split()[0] for line in listed if line[2] != " "] == COMMANDS


@pytest.mark.parametrize("command", COMMANDS)
def test_help_is_understood_by_every_terminal(xlmc, command):
    """click writes it, which takes no heed of what the terminal's encoding lacks."""
    assert xlmc(command, "--help").out.isascii()
