from __future__ import annotations

import sys
from random import Random

import numpy as np
import pytest
from hypothesis import event, given, note, settings
from hypothesis import strategies as st

from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.numpy.sequence import Buffers
from xlmc.errors import ErrorCode

INPUTS = ("A1", "A2", "A3")
HELD = {"B1": 2.0, "B2": "x", "B4": True, "B5": "2", "B6": -0.5}  # B3 is blank
RANGES = ("A1:A3", "B1:B3", "B4:B6", "A1:B2", "B3:B3")
NUMBERS = ("0", "1", "2", "0.5", "3", "1E3", "10%")

PAIRS = ("+", "-", "*", "/", "^", "=", "<>", "<", "<=", ">", ">=", "&")
ONE = ("SQRT", "LN", "EXP", "ABS", "SIN", "INT", "SIGN", "NOT", "ISERROR", "ISNUMBER", "TAN", "ASIN")
TWO = ("IFERROR", "IFNA", "AND", "OR", "XOR", "MOD", "POWER", "ATAN2", "ROUND", "MAX", "IF")
MANY = ("SUM", "MIN", "MAX", "PRODUCT", "AVERAGE", "COUNT", "AND", "OR", "COUNTA")
ARRAYS = ("SUM({{1,2,3}}*{0})", "SUMPRODUCT(({1}>{0})*{1})", "SUM(LARGE({1},{{1,2}}))", "({0}+{{1;2}})", "MEDIAN({1})")


def expression(random, cells, depth):
    """A formula over the inputs, cells that hold all kinds of values, and the formula cells so far."""
    if random.random() < 0.25 or depth == 0:
        return random.choice((*INPUTS, *INPUTS, *HELD, "B3", *NUMBERS, *cells, *cells))

    def part():
        return expression(random, cells, depth - 1)

    ranges = (*RANGES, *([f"C1:C{len(cells)}"] if cells else []))
    return random.choice(
        (
            lambda: f"({part()}{random.choice(PAIRS[:4])}{part()})",
            lambda: f"({part()}{random.choice(PAIRS)}{part()})",
            lambda: f"({random.choice('-+')}{part()})",
            lambda: f"{random.choice(ONE)}({part()})",
            lambda: f"{random.choice(TWO)}({part()},{part()})",
            lambda: f"IF({part()},{part()},{part()})",
            lambda: f"IF({part()}>{part()},{part()},SQRT(A1-{random.random()}))",
            lambda: f"{random.choice(MANY)}({random.choice(ranges)},{part()})",
            lambda: f"{random.choice(MANY)}({random.choice(ranges)})",
            lambda: random.choice(ARRAYS).format(part(), random.choice(ranges)),
        )
    )()


def a_book(seed):
    """Cells that build on each other, one or two filters, forecasts, and draws, harmless ones or any."""
    random = Random(seed)
    cells, names = dict(HELD), []
    for row in range(1, random.randint(2, 7)):
        cells[f"C{row}"] = "=" + expression(random, names, 3)
        names.append(f"C{row}")
    filters = [f"D{row}" for row in range(1, random.randint(1, 3))]
    for name in filters:
        cells[name] = f"={random.choice(names)}>{random.choice(('0', '0.7', 'A1'))}"
    cells["E1"] = "=" + "".join(f"{random.choice('+-')}{name}" for name in names)
    forecasts = ["E1", *random.sample((*names, *INPUTS), random.randint(0, 3))]
    odd = random.choice(((), (0.0, 1.0, -1.0, 2.0, 1e200, -3.5), (1.0, 2.0, 0.75)))
    numbers = [*odd, *(random.uniform(0.1, 2.0) for _ in range(10))]
    return cells, {name: random.choices(numbers, k=20) for name in INPUTS}, forecasts, filters


@settings(max_examples=240, deadline=None)
@given(st.integers(0, 2**40))
def test_the_fast_path_equals_the_careful_one(run, seed):
    case = a_book(seed)
    note(case)
    event(f"careful: {run(*case).careful}")


