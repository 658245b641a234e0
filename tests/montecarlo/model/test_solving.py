"""Cells that are solved for in every trial, against books that hold the closed form."""

from __future__ import annotations

import numpy as np
import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.errors import DefinitionError, DefinitionsError, FormulaError
from xlmc.montecarlo.model.loading import load

HEADS = ["Name", "Cell", "To", "By", "Low", "High", "Root"]
ROW = ["x", "=Model!B2", "=Inputs!B3", "=Inputs!B6", 0, 100, None]


@pytest.fixture
def book(tmp_path):
    """a x² + x = c, with a and c uniform, solved for x in Inputs!B6; `twice` is computed from it."""

    def make(*rows, formula="=Inputs!B2*Inputs!B6^2+Inputs!B6", inputs=(), forecasts=(), more=()):
        rows = rows or (ROW,)
        sheets = {
            "Inputs": [
                ["Name", "Value", "Low", "High"],
                ["a", 2, 1, 3],
                ["c", 50, 10, 100],
                [],
                ["A cell", "Value"],
                ["x", 1],
                *inputs,
            ],
            "Model": [
                ["Name", "Value"],
                ["y", formula],
                ["x", "=Inputs!B6"],
                ["twice", "=2*Inputs!B6"],
                *forecasts,
                [],
                *more,
            ],
            "Solve": [HEADS, *rows],
        }
        tables = {
            "xlmc_assumptions": "Inputs!A1:D3",
            "xlmc_forecasts": f"Model!A1:B{4 + len(forecasts)}",
            "xlmc_solve": f"Solve!A1:G{1 + len(rows)}",
        }
        path = tmp_path / "book.xlsx"
        workbook_of(sheets, tables).save(path)
        return path

    return make


def closed_form(run):
    a, c = run.inputs["a"], run.inputs["c"]
    return (-1 + np.sqrt(1 + 4 * a * c)) / (2 * a)


@pytest.mark.parametrize("engine", ["numpy", "jit"])
@pytest.mark.parametrize("options", [{}, {"jobs": 2}, {"jobs": 2, "scheduler": "processes"}])
def test_solutions_are_those_of_the_closed_form(book, engine, options):
    run = xlmc.load(book()).simulate(70_000, engine=engine, keep_inputs=None, **options)
    exact = closed_form(run)
    assert np.max(np.abs(run.forecasts["x"] / exact - 1)) < 1e-13
    assert np.max(np.abs(run.forecasts["twice"] / (2 * exact) - 1)) < 1e-13
    assert np.max(np.abs(run.forecasts["y"] / run.inputs["c"] - 1)) < 1e-13
    assert run.error_trials == 0


def test_engines_and_blocks_give_the_same_bits(book):
    model = xlmc.load(book())
    first = model.simulate(50_000, seed=4)
    for options in ({"engine": "jit"}, {"jobs": 2}):
        assert np.array_equal(model.simulate(50_000, seed=4, **options).forecasts["x"], first.forecasts["x"])
    assert np.array_equal(model.simulate(1_000, seed=4).forecasts["x"], first.forecasts["x"][:1_000])


@pytest.mark.parametrize(
    ("formula", "low", "high", "to", "by_loop"),
    [
        ("=Inputs!B2*Inputs!B6^2+Inputs!B6", 0, 100, "=Inputs!B3", 1.0),
        ("=Inputs!B2*Inputs!B6-1", 0, 100, "=Inputs!B3", 1.0),
        ("=Inputs!B6/Inputs!B2", 0, 100, "=Inputs!B3", 0.45),  # not all trials have a solution
        ("=Inputs!B6^2-2*Inputs!B6*Inputs!B2+Inputs!B2^2", -10, 10, 2, 0.0),  # all have two
        ("=Inputs!B6^2-2*Inputs!B6*Inputs!B2+Inputs!B2^2", "=Inputs!B2", 50, 4, 0.9),
        ("=IF(Inputs!B6<Inputs!B2,Inputs!B6-Inputs!B2,3*(Inputs!B6-Inputs!B2))", 0, 50, 0.5, 1.0),
        ("=IF(Inputs!B6<20,Inputs!B6-20.3,Inputs!B6)", 0, 50, "=Inputs!B2-2", 0.25),  # some jump past it
        ("=SQRT(Inputs!B6-Inputs!B2)", 0, 50, 5, 0.0),  # an error at the low end
        ("=Inputs!B6*SQRT(Inputs!B2-1.9)", 0, 100, 10, 0.0),  # errors in half of the trials
        ("=MAX(Inputs!B6-10,Inputs!B6*Inputs!B2)-MIN(Inputs!B3,50)", -100, 100, 0, 0.9),
        ("=SUM(Inputs!B2:B3,Inputs!B6)%", -100, 100, 1, 0.9),
        ("=(Inputs!B6-Inputs!B2)*ABS(Inputs!B6-Inputs!B2)", 0, 10, 0, 0.0),  # flat at its root
    ],
)
def test_native_code_finds_the_same_bits(book, monkeypatch, formula, low, high, to, by_loop):
    """And leaves to NumPy what it cannot tell; `by_loop` is the least share of trials that it solves."""
    from xlmc.engine.llvm.root_loop import RootLoop

    solved, call = [], RootLoop.__call__
    monkeypatch.setattr(RootLoop, "__call__", lambda *given: solved.append(call(*given)) or solved[-1])
    model = xlmc.load(book(["x", "=Model!B2", to, "=Inputs!B6", low, high, None], formula=formula))
    numpy, native = (model.simulate(20_000, seed=2, engine=engine) for engine in ("numpy", "jit"))
    assert np.array_equal(numpy.forecasts["x"], native.forecasts["x"], equal_nan=True)
    assert numpy.faults == native.faults
    assert np.mean(np.concatenate([result for _, result in solved or [(None, [False])]])) >= by_loop


