"""The sheets Sensitivity and Filter limits: what they show is what the analysis found, and the charts draw it."""

from __future__ import annotations

import io
import re
import zipfile

import openpyxl
import pytest
from openpyxl.utils import range_boundaries
from packed_sheets import packed_sheets

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.outputs.document.cells import NOISE
from xlmc.outputs.document.content.limits import moved_caption
from xlmc.outputs.document.content.sensitivity import influence_table
from xlmc.outputs.document.html_writer import blocks_html


@pytest.fixture(scope="module")
def packed(run, package_of):
    return package_of(run)


@pytest.fixture(scope="module")
def result(run):
    return sensitivities(run)


@pytest.fixture(scope="module")
def charts(packed):
    """Title -> the XML of every chart with it, in the order of the package."""
    titled = {}
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        names = [name for name in package.namelist() if name.startswith("xl/charts/chart")]
        for name in sorted(names, key=lambda name: int(re.findall(r"\d+", name)[0])):
            xml = package.read(name).decode()
            title = re.search(r"<c:title>.*?<a:t>(.*?)</a:t>", xml)
            if title:
                titled.setdefault(title[1], []).append(xml)
    return titled


def drawn(book, xml, part):
    """The values of the cells that a part (`cat`, `val`, `xVal`, `yVal`, `plus`) of each series refers to."""
    values = []
    for formula in re.findall(rf"<c:{part}>.*?<c:f>(.*?)</c:f>", xml):
        sheet, _, area = formula.rpartition("!")
        left, top, right, bottom = range_boundaries(area.replace("$", ""))
        rows = book[sheet.strip("'")].iter_rows(top, bottom, left, right, values_only=True)
        values.append([value for row in rows for value in row])
    return values


def test_influences_stand_in_the_table(book, result, row_of):
    for forecast in result.forecasts:
        for each in forecast.influences:
            row = next(
                row
                for row in book["Sensitivity"].iter_rows(values_only=True)
                if row[0] == each.assumption and row[2] == each.explained.value
            )
            assert row[:4] == (each.assumption, each.units, each.explained.value, each.explained.error)
            assert row[4] == each.explained_floor
            assert row[5:8] == (each.dependence.value, each.dependence.error, each.dependence_floor)
            assert row[8:12] == (
                each.rank_correlation.value,
                each.rank_correlation.error,
                each.contribution.value,
                each.contribution.error,
            )


def test_charts_draw_the_columns_of_their_names(book, result, charts):
    picks = {
        "Variance explained": lambda each: each.explained,
        "Dependence": lambda each: each.dependence,
        "Rank correlation": lambda each: each.rank_correlation,
        "Contribution to variance (approximate)": lambda each: each.contribution,
    }
    for title, pick in picks.items():
        assert len(charts[title]) == len(result.forecasts)
        for xml, forecast in zip(charts[title], result.forecasts, strict=True):
            assert drawn(book, xml, "cat") == [[each.assumption for each in forecast.influences]]
            assert drawn(book, xml, "val") == [[pick(each).value for each in forecast.influences]]
            assert drawn(book, xml, "plus") == [[pick(each).error for each in forecast.influences]]


def test_tornado_and_spider_draw_changes_from_the_base_case(book, result, charts):
    for tornado, spider, forecast in zip(charts["Tornado"], charts["Spider"], result.forecasts, strict=True):
        changes = [[answer - forecast.base for answer in bar.answers] for bar in forecast.bars]
        assert drawn(book, tornado, "val") == [[each[0] for each in changes], [each[-1] for each in changes]]
        assert drawn(book, spider, "val") == changes
        for drawing in (tornado, spider):
            assert f"Change from the base case, {forecast.units}<" in drawing


def test_axes_have_titles_and_charts_a_description(packed, charts):
    for each in (xml for result in charts.values() for xml in result):
        assert each.count("<c:title>") >= 2
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        drawings = [
            package.read(name).decode() for name in package.namelist() if name.startswith("xl/drawings/drawing")
        ]
    described = [text for xml in drawings for text in re.findall(r'descr="(.*?)"', xml)]
    assert any(text.startswith("Contribution to variance as Crystal Ball shows it") for text in described)
    assert any(text.startswith("Tornado: how far the forecast moves") for text in described)


