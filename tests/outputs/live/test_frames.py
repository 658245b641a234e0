"""What the window draws of a run, against the trials of the run counted by NumPy and SciPy."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from live_books import add_tables, book_of_dates
from openpyxl import Workbook
from scipy import stats
from simulated import simulated

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.live.frames import (
    _bars_behind,
    _figure,
    _of_chosen,
    _texts,
    bases_of,
    frame_of,
    matrix_of,
    matters_html,
    pair_of,
    rest_of,
    tables_html,
)

INPUTS = {
    "u": {"cell": "A1", "low": 0.0, "high": 10.0},
    "v": {"cell": "A2", "low": 0.0, "high": 1.0},
}
FORMULAS = {
    "A1": 5.0,
    "A2": 0.5,
    "B1": "=A1*2",
    "B2": "=A1+A2",
    "B3": "=A2>0.25",
    "B4": '=IF(A2>0.9,"high",IF(A2>0.4,"middle",""))',
    "B5": "=SQRT(A1-5)",
    "B6": "=A2*0+3",
    "B7": "=LN(A2-2)",
    "B8": "=A1",
}
FORECASTS = {"double": "B1", "sum": "B2", "wet": "B3", "text": "B4", "root": "B5", "fixed": "B6", "none": "B7"}


@pytest.fixture(scope="module")
def model(model_of):
    return model_of(FORMULAS, INPUTS, FORECASTS)


@pytest.fixture(scope="module")
def run(model):
    return simulated(model, trials=2_999, seed=3)


@pytest.fixture(scope="module")
def other(model_of):
    """The run of a state in which u goes further."""
    inputs = {**INPUTS, "u": {"cell": "A1", "low": 0.0, "high": 20.0}}
    return simulated(model_of(FORMULAS, inputs, FORECASTS), trials=2_000, seed=3)


def drawn(run, name, behind=None, *, moving=False):
    return frame_of(run, behind, [name], bases_of(run), moving=moving, fits=False)["forecasts"][name]


def test_a_frame_says_how_many_trials_were_accepted(model_of):
    filters = {"f": {"cell": "B2", "at_most": 5.0}}
    run = simulated(model_of(FORMULAS, INPUTS, {"sum": "B2"}, filters), trials=2_000, seed=3)
    frame = frame_of(run, None, ["sum", "unknown"], None, moving=False, fits=False)
    assert [*frame["forecasts"]] == ["sum"]
    assert (frame["trials"], frame["accepted"], frame["few"]) == (2000, run.accepted, False)
    share = 100 * run.accepted / 2000
    written = re.fullmatch(r"([\d.]+) ± ([\d.]+) %", frame["share"])
    assert float(written[1]) == pytest.approx(share, abs=0.01)
    assert float(written[2]) == pytest.approx(math.sqrt(share * (100 - share) / 2000), abs=0.02)
    rejected = rest_of(run)["rejected"]
    assert rejected == {"f": [2000 - run.accepted] * 2}
    assert rest_of(run)["evaluated"] == 2000


def test_bases_are_those_of_the_cells(run):
    bases = bases_of(run)
    assert (bases["double"], bases["sum"], bases["root"]) == (10, 5.5, 0)
    assert bases["none"] is None


def test_bars_and_their_parts_count_all_trials(run):
    chart = drawn(run, "double")
    values, bins = run.forecasts["double"], chart["bins"]
    np.testing.assert_array_equal(bins["counts"], np.histogram(values, bins["edges"])[0])
    parts = np.array(bins["parts"])
    assert parts.shape == (len(bins["counts"]), 20)
    np.testing.assert_array_equal(parts.sum(axis=1), bins["counts"])
    assert chart["trials"] == 2999


def test_numbers_beside_a_chart(run):
    x = run.forecasts["double"]
    beside = {label: rest for label, *rest in drawn(run, "double")["beside"]}
    assert [*beside] == [
        "Mean", "Standard deviation", "Minimum", "5 %", "25 %", "50 %", "75 %", "95 %", "Maximum"
    ]  # fmt: skip
    wanted = {"Mean": x.mean(), "Standard deviation": x.std(ddof=1), "Minimum": x.min(), "Maximum": x.max()}
    wanted |= {f"{q} %": np.percentile(x, q) for q in (5, 25, 50, 75, 95)}
    for label, (text, before, change) in beside.items():
        assert (before, change) == ("", "")
        assert float(text.partition(" ± ")[0]) == pytest.approx(wanted[label], abs=0.03), label


def test_beside_the_state_behind(run, other):
    chart = drawn(run, "double", other)
    now, before = run.forecasts["double"].mean(), other.forecasts["double"].mean()
    label, *texts = chart["beside"][0]
    assert label == "Mean"
    shown, old, change = (float(text.partition(" ± ")[0].replace("−", "-")) for text in texts)
    assert (shown, old) == pytest.approx((now, before), abs=0.006)
    assert change == pytest.approx(now - before, abs=0.011)
    assert chart["said"] == f"double: mean {old:.2f} → {shown:.2f}"


def test_bars_of_the_state_behind_are_as_wide(run, other):
    chart = drawn(run, "double", other)
    behind, x = chart["behind"], np.sort(other.forecasts["double"])
    assert np.diff(behind["edges"]) == pytest.approx(chart["bins"]["width"])
    assert behind["parts"] == 1
    np.testing.assert_array_equal(behind["counts"], np.histogram(x, behind["edges"])[0])
    assert behind["trials"] == 2000
    assert behind["edges"][0] <= x[2] < behind["edges"][1]  # all but a thousandth at either end
    assert behind["edges"][-2] <= x[1997] < behind["edges"][-1]
    assert behind["mean"] == pytest.approx(x.mean(), rel=1e-12)
    levels = np.array(behind["curve"])
    np.testing.assert_allclose(levels[:, 1], np.arange(101), atol=1e-12)
    np.testing.assert_array_equal(levels[:, 0], x[np.round(np.linspace(0, 1, 101) * 1999).astype(int)])


def test_the_state_behind_is_much_wider(model_of):
    narrow, wide = (
        simulated(model_of({"A1": 1.0}, {"u": {"cell": "A1", "low": -high, "high": high}}, {"x": "A1"}), 1_500)
        for high in (1.0, 1_000.0)
    )
    figure = _figure(narrow.results["x"], None)
    behind = _bars_behind(figure, wide.results["x"].sample)
    times = 1 / behind["parts"]
    assert math.log2(times).is_integer()
    assert np.diff(behind["edges"]) == pytest.approx(times * figure.bins.width)
    assert 200 <= len(behind["counts"]) <= 400  # no wider than needed
    values = wide.forecasts["x"]
    np.testing.assert_array_equal(behind["counts"], np.histogram(values, behind["edges"])[0])
    assert sum(behind["counts"]) >= 0.997 * values.size


def test_shares_of_texts_and_of_yes(run, other):
    texts = run.labels["text"]
    values = run.forecasts["text"]
    assert sorted(texts) == ["", "high", "middle"]
    chart = drawn(run, "text", other)
    shares = {name: (shown, share, before) for name, shown, share, before in chart["shares"]}
    assert {*shares} == {"(empty)", "high", "middle"}
    v, behind = run.inputs["v"], other.inputs["v"]
    for name, low, high in (("(empty)", -1, 0.4), ("middle", 0.4, 0.9), ("high", 0.9, 1)):
        assert shares[name][1] == pytest.approx(100 * np.mean((v > low) & (v <= high)))
        assert shares[name][2] == pytest.approx(100 * np.mean((behind > low) & (behind <= high)))
        assert shares[name][0].startswith(f"{shares[name][1]:.2f}"[:3])
    assert values.size == 2999
    alone = drawn(run, "wet")
    assert [row[3] for row in alone["shares"]] == [None] * len(alone["shares"])
    assert sum(row[2] for row in alone["shares"]) == pytest.approx(100)


def test_a_text_that_only_the_state_behind_has(model_of):
    def of(high):
        cells = {"A1": 0.5, "B1": '=IF(A1>0.9,"high","low")'}
        return simulated(model_of(cells, {"v": {"cell": "A1", "low": 0.0, "high": high}}, {"text": "B1"}), 500)

    now, before = of(0.8), of(1.0)
    shares = {row[0]: row for row in drawn(now, "text", before)["shares"]}
    assert shares["high"][1:3] == ["0 %", 0]
    assert shares["high"][3] == pytest.approx(100 * np.mean(before.inputs["v"] > 0.9))


def test_what_has_no_number_has_no_chart(run):
    frame = frame_of(run, None, ["none", "double"], None, moving=True, fits=False)
    assert frame["forecasts"]["none"] is None
    assert "Base case" not in [mark["label"] for mark in frame["forecasts"]["double"]["marks"]]
    assert "Base case" in [mark["label"] for mark in drawn(run, "double")["marks"]]


def test_fewer_values_while_a_handle_moves(run):
    at_rest, moving = drawn(run, "double"), drawn(run, "double", moving=True)
    assert len(at_rest["values"]) >= 2999
    assert 100 < len(moving["values"]) <= 410  # with the ends of the range
    assert sum(at_rest["counts"]) == sum(moving["counts"]) + sum(moving["gaps"]) == 2999


PERCENT = Form(Kind.PERCENT, "0%")
DAY = Form(Kind.DATE, "yyyy-mm-dd")


@pytest.mark.parametrize(
    ("form", "now", "before", "texts"),
    [
        (PLAIN, Estimate(5.31, 0.02), Estimate(4.72, 0.3), ("5.31 ± 0.02", "4.72 ± 0.30", "+0.59")),
        (PLAIN, Estimate(1.5, 0.2), Estimate(2.0, 0.3), ("1.50 ± 0.20", "2.00 ± 0.30", "−0.50")),
        (PLAIN, Estimate(2.0, 0.2), Estimate(2.0, 0.3), ("2.00 ± 0.20", "2.00 ± 0.30", "0.00")),
        (PLAIN, Estimate(3.0, None), None, ("3", "", "")),
        (PLAIN, Estimate(24.99791234), Estimate(20.12345678), ("24.9979", "20.1235", "+4.8745")),
        (PLAIN, Estimate(100_000.25), Estimate(0.125), ("100,000", "0.125", "+100,000")),
        (PLAIN, Estimate(10.0, 1e-17), Estimate(10.0, 2e-17), ("10", "10", "0")),
        (PLAIN, Estimate(10.0 + 4e-15, 1e-17), Estimate(10.0, 2e-17), ("10", "10", "0")),
        (PLAIN, Estimate(math.inf), Estimate(1.0), None),
        (DAY, Estimate(46084.0, 0.5), Estimate(46082.5, 0.5), ("2026-03-03 ± 12 h", "2026-03-01 ± 12 h", "+1.5 days")),
        (PERCENT, Estimate(0.1, 1e-17), Estimate(0.1, 1e-17), ("10 %", "10 %", "0 %")),
        (PERCENT, Estimate(0.32, 0.003), Estimate(0.3, 0.003), ("32.00 ± 0.30 %", "30.00 ± 0.30 %", "+2.00 %")),
    ],
)  # fmt: skip
def test_a_number_beside_the_one_before(form, now, before, texts):
    written = _texts("Mean", now, before, form)
    if texts is None:
        assert written[1:] == ("1", "")
    else:
        assert written == texts


@pytest.mark.parametrize(
    ("code", "formula", "pattern"),
    [
        ("yyyy-mm-dd", "=A1+46000", r"x: mean 2025-12-1\d → 2025-12-1\d"),
        ('#,##0 "€"', "=A1*1000", r"x: mean [\d,]+ € → [\d,]+ €"),
        ("0%", "=A1/20", r"x: mean [\d.]+ % → [\d.]+ %"),
        ("General", "=A1*1E-15", r"x: mean \d\.\d+e-1[45] → \d\.\d+e-1[45]"),
    ],
)
def test_how_a_mean_moved_is_said_without_errors(tmp_path, code, formula, pattern):
    def of(high):
        book = Workbook()
        book.active["A1"], book.active["B1"] = 5.0, formula
        book.active["B1"].number_format = code
        tables = {
            "xlmc_assumptions": [
                ["Name", "Cell", "Distribution", "Low", "High"],
                ["u", "=Sheet!A1", "Uniform", 4.0, high],
            ],
            "xlmc_forecasts": [["Name", "Cell"], ["x", "=Sheet!B1"]],
        }
        add_tables(book.create_sheet("T"), tables)
        book.save(tmp_path / "book.xlsx")
        return simulated(load(tmp_path / "book.xlsx"), 500)

    assert re.fullmatch(pattern, drawn(of(9.0), "x", of(8.0))["said"])


def test_two_quantities_in_the_same_trials(run):
    pair = pair_of(run, "u", "root")
    u, root = run.inputs["u"], run.forecasts["root"]
    known = np.isfinite(root)
    assert 1000 < known.sum() < 2000
    assert (pair["trials"], pair["looked"], pair["accepted"]) == (known.sum(), 2999, 2999)
    np.testing.assert_array_equal(pair["x"], u[known][:2000])
    np.testing.assert_array_equal(pair["y"], root[known][:2000])
    assert pair["correlation"] == pytest.approx(stats.spearmanr(u[known], root[known]).statistic)
    assert pair["together"] == []


def test_no_pair_of_texts_or_of_what_is_unknown(run):
    assert pair_of(run, "u", "text") is None
    assert pair_of(run, "unknown", "u") is None
    assert pair_of(run, "u", "unknown") is None


def test_shares_of_trials_above_medians_and_thresholds(run):
    pair = pair_of(run, "double", "wet")
    x, y = run.forecasts["double"], run.forecasts["wet"]
    right, upper = x > np.median(x), y > 0.5
    shares = [
        f"{100 * np.mean(each):.1f} %" for each in (right & upper, right & ~upper, upper & ~right, ~right & ~upper)
    ]
    said = pair["quadrants"]
    assert re.findall(r"[\d.]+ %", said) == shares
    median, _, _ = said.removeprefix("Above double ").partition(" (median) and above wet (a yes is above): ")
    assert float(median) == pytest.approx(np.median(x), abs=0.06)
    assert "of the trials; only the first" in said


def test_nothing_is_said_of_what_does_not_vary(run):
    assert pair_of(run, "u", "fixed")["quadrants"] == ""
    assert pair_of(run, "fixed", "u")["quadrants"] == ""


def test_two_forecasts_in_one_unit_lie_over_each_other(run):
    assert [chart["name"] for chart in pair_of(run, "double", "sum")["together"]] == ["double", "sum"]
    assert pair_of(run, "double", "double")["together"] == []
    assert pair_of(run, "double", "none")["together"] == []
    assert pair_of(run, "double", "wet")["together"] == []
    assert pair_of(run, "double", "u")["together"] == []


def test_forecasts_in_two_units_do_not(tmp_path):
    run = simulated(load(book_of_dates(tmp_path / "dates.xlsx")), 200)
    assert pair_of(run, "end", "net price")["together"] == []


def test_both_means_have_the_decimals_of_the_larger_error(run, model_of):
    few = simulated(model_of(FORMULAS, INPUTS, FORECASTS), trials=20, seed=3)
    assert re.fullmatch(r"double: mean \d+\.\d → \d+\.\d", drawn(run, "double", few)["said"])


def test_a_matrix_of_forecasts(run):
    matrix = matrix_of(run, ["double", "root", "text", "fixed", "none", "sum"])
    assert matrix["names"] == ["double", "sum", "root"]
    assert (matrix["left"], matrix["looked"], matrix["accepted"]) == (0, 2999, 2999)
    columns = {name: run.forecasts[name] for name in matrix["names"]}
    medians = {name: np.nanmedian(column) for name, column in columns.items()}
    assert matrix["limits"] == pytest.approx([*medians.values()])
    assert [len(points) for points in matrix["points"]] == [300] * 3
    assert matrix["points"][0] == columns["double"][:300].tolist()
    assert [point is None for point in matrix["points"][2]] == np.isnan(columns["root"][:300]).tolist()
    assert [(cell["first"], cell["second"]) for cell in matrix["cells"]] == [
        ("double", "sum"), ("double", "root"), ("sum", "root")
    ]  # fmt: skip
    for cell in matrix["cells"]:
        x, y = columns[cell["first"]], columns[cell["second"]]
        both = np.isfinite(x) & np.isfinite(y)
        above = (x[both] > medians[cell["first"]]) & (y[both] > medians[cell["second"]])
        assert cell["above"] == pytest.approx(100 * above.mean())
        assert cell["correlation"] == pytest.approx(stats.spearmanr(x[both], y[both]).statistic)


def test_a_matrix_has_two_to_six_forecasts(run, model_of):
    assert matrix_of(run, ["double", "fixed"]) is None
    many = {f"x{number}": f"C{number}" for number in range(1, 9)}
    cells = FORMULAS | {f"C{number}": f"=A2/{number}" for number in range(1, 9)}
    matrix = matrix_of(simulated(model_of(cells, INPUTS, many), 200), many)
    assert matrix["names"] == [*many][:6]
    assert (matrix["left"], len(matrix["cells"])) == (2, 15)


def test_weighted_trials_have_no_matrix_and_nothing_that_matters(model_of):
    evidence = {"seen": {"cell": "B1", "reading": 10.0, "error": "normal", "std_dev": 1.0}}
    model = model_of(FORMULAS, INPUTS, {"double": "B1", "sum": "B2"}, {}, evidence=evidence)
    run = simulated(model, 2_000, evidence="weights")
    assert matrix_of(run, ["double", "sum"]) is None
    assert "a weight of its own" in matters_html(run, ["double"], lambda share: None)
    pair = pair_of(run, "double", "sum")
    assert np.mean(pair["x"]) == pytest.approx(10, abs=0.2)
    assert np.std(pair["x"]) == pytest.approx(1, abs=0.1)  # every row counts as often as its weight says


@pytest.mark.parametrize(
    ("names", "note"),
    [
        ([], "Choose an answer above."),
        (["double", "sum"], "Of 2 of 7 answers: those that are chosen above."),
        ([*FORECASTS], ""),
    ],
)
def test_of_how_many_answers_a_tab_is(run, names, note):
    html = _of_chosen(run, names).source
    assert note in html
    assert bool(html) == bool(note)


def test_what_matters_and_how_far_it_is(run):
    shares = []
    html = matters_html(run, ["sum"], shares.append)
    assert "Of 1 of 7 answers" in html
    assert shares[-1] == pytest.approx(0.9)  # half of what is left when all is measured
    assert shares == sorted(shares)
    assert max(shares[:-1]) == pytest.approx(0.8)
    assert matters_html(run, [], shares.append) == _of_chosen(run, []).source


def test_tables_and_how_far_they_are(run):
    shares = []
    html = tables_html(run, ["double"], shares.append)
    assert shares == pytest.approx([number / 7 for number in range(7)])
    assert "Of 1 of 7 answers" in html
    assert "double" in html
    assert html.count("<h2") >= 4