@pytest.mark.parametrize(
    ("row", "code", "words"),
    [
        ([*ROW[:4], 0, 4, None], "#N/A", "no value from 0 to 4 makes Model!B2 equal to Solve!C2"),
        ([*ROW[:4], -100, 100, "only"], "#NUM!", "several values from -100 to 100 make Model!B2 equal to Solve!C2"),
    ],
)
def test_trials_without_a_solution_are_errors_with_words(book, row, code, words):
    from xlmc.analysis.results.record.errors_met import lost_sentences

    run = xlmc.load(book(row)).simulate(20_000, keep_inputs=None)
    exact = closed_form(run)
    assert run.faults["x"] == {code: 20_000 if code == "#NUM!" else np.count_nonzero(exact > 4)}
    sentences = " ".join(lost_sentences(run._run))
    assert f"from Inputs!B6 {code}: {words}" in sentences
    solved = run.forecasts["x"][~np.isnan(run.forecasts["x"])]
    assert np.allclose(solved, exact[exact <= 4] if code == "#N/A" else [])


@pytest.mark.parametrize(("root", "sign"), [("first", -1), ("Last", 1)])
def test_a_row_says_which_of_several_is_taken(book, root, sign):
    run = xlmc.load(book([*ROW[:4], -100, 100, root])).simulate(5_000, keep_inputs=None)
    a, c = run.inputs["a"], run.inputs["c"]
    assert np.allclose(run.forecasts["x"], (-1 + sign * np.sqrt(1 + 4 * a * c)) / (2 * a), rtol=1e-13)


def test_ranges_and_targets_may_be_formulas(book):
    """Of a x² + x = 2c between -c and 0 there is the lower root alone."""
    path = book(["x", "=Model!B2", "=2*Inputs!B3", "=Inputs!B6", "=-Inputs!B3", 0, None])
    run = xlmc.load(path).simulate(5_000, keep_inputs=None)
    a, c = run.inputs["a"], run.inputs["c"]
    exact = (-1 - np.sqrt(1 + 8 * a * c)) / (2 * a)
    inside = exact >= -c
    assert inside.any()
    assert np.array_equal(~np.isnan(run.forecasts["x"]), inside)
    assert np.allclose(run.forecasts["x"][inside], exact[inside], rtol=1e-13)


def test_one_solution_may_need_another_in_any_order(book):
    """x from the first equation, then z with z³ = x; the row of z stands first."""
    first = ["z", "=Model!B7", "=Inputs!B6", "=Inputs!B7", 0, 10, None]
    path = book(first, ROW, inputs=[["z", 1]], forecasts=[["z", "=Inputs!B7"]], more=[["cube", "=Inputs!B7^3"]])
    run = xlmc.load(path).simulate(2_000, keep_inputs=None)
    assert np.allclose(run.forecasts["z"], np.cbrt(closed_form(run)), rtol=1e-13)


def test_solutions_that_need_each_other_are_refused(book):
    other = ["z", "=Model!B7", "=Inputs!B6", "=Inputs!B7", 0, 10, None]
    path = book(
        ROW,
        other,
        formula="=Inputs!B2*Inputs!B6^2+Inputs!B7",
        inputs=[["z", 1]],
        forecasts=[["z", "=Inputs!B7"]],
        more=[["cube", "=Inputs!B7^3"]],
    )
    with pytest.raises(DefinitionError, match="'x' and 'z' need each other's solutions"):
        load(path)