@pytest.mark.parametrize("seed", range(30))
def test_values_do_not_depend_on_which_buffers_they_lie_in(run, evaluate, seed):
    cells, draws, forecasts, filters = a_book(seed)
    made_of = run(cells, draws, forecasts, filters).program._made_of
    draws = {name: np.array(values) for name, values in draws.items()}

    def result():
        return evaluate(NumpyProgram(*made_of).evaluator(20), draws, 20)

    shared = result()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Buffers, "free", lambda self, nodes: [])
        patch.setattr(Buffers, "exchange", lambda self, done, node, loose: self.take(node))
        own = result()
        patch.setattr(Buffers, "take", lambda self, node: None)
        assert shared == own == result()


HARMLESS = [
    # with A1 and A2 between 1 and 2: whatever could err stands in a branch that is not taken, or is rescued
    "IF(A1>0,1/A1,1/(A1-A1))",
    "IF(A1<0,SQRT(A1-9),A2)",
    "IF(A1<0,LN(-A1),IF(A2>0,SQRT(A2),LN(A2-9)))",
    "IF(A1>A2,SQRT(A1-A2),SQRT(A2-A1))",
    "IF(A1>A2,1/(A1-A2),IF(A1=A2,0,1/(A2-A1)))",
    "IF(A1<0,A2,A1)",
    "IF(A1>1.5,A2)",
    "IF(A1,1/A1,1/0)",
    "IFERROR(SQRT(A1),1/0)",
    "IFERROR(SQRT(A1),SQRT(A1-9))",
    "IFNA(A1*A2,LN(A1-9))",
    "IF(AND(A1>0,A2>0),A1,SQRT(-A1))",
    "SUM(A1:A2)+MAX(A1:A3,B3)+MIN(A1,B1)",
    "SUM(A1:B6)",  # texts and logicals in a range do not count
    "A1^0.5+A2^2+A1^-1",
    "A1%+(+A2)",
    "ROUND(A1,2)+INT(A2)+MOD(A1,0.3)",
    "ATAN2(A1,A2)+SIN(A1)*COS(A2)/TAN(A1)",
    "RADIANS(A1)+DEGREES(A2)+PI()",
    "A1*(A1>1.5)+(A2<=1.5)",
    "NOT(A1>1)*1+AND(A1>0,TRUE)+OR(A1>9,A2)+XOR(A1>1.5,A2>1.5)",
    "B4*A1+(B3+A2)",
]


@pytest.fixture
def harmless():
    draws = np.random.default_rng(1).uniform(1, 2, (3, 64))
    return dict(zip(INPUTS, draws, strict=True))


@pytest.mark.parametrize("formula", HARMLESS)
@pytest.mark.parametrize("role", ["filter", "forecast"])
def test_what_errs_nowhere_stays_on_the_fast_path(run, harmless, formula, role):
    cells = HELD | {"C1": f"={formula}", "D1": "=C1>-1E9"}
    outcome = run(cells, harmless, ["C1"], ["D1"] if role == "filter" else [])
    assert not outcome.careful
    assert all(isinstance(value, float) for value in outcome.forecasts[0])