def test_lines_are_straight_and_shares_end_at_one(packed, charts):
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        xmls = [package.read(name).decode() for name in package.namelist() if name.startswith("xl/charts/chart")]
    xmls = [re.sub("<c:barChart>.*?</c:barChart>", "", xml) for xml in xmls]  # bars, also those below a line
    lined = [xml for xml in xmls if "<c:lineChart>" in xml or "<c:scatterChart>" in xml]
    assert lined
    for xml in lined:
        assert xml.count('<c:smooth val="0"/>') == xml.count("<c:ser>")
    for xml in charts["Share of trials accepted"]:
        top, step = (float(re.findall(rf'<c:{part} val="(.*?)"/>', xml)[-1]) for part in ("max", "majorUnit"))
        assert 0.0 < step < top <= 1.0


def test_the_minus_sign_of_an_axis_is_one_that_no_program_parts_from_its_number(packed):
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        xmls = [package.read(name).decode() for name in package.namelist() if name.startswith("xl/charts/chart")]
    formats = {result for xml in xmls for result in re.findall(r'<c:numFmt formatCode="([^"]*)" sourceLinked="0"', xml)}
    assert formats
    assert {results for results in formats if ";&quot;−&quot;" not in results} == set()


def test_no_more_than_noise_is_pale(make, opened):
    run = make.simulate(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+0*A2"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5), make.uniform("b", "A2", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1")],
    )
    with zipfile.ZipFile(io.BytesIO(packed_sheets(run, "Sensitivity"))) as package:
        xml = next(
            text
            for text in (package.read(n).decode() for n in package.namelist() if n.startswith("xl/charts/chart"))
            if "Variance explained" in text
        )
    colours = re.findall(r'<c:dPt>.*?<a:srgbClr val="(\w+)"', xml)
    assert colours == ["2F6DA8", "BCD3E8"]


def test_sobol_indices_stand_where_they_are_right(make, opened):
    run = make.simulate(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1*A2"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5), make.uniform("b", "A2", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1")],
    )
    sheet = opened(run, "Sensitivity")["Sensitivity"]
    each = sensitivities(run)["x"].influences[0]
    row = next(row for row in sheet.iter_rows(values_only=True) if row[0] == each.assumption and row[12])
    assert row[12:16] == (each.first_order.value, each.first_order.error, each.total.value, each.total.error)


def test_it_is_said_why_there_are_no_sobol_indices(book):
    messages = [str(row[0]) for row in book["Sensitivity"].iter_rows(values_only=True)]
    assert any(text.startswith("Sobol indices are not given: the filters reject trials") for text in messages)


def test_limits_stand_in_their_tables(book, result):
    rows = list(book["Filter limits"].iter_rows(values_only=True))
    for limit in result.filter_limits:
        for point in limit.points:
            share = (point.limit, point.trials, point.acceptance.value, point.acceptance.error)
            assert any(row[1:5] == share for row in rows)
            for answer in point.answers:
                estimates = (answer.mean, answer.change, answer.low, answer.high)
                numbers = tuple(number for each in estimates for number in (each.value, each.error))
                assert any(row[:10] == (answer.forecast, point.limit, *numbers) for row in rows)
        for slope in limit.slopes:
            assert any(row[0] == slope.forecast and row[1:3] == (slope.mean.value, slope.mean.error) for row in rows)


def test_limit_charts_draw_them(book, result, charts):
    for xml, limit in zip(charts["Change of each mean"], result.filter_limits, strict=True):
        limits = [point.limit for point in limit.points]
        assert drawn(book, xml, "xVal") == [limits] * len(result.forecasts)
        changes = [[point.answers[place].change.value for point in limit.points] for place in range(2)]
        assert drawn(book, xml, "yVal") == changes
    for xml, limit in zip(charts["Share of trials accepted"], result.filter_limits, strict=True):
        assert drawn(book, xml, "yVal") == [[point.acceptance.value for point in limit.points]]


