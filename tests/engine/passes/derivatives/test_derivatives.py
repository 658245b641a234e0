"""What is found beside the numbers: where there is no derivative and why, kinks, differences and their errors."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.analysis.studies import derivatives as of_model
from xlmc.analysis.studies.derivatives import derivatives
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent, Formula

X = {"x": {"cell": "A1", "low": -9, "high": 9}}
XY = X | {"y": {"cell": "B1", "low": -9, "high": 9}}
BASE = {"A1": 1.0, "B1": 1.0}


@pytest.fixture(scope="session")
def of(book):
    """`of(formula, {"x": …})`: the derivatives of one formula of A1, and B1 where `y` is given."""

    def make(formula, points, order=1, **cells):
        given_ = {name: XY[name] for name in points}
        model = book(BASE | cells | {"Z1": formula}, given_, {"f": "Z1"} | {n: XY[n]["cell"] for n in points})
        return derivatives(model, points, order=order)

    return make


def test_a_chain_of_cells_with_a_filter(book):
    cells = BASE | {"C1": "=A1*EXP(B1)", "C2": "=SIN(C1)+A1", "C3": "=SQRT(C2^2+C1^2)", "D1": "=C1-C2"}
    model = book(cells, XY, {"f": "C3"}, {"closing": {"cell": "D1", "above": 0}})
    cell = Cell("S", 1, 3)
    result = derivatives(model, {"x": [0.5, 1.5], "y": [0.25, -0.5]}, order=2, cells=[cell])
    assert result.names == ("x", "y")
    assert result.points.tolist() == [[0.5, 0.25], [1.5, -0.5]]

    def c1(x, y):
        return x * mpmath.exp(y)

    def c2(x, y):
        return mpmath.sin(c1(x, y)) + x

    exact = {
        "f": (result.forecasts["f"], lambda x, y: mpmath.hypot(c2(x, y), c1(x, y))),
        "filter": (result.filters["closing"], lambda x, y: c1(x, y) - c2(x, y)),
        "cell": (result.cells[cell], c1),
    }
    with mpmath.workdps(50):
        for one, f in exact.values():
            for i, point in enumerate(result.points):
                gradient = [mpmath.diff(f, tuple(point), n) for n in ((1, 0), (0, 1))]
                assert one.gradient[i] == pytest.approx(np.array(gradient, float), rel=1e-10)
                hessian = [
                    [mpmath.diff(f, tuple(point), n) for n in row] for row in (((2, 0), (1, 1)), ((1, 1), (0, 2)))
                ]
                assert one.hessian[i] == pytest.approx(np.array(hessian, float), rel=1e-10)


@pytest.mark.parametrize(
    ("formula", "x", "function", "why"),
    [
        ("=ABS(A1)", 0.0, "ABS", "it turns at 0"),
        ("=SQRT(A1)", 0.0, "SQRT", "a root is vertical at 0"),
        ("=A1^0.5", 0.0, "^", "a root is vertical"),
        ("=ASIN(A1)", 1.0, "ASIN", "vertical at ±1"),
        ("=ATAN2(-1,A1)", 0.0, "ATAN2", "jumps from -180° to 180°"),
        ("=MAX(A1,2)", 2.0, "MAX", "two of the numbers are equal"),
        ("=MEDIAN(A1,2,3)", 2.0, "MEDIAN", "two of the numbers are equal"),
        ("=ROUND(A1,1)", 1.25, "ROUND", "the value jumps"),
        ("=INT(A1)", 2.0, "INT", "the value jumps"),
        ("=CEILING(A1,0.5)", 1.5, "CEILING", "the value jumps"),
        ("=MOD(A1,2)", 4.0, "MOD", "the remainder jumps"),
        ("=IF(A1>2,A1,0)", 2.0, ">", "the two sides are equal"),
        ("=IF(AND(A1>=2,A1<5),A1,0)", 2.0, ">=", "the two sides are equal"),
        ("=VLOOKUP(A1,{1,10;2,20},2)", 2.0, "a lookup", "from one cell to the next"),
        ("=1/A1", 0.0, "/", "it is #DIV/0!"),
        ("=LN(A1)", -1.0, "LN", "it is #NUM!"),
        ('=VALUE(TEXT(A1,"0.00"))', 1.5, "TEXT", "through a text"),
        ("=STDEV.S(A1,2)", 2.0, "STDEV.S", "all the numbers are equal"),
    ],
)
def test_where_there_is_no_derivative_it_is_nan_with_a_reason(of, formula, x, function, why):
    results = of(formula, {"x": [x, 3.3]}, order=2)
    result = results.forecasts["f"]
    assert np.isnan(result.gradient[0, 0])
    assert np.isnan(result.hessian[0, 0, 0])
    assert results.undefined
    first = next(one for one in results.undefined if one.first == 0)
    assert (str(first.cell), first.function) == ("S!Z1", function)
    assert why in first.why


def test_a_kink_takes_the_derivatives_of_its_own_assumption_only(of):
    result = of("=ABS(A1)+3*B1", {"x": [0.0], "y": [1.0]}).forecasts["f"]
    assert np.isnan(result.gradient[0, 0])
    assert result.gradient[0, 1] == 3.0


@pytest.mark.parametrize("formula", ["=IF(A1>2,B1,B1)", "=IF(A1=2,B1^2/2,7)", "=VLOOKUP(A1,{1,10;2,20},2,FALSE)+B1"])
def test_labels_stand_still(of, formula):
    result = of(formula, {"x": [2.0, 2.0], "y": [1.0, 1.0]})
    assert result.forecasts["f"].gradient[:, 1].tolist() == [1.0, 1.0]


def test_errors_of_a_branch_not_taken_are_not_told(of):
    result = of("=IF(A1>0,LN(A1),SQRT(-A1))", {"x": [2.0, -4.0]})
    assert result.forecasts["f"].gradient[:, 0] == pytest.approx([0.5, -0.25])
    assert not result.undefined


@pytest.mark.parametrize(
    ("formula", "x", "function", "ways", "jumps"),
    [
        ("=IF(A1>0,A1,2*A1)", [-1, 2, 3], "IF", 2, True),
        ("=ABS(A1)", [-1, 2, 3], "ABS", 2, False),
        ("=MAX(A1,0)", [-1, 2, 3], "MAX", 2, False),
        ("=ROUND(A1,0)", [-1.1, 2.2, 3.3], "ROUND", 3, True),
        ("=ATAN2(-1,A1)", [-1, 2, 3], "ATAN2", 2, True),
        ("=VLOOKUP(A1,{-9,10;0,20},2)", [-1, 2, 3], "a lookup", 2, True),
        ("=MATCH(A1,{-9,0})", [-1, 2, 3], "a lookup", 2, True),
        ("=(A1>0)*A1", [-1, 2, 3], ">", 2, True),
        ("=IFERROR(LN(A1),0)", [-1, 2, 3], "IFERROR", 2, True),
    ],
)
def test_kinks_inside_the_ranges(of, formula, x, function, ways, jumps):
    result = of(formula, {"x": np.array(x, float)})
    (kink,) = result.kinks
    assert (str(kink.cell), kink.function, kink.branches, kink.jumps) == ("S!Z1", function, ways, jumps)
    assert kink.share == pytest.approx(1 - (2 if ways == 2 else 1) / 3)
    assert not of(formula, {"x": np.full(3, 2.3)}).kinks


@pytest.mark.parametrize(
    ("formula", "f", "x"),
    [
        ("=NORM.DIST(A1,0.5,2,TRUE)", lambda x: mpmath.ncdf((x - 0.5) / 2), (-3, 3)),
        ("=GAMMALN(A1)", mpmath.loggamma, (0.5, 9)),
        ("=ERF(A1)", mpmath.erf, (-2, 2)),
        ("=PMT(A1/100,10,-1000)", lambda r: 1000 * (r / 100) / (1 - (1 + r / 100) ** -10), (1, 9)),
        ("=NPV(A1/100,C1:C3)", lambda r: sum((3 * r) / (1 + r / 100) ** i for i in (1, 2, 3)), (1, 9)),
        ("=GEOMEAN(C1:C3,5)", lambda x: ((3 * x) ** 3 * 5) ** mpmath.mpf("0.25"), (1, 9)),
    ],
)
@settings(max_examples=30)
@given(data=st.data())
def test_differences_are_as_near_as_they_say(of, formula, f, x, data):
    """The error estimated covers the true one, and is itself small: 1e-7 of the derivative, 1e-4 of the second."""
    points = data.draw(st.lists(st.floats(*x), min_size=2, max_size=2))
    results = of(formula, {"x": points}, order=2, C1="=3*A1", C2="=3*A1", C3="=A1*3")
    assert len(results.numerical) == 1
    result = results.forecasts["f"]
    with mpmath.workdps(50):
        first = np.array([mpmath.diff(f, point) for point in points], float)
        second = np.array([mpmath.diff(f, point, 2) for point in points], float)
    size = np.abs(result.value)
    assert (np.abs(result.gradient[:, 0] - first) <= 10 * result.gradient_error[:, 0] + 1e-13 * size).all()
    assert (result.gradient_error[:, 0] <= 1e-7 * np.maximum(np.abs(first), size)).all()
    curve, error = result.hessian[:, 0, 0], result.hessian_error[:, 0, 0]
    known = ~np.isnan(curve)
    assert (np.abs(curve - second)[known] <= 10 * error[known] + 1e-11 * size[known]).all()


def test_differences_of_two_arguments_mix(of):
    points = {"x": [0.7, 1.9], "y": [1.1, 0.4]}
    result = of("=NORM.DIST(A1,B1,2,TRUE)*A1", points, order=2).forecasts["f"]
    with mpmath.workdps(50):
        for i, point in enumerate(zip(*points.values(), strict=True)):
            exact = mpmath.diff(lambda x, y: x * mpmath.ncdf((x - y) / 2), point, (1, 1))
            assert result.hessian[i, 0, 1] == pytest.approx(float(exact), rel=1e-8)
            assert abs(result.hessian[i, 0, 1] - float(exact)) <= 10 * result.hessian_error[i, 0, 1]


@pytest.mark.parametrize("formula", ["=COUNT(A1:B1)*A1", "=NPV(0.1,A1,B1)", "=FORECAST(3,A1:B1,{2,5})"])
def test_what_does_not_bend_mixes_to_0(of, formula):
    """The mixed derivative is 0, and no more than rounding is known of it: that is not none."""
    result = of(formula, {"x": [0.7, -1.9], "y": [1.1, 0.4]}, order=2).forecasts["f"]
    assert (np.abs(result.hessian) <= 10 * result.hessian_error + 1e-11).all()


def test_a_jump_has_no_difference(of):
    """MOD has a rule; WEEKNUM jumps between its days, and stands still within them."""
    result = of("=WEEKDAY(A1)", {"x": [44000.5, 44001.0]})
    assert result.forecasts["f"].gradient[0, 0] == 0.0
    assert np.isnan(result.forecasts["f"].gradient[1, 0])


def test_arrays_whose_size_varies(of):
    """Two of the cells are above x in one trial, three in the other."""
    dynamic = CellContent(None, Formula("SUM(FILTER(C1:C3,C1:C3>A1))", 1, 26, dynamic=True))
    result = of(dynamic, {"x": [1.5, 0.5]}, order=2, C1=1.0, C2="=A1^2", C3="=A1*3").forecasts["f"]
    assert result.value.tolist() == [6.75, 2.5]
    assert result.gradient[:, 0].tolist() == [6.0, 3.0]
    assert result.hessian[:, 0, 0].tolist() == [2.0, 0.0]


def test_portions_change_nothing(of, monkeypatch):
    x, y = np.linspace(0.1, 3, 23), np.linspace(2, -1, 23)
    whole = of("=IF(A1>B1,SIN(A1*B1),MAX(A1,B1)^2)", {"x": x, "y": y}, order=2)
    monkeypatch.setattr(of_model, "_PORTION", 20)
    parts = of("=IF(A1>B1,SIN(A1*B1),MAX(A1,B1)^2)", {"x": x, "y": y}, order=2)
    assert np.array_equal(whole.forecasts["f"].gradient, parts.forecasts["f"].gradient)
    assert np.array_equal(whole.forecasts["f"].hessian, parts.forecasts["f"].hessian)
    assert whole.kinks == parts.kinks


def test_what_cannot_be_asked(book):
    model = book(BASE | {"Z1": "=A1+B1", "Y1": "=A1"}, XY, {"f": "Z1"})
    with pytest.raises(SimulationError, match="order 3"):
        derivatives(model, {"x": 1.0, "y": 1.0}, order=3)
    with pytest.raises(SimulationError, match="No values for the assumption 'y'"):
        derivatives(model, {"x": 1.0})
    with pytest.raises(SimulationError, match="No forecast or filter needs S!Y1"):
        derivatives(model, {"x": 1.0, "y": 1.0}, cells=[Cell("S", 1, 25)])


def test_a_forecast_that_nothing_changes(of):
    result = of("=3+4", {"x": [1.0, 2.0]}, order=2).forecasts["f"]
    assert result.value.tolist() == [7.0, 7.0]
    assert not result.gradient.any()
    assert not result.hessian.any()
