from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError, FormulaError, Notice, XlmcError


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (XlmcError("the file is empty"), "the file is empty."),
        (XlmcError("the file is empty", hint="Save it again"), "the file is empty. Save it again."),
        (XlmcError("no such function", where="Sheet1!A1"), "Sheet1!A1: no such function."),
        (XlmcError("did you mean A?", hint="Rename it A"), "did you mean A? Rename it A."),
        (XlmcError("it holds '#REF!'.", hint="Type a number!"), "it holds '#REF!'. Type a number!"),
        (XlmcError("there is no Nrmal", hint="did you mean Normal?"), "there is no Nrmal. Did you mean Normal?"),
        (XlmcError("it is not there", hint="xlmc new lists them"), "it is not there. xlmc new lists them."),
        (XlmcError("it is not there", hint="--all names them"), "it is not there. --all names them."),
        (DefinitionError("there is no Nrmal", hint="Did you mean Normal?"), "there is no Nrmal. Did you mean Normal?"),
    ],
)
def test_a_message_is_a_sentence(error, text):
    assert str(error) == text


def test_messages_that_quote_a_file_stay_short():
    assert len(str(XlmcError("x" * 10_000, where="S!A1", hint="Shorten it"))) < 600
    assert len(str(Notice("x" * 10_000, where="y" * 10_000))) < 1_100
    long = "+".join(f"B{row}" for row in range(1, 3000)) + "+#faulty+C1"
    at = long.index("#faulty")
    lines = str(FormulaError("there is no such cell", where="S!A1", text=long, span=(at, at + 7))).splitlines()
    assert all(len(line) < 600 for line in lines)
    start = lines[2].index("^")
    assert lines[1][start : start + 7] == "#faulty"
    assert lines[2].strip() == "^" * 7