ERRORS = {
    # formula -> what one trial of A1 = 0 among sound ones gives
    "1/A1": "#DIV/0!",
    "0/A1": "#DIV/0!",
    "LN(A1)": "#NUM!",
    "LOG10(A1)": "#NUM!",
    "SQRT(A1-1E-9)": "#NUM!",
    "EXP(1/(A1+1E-3))": "#NUM!",
    "A1^0": "#NUM!",
    "A1^A1": "#NUM!",
    "A1^-1": "#DIV/0!",
    "(A1-1)^0.5": "#NUM!",
    "ATAN2(A1,A1)": "#DIV/0!",
    "ATAN2(A1,0)": "#DIV/0!",
    "SIN(IF(A1,A1,2^28))": "#NUM!",
    "COS(IF(A1,A1,-2^27))": "#NUM!",
    "TAN(IF(A1,A1,2^27))": "#NUM!",
    "MOD(1,A1)": "#DIV/0!",
    "ASIN(2-A1)": "#NUM!",
    "ROUND(1/A1,2)": "#DIV/0!",
    "SUM(A1:A2,1/A1)": "#DIV/0!",
    "IF(A1>0,A1,1/A1)": "#DIV/0!",
    "IF(1/A1>0,1,2)": "#DIV/0!",
    "IF(A1=0,B2+1,A1)": "#VALUE!",
    "IFNA(1/A1,9)": "#DIV/0!",
    "IFERROR(1/A1,9)": 9.0,
    "IFERROR(1/A1,A1^A1)": "#NUM!",
    "ISERROR(1/A1)": 1.0,
    "IF(ISERROR(1/A1),-1,A1)": -1.0,
    "AND(TRUE,1/A1)": "#DIV/0!",
    "OR(TRUE,1/A1)": "#DIV/0!",
    'IF(A1=0,"none",A1)': "text",
    'IF(A1=0,"",A1)+1': "#VALUE!",
    'IF(A1=0,"7",A1)+1': 8.0,
}


@pytest.mark.parametrize("formula", ERRORS)
def test_one_trial_in_error_among_sound_ones(run, harmless, formula):
    harmless["A1"][17] = 0.0
    outcome = run(HELD | {"C1": f"={formula}"}, harmless, ["C1"])
    assert outcome.forecasts[0][17] == ERRORS[formula]
    sound = [value for trial, value in enumerate(outcome.forecasts[0]) if trial != 17]
    assert all(isinstance(value, float) for value in sound)


def test_errors_are_values_trial_by_trial(run):
    draws = {"A1": [0.0, 1.0, -1.0, 2.0]}
    cells = {"C1": "=1/A1", "C2": "=SQRT(A1)", "C3": "=C1+C2", "C4": "=C2+C1", "C5": "=IFERROR(C3,-1)"}
    outcome = run(cells, draws, [*cells])
    assert outcome.careful
    assert outcome.forecasts[0] == ["#DIV/0!", 1.0, -1.0, 0.5]
    assert outcome.forecasts[1] == [0.0, 1.0, "#NUM!", 2**0.5]
    assert outcome.forecasts[2] == ["#DIV/0!", 2.0, "#NUM!", 0.5 + 2**0.5]
    assert outcome.forecasts[3] == ["#DIV/0!", 2.0, "#NUM!", 2**0.5 + 0.5]
    assert outcome.forecasts[4] == [-1.0, 2.0, -1.0, 0.5 + 2**0.5]


def test_the_first_error_wins(run):
    outcome = run({"C1": "=LN(A1)+1/A1", "C2": "=1/A1+LN(A1)", "C3": "=SUM(C1,C2)"}, {"A1": [0.0]}, ["C1", "C2", "C3"])
    assert outcome.forecasts == [["#NUM!"], ["#DIV/0!"], ["#NUM!"]]


def test_a_draw_that_is_an_error_makes_the_block_careful(run):
    cells = {"C1": "=A1+1", "C2": "=A2*2", "C3": "=IFERROR(A1,7)"}
    outcome = run(cells, {"A1": [np.nan, 1.0], "A2": [1.0, 2.0]}, ["C1", "C2", "C3"])
    assert outcome.careful
    assert outcome.forecasts == [["#NUM!", 2.0], [2.0, 4.0], [7.0, 1.0]]


def test_an_error_in_a_draw_that_nothing_needs_is_no_matter(run):
    outcome = run({"C2": "=A2*2"}, {"A1": [np.nan, 1.0], "A2": [1.0, 2.0]}, ["C2"])
    assert not outcome.careful


def test_an_infinite_draw_is_an_error(run):
    assert run({"C1": "=A1+1"}, {"A1": [np.inf, 1.0]}, ["C1"]).forecasts == [["#NUM!", 2.0]]