@pytest.mark.parametrize(
    ("row", "message", "where"),
    [
        ([*ROW[:3], "=Model!B3", 0, 1, None], "Model!B3 holds a formula", "Solve!D2"),
        ([*ROW[:3], "=Inputs!B2", 0, 1, None], "Inputs!B2 is the cell of an assumption", "Solve!A2"),
        ([*ROW[:3], "Inputs!B9", 0, 1, None], "Model!B2 does not depend on Inputs!B9", "Solve!A2"),
        ([*ROW[:4], 5, 5, None], r"Low \(5\) is not below High \(5\)", "Solve!F2"),
        ([*ROW[:4], None, 5, None], "Low is blank", "Solve!E2"),
        ([*ROW[:2], None, *ROW[3:]], "To is blank", "Solve!C2"),
        ([*ROW[:4], "=Inputs!B6-1", 5, None], "The range of Inputs!B6 depends on Inputs!B6", "Solve!A2"),
        ([*ROW[:6], "middle"], "Root 'middle' is unknown", "Solve!G2"),
        (["x", None, *ROW[2:]], "Cell is blank", "Solve!B2"),
    ],
)
def test_mistakes_are_named_with_their_cell(book, row, message, where):
    with pytest.raises((DefinitionError, DefinitionsError), match=message) as caught:
        load(book(row))
    assert where in str(caught.value)


@pytest.mark.parametrize(
    ("formula", "high", "message"),
    [
        (
            "=50+(Inputs!B6-70)*(Inputs!B6-71)*(Inputs!B6-72)",
            100,
            "at 3 values of .*, and a run would find 1",
        ),
        ("=50+(Inputs!B6-71)*(Inputs!B6-72)", 100, "at 2 values of Inputs!B6 .*, and a run would find 0"),
        ("=ROUND(Inputs!B6,-1)", 100, "at .* values of Inputs!B6 .*, and a run would find 1"),
        ("=50+(Inputs!B6-70)*(Inputs!B6-71)*(Inputs!B6-72)", 70.5, None),
    ],
)
def test_a_range_that_the_scan_is_too_coarse_for_is_refused(book, formula, high, message):
    """Values within one sixteenth of the range; and a whole range of values."""
    path = book([*ROW[:2], 50, ROW[3], 0, high, None], formula=formula)
    if message is None:
        assert xlmc.load(path).simulate(100, seed=1).forecasts["x"] == pytest.approx(np.full(100, 70.0))
        return
    with pytest.raises(DefinitionError, match=message) as caught:
        load(path)
    assert "Solve!A2" in str(caught.value)


def test_the_slow_engine_says_that_it_cannot(book):
    with pytest.raises(FormulaError, match="The engine `formulas` cannot compute what a row of xlmc_solve gives"):
        xlmc.load(book()).simulate(100, engine="formulas")


def test_studies_and_records_take_the_cell_as_a_formula(book, tmp_path):
    model = xlmc.load(book())
    run = model.simulate(20_000)
    result = xlmc.sensitivities(run)
    assert {each.assumption for each in result.forecasts[1].influences} == {"a", "c"}
    held = xlmc.screen(model, trials=5_000, tolerance="0.001")
    assert held.joint is None
    changed = model.with_(a=2.0).simulate(1_000, keep_inputs=None)
    assert np.allclose(changed.forecasts["x"], (-1 + np.sqrt(1 + 8 * changed.inputs["c"])) / 4, rtol=1e-13)
    path = run.save(tmp_path / "results.xlsx")
    again = xlmc.replay(path)
    assert again.identical
    assert run.keep(tmp_path / "kept.xlmcrun").exists()
    kept = xlmc.open_run(tmp_path / "kept.xlmcrun")
    assert np.array_equal(kept.forecasts["x"], run.forecasts["x"])


def test_filters_act_on_solutions(book, tmp_path):
    model = xlmc.load(book())
    run = model.simulate(5_000, keep_inputs=None)
    accepted = closed_form(run) < 5
    assert 0.1 < accepted.mean() < 0.9
    assert run["x"].probability_above(5).value == pytest.approx(1 - accepted.mean())


def other_book(tmp_path, name, rows, answer, formula):
    sheets = {"I": [["Name", "Value", "Low", "High"], *rows], "M": [["Name", "Value"], [answer, formula]]}
    path = tmp_path / name
    workbook_of(sheets, {"xlmc_assumptions": f"I!A1:D{1 + len(rows)}", "xlmc_forecasts": "M!A1:B2"}).save(path)
    return path


def test_a_book_with_solutions_feeds_another(book, tmp_path):
    source = book()
    path = other_book(tmp_path, "fed.xlsx", [["v", 1, 0, 2], ["w", 1, 0, 2]], "z", "=I!B2*2+I!B3")
    run = xlmc.load(path, feeds={"v": f"{source}!x"}).simulate(2_000, keep_inputs=None)
    alone = xlmc.load(source).simulate(2_000, keep_inputs=None)
    assert np.allclose((run.forecasts["z"] - run.inputs["w"]) / 2, alone.forecasts["x"], rtol=1e-12)


def test_a_book_with_solutions_is_fed_by_another(book, tmp_path):
    source = other_book(tmp_path, "source.xlsx", [["q", 1, 0, 2]], "c", "=40+I!B2*5")
    run = xlmc.load(book(), feeds={"c": f"{source}!c"}).simulate(2_000, keep_inputs=None)
    a, c = run.inputs["a"], 40 + 5 * run.inputs["q"]
    assert np.allclose(run.forecasts["x"], (-1 + np.sqrt(1 + 4 * a * c)) / (2 * a), rtol=1e-12)
