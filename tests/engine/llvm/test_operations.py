"""What the loop computes of single values against NumPy and SciPy; NaN stands for an error of Excel."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from xlmc.engine.engine import Target
from xlmc.engine.graph.nodes import Apply
from xlmc.engine.llvm import phase
from xlmc.engine.llvm.loop import compile_loop
from xlmc.engine.llvm.operations import loop_rule_of
from xlmc.engine.llvm.program import JitProgram
from xlmc.errors import ErrorCode
from xlmc.excel.functions.operators import ALL_BITS

A = np.array([-7.5, -2.0, -1.0, -0.25, 0.0, 0.5, 1.0, 3.0, 1e6, 2.0**27, 1e-295, 4.000000000000001])
B = np.array([2.0, -0.5, 1.0, 0.0, 0.0, 2.0, -3.0, 3.0, 7.0, 4.0, 1e-295, 4.0])

NAN = np.nan


def where(condition, value, instead=NAN):
    with np.errstate(all="ignore"):
        return np.where(condition, value, instead)


def excel_mod(a, b):
    return np.array([math.fmod(math.fmod(x, y) + y, y) if y else NAN for x, y in zip(a, b, strict=True)])


def power(a, b):
    fine = (a > 0) | ((a == 0) & (b > 0)) | ((a < 0) & (b == np.floor(b)))
    return where(fine, np.power(np.where(fine, a, 1.0), np.where(fine, b, 1.0)))


VALUES = {
    "A1+B1": lambda a, b: a + b,
    "A1-B1": lambda a, b: where(np.abs(a - b) < 1e-14, 0.0, a - b),
    "A1*B1": lambda a, b: where(np.abs(a * b) < 2.3e-308, 0.0, a * b),
    "A1/B1": lambda a, b: where(b != 0, a / np.where(b == 0, 1.0, b)),
    "A1/3": lambda a, b: a / 3,
    "A1/1E-30": lambda a, b: a / 1e-30,
    "-A1": lambda a, b: -a,
    "A1%": lambda a, b: a / 100,
    "A1=B1": lambda a, b: (a == b) | (a == A[-1]),
    "A1<>B1": lambda a, b: (a != b) & (a != A[-1]),
    "A1<B1": lambda a, b: a < b,
    "A1>B1": lambda a, b: (a > b) & (a != A[-1]),
    "A1<=B1": lambda a, b: (a <= b) | (a == A[-1]),
    "A1>=B1": lambda a, b: a >= b,
    "A1=4": lambda a, b: a == A[-1],
    "A1<>4": lambda a, b: a != A[-1],
    "A1<4": lambda a, b: a < 4,
    "A1<=4": lambda a, b: (a < 4) | (a == A[-1]),
    "A1>4": lambda a, b: (a > 4) & (a != A[-1]),
    "A1>=4": lambda a, b: a >= 4,
    "1>A1": lambda a, b: a < 1,
    "1>=A1": lambda a, b: a <= 1,
    "1<A1": lambda a, b: a > 1,
    "1<=A1": lambda a, b: a >= 1,
    "1=A1": lambda a, b: a == 1,
    "NOT(A1>B1)": lambda a, b: (a <= b) | (a == A[-1]),
    "IF(A1>0,B1,-B1)": lambda a, b: np.where(a > 0, b, -b),
    "IFERROR(A1,B1)": lambda a, b: a,
    "IFERROR(1/A1,B1)": lambda a, b: where(a != 0, 1 / np.where(a == 0, 1.0, a), b),
    "ABS(A1)": lambda a, b: np.abs(a),
    "SIGN(A1)": lambda a, b: np.sign(a),
    "SQRT(A1)": lambda a, b: where(a >= 0, np.sqrt(np.abs(a))),
    "INT(A1)": lambda a, b: np.floor(a) + 0.0,
    "MOD(A1,B1)": lambda a, b: excel_mod(a, b),
    "QUOTIENT(A1,B1)": lambda a, b: where(b != 0, np.trunc(a / np.where(b == 0, 1.0, b))),
    "MROUND(A1,2)": lambda a, b: where(a >= 0, 2 * np.floor(a / 2 + 0.5)),
    "ISEVEN(A1)": lambda a, b: np.trunc(a) % 2 == 0,
    "ISODD(A1)": lambda a, b: np.trunc(a) % 2 != 0,
    "SIN(A1)": lambda a, b: where(np.abs(a) < 2**27, np.sin(a)),
    "COS(A1)": lambda a, b: where(np.abs(a) < 2**27, np.cos(a)),
    "TAN(A1)": lambda a, b: where(np.abs(a) < 2**27, np.tan(a)),
    "SEC(A1)": lambda a, b: where(np.abs(a) < 2**27, 1 / np.cos(a)),
    "CSC(A1)": lambda a, b: where((np.abs(a) < 2**27) & (a != 0), 1 / np.sin(np.where(a == 0, 1.0, a))),
    "ATAN(A1)": lambda a, b: np.arctan(a),
    "ATAN2(A1,B1)": lambda a, b: where((a != 0) | (b != 0), np.arctan2(b, a)),
    "ASIN(A1)": lambda a, b: where(np.abs(a) <= 1, np.arcsin(np.clip(a, -1, 1))),
    "ACOS(A1)": lambda a, b: where(np.abs(a) <= 1, np.arccos(np.clip(a, -1, 1))),
    "EXP(A1)": lambda a, b: where(a < 700, np.exp(np.minimum(a, 700))),
    "LN(A1)": lambda a, b: where(a > 0, np.log(np.where(a > 0, a, 1.0))),
    "LOG10(A1)": lambda a, b: where(a > 0, np.log10(np.where(a > 0, a, 1.0))),
    "LOG(A1)": lambda a, b: where(a > 0, np.log10(np.where(a > 0, a, 1.0))),
    "LOG(A1,10)": lambda a, b: where(a > 0, np.log10(np.where(a > 0, a, 1.0))),
    "LOG(A1,2)": lambda a, b: where(a > 0, np.log2(np.where(a > 0, a, 1.0))),
    "A1^B1": power,
    "A1^0.5": lambda a, b: power(a, 0.5 + 0 * a),
    "A1^1": lambda a, b: a,
    "A1^-1": lambda a, b: power(a, -1 + 0 * a),
    "A1^3": lambda a, b: where(np.abs(a) < 1e-100, 0.0, a**3),
    "A1^5": lambda a, b: where(np.abs(a) < 1e-100, 0.0, a**5),
    "A1^4": lambda a, b: where(np.abs(a) < 1e-100, 0.0, a**4),
    "A1^1.5": lambda a, b: where(np.abs(a) < 1e-290, np.where(a == 0, 0.0, 0.0), power(a, 1.5 + 0 * a)),
    "A1^-0.5": lambda a, b: power(a, -0.5 + 0 * a),
    "2^A1": lambda a, b: where(a < 1000, 2.0 ** np.minimum(a, 1000)),
    "ROUND(A1,0)": lambda a, b: np.copysign(np.floor(np.abs(a) + 0.5), a) + 0.0,
    "ROUND(A1,1)": lambda a, b: np.array([round(x * 10 + math.copysign(1e-9, x)) / 10 for x in a]) + 0.0,
    "ROUNDUP(A1,0)": lambda a, b: np.copysign(np.ceil(np.abs(a)), a) - (a == A[-1]),
    "TRUNC(A1)": lambda a, b: np.trunc(a) + 0.0,
    "ROUND(A1,-1)": lambda a, b: np.copysign(10 * np.floor(np.abs(a) / 10 + 0.5), a) + 0.0,
    "ISERROR(A1)+ISERR(A1)+ISNA(A1)+ISTEXT(A1)+ISBLANK(A1)": lambda a, b: 0 * a,
    "ISNONTEXT(A1)*1": lambda a, b: 1 + 0 * a,
    "ISERROR(A1>0)*1": lambda a, b: 0 * a,
}


@pytest.fixture(scope="module")
def loop(lower):
    """`loop(formulas)`: what each gives for the numbers A and B in A1 and B1, NaN where it is an error."""

    def compute(formulas):
        cells = {f"Z{row}": f"={formula}" for row, formula in enumerate(formulas, 1)}
        lowering, targets = lower({"A1": 0.0, "B1": 0.0, **cells}, ["A1", "B1"], [*cells])
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(phase, "compile_loop", lambda *given: compile_loop(*given[:6], 0))
            evaluator = JitProgram(lowering, [], targets, frozenset()).evaluator(A.size)
        list(evaluator.filters({"A1": A, "B1": B}, A.size))
        columns = evaluator.forecasts(np.arange(A.size))
        codes = [np.zeros(A.size) if column.codes is None else column.codes for column in columns]
        values = [np.where(code > 0, NAN, column.values) for code, column in zip(codes, columns, strict=True)]
        return dict(zip(formulas, values, strict=True)), dict(zip(formulas, codes, strict=True))

    return compute


@pytest.fixture(scope="module")
def computed(loop):
    return loop(VALUES)[0]


@pytest.mark.parametrize("formula", VALUES)
def test_values(computed, formula):
    with np.errstate(all="ignore"):
        expected = np.asarray(VALUES[formula](A, B), float)
    np.testing.assert_allclose(computed[formula], expected, rtol=1e-14, atol=0)


LOST = [
    "1/({})", "SIGN({})", "INT({})", "ATAN({})", "EXP(-{})", "({})^-1", "MOD(5,{})", "{}>3", "{}<3", "{}={}+1",
    "QUOTIENT(5,{})", "ISEVEN({})", "ISODD({})", "ROUND({},0)", "ROUND({},-2)", "TRUNC({})", "LN({})", "LOG10({})",
    "2^(-{})", "0.5^({})", "ATAN2({},1)", "ATAN2(1,{})", "A1^(-{})", "({})^B1", "({})^-0.5", "({})^-4", "ABS({})",
    "NOT({})", "IF({}>0,1,2)", "SQRT({})", "{}*0", "-({})", "SIN({})", "ASIN({})", "MROUND({},2)", "5/({})",
]  # fmt: skip


@pytest.fixture(scope="module")
def lost(loop):
    return loop([formula.replace("{}", "(1/A1)") for formula in LOST])[1]


@pytest.mark.parametrize("formula", LOST)
def test_an_error_of_an_operand_leaves_its_trace(lost, formula):
    """1/A1 is infinite where A1 is 0: Excel's result is `#DIV/0!`, whatever a function would make of infinity."""
    assert lost[formula.replace("{}", "(1/A1)")][4] == ErrorCode.DIV0


