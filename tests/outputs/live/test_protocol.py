from __future__ import annotations

import json

import pytest

from xlmc.outputs.live.protocol import MOST_BYTES, ProtocolError, read_message

SET = {"kind": "set", "of": "assumption", "name": "a", "key": "high", "value": 1.5, "held": True, "seq": 3}
VIEW = {
    "kind": "view",
    "forecasts": [],
    "chosen": [],
    "tab": "charts",
    "first": "",
    "second": "",
    "trial": 0,
    "fits": False,
}

WRONG = {
    "no JSON": "{",
    "no object": "[1]",
    "no kind": "{}",
    "another kind": '{"kind": "eval"}',
    "a kind that is a list": '{"kind": []}',
    "a field missing": json.dumps({**SET, "key": None}),
    "NaN": json.dumps({**SET, "value": float("nan")}),
    "a number beyond all": json.dumps(SET).replace("1.5", "1e999"),
    "an integer beyond all": json.dumps(SET).replace("1.5", "9" * 400),
    "a text as a number": json.dumps({**SET, "value": "1"}),
    "a number as a switch": json.dumps({**SET, "held": 1}),
    "a negative count": json.dumps({**SET, "seq": -1}),
    "neither assumption nor filter": json.dumps({**SET, "of": "file"}),
    "a long name": json.dumps({**SET, "name": "a" * 2_001}),
    "too long": json.dumps({**SET, "more": "a" * MOST_BYTES}),
    "nested without end": "[" * 60_000,
    "another file": '{"kind": "save", "what": "../../x"}',
    "names that are no list": json.dumps({**VIEW, "forecasts": "a"}),
    "another tab": json.dumps({**VIEW, "tab": "x"}),
}


@pytest.mark.parametrize("text", WRONG.values(), ids=WRONG.keys())
def test_what_no_page_says_is_refused(text):
    with pytest.raises(ProtocolError):
        read_message(text)


def test_what_a_page_says_is_read_without_what_it_adds():
    said = read_message(json.dumps({**SET, "more": 1}))
    assert said.kind == "set"
    assert dict(said.fields) == {name: value for name, value in SET.items() if name != "kind"}
