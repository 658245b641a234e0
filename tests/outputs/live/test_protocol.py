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
    message = read_message(json.dumps({**SET, "more": 1}))
    assert message.kind == "set"
    assert dict(message.fields) == {name: value for name, value in SET.items() if name != "kind"}


NUMBERS = {"kind": "numbers", "of": "assumption", "name": "a", "values": {"low": 1}, "seq": 0}
RUN = {"kind": "run", "trials": None, "seed": None}
BOUNDS = [
    (SET, "name", ["", "a" * 2_000], ["a" * 2_001, None, 1, ["a"]]),
    (SET, "value", [None, True, False, 0, -1.5, 1e308, "none", "Normal"], ["1", "normal", [], {}, 1 << 1_030]),
    (SET, "held", [True, False], [0, 1, None, "true"]),
    (SET, "seq", [0, 1, (1 << 53) - 1], [-1, 1 << 53, 1.5, True, None, "1"]),
    (SET, "of", ["assumption", "filter", "forecast", "correlation", "decision", "solve"], ["Filter", "", None]),
    (RUN, "trials", [None, 0, 5], [-1, 1.5, True, "5", [], 1 << 53]),
    (VIEW, "forecasts", [[], ["a"], ["a"] * 500], [["a"] * 501, ["a" * 2_001], [1], "a", None, {"a": "b"}]),
    (VIEW, "tab", ["charts", "studies"], ["", "other", None, 1]),
    (NUMBERS, "values", [{"low": 1}, {str(k): 0.5 for k in range(20)}], [{}, {str(k): 1 for k in range(21)}]),
    (NUMBERS, "values", [{"a" * 2_000: -1}], [{"low": True}, {"low": None}, {"low": "1"}, {"a" * 2_001: 1}, [1], None]),
]  # fmt: skip


@pytest.mark.parametrize(("message", "field", "good", "bad"), BOUNDS)
def test_what_a_field_may_hold(message, field, good, bad):
    for value in good:
        assert read_message(json.dumps({**message, field: value}))[field] == value
    for value in bad:
        with pytest.raises(ProtocolError, match=f"'{field}' of a message '{message['kind']}'"):
            read_message(json.dumps({**message, field: value}))


def test_a_message_may_have_so_many_characters_and_no_more():
    text = json.dumps(SET)
    assert read_message(text + " " * (MOST_BYTES - len(text))).kind == "set"
    with pytest.raises(ProtocolError, match="65,537 characters is too long"):
        read_message(text + " " * (MOST_BYTES - len(text) + 1))
