from __future__ import annotations

import pytest

from xlmc.errors import DefinitionError, FormulaError, Notice, XlmcError


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (XlmcError("The file is empty"), "The file is empty."),
        (XlmcError("The file is empty", hint="Save it again"), "The file is empty. Save it again."),
        (XlmcError("no such function", where="Sheet1!A1"), "Sheet1!A1: No such function."),
        (XlmcError("Did you mean A?", hint="Rename it A"), "Did you mean A? Rename it A."),
        (XlmcError("it holds '#REF!'.", hint="Type a number!"), "It holds '#REF!'. Type a number!"),
        (XlmcError("There is no Nrmal", hint="did you mean Normal?"), "There is no Nrmal. Did you mean Normal?"),
        (XlmcError("it is not there", hint="xlmc new lists them"), "It is not there. xlmc new lists them."),
        (XlmcError("it is not there", hint="--all names them"), "It is not there. --all names them."),
        (DefinitionError("There is no Nrmal", hint="did you mean Normal?"), "There is no Nrmal. Did you mean Normal?"),
    ],
)
def test_a_message_is_a_sentence(error, text):
    assert str(error) == text


def test_messages_that_quote_a_file_stay_short():
    assert len(str(XlmcError("x" * 10_000, where="S!A1", hint="Shorten it"))) < 600
    assert len(str(Notice("x" * 10_000, where="y" * 10_000))) < 1_100
    long = "+".join(f"B{row}" for row in range(1, 3000)) + "+#faulty+C1"
    at = long.index("#faulty")
    lines = str(FormulaError("There is no such cell", where="S!A1", text=long, span=(at, at + 7))).splitlines()
    assert all(len(line) < 600 for line in lines)
    start = lines[2].index("^")
    assert lines[1][start : start + 7] == "#faulty"
    assert lines[2].strip() == "^" * 7