def test_answers_in_different_units_are_drawn_as_shares_of_their_ranges(make):
    run = make.simulate(
        {"A1": 0.5, "B1": "=A1", "B2": "=A1*100"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1", units="ft"), make.forecast("y", "B2", units="mph")],
        [make.filter("f", "A1", below=0.6)],
    )
    packed = packed_sheets(run, "Filter limits")
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        texts = [package.read(n).decode() for n in package.namelist() if n.startswith("xl/charts/chart")]
    xml = next(text for text in texts if "Change of each mean" in text)
    assert "of the central range" in xml
    first, second = drawn(openpyxl.load_workbook(io.BytesIO(packed)), xml, "yVal")
    assert first == pytest.approx(second)


def test_of_many_forecasts_those_that_move_most_are_drawn(make):
    """Forecasts of one assumption move, those of another, which the filter leaves alone, do not."""
    moves = [2, 3, 5, 6, 8, 9]
    cells = {"A1": 0.5, "A2": 0.5} | {f"B{n}": f"=A{1 if n in moves else 2}*{n}" for n in range(1, 10)}
    run = make.simulate(
        cells,
        [make.uniform(name, cell, 0.0, 1.0, base=0.5) for name, cell in (("a", "A1"), ("b", "A2"))],
        [make.forecast(f"f{n}", f"B{n}", units=f"u{n}") for n in range(1, 10)],
        [make.filter("f", "A1", below=0.6)],
    )
    packed = packed_sheets(run, "Filter limits")
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        texts = [package.read(n).decode() for n in package.namelist() if n.startswith("xl/charts/chart")]
    (xml,) = (text for text in texts if "Change of the 6 means that move most" in text)
    book = openpyxl.load_workbook(io.BytesIO(packed))
    assert [name for name, *_ in drawn(book, xml, "tx") if name] == [f"f{n}" for n in moves]


@pytest.mark.parametrize(("limit", "unmoved"), [(0.5, False), (5.0, True)])
def test_changes_of_nothing_are_explained(make, limit, unmoved):
    """No trial is near a limit of 5, and 0 ± 0 is no certainty that none ever is."""
    run = make.simulate(
        {"A1": 0.5, "B1": "=A1*2", "C1": "=A1"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1")],
        [make.filter("f", "C1", at_most=limit)],
        trials=500,
    )
    (moved,) = sensitivities(run).filter_limits
    assert ("nothing moves" in moved_caption(moved)) == unmoved
    packed = packed_sheets(run, "Filter limits")
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        charts = [package.read(n).decode() for n in package.namelist() if n.startswith("xl/charts/chart")]
    assert any("Change of each mean" in xml for xml in charts) != unmoved  # an empty chart says nothing
    texts = [str(cell.value) for row in openpyxl.load_workbook(io.BytesIO(packed))["Filter limits"] for cell in row]
    assert any("so nothing moves" in text for text in texts) == unmoved


def test_what_is_noise_reads_noise_in_the_table(make, opened):
    run = make.simulate(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+0*A2"},
        [make.uniform("a", "A1", 0.0, 1.0, base=0.5), make.uniform("b", "A2", 0.0, 1.0, base=0.5)],
        [make.forecast("x", "B1")],
    )
    rows = {
        row[0].value: row
        for row in opened(run, "Sensitivity")["Sensitivity"].iter_rows()
        if row[0].value in ("a", "b") and row[9].value
    }
    noisy = {name: [row[place].number_format == NOISE for place in (2, 5, 8, 10)] for name, row in rows.items()}
    assert noisy == {"a": [False] * 4, "b": [True] * 4}
    assert all(isinstance(rows["b"][place].value, float) for place in (2, 5, 8, 10))
    assert str(blocks_html([influence_table(sensitivities(run)["x"], False)])).count(">noise<") == 4


def test_units_that_read_like_a_reference_stay_words(make):
    run = make.simulate(
        {"A1": 1.0, "B1": "=A1^2"},
        [make.uniform("a", "A1", 0.0, 2.0, base=1.0)],
        [make.forecast("f", "B1", units="Model!D50")],
        [make.filter("kept", "B1", at_least=0.5)],
    )
    with zipfile.ZipFile(io.BytesIO(packed_sheets(run, "Sensitivity", "Filter limits"))) as package:
        charts = [package.read(name).decode() for name in package.namelist() if name.startswith("xl/charts/chart")]
    assert [xml for xml in charts if ", Model!\N{WORD JOINER}D50</a:t>" in xml]
    assert {f for xml in charts for f in re.findall(r"<c:f>(.*?)</c:f>", xml) if "D50" in f} == set()


@pytest.mark.parametrize("name", ["Sensitivity", "Filter limits"])
def test_charts_come_first_and_the_tables_below_them_are_not_printed(book, name):
    sheet = book[name]
    last = int(sheet.print_area.rpartition("$")[2])
    rows = [chart.anchor._from.row + 1 for chart in sheet._charts]
    assert min(rows) < last < max(rows)
    heads = [row[0].row for row in sheet.iter_rows() if row[1].value in ("Units", "Value", "Limit")]
    assert heads
    assert min(heads) > last
