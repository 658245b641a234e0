"""Accepted trials over the drawing of a workbook, as every output shows them."""

from __future__ import annotations

import io
import shutil
import zipfile

import numpy as np
import openpyxl
import pytest
from committed_books import TEMPLATES

import xlmc
from xlmc.errors import SimulationError
from xlmc.outputs import save
from xlmc.outputs.document import Wanted, document_bytes
from xlmc.outputs.document.build import build
from xlmc.outputs.document.drawings import drawn
from xlmc.outputs.document.drawn_trials import drawn_trials
from xlmc.outputs.notebook import run_html
from xlmc.outputs.page import page_text

TITLE = "Trials over the chart"


@pytest.fixture(scope="module")
def impact():
    """Trials of a bumper impact, whose drawing is restitution against closing speed."""
    return xlmc.load(TEMPLATES["low-speed"]).simulate(1_500)._run


def with_evidence(folder, used):
    """The run of that workbook with one of the two rows of the curve in use."""
    path = folder / "used.xlsx"
    shutil.copy(TEMPLATES["low-speed"], path)
    book = openpyxl.load_workbook(path)
    rows = [row for row in book["Evidence"].iter_rows(min_row=6) if row[0].value == used]
    rows[0][9].value = "TRUE"
    edited = folder / "edited.xlsx"
    book.save(edited)
    # openpyxl drops what a chart has stored: the drawing stays as it was.
    with (
        zipfile.ZipFile(path) as old,
        zipfile.ZipFile(edited) as new,
        zipfile.ZipFile(folder / "both.xlsx", "w") as both,
    ):
        for name in new.namelist():
            both.writestr(name, (old if name.startswith("xl/charts/") else new).read(name))
    return xlmc.load(folder / "both.xlsx").simulate(1_500)._run


def test_each_point_is_an_accepted_trial(impact):
    chart = drawn_trials(impact)
    assert (chart.across, chart.data.upwards) == ("Closing speed, mph", "Restitution")
    assert [line.name for line in chart.data.lines] == ["Range on sheet Inputs, to", "The same, from"]
    points = np.array(chart.data.cloud.points)
    assert points.shape == (1_000, 2)
    np.testing.assert_array_equal(points[:, 0], impact.forecasts["Closing speed"][:1_000])
    np.testing.assert_array_equal(points[:, 1], impact.inputs["Restitution"][:1_000])


def test_as_a_limit_the_curve_keeps_the_points_between_its_lines(impact, tmp_path):
    def outside(run):
        e = np.array(drawn_trials(run).data.cloud.points)[:, 1]
        return np.mean((e < 0.1) | (e > 0.41))

    assert outside(impact) > 0.2
    assert outside(with_evidence(tmp_path, "Restitution within the published range")) == 0


def test_a_plan_view_has_the_curve_beside_it():
    """On a sheet of its own: the restitution that run-out and directions imply, which nobody drew."""
    run = xlmc.load(TEMPLATES["planar-impact"]).simulate(40_000)._run
    points = np.array(drawn_trials(run).data.cloud.points)
    np.testing.assert_array_equal(points[:, 1], run.forecasts["Restitution along the normal"][:1_000])
    np.testing.assert_array_equal(points[:, 0], run.forecasts["Closing speed along the normal"][:1_000])
    assert 0 <= points[:, 1].min() < points[:, 1].max() < 1  # the filter of the template


def test_a_cloud_is_drawn_as_dots_and_named(impact):
    svg = drawn(drawn_trials(impact)).svg
    assert svg.count("<circle") == 1_001
    assert "Accepted trials" in svg


def test_it_is_in_every_output(impact, tmp_path):
    pypdf, docx = pytest.importorskip("pypdf"), pytest.importorskip("docx")
    document = build(impact, Wanted(sections=("scene-trials",)))
    pdf = pypdf.PdfReader(io.BytesIO(document_bytes(document, ".pdf")))
    assert TITLE in "".join(page.extract_text() for page in pdf.pages)
    word = docx.Document(io.BytesIO(document_bytes(document, ".docx")))
    assert TITLE in [paragraph.text for paragraph in word.paragraphs]
    assert word.inline_shapes
    for shown in (page_text(impact), run_html(impact)):
        assert TITLE in shown
        assert shown.count('fill-opacity="0.35"') > 1_000


def test_the_chart_of_the_result_workbook_is_a_native_one(impact, tmp_path):
    book = openpyxl.load_workbook(save(impact, tmp_path / "out.xlsx"))
    (chart,) = book[TITLE]._charts
    cloud, *lines = chart.series
    assert len(lines) == 2
    assert cloud.graphicalProperties.line.noFill
    assert cloud.marker.symbol == "circle"
    data = book[f"{TITLE} data"]
    assert data["A1"].value == "Accepted trials"
    assert data.max_row == 1_001


def test_matplotlib_draws_it(impact):
    axes = xlmc.load(TEMPLATES["low-speed"]).simulate(200).plot(kind="drawing").axes[0]
    assert [line.get_label() for line in axes.lines] == [
        "Accepted trials",
        "Range on sheet Inputs, to",
        "The same, from",
    ]
    assert axes.get_xlabel() == "Closing speed, mph"


@pytest.mark.parametrize("name", ["skid", "planar-forward", "mass-calibration"])
def test_a_drawing_whose_base_case_is_no_pair_of_quantities_has_none(name):
    run = xlmc.load(TEMPLATES[name]).simulate(100)
    assert drawn_trials(run._run) is None
    with pytest.raises(SimulationError, match="no drawing"):
        run.plot(kind="drawing")


def test_one_point_for_all_trials_is_not_drawn(tmp_path):
    from committed_books import EXAMPLES

    assert drawn_trials(xlmc.load(EXAMPLES["bumper-test"]).simulate(100)._run) is None
