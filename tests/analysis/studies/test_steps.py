"""The steps of long studies: what is told, how long they take, and an answer at any time on Ctrl-C."""

from __future__ import annotations

import signal
from importlib import import_module

import pytest

from xlmc.analysis.studies.comparison import compare
from xlmc.analysis.studies.comparison.causes import Step, cause_of
from xlmc.analysis.studies.methods import study
from xlmc.analysis.studies.screening import ALONE, screen
from xlmc.analysis.studies.stability import stability
from xlmc.analysis.studies.steps import Steps, ended_early


@pytest.fixture(autouse=True)
def usual_interrupts():
    """Have Ctrl-C do what it does in a program, whatever the test runner made of it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def wide(book, count, weight=0.001):
    """y = a + Σ w·b, z = 2·a: every b may be held."""
    names = ["a", *(f"b{k}" for k in range(count))]
    cells = {f"A{row}": 0.5 for row in range(1, count + 2)}
    cells |= {"D1": "=A1+" + "+".join(f"{weight}*A{row}" for row in range(2, count + 2)), "D2": "=A1*2"}
    given = {name: {"cell": f"A{row}", "low": 0, "high": 1} for row, name in enumerate(names, start=1)}
    return book(cells, given, {"y": "D1", "z": "D2"}, {})


def interrupting(at):
    """`tell` that presses Ctrl-C at a step, counted from 1, and what it was told."""
    messages = []

    def tell(what):
        messages.append(what)
        if len(messages) == at:
            signal.raise_signal(signal.SIGINT)

    return tell, messages


def test_steps_tell_which_of_how_many_and_how_long():
    messages, now = [], iter([0.0, 10.0, 14.0, 18.0, 400.0])
    with Steps(messages.append, lambda: next(now)) as steps:
        steps.begin("first")
        steps.expect(60)
        for name in ("second", "third"):
            steps.begin(name)
        steps.expect(1)
        steps.begin("last")
        steps.begin("one more")
    assert messages == [
        "first",
        "second (2 of about 61, 10 min left)",
        "third (3 of about 61, 7 min left)",
        "last (4 of about 4, 4 s left)",
        "one more",
    ]


def test_ctrl_c_ends_the_steps_once_there_is_something_to_tell():
    messages = []
    with Steps(messages.append) as steps:
        steps.begin("first")
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        steps.can_end()
        steps.expect(8)
        done = []
        for number in steps.each(range(9)):
            done.append(number)
            if number == 2:
                signal.raise_signal(signal.SIGINT)
        assert done == [0, 1, 2]
        assert steps.why_ended == "it was interrupted after 1 of about 9 steps"
        steps.begin("what is needed all the same")
        assert messages[-1] == "what is needed all the same (interrupted: it ends with what is known as soon as it can)"
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


def test_a_step_can_be_left_at_once():
    with Steps() as steps:
        steps.can_end()
        left = True
        with steps.left_at_once():
            signal.raise_signal(signal.SIGINT)
            left = False
        assert left
        assert steps.ended
        with pytest.raises(KeyboardInterrupt), steps.left_at_once():
            signal.raise_signal(signal.SIGINT)


def test_a_step_that_fails_by_itself_is_no_ctrl_c():
    with Steps() as steps:
        steps.can_end()
        with pytest.raises(KeyboardInterrupt), steps.left_at_once():
            raise KeyboardInterrupt
        assert not steps.ended


def test_what_will_be_done_is_said_once_of_a_long_study():
    said = []
    with Steps(plan=said.append) as steps:
        steps.say_plan("Makes 2 runs", 9.0)
        steps.say_plan("Makes 9 runs", 130.0)
        steps.say_plan("Makes 8 runs", 120.0)
    assert said == ["Makes 9 runs, about 2 min. Ctrl-C ends it with what is known by then."]


def test_no_step_goes_on_beyond_the_limit_of_time():
    messages, now = [], iter([0.0, 10.0, 14.0])
    with Steps(messages.append, lambda: next(now)) as steps:
        steps.latest = 17.0
        steps.begin("first")
        steps.expect(60)
        for name in ("second", "third"):
            steps.begin(name)
    assert messages[1:] == ["second (2 of about 61, 7 s left)", "third (3 of about 61, 3 s left)"]


def test_many_assumptions_are_held_at_once_before_any_is_alone(book):
    result = screen(wide(book, 40), trials=2_000, seed=1)
    assert set(result.at_once.names) == {f"b{k}" for k in range(40)}
    assert [cost.names for cost in result.single] == [("a",)]
    assert result.joint == result.at_once
    assert result.runs < 10
    assert not result.ended


def test_few_assumptions_are_held_one_by_one(book):
    result = screen(wide(book, ALONE - 1), trials=2_000, seed=1)
    assert result.at_once is None
    assert len(result.single) == ALONE
    assert len(result.joint.names) == ALONE - 1


def test_an_answer_that_a_change_does_not_reach_is_compared_with_itself(book):
    """b does not reach z: its difference is 0 ± 0 in every number, to the bit that of a full comparison."""
    result = screen(wide(book, 2), trials=2_000, seed=1)
    (b, a) = sorted(result.single, key=lambda cost: cost.size)[0], result.single[-1]
    assert all(change.difference.value == change.difference.error == 0.0 for _, change in b.forecasts["z"].changes)
    assert a.forecasts["z"].standard_deviation.difference.value != 0.0
    assert b.forecasts["y"].largest > 0.0


def test_a_screening_that_is_interrupted_tells_what_was_run(book):
    model = wide(book, 9, weight=0.5)
    tell, messages = interrupting(6)
    result = screen(model, trials=2_000, seed=1, tell=tell)
    assert result.ended.startswith("it was interrupted after 6 of about ")
    assert len(messages) == 6
    assert len(result.single) == 4
    whole = {cost.names: cost for cost in screen(model, trials=2_000, seed=1).single}
    assert all(cost.size == whole[cost.names].size for cost in result.single)


def test_before_there_is_an_answer_ctrl_c_is_as_ever(book):
    tell, _ = interrupting(1)
    with pytest.raises(KeyboardInterrupt):
        screen(wide(book, 3), trials=2_000, seed=1, tell=tell)


def test_a_search_for_lost_digits_that_is_interrupted(book):
    model = book({"A1": 1.5, "B1": "=(A1+1E16)-1E16"}, {"x": {"cell": "A1", "low": 1, "high": 2}}, {"f": "B1"}, {})
    tell, messages = interrupting(4)
    result = stability(model, trials=500, seed=1, tell=tell)
    assert [finding.kind for finding in result.findings] == ["cancellation"]
    assert result.cells == ()
    assert result.ended == "it was interrupted after 4 of about 12 steps"
    assert result.not_looked_for[0] == "heavy tails"
    assert messages[-1].startswith("lost digits (4 of about 12")
    whole = stability(model, trials=500, seed=1)
    assert (whole.ended, whole.not_looked_for) == ("", ())


def test_a_search_for_lost_digits_does_not_end_its_step_first(book, monkeypatch):
    def endless(case):
        signal.raise_signal(signal.SIGINT)
        raise AssertionError("the step goes on")

    monkeypatch.setitem(import_module("xlmc.analysis.studies.stability.find")._DETECTORS, "lost digits", endless)
    model = book({"A1": 1.5, "B1": "=A1*2"}, {"x": {"cell": "A1", "low": 1, "high": 2}}, {"f": "B1"}, {})
    result = stability(model, trials=500, seed=1)
    assert result.ended.startswith("it was interrupted after 4 of about ")
    assert result.not_looked_for[:2] == ("lost digits", "heavy tails")


def test_a_search_for_causes_that_is_interrupted(book):
    def scene(high):
        names = [f"x{k}" for k in range(6)]
        given = {name: {"cell": f"A{row}", "low": 0, "high": high} for row, name in enumerate(names, start=1)}
        cells = {f"A{row}": 0.5 for row in range(1, 7)} | {"B1": "=SUM(A1:A6)"}
        return book(cells, given, {"y": "B1"}, {})

    tell, _ = interrupting(4)
    result = compare(scene(1), scene(2), trials=2_000, seed=1, tell=tell)
    assert result.ended.startswith("it was interrupted after 4")
    assert result.forecasts[0].cause is None
    assert result.forecasts[0].difference.mean.difference.value == pytest.approx(3.0, rel=0.1)
    assert compare(scene(1), scene(2), trials=2_000, seed=1).forecasts[0].cause is not None


def test_methods_that_are_interrupted_tell_of_the_runs_made(book):
    model = book({"A1": 1.5, "B1": "=A1^2"}, {"x": {"cell": "A1", "low": 1, "high": 2}}, {"f": "B1"}, {})
    messages = []

    def tell(what):
        messages.append(what)
        if "3 of 9" in what:
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGINT)

    sizes = {"reference_trials": 4_096, "trials": 1_024, "seed": 1}
    with pytest.raises(KeyboardInterrupt):
        study(model, replicates=9, tell=tell, **sizes)
    messages.clear()

    def later(what):
        messages.append(what)
        if "4 of 9" in what:
            signal.raise_signal(signal.SIGINT)

    result = study(model, replicates=9, tell=later, **sizes)
    assert "4 of 9" in messages[-1]
    assert result.ended
    assert result.curves


def test_of_many_steps_groups_that_are_not_needed_are_left_out_first():
    steps = [Step("assumption", 0, f"x{k}") for k in range(300)]
    needed, asked = {steps[17], steps[204]}, []

    def left(taken):
        taken = {*taken}
        asked.append(len(taken))
        return 0.0 if needed <= taken else 2.0 - 0.9 * len(needed & taken)

    assert {*cause_of(steps, left)} == needed
    assert len(asked) < 120


def test_the_sentence_names_the_study():
    assert ended_early("search", "its trials were spent", "More would follow.") == (
        "The search ended early, because its trials were spent. More would follow."
    )
