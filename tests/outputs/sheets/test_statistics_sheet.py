from __future__ import annotations

import pytest

NAMES = {
    "Mean": "mean",
    "Median": "median",
    "Mode": "mode",
    "Standard deviation": "standard_deviation",
    "Variance": "variance",
    "Skewness": "skewness",
    "Kurtosis (normal 3)": "kurtosis",
    "Coefficient of variation": "coefficient_of_variation",
    "Minimum": "minimum",
    "Maximum": "maximum",
    "Range width": "range_width",
    "Mean standard error": "mean_standard_error",
}


def _expected(estimate):
    return [
        estimate.value,
        "–" if estimate.error is None else estimate.error,
        *(("–", "–") if estimate.interval is None else estimate.interval),
    ]


@pytest.mark.parametrize(("label", "attribute"), NAMES.items())
def test_every_statistic_has_its_error_and_interval(run, book, row_of, label, attribute):
    estimates = [getattr(run[name].statistics, attribute) for name in ("area", "difference")]
    expected = [number for estimate in estimates for number in _expected(estimate)]
    assert row_of(book["Statistics"], label)[1:] == expected


def test_forecasts_stand_side_by_side_with_their_units(book, row_of):
    names = [name for name in row_of(book["Statistics"], "Forecast") if name]
    assert names == ["Forecast", "area (ft)", "difference (ft)"]
    assert row_of(book["Statistics"], "Statistic")[1:5] == ["Value", "±", "95 % from", "to"]


def test_percentiles_the_central_range_and_the_threshold_stand_below(run, book, row_of):
    sheet, result = book["Statistics"], run["area"].statistics
    for percent, estimate in result.percentiles.items():
        assert row_of(sheet, f"{percent:g} %")[1:5] == _expected(estimate)
    for end, estimate in zip(("from", "to"), result.central, strict=True):
        assert row_of(sheet, f"Central range {end}")[1:5] == _expected(estimate)
    assert row_of(sheet, "Central range, share")[1::4] == [0.51, 0.51]
    assert row_of(sheet, "Threshold")[1:] == [16.0]
    assert row_of(sheet, "Above threshold")[1:] == _expected(result.probability_above)


def test_extremes_show_the_digits_of_the_mean(book):
    sheet = book["Statistics"]
    formats = {sheet.cell(row, 1).value: sheet.cell(row, 2).number_format for row in range(1, 20)}
    assert formats["Minimum"] == formats["Mean"] == "#,##0.000"


def test_six_forecasts_stand_on_a_page(make, opened):
    forecasts = [make.forecast(f"f{n}", "B1" if n == 0 else f"D{n}") for n in range(13)]
    cells = {"A1": 0.5, "B1": "=A1*2"} | {f"D{n}": "=A1+1" for n in range(1, 13)}
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts)
    sheet = opened(run, "Statistics")["Statistics"]
    begins = [brk.id + 1 for brk in sheet.row_breaks.brk]
    assert [sheet.cell(row, 2).value for row in begins] == ["f6", "f12"]


def test_no_table_breaks_where_two_of_six_forecasts_have_no_room_on_a_page(make, opened):
    """Thresholds and long names make both tables higher than a page together: each then begins its own."""
    names = [f"{' '.join(['a long name'] * 30)} {n}" for n in range(7)]
    forecasts = [make.forecast(name, f"D{n}", threshold=1.0) for n, name in enumerate(names, 1)]
    cells = {"A1": 0.5} | {f"D{n}": f"=A1+{n}" for n in range(1, 8)}
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts, trials=50)
    sheet = opened(run, "Statistics")["Statistics"]
    begins = [brk.id + 1 for brk in sheet.row_breaks.brk]
    assert len(begins) > 1
    assert {sheet.cell(row, 1).value for row in begins} == {"Forecast"}


def test_statistics_of_weighted_trials_are_weighted(weighted, opened, row_of):
    """The mean given the reading is 0.8; that of the trials, each counted once, is 0."""
    values, weights = weighted["y"].values, weighted.weighting.weights
    mean = row_of(opened(weighted, "Statistics")["Statistics"], "Mean")[1]
    assert mean == weighted["y"].mean.value
    assert mean == pytest.approx((weights * values).sum() / weights.sum(), rel=1e-12)
    assert mean == pytest.approx(0.8, abs=0.06)
    assert abs(values.mean()) < 0.06