LARGE = ["EXP(A1)", "A1^60", "10^A1", "EXP(ABS(A1))", "A1*1E200*1E200", "A1/1E-200/1E-200", "(A1*1E150)^3"]


def test_an_overflow_leaves_its_trace(loop):
    """Of 10^6 each is too large: `#NUM!`, though the arc tangent of infinity is a number."""
    codes = loop([f"ATAN({formula})" for formula in LARGE])[1]
    assert [code[8] for code in codes.values()] == [ErrorCode.NUM] * len(LARGE)


def rule_of(lower, formula):
    """The rule of the last function of a formula of A1 and B1; the names of nodes that it reads."""
    cells = {"A1": 0.0, "B1": 0.0, "C1": "text", "C2": "3", "D1": "=1/0", "Z1": f"={formula}"}
    lowering, (target,) = lower(cells, ["A1", "B1"], ["Z1"])
    assert isinstance(target, Target)
    node = lowering.target(target)
    assert isinstance(lowering.dag.nodes[node], Apply)
    return loop_rule_of(lowering.dag, node)


@pytest.mark.parametrize(
    ("formula", "has_one"),
    [
        ("A1+B1", True), ("A1&B1", False), ("LOG(A1,10)", True), ("LOG(A1,2)", False), ("LOG(A1,B1)", False),
        ("ROUND(A1,2)", True), ("ROUND(A1,22)", True), ("ROUND(A1,23)", False), ("ROUND(A1,-23)", False),
        ("ROUND(A1,B1)", False), ("TRUNC(A1)", True), ("SIN(A1)", True), ("GAMMALN(A1)", False), ("A1+C2", True),
        ("ISTEXT(A1)", True), ("(A1>0)=(B1>0)", False), ("A1=C1", False), ("MAX(A1,B1)", True),
    ],
)  # fmt: skip
def test_what_has_a_rule(lower, formula, has_one):
    assert (rule_of(lower, formula) is not None) == has_one


@pytest.mark.parametrize("relation", ALL_BITS)
def test_comparisons_of_all_bits_have_a_rule(lower, relation):
    """Those of a filter's limits: without a rule, no model with such a filter is run in whole blocks."""
    lowering, (target,) = lower({"A1": 0.0, "Z1": "=A1+1"}, ["A1"], ["Z1"])
    node = lowering.apply(ALL_BITS[relation], (lowering.target(target), lowering.number(1.0)))
    assert loop_rule_of(lowering.dag, node) is not None


def test_what_nothing_finite_makes_infinite(lower):
    """Only results that may be infinite are looked at."""
    makes = {"A1*B1": True, "ABS(A1)": False, "SIN(A1)": False, "ROUND(A1,-1)": True, "ROUND(A1,1)": False}
    assert {formula: rule_of(lower, formula).makes for formula in makes} == makes