def test_forecasts_are_evaluated_on_the_survivors_alone(run):
    """SQRT(A1) and 1/A1 err in trials that the filter rejects: the fast path never sees these."""
    cells = {"C1": "=SQRT(A1)", "C2": "=1/A2+C3", "C3": "=A1*2", "D1": "=C3>0"}
    draws = {"A1": [1.0, -1.0, 4.0, 0.0], "A2": [1.0, 0.0, 2.0, 0.0]}
    outcome = run(cells, draws, ["C1", "C2", "A2", "C3", "D1"], ["D1"])
    assert not outcome.careful
    assert outcome.forecasts == [[1.0, 2.0], [3.0, 8.5], [1.0, 2.0], [2.0, 8.0], [1.0, 1.0]]


def test_an_error_among_the_survivors_makes_the_forecasts_careful(run):
    cells = {"C1": "=1/A2", "D1": "=A1>0"}
    outcome = run(cells, {"A1": [1.0, -1.0, 4.0], "A2": [1.0, 0.0, 0.0]}, ["C1"], ["D1"])
    assert outcome.careful
    assert outcome.forecasts == [[1.0, "#DIV/0!"]]


def test_no_filter_and_no_varying_forecast(run):
    outcome = run(
        {"C1": "=1+1", "C2": "x", "C3": "=1/0", "C4": "=C5"}, {"A1": [1.0, 2.0]}, ["C1", "C2", "C3", "C4", "C5"]
    )
    assert outcome.forecasts == [[2.0, 2.0], ["text"] * 2, ["#DIV/0!"] * 2, [0.0, 0.0], ["blank"] * 2]


def test_an_evaluator_takes_blocks_of_any_size_up_to_its_own(lower):
    lowering, (forecast,) = lower({"C1": "=IF(A1>0,SQRT(A1),-1)+A1"}, ["A1"], ["C1"])
    evaluator = NumpyProgram.of(lowering, [], [forecast], frozenset()).evaluator(10)
    for values in ([1.0, 4.0], [9.0], [4.0] * 10, [-1.0, 16.0]):
        evaluator.filters({"A1": np.array(values)}, len(values))
        (result,) = evaluator.forecasts(np.arange(len(values)))
        expected = [value**0.5 + value if value > 0 else value - 1 for value in values]
        assert result.as_floats().tolist() == expected


def test_a_careful_block_leaves_no_trace_in_the_next(lower):
    lowering, (filter_, forecast) = lower({"C1": "=1/A1", "D1": "=A1<5"}, ["A1"], ["D1", "C1"])
    evaluator = NumpyProgram.of(lowering, [filter_], [forecast], frozenset()).evaluator(2)
    for values, expected in (([1.0, 0.0], [1.0, None]), ([2.0, 4.0], [0.5, 0.25]), ([0.0, 4.0], [None, 0.25])):
        evaluator.filters({"A1": np.array(values)}, 2)
        (result,) = evaluator.forecasts(np.arange(2))
        assert [None if np.isnan(value) else value for value in result.as_floats()] == expected


def test_an_input_in_one_branch_only(run):
    outcome = run({"C1": "=IF(A1>1,1/A2,0)"}, {"A1": [0.0, 2.0], "A2": [0.0, 4.0]}, ["C1"])
    assert not outcome.careful
    assert outcome.forecasts == [[0.0, 0.25]]


