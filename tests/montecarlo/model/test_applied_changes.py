"""A model with changes against the workbook that was edited to say the same: trials are the same to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.errors import DefinitionError
from xlmc.excel.address import parse_address
from xlmc.excel.workbook.injection.cell_edit import with_contents
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.definitions.scenarios import (
    Band,
    Drawn,
    Frozen,
    Limits,
    Measured,
    Numbers,
    Range,
    Stated,
    Typed,
)
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import build_model, load
from xlmc.montecarlo.simulation.simulate import simulate

CASE = Path("examples/intersection.xlsx")
FRICTION, ANGLE = "Nissan post-impact deceleration", "Chevrolet approach angle"
TANGENT = "Restitution, tangential"
LOWEST, HIGHEST = (float(FAMILIES["Uniform"].ppf(p, low=0.6, high=0.95)) for p in (0.1, 0.9))
WANTED = "Results wanted"


def typed(**cells):
    return [Typed(parse_address(address, "Inputs"), value) for address, value in cells.items()]


UNIT = {"cell": "A1", "low": 0, "high": 1}
TRAPEZOID = {"F17": "Trapezoid", "J17": 0.7, "K17": 0.85}
ONE_ROAD = {"A34": "Chevrolet post-impact deceleration", "B34": FRICTION, "C34": 0.8}

KINDS = {
    "a range": ([Range(FRICTION, 0.7, 0.8)], {"G17": 0.7, "H17": 0.8}),
    "one end": ([Range(ANGLE, None, 195.0)], {"H8": 195.0}),
    "numbers": ([Numbers(FRICTION, {"low": 0.5, "upper_cutoff": 0.9})], {"G17": 0.5, "O17": 0.9}),
    "held": ([Frozen(FRICTION)], {"P17": True}),
    "held at a value": ([Frozen(ANGLE, 184.0)], {"P8": True, "D8": 184.0}),
    "the lowest tenth": ([Band(FRICTION, 0, 10)], {"O17": LOWEST}),
    "the highest tenth": ([Band(FRICTION, 90, 100)], {"N17": HIGHEST}),
    "limits": ([Limits(TANGENT, {"at_most": 0.5})], {f"{WANTED}!D16": 0.5}),
    "another limit": (
        [Limits(TANGENT, {"at_least": None, "above": -0.1})],
        {f"{WANTED}!C16": None, f"{WANTED}!E16": -0.1},
    ),
    "a fixed input": (typed(D28=-20.0), {"D28": -20.0}),
    "another distribution": (typed(**TRAPEZOID), TRAPEZOID),
    "a correlation": (
        [Typed(parse_address(cell, WANTED), value) for cell, value in ONE_ROAD.items()],
        {f"{WANTED}!{cell}": value for cell, value in ONE_ROAD.items()},
    ),
    "several": (
        [Range(FRICTION, 0.65, 0.9), Frozen(ANGLE, 187.0), Limits(TANGENT, {"at_most": 1.0}), *typed(D28=-10.0)],
        {"G17": 0.65, "H17": 0.9, "P8": True, "D8": 187.0, f"{WANTED}!D16": 1.0, "D28": -10.0},
    ),
}

TOGETHER = [
    ("one end", "numbers"),
    ("held", "another limit"),
    ("the lowest tenth",),
    ("the highest tenth", "a correlation"),
    ("another distribution",),
    ("several",),
]
"""Kinds that one workbook can have; the last one has those that are missing here."""


@pytest.fixture(scope="module")
def case():
    return load(CASE)


def edited(workbook, cells):
    """The model of the workbook with other contents in cells, written and read again."""
    parts = dict(workbook.parts)
    for address, value in cells.items():
        cell = parse_address(address, "Inputs")
        part = workbook.sheets[cell.sheet].part
        parts[part] = with_contents(parts[part], part, cell.sheet, {(cell.row, cell.column): value})
    return build_model(read_workbook(package_bytes(parts), CASE.name), CASE)


def run(model, **more):
    return simulate(model, trials=3_000, seed=5, **more)


def assert_same(result, expected):
    assert result.block == expected.block
    assert result.trial_index.size > 5
    assert np.array_equal(result.trial_index, expected.trial_index)
    assert result.tally.rejected.tolist() == expected.tally.rejected.tolist()
    for mine, theirs in ((result.forecasts, expected.forecasts), (result.inputs, expected.inputs)):
        assert list(mine) == list(theirs)
        assert all(mine[name].tobytes() == theirs[name].tobytes() for name in mine)


@pytest.mark.parametrize("kinds", TOGETHER)
def test_changes_give_what_the_edited_workbook_gives(case, kinds):
    run(case)  # so that its program is there to be used again
    changes = [change for kind in kinds for change in KINDS[kind][0]]
    cells = {cell: value for kind in kinds for cell, value in KINDS[kind][1].items()}
    assert_same(run(applied(case, changes)), run(edited(case.workbook, cells)))


def test_changes_do_not_touch_the_model_that_they_are_made_of(case):
    before = run(case)
    for changes, _ in KINDS.values():
        applied(case, changes)
    assert_same(run(case), before)


def test_draws_of_unchanged_assumptions_stay_to_the_last_bit(case):
    """Each has a stream of its own, by the seed and its name, so that scenarios share their random numbers."""
    for sampling in ("mc", "lhs500"):
        plain = simulate(case, trials=1_000, seed=5, sampling=sampling).prior
        for kind in ("a range", "held", "the lowest tenth", "limits", "another distribution"):
            prior = simulate(applied(case, KINDS[kind][0]), trials=1_000, seed=5, sampling=sampling).prior
            others = [name for name in prior if name != FRICTION]
            assert len(others) == 16, (kind, sampling)
            assert all(prior[name].tobytes() == plain[name].tobytes() for name in others), (kind, sampling)


def test_what_only_moves_ranges_shares_nodes_and_programs(case):
    program = case.program("numpy")
    inside = applied(case, [Range(FRICTION, 0.7, 0.8)])
    assert inside.lowering is case.lowering
    assert inside.program("numpy") is program
    other_limit = applied(case, [Limits(TANGENT, {"at_most": 0.4})])
    assert other_limit.lowering is case.lowering
    assert other_limit.program("numpy") is not case.program("numpy")
    assert applied(case, [Frozen(FRICTION)]).lowering is not case.lowering


def test_many_limits_do_not_pile_up_nodes(book):
    model = book({"A1": 0.5, "B1": "=A1*2"}, {"a": UNIT}, {"x": "B1"}, {"f": {"cell": "B1", "at_most": 1}})
    first = run(model)
    moved = [applied(model, [Limits("f", {"at_most": 1 + number / 100})]) for number in range(60)]
    sizes = [len(each.lowering.dag.nodes) for each in moved]
    assert max(sizes) < 7 * sizes[0]
    assert len({id(each.lowering) for each in moved}) > 1
    assert_same(run(model), first)
    assert_same(run(moved[10]), run(applied(model, [Limits("f", {"at_most": 1.1})])))


def test_a_wider_range_makes_the_program_anew_and_both_stay_right(case):
    """Bounds of draws let a program leave out tests of angles: those of one range must not serve a wider one."""
    model = load(CASE)
    run(model)
    wide = [Range(ANGLE, -1e9, 1e9)]
    far = run(applied(model, wide))
    assert far.trial_index.tobytes() == run(edited(case.workbook, {"G8": -1e9, "H8": 1e9})).trial_index.tobytes()
    assert_same(run(model), run(load(CASE)))


def test_rows_whose_cells_other_formulas_read(book_of_rows, subtests):
    """A cell of a row that a formula reads, a range about the cell itself, a row that is frozen."""
    for kind, (changes, cells) in {
        "read by a formula": ([Range("a", 2.0, 3.0)], {"Inputs!C2": 2.0, "Inputs!D2": 3.0}),
        "about its own cell": ([Frozen("a", 1.5)], {"Inputs!B2": 1.5, "Inputs!E2": True}),
        "a formula in the row": ([Range("b", None, 7.0)], {"Inputs!D3": 7.0}),
        "a distribution that reads a range": (
            [Range("a", 2.0, 3.0), Range("d", None, 5.0)],
            {"Inputs!C2": 2.0, "Inputs!D2": 3.0, "Inputs!D5": 5.0},
        ),
        "the end that reads another": (
            [Range("a", 2.0, 3.0), Range("d", 3.5, None)],
            {"Inputs!C2": 2.0, "Inputs!D2": 3.0, "Inputs!C5": 3.5},
        ),
        "held beside what it reads": (
            [Range("a", 2.0, 3.0), Frozen("d", 1.25)],
            {"Inputs!C2": 2.0, "Inputs!D2": 3.0, "Inputs!B5": 1.25, "Inputs!E5": True},
        ),
        "a cell that a filter reads": ([Limits("f", {"below": 9.0})], {"Wanted!C5": 9.0}),
        "drawn again": (
            [Drawn("c"), Range("c", 0.0, 2.0), Range("b", None, 7.0)],
            {"Inputs!E4": False, "Inputs!C4": 0.0, "Inputs!D4": 2.0, "Inputs!D3": 7.0},
        ),
    }.items():
        with subtests.test(kind):
            assert_same(run(applied(book_of_rows({}), changes)), run(book_of_rows(cells)))


@pytest.fixture(scope="module")
def book_of_rows(tmp_path_factory):
    """`book_of_rows({cell: content})`: a small workbook, written and read, with these contents in its cells."""

    def make(cells):
        book = openpyxl.Workbook()
        book.remove(book.active)
        rows = {
            "Inputs": [
                ["Name", "Value", "Low", "High", "Frozen", "Distribution"],
                ["a", 1.0, 1.0, 2.0, None],
                ["b", 5.0, "=B3*0.5", "=B3*1.2+B4*0.1", None],
                ["c", 1.0, 0.5, 1.5, True],
                ["d", 3.0, "=C2*0.5", 4.0, None, '=IF(C2>1.5,"Reciprocal","Uniform")'],
            ],
            "Model": [["=Inputs!B2*Inputs!B3+Inputs!B4+Inputs!D2+0.1*Inputs!B5", "=Inputs!C2*4"]],
            "Wanted": [
                ["Name", "Cell"],
                ["x", "=Model!A1"],
                [],
                ["Name", "Cell", "Below", "Because"],
                ["f", "=Model!A1", "=Model!B1*2.5", "seen"],
            ],
        }
        for name, lines in rows.items():
            sheet = book.create_sheet(name)
            for line in lines:
                sheet.append(line)
        for name, area in (("assumptions", "Inputs!A1:F5"), ("forecasts", "Wanted!A1:B2"), ("filters", "Wanted!A4:D5")):
            where = parse_address(area)
            book[where.sheet].add_table(Table(displayName=f"xlmc_{name}", ref=where.a1))
        for address, value in cells.items():
            cell = parse_address(address)
            book[cell.sheet].cell(cell.row, cell.column).value = value
        path = tmp_path_factory.mktemp("book") / "book.xlsx"
        book.save(path)
        return load(path)

    return make


def test_what_the_edited_workbook_refuses_is_refused(book_of_rows):
    """High of b depends on its own cell, and on c as soon as that is drawn."""
    with pytest.raises(DefinitionError) as edited_book:
        book_of_rows({"Inputs!E4": False})
    with pytest.raises(DefinitionError) as changed:
        applied(book_of_rows({}), [Drawn("c")])
    assert str(changed.value) == str(edited_book.value)


def test_a_draw_in_a_cell(tmp_path, subtests):
    def book(draw):
        written = openpyxl.Workbook()
        written.active.append([3.0, f"={draw}*A1", '=RiskOutput("answer")+B1+RiskNormal(A1,1,RiskName("n"))'])
        written.save(tmp_path / "book.xlsx")
        return load(tmp_path / "book.xlsx")

    plain = book('RiskUniform(1,2,RiskName("u"))')
    for kind, (changes, draw) in {
        "a range": ([Range("u", 1.5, None)], 'RiskUniform(1.5,2,RiskName("u"))'),
        "held": ([Frozen("u", 1.25)], "1.25"),
        "cut off": ([Numbers("u", {"upper_cutoff": 1.5})], 'RiskUniform(1,2,RiskName("u"),RiskTruncate(,1.5))'),
    }.items():
        with subtests.test(kind):
            result = run(applied(plain, changes)).forecasts["answer"]
            assert result.tobytes() == run(book(draw)).forecasts["answer"].tobytes()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([Range("Nisan weight", 1, 2)], "there is no assumption 'Nisan weight'"),
        ([Limits("Restitution", {"at_most": 1})], "there is no filter 'Restitution'"),
        ([Range(FRICTION, 0.8, 0.7)], f"{FRICTION}: Low (0.8) is above High (0.7)"),
        ([Limits(TANGENT, {"at_most": -1})], f"{TANGENT}: At least (0) and At most (-1) contradict each other"),
        ([Frozen(FRICTION, 0.7), Range(FRICTION, 0.6, 0.7)], f"{FRICTION!r} is frozen"),
        ([Band(FRICTION, 10, 10)], "a band from P10 to P10 holds nothing"),
        ([Typed(parse_address("Input!D28"), 1.0)], "the workbook has no sheet 'Input'"),
        ([Typed(parse_address("'Results wanted'!B41"), 1.0)], "is a cell of the table xlmc_settings"),
        ([Limits(TANGENT, {"at_least": None, "at_most": None})], "has no limit, and its cell is"),
        ([Measured(TANGENT, {"reading": 0.3})], f"{TANGENT!r} is a filter, and has no reading"),
        ([Measured("laser", {"reading": 0.3})], "there is no evidence 'laser'"),
        ([Stated("Nisan impact speed", {"threshold": 3.0})], "there is no forecast 'Nisan impact speed'"),
        ([Stated("Nissan impact speed", {"central": 0.5})], "a central range of 0.5 % of 'Nissan"),
        ([Stated("Nissan impact speed", {"central": 1.0})], "must be above 1 and below 100"),
        ([Stated("Nissan impact speed", {"central": 100.0})], "must be above 1 and below 100"),
    ],
)
def test_what_cannot_be_changed(case, changes, message):
    with pytest.raises(DefinitionError) as caught:
        applied(case, changes)
    assert message in caught.value.message
    assert caught.value.hint
