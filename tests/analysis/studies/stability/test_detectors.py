"""One small book a detector: what it says, and that it is silent where there is nothing to say."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies.derivatives import Movements, derivatives
from xlmc.analysis.studies.stability import Level, stability
from xlmc.errors import FormulaError
from xlmc.excel.workbook.workbook import CellContent, Formula

UNIFORM = {"x": {"cell": "A1", "low": 1, "high": 2}, "y": {"cell": "A2", "low": 1, "high": 2}}
BASE = {"A1": 1.5, "A2": 1.5}


@pytest.fixture(scope="session")
def look(book):
    """`look({"B1": "=…"}, x=(low, high))`: the findings of a book whose forecast is B1, by kind."""

    def make(cells, filters=None, trials=20_000, **ranges):
        given = {
            name: {**one, **dict(zip(("low", "high"), ranges.get(name, (1, 2)), strict=True))}
            for name, one in UNIFORM.items()
        }
        base = {one["cell"]: sum(ranges.get(name, (1, 2))) / 2 for name, one in UNIFORM.items()}
        model = book(base | cells, given, {"f": "B1", "y": "A2"}, filters or {})
        return stability(model, trials=trials, seed=5)

    return make


def kinds(result):
    return [one.kind for one in result.findings]


def only(result, kind):
    (one,) = [finding for finding in result.findings if finding.kind == kind]
    return one


def test_a_sound_book_has_no_finding(look):
    assert look({"B1": "=SQRT(A1^2+A2^2)*EXP(-A1)"}).findings == ()


def test_a_difference_of_near_equals(look):
    one = only(look({"C1": "=A1+1000000000", "B1": "=(C1-1000000000)*A2"}), "cancellation")
    assert (str(one.cell), one.level) == ("S!B1", Level.DOUBTFUL)
    assert "C1-1000000000 is a difference of nearly equal numbers" in one.what


def test_digits_that_are_not_there(look):
    result = look({"C1": "=A1+1E16", "B1": "=(C1-1E16)*A2"})
    assert only(result, "cancellation").level is Level.WRONG
    assert result.wrong
    assert any("the digits of 'f' cannot be trusted" in warning for warning in result.run.warnings)


def test_angles_subtracted_in_radians(look):
    one = only(look({"B1": "=SIN(RADIANS(A1)-RADIANS(A2))"}, x=(271.0, 272.0), y=(270.9, 271.1)), "angles")
    assert one.instead == "=SIN(RADIANS(A1-A2))"
    assert "angles" not in kinds(look({"B1": "=SIN(RADIANS(A1)-RADIANS(A2))"}, x=(271.0, 272.0), y=(90.9, 91.1)))


def test_a_quadrant_lost_in_some_trials(look):
    one = only(look({"B1": "=ATAN(A2/A1)"}, x=(-1, 3)), "quadrant")
    assert "in 2" in one.effect  # some quarter of the trials
    assert one.where[0].name == "x"
    assert one.where[0].high < 0
    assert one.instead == "=ATAN2(A1,A2)"
    assert one.level is Level.WRONG


def test_what_is_the_same_a_whole_turn_on_is_not_lost_though_rounding_moves_it(look):
    """Near 0, what rounding leaves of a whole turn is a large share of the sine."""
    assert "quadrant" not in kinds(look({"B1": "=SIN(2*ATAN(A2/A1))"}, trials=2000, x=(-1, 1), y=(-1, 1)))


@pytest.mark.parametrize("formula", ["=ATAN(A2/A1)", "=ATAN2(A1,A2)"])
def test_no_quadrant_is_lost(look, formula):
    assert "quadrant" not in kinds(look({"B1": formula}))


@pytest.mark.parametrize(
    "cells",
    [
        {"B1": "=IF(A1<0,PI(),0)+ATAN(A2/A1)"},
        {"B1": "=IF(A1<0,ATAN(A2/A1)+PI(),ATAN(A2/A1))"},
        {"B1": "=IF(A1>0,ATAN(A2/A1),IF(A1<0,ATAN(A2/A1)+PI()*SIGN(A2),PI()/2))"},
        {"B1": "=MOD(DEGREES(ATAN(A2/A1))-30+180*(A1<0),360)"},
        {"B1": "=DEGREES(ATAN(A2/A1))+90*(1-SIGN(A1))"},
        {"B1": "=SIN(ATAN(A2/A1))*SIGN(A1)"},
        {"B1": "=IF(C1=1,C2,C2+180)", "C1": "=IF(A1>0,1,2)", "C2": "=DEGREES(ATAN(C3))", "C3": "=A2/A1"},
        {"B1": "=IF(A1+5<5,180,0)+DEGREES(ATAN(A2/A1))"},
        {"B1": "=IF(A1>0,ATAN(A2/A1),0)"},
        {"B1": "=TAN(ATAN(A2/A1))*A1"},
    ],
)
def test_a_formula_that_minds_the_quadrant_itself(look, cells):
    result = look({"D1": "=IF(A1<0,1,2)", **cells}, filters={"some": {"cell": "D1", "at_least": 0}}, x=(-1, 3))
    assert "quadrant" not in kinds(result)


def test_the_choice_that_mends_a_quadrant_is_no_jump(look):
    assert "jump" not in kinds(look({"B1": "=IF(A1<0,ATAN(A2/A1)+PI(),ATAN(A2/A1))"}, x=(-1, 3)))
    assert "jump" not in kinds(look({"B1": "=IF(A1<0,180,0)+DEGREES(ATAN(A2/A1))"}, x=(-1, 3)))


def test_only_assumptions_that_a_cell_depends_on_are_named(look):
    """Some fifteen trials of 3,000: of y, which has no part in it, they may well take up half."""
    result = look({"B1": "=LN(A1-1.005)", "C1": "=A2*2"}, filters={"y": {"cell": "C1", "at_least": 0}})
    assert [one.name for one in only(result, "edge").where] == ["x"]


@pytest.mark.parametrize(
    ("cells", "filters"),
    [
        ({"B1": "=ATAN(A2/A1)*IF(A1<0,1,2)"}, {}),
        ({"B1": "=ATAN(A2/A1)+IF(A1<0,1,2)"}, {}),
        ({"B1": "=ATAN(A2/A1)", "C1": "=A1+0"}, {"near": {"cell": "C1", "at_least": -0.5}}),
        ({"B1": "=ATAN(A2/A1)"}, {"some": {"cell": "A1", "at_least": -0.5}}),
        ({"B1": "=ATAN(C1)+IF(A1<0,1,2)", "C1": "=A2/A1"}, {}),
        ({"B1": "=C1+IF(C1>9,1,2)", "C1": "=ATAN(A2/A1)"}, {"guarded": {"cell": "C2", "below": 9}}),
    ],
)
def test_a_comparison_that_does_not_guard_the_arctangent_changes_nothing(look, cells, filters):
    result = look({"C2": "=IF(A1<0,PI(),0)+ATAN(A2/A1)", **cells}, filters=filters, x=(-1, 3))
    assert only(result, "quadrant").level is Level.WRONG


@pytest.mark.parametrize(
    ("formula", "what"),
    [
        ("=SQRT(A1-A2+0.9)", "SQRT takes 0 or more"),
        ("=LN(A1-A2+0.9)", "LN takes above 0"),
        ("=ASIN(A1-A2+0.1)", "ASIN takes -1 to 1"),
    ],
)
def test_arguments_beyond_their_domain(look, formula, what):
    one = only(look({"B1": formula}), "edge")
    assert what in one.what
    assert one.level is Level.DOUBTFUL
    assert "the cell is an error in" in one.effect


SMALL = {"x": (1e-9, 2e-9)}


@pytest.mark.parametrize(
    ("cells", "where", "message", "instead"),
    [
        ({"B1": "=(1-COS(A1))/A1^2"}, "S!B1", "'f' shows 0 in a trial in which it is 0.5", "=2*SIN(A1/2)^2/A1^2"),
        ({"C1": "=1-COS(A1)", "B1": "=C1/A1^2"}, "S!C1", "'f' shows 0 in a trial in which it is 0.5", "=2*SIN(A1/2)^2"),
        ({"B1": "=(1-COS(A1))/A1^2+A2*0"}, "S!B1", "is 0.5", None),
        ({"B1": "=LN(1+A1*1E-9)/A1*1E9"}, "S!B1", "in which it is 1", None),
        ({"B1": "=(SQRT(1+A1*1E-9)-1)/A1*1E9"}, "S!B1", "in which it is 0.5", None),
    ],
    ids=str,
)
def test_what_is_absorbed_whole_goes_to_50_digits(look, cells, where, message, instead):
    result = look(cells, trials=2000, **SMALL)
    (one,) = [each for each in result.findings if each.level is Level.WRONG]
    assert (str(one.cell), message in one.effect) == (where, True), one.effect
    assert instead is None or one.instead == instead


@pytest.mark.parametrize("formula", ["=5+(1-COS(A1))", "=MAX(A1,5)", "=IF(A1>5,1,0)", "=ROUND(A1,3)", "=A1-A1"])
def test_what_never_varies_for_a_reason_is_sound(look, formula):
    assert not look({"B1": formula}, trials=2000, **SMALL).findings


@pytest.mark.parametrize(
    ("cells", "better"),
    [
        ({"B1": "=AVERAGE(MOD(A1,360),MOD(A2,360))"}, "=MOD(DEGREES(ATAN2(COS(RADIANS(MOD(A1,360)))+"),
        ({"B1": "=(MOD(A1,360)+MOD(A2,360))/2"}, "=MOD(DEGREES(ATAN2("),
        ({"B1": "=0.5*SUM(MOD(A1,360),MOD(A2,360))"}, "=MOD(DEGREES(ATAN2("),
        ({"C1": "=MOD(A1,360)", "C2": "=MOD(A2,360)", "B1": "=AVERAGE(C1:C2)"}, "=MOD(DEGREES(ATAN2(SUMPRODUCT(COS("),
        ({"B1": "=MEDIAN(MOD(A1,2*PI()),MOD(A2,2*PI()))"}, "=MOD(ATAN2(COS(MOD(A1,2*PI()))+"),
        ({"B1": "=AVERAGE(DEGREES(ATAN2(-10,A1)),DEGREES(ATAN2(-10,A2)))"}, "=MOD(DEGREES(ATAN2("),
    ],
    ids=str,
)
def test_directions_are_not_averaged_as_numbers(look, cells, better):
    result = look(cells, trials=2000, x=(-2, 2), y=(-2, 2))
    one = only(result, "direction")
    assert one.level is Level.WRONG
    assert one.instead.startswith(better)
    assert "of the accepted trials they lie on both sides of the jump" in one.effect
    mended = look(cells | {"B1": one.instead}, trials=2000, x=(-2, 2), y=(-2, 2))
    assert "direction" not in kinds(mended)
    values = mended.run["f"].values
    turn = 360.0 if "360" in str(cells) or "DEGREES" in str(cells) else 6.283185307179586
    middle = turn / 2 if "ATAN2" in str(cells) else 0.0
    off = (values - middle + turn / 2) % turn - turn / 2
    assert abs(off).max() < 15.0


@pytest.mark.parametrize(
    "formula",
    [
        "=AVERAGE(MOD(A1,360),MOD(A2,360))",
        "=AVERAGE(A1,MOD(A2,360))",
        "=(MOD(A1,360)+MOD(A2,360))/3",
        "=AVERAGE(A1,A2)",
    ],
)
def test_directions_on_one_side_of_the_jump_may_be_averaged(look, formula):
    assert "direction" not in kinds(look({"B1": formula}, trials=2000, x=(170, 190), y=(175, 185)))


@pytest.mark.parametrize(
    ("formula", "what", "ranges"),
    [
        ("=POWER(A1,0.5)", "POWER with a broken exponent takes 0 or more, and A1 goes to -", {"x": (-1, 2)}),
        ("=A1^A2", "a power with a broken exponent takes 0 or more, and A1 goes to -", {"x": (-1, 2)}),
        ("=(A1-1)^1.5", "and A1-1 goes to -", {"x": (0, 2)}),
        ("=EXP(A1)", "EXP takes 709.8 or less, and A1 goes to 7", {"x": (700, 720)}),
        ("=LN(COSH(A1))", "COSH takes -710.5 to 710.5, and A1 goes to 7", {"x": (700, 720)}),
    ],
)
def test_powers_and_overflows_have_edges(look, formula, what, ranges):
    result = look({"B1": formula}, trials=2000, **ranges).findings
    assert [one.level for one in result if one.kind == "edge" and what in one.what] == [Level.DOUBTFUL]


@pytest.mark.parametrize("formula", ["=A1^2", "=A1^-1", "=POWER(A1,3)", "=(A1^2)^0.5", "=EXP(A1)", "=ABS(A1)^0.5"])
def test_powers_and_overflows_without_edges(look, formula):
    result = look({"B1": formula}, trials=2000, x=(-2, 2)).findings
    assert not [one for one in result if one.kind == "edge" and one.level is Level.DOUBTFUL]


@pytest.mark.parametrize("ends", [(0.1, 0.9), (1, 2), (1100, 2000), (1.1e6, 2e6), (2e8, 2.5e8), (0.99, 1.01)])
@pytest.mark.parametrize("formula", ["=VAR.P(A1,A1+1,A1+2)", "=STDEV.P(A1,A1+1,A1+2)", "=VAR.S(A1,A1+1,A1+2)*A2"])
def test_a_variance_that_is_right_to_its_last_digits_is_not_doubted(look, formula, ends):
    assert look({"B1": formula}, trials=2000, x=ends).findings == ()


def test_an_unstable_recurrence_is_one_finding(look):
    steps = {f"C{n}": f"=1-{n - 1}*C{n - 1}" for n in range(2, 21)}
    result = look({"C1": "=1-EXP(-1)+A1*1E-3", **steps, "B1": "=C20"}, trials=2000, x=(0, 1e-25))
    one = only(result, "cancellation")
    assert one.level is Level.WRONG
    assert "cells repeat this step, from S!C" in one.what
    assert " to S!C" in one.what


def test_an_argument_close_to_the_edge_of_its_domain(look):
    one = only(look({"B1": "=SQRT(A1-1)"}), "edge")
    assert one.level is Level.NOTE
    assert one.where[0].name == "x"
    assert one.where[0].low == 1


def test_a_jump_and_a_bend(look):
    one = only(look({"B1": "=IF(A1>1.5,A1+1,A1)"}), "jump")
    assert "A1>1.5 changes within the ranges" in one.what
    assert one.where[0].low < 1.5 < one.where[0].high
    assert "jump" not in kinds(look({"B1": "=IF(A1>1.5,2*A1-1.5,A1)"}))
    assert "jump" not in kinds(look({"B1": "=IF(A1>2.5,A1+1,A1)"}))


def test_a_lookup_with_steps(look):
    assert "a lookup finds 3 different cells" in only(look({"B1": "=VLOOKUP(A1,{0,1;1.3,4;1.6,9},2)"}), "jump").what


def test_a_forecast_without_a_mean(look):
    one = only(look({"B1": "=1/(A1-A2)"}), "tail")
    assert one.level is Level.DOUBTFUL
    assert "converge" in one.effect


def test_a_quotient_in_a_filter_is_harmless_and_has_another_form(look):
    result = look({"B1": "=A1*A2", "C1": "=A2/(A1-1.5)"}, filters={"e": {"cell": "C1", "at_least": 0, "below": 5}})
    one = only(result, "tail")
    assert one.level is Level.NOTE
    assert one.instead == "=AND(A1-1.5<>0,A2*SIGN(A1-1.5)>=0,A2*SIGN(A1-1.5)<5*ABS(A1-1.5))"


def test_filters_that_accept_almost_nothing(look):
    result = look({"B1": "=A1*A2"}, filters={"big": {"cell": "B1", "above": 3.92}})
    one = only(result, "filter")
    assert one.level is Level.DOUBTFUL
    assert "'big' rejects most" in one.what
    none = look({"B1": "=A1*A2"}, filters={"big": {"cell": "B1", "above": 5}})
    assert only(none, "filter").level is Level.WRONG
    assert "there is no answer" in only(none, "filter").effect


def test_an_answer_that_amplifies(look):
    result = look({"B1": "=(A1-0.99*A1)/(A1-A2)"}, x=(1.0, 1.0001), y=(1.0002, 1.0003))
    one = only(result, "amplification")
    assert "when its assumptions change by 1 %" in one.what


def test_functions_that_are_not_recomputed_are_named(look):
    result = look({"B1": "=NORM.DIST(A1,A2,1,TRUE)+1E8*A1-1E8*A1"})
    assert [(str(cell), functions) for cell, functions in result.unchecked] == [("S!B1", ("NORM.DIST",))]


def test_arrays_whose_size_varies(look, monkeypatch):
    """Such trials are worked out one by one: a few are enough here."""
    monkeypatch.setattr("xlmc.analysis.studies.stability.extent._PRIOR", 32)
    monkeypatch.setattr("xlmc.analysis.studies.stability.extent._ACCEPTED", 16)
    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.BLOCK", 512)
    dynamic = CellContent(None, Formula("SUM(FILTER(C1:C3,C1:C3>A1))+1E16-1E16", 1, 2, dynamic=True))
    result = look({"B1": dynamic, "C1": 1.25, "C2": "=A1*1.1", "C3": "=A1/3+A2"}, trials=200)
    assert only(result, "cancellation").level is Level.WRONG
    assert result.run.warnings
    assert result.unchecked


def test_sums_of_large_arrays_of_constants_count_as_typed_and_are_named(look, monkeypatch):
    monkeypatch.setattr("xlmc.analysis.studies.stability.extent._MOST_OPENED", 1_000)
    cells = {f"C{k}": k / 7 for k in range(1, 1001)}
    result = look(cells | {"D1": "=SUMPRODUCT(C1:C1000*C1:C1000)*2", "B1": "=(A1+D1+1E16)-1E16"})
    assert only(result, "cancellation").level is Level.WRONG
    assert [(str(cell), functions) for cell, functions in result.unchecked] == [("S!D1", ("SUMPRODUCT",))]


def test_a_book_whose_arrays_do_not_fit_into_memory_is_refused_before_the_run(look, monkeypatch):
    monkeypatch.setattr("xlmc.analysis.studies.stability.extent._MOST_BYTES", 10**6)
    monkeypatch.setattr("xlmc.analysis.studies.stability.find.simulate", None)
    cells = {f"C{k}": k / 7 for k in range(1, 401)}
    with pytest.raises(FormulaError, match=r"S!B1: Stability keeps .* takes 0.0 GB: xlmc takes up to 0.0 GB") as error:
        look(cells | {"B1": "=SUMPRODUCT(SQRT(C1:C400*A1))"})
    assert "this one first" in str(error.value)


def test_cells_move_with_assumptions_as_their_derivatives_say(book):
    cells = {"A1": 1.5, "A2": 1.5, "C1": "=A1^2", "B1": '=IF(A2>1.9,"text",C1*A2)'}
    model = book(cells, UNIFORM, {"f": "B1"})
    rng = np.random.default_rng(1)
    draws = {"x": rng.uniform(1, 2, 500), "y": rng.uniform(1, 2, 500)}
    needed = [cell for cell in model.lowering.graph.formulas if cell not in model.lowering.inputs]
    movements = Movements({cell: model.lowering.cell(cell) for cell in needed})
    derivatives(model, draws, movements=movements)
    result = derivatives(model, draws, cells=needed)
    for cell in needed:
        moved = np.abs(result.cells[cell].gradient * result.points)
        node = movements.nodes[cell]
        assert movements.of_trials[node].tobytes() == np.nansum(moved, axis=1).tobytes()
        assert movements.of_assumptions[node] == pytest.approx(np.nansum(moved, axis=0), rel=1e-13)


def test_a_book_without_assumptions(book):
    result = stability(book({"A1": 2.0, "B1": "=A1^2"}, {}, {"f": "B1"}), trials=100)
    assert result.findings == ()


def test_trials_apart_from_the_rest_are_no_heavy_tail(look):
    """A jump of half a turn in a few trials: the direction is bounded, and its SD converges."""
    assert "tail" not in kinds(look({"B1": "=IF(A1>1.99,180,0)+A2/100"}))


def test_the_root_of_a_sum_of_squares_has_no_edge(look):
    assert "edge" not in kinds(look({"B1": "=SQRT((A1-1.5)^2+(A2-1.5)^2)"}))


def test_a_quadrant_lost_in_trials_that_no_filter_keeps(look):
    result = look({"B1": "=ATAN(A2/A1)", "C1": "=A1*1"}, filters={"ahead": {"cell": "C1", "above": 0}}, x=(-1, 3))
    assert only(result, "quadrant").level is Level.DOUBTFUL


def test_a_divisor_that_no_assumption_changes(look):
    """270° typed into a cell: its cosine is folded to -1.8e-16 before any trial, and yet 0."""
    result = look({"A3": 270.0, "B1": "=(A1*COS(RADIANS(A3))+A2*SIN(RADIANS(2*A3)))/COS(RADIANS(A3))"})
    one = only(result, "division")
    assert one.level is Level.WRONG
    assert "no error where the formula, computed exactly, has no value" in one.effect
    assert "it divides by COS(RADIANS(A3))" in one.what
    assert any("the digits of 'f' cannot be trusted" in warning for warning in result.run.warnings)


def test_the_range_that_provokes_a_loss_is_told(look):
    """x² is below 1e-6 throughout; what provokes the loss are the small x, not all of them."""
    one = only(look({"B1": "=(1-COS(A1))/A1^2"}, x=(1e-7, 1e-3)), "cancellation")
    assert one.where[0].high < 0.5e-3


@pytest.mark.filterwarnings("error")
def test_a_forecast_that_is_an_error_everywhere(look):
    result = look({"B1": "=SQRT(-A1)"})
    assert any("lost to errors" in warning for warning in result.run.warnings)


@pytest.mark.filterwarnings("error")
def test_a_forecast_of_texts(look):
    result = look({"B1": '=IF(A1>1.5,"fast","slow")'})
    assert (result.findings, result.run.warnings) == ((), [])


def test_the_last_digits_of_zero_are_no_loss(look):
    """0.3 - 0.1 - 0.2 is -2.8e-17 in doubles, and 0 exactly."""
    result = look({"C1": "=0.3*A1-0.1*A1-0.2*A1", "B1": "=C1*3"})
    assert result.findings == ()
    assert [(one.rounding, one.excess) for one in result.cells if str(one.cell) == "S!B1"] == [(0.0, 0.0)]