@pytest.mark.parametrize("order", [1, 0, -1])
@pytest.mark.parametrize(
    ("formulas", "forecasts"),
    [
        (["INDEX(F1:F9,{m})", "INDEX(G1:G9,{m})*2"], ["C1", "C2"]),
        (["INDEX(F1:F9,{m})", "{m}"], ["C1", "C2"]),
        (["INDEX(F1:F9,{m})+{m}", "SIN(INDEX(G1:G9,{m}))"], ["C1", "C2"]),
        (["SIN(INDEX(G1:G9,{m}))+EXP(INDEX(F1:F9,{m}))"], ["C1"]),
        (["IF(A2>1.5,1/INDEX(F1:F9,{m}),INDEX(G1:G9,{m}))", "INDEX(F1:F9,{m})"], ["C1", "C2"]),
        (["{m}", "INDEX(F1:F9,C1)", "IF(A2>1.5,1/C1,C2)"], ["C3", "C2"]),
    ],
)
@pytest.mark.parametrize("filters", [(), ("D1",)])
def test_a_position_that_picks_read_and_others(run, order, formulas, forecasts, filters):
    """Where nothing but picks reads it, it is kept as an index."""
    keys = [1.0 + row / 9 for row in range(9)]
    cells = {f"E{row}": key for row, key in enumerate(keys if order >= 0 else keys[::-1], start=1)}
    cells |= {f"{column}{row}": row * factor for column, factor in (("F", 0.3), ("G", 7.0)) for row in range(1, 10)}
    cells |= {f"C{row}": "=" + text.format(m=f"MATCH(A1,E1:E9,{order})") for row, text in enumerate(formulas, start=1)}
    cells |= {"D1": f"=INDEX(G1:G9,MATCH(A1,E1:E9,{order}))>20"}
    random = np.random.default_rng(1)
    draws = {"A1": random.choice(keys, 64), "A2": random.uniform(1, 2, 64)}
    assert not run(cells, draws, forecasts, filters).careful


@pytest.mark.parametrize("limit", [0.0, 1.03, 1.5, 9.0])
@pytest.mark.parametrize("formula", ["IF(A1>{0},A2,-A3)", "IF(A1>{0},A2,0)", "IF(A1>{0},1E300,A2)", "IF(A1>{0},2,-3)"])
def test_a_choice_in_all_trials_in_some_and_in_none(run, harmless, formula, limit):
    outcome = run({"C1": "=" + formula.format(limit)}, harmless, ["C1"])
    assert not outcome.careful
    parts = {"A2": harmless["A2"], "-A3": -harmless["A3"]}
    yes, no = (parts.get(part, part) for part in formula[:-1].split(",")[1:])
    assert outcome.forecasts == [np.where(harmless["A1"] > limit, *(np.asarray(p, float) for p in (yes, no))).tolist()]


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ('IF(IF(A1>1,TRUE,"x"),1/A1,2)', ["#VALUE!", 0.5]),  # the condition is a text in one trial
        ("IF(1/0,1/A1,SQRT(A1))", ["#DIV/0!"] * 2),
        ("IF(NA(),A1,1/A1)", ["#N/A"] * 2),
        ('IF("x",A1,1/A1)', ["#VALUE!"] * 2),
        ('IF("true",1/A1,A1)', [1.0, 0.5]),
        ("IF(B3,A1,1/A1)", [1.0, 0.5]),
        ("IF(2,1/A1,A1)", [1.0, 0.5]),
        ("IF(A1>1,B3,A1)+1", [2.0, 1.0]),
        ("IF(A1>1,,A1)", [1.0, 0.0]),
        ("IF(A1>1,B4,A1)", [1.0, 1.0]),
        ("IFERROR(1/0,A1)", [1.0, 2.0]),
        ("IFERROR(B3,A1)", [0.0, 0.0]),
        ("IFNA(5,A1)/A1", [5.0, 2.5]),
        ("XOR(A1:A1,C8)", ["#DIV/0!", 1.0]),  # a text does not count, yet may be an error
        ("SUM(A1:A1,C9)", ["#DIV/0!", 2.0]),  # nor does a logical
    ],
)
def test_conditions_and_kinds(run, formula, expected):
    cells = HELD | {"C1": f"={formula}", "C8": "=B2&1/(A1-1)", "C9": "=1/(A1-1)>0"}
    assert run(cells, {"A1": [1.0, 2.0]}, ["C1"]).forecasts == [expected]


def test_a_range_that_several_functions_read_later(run):
    """The cells of a range live as long as the last function that folds them."""
    cells = {f"B{i}": f"=A1*{i}" for i in range(1, 5)}
    cells |= {"C1": "=SUM(B1:B4)", "C2": "=SQRT(C1)*2+C1*3", "C3": "=MAX(B1:B4)-MIN(B1:B4)", "C4": "=PRODUCT(B1:B4)"}
    outcome = run(cells, {"A1": [1.0, 2.0]}, ["C4", "C3", "C2", "C1"])
    assert not outcome.careful
    assert outcome.forecasts == [[24.0, 384.0], [3.0, 6.0], [10**0.5 * 2 + 30, 20**0.5 * 2 + 60], [10.0, 20.0]]


@pytest.mark.parametrize("depth", [3, 300])
def test_branches_within_branches(run, depth):
    cells = {"B1": "=1/A1"} | {f"B{k}": f"=IF(A1>{k}/1000,SQRT(B{k - 1}),B{k - 1})" for k in range(2, depth)}
    draws = np.random.default_rng(1).uniform(0.001, depth / 1000, 40)
    outcome = run(cells, {"A1": draws}, [f"B{depth - 1}"])
    assert not outcome.careful


@pytest.mark.parametrize("depth", [3, 200])
def test_rescues_within_rescues(run, depth):
    cells = {"B1": "=1/A1"} | {f"B{k}": f"=IFERROR(SQRT(A1-{k}),B{k - 1})" for k in range(2, depth)}
    run(cells, {"A1": [0.0, 2.5, 7.0, 1e3]}, [f"B{depth - 1}"])


def test_a_long_chain_of_cells(run):
    cells = {"B1": "=A1+1"} | {f"B{k}": f"=B{k - 1}+1" for k in range(2, 1201)}
    outcome = run(cells, {"A1": [0.0, 1.0]}, ["B1200"])
    assert outcome.forecasts == [[1200.0, 1201.0]]


def test_a_long_sum(run):
    """Of more terms than Python's own calls may be deep; the longest that Excel takes is among the tests of parsing."""
    more = sys.getrecursionlimit()
    assert run({"B1": "=A1" + "+A1" * more}, {"A1": [0.5]}, ["B1"]).forecasts == [[(1 + more) / 2]]


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("COUNT(IFERROR(TAKE(B1:B3,A1),9))", [1.0, 2.0, 3.0]),
        ("AGGREGATE(9,6,IFNA(TAKE(B1:B3,A1),9))", [4.0, 6.0, 15.0]),
        ("COUNT(IFERROR(TAKE(B1:B3,A1),{1;2;3;4}))", [4.0, 4.0, 4.0]),
        ("SUM(IFERROR(TAKE(B1:B2,2),A1:A4))", [9.0, 10.0, 11.0]),
        ('LEN(IFERROR(INDEX(B1:B4,A1*0+4),"x"))', [1.0, 1.0, 1.0]),
        ("SUM(LEN(IFERROR(TAKE(D1:D3,A1),7)))", [1.0, 2.0, 3.0]),
    ],
)
def test_rescues_of_many_cells_and_of_blanks(run, formula, expected):
    """`B3` is an error that only the third trial takes, and may hide in an array of its own size; `D1` on is empty."""
    cells = {"A3": "=A1", "A4": 2.0, "B1": 4.0, "B2": 2.0, "B3": ErrorCode.NA, "Z1": f"={formula}"}
    assert run(cells, {"A1": [1.0, 2.0, 3.0]}, ["Z1"]).forecasts == [expected]


def test_a_count_that_branches_within_branches_need_is_a_number_for_each_trial(run):
    cells = {"Z1": "=IF(A1>2,IF(A2>3,COUNT(A1:A3),COUNT(A1:A3)/A2),1/A3)"}
    draws = {"A1": [3.0, 3.0, 1.0], "A2": [4.0, 2.0, 4.0], "A3": [4.0, 4.0, 4.0]}
    assert list(run(cells, draws, ["Z1"]).forecasts[0]) == [3.0, 1.5, 0.25]
