from __future__ import annotations

import pytest

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.outputs.document.content.sensitivity import BARS
from xlmc.outputs.document.element import EMPTY
from xlmc.outputs.page.sensitivity_sections import dependence, limits


@pytest.fixture(scope="module")
def result(run):
    return sensitivities(run)


def test_each_forecast_has_its_drawings_and_numbers(run, result, page_of):
    (section,) = page_of(run).all("section", id="sensitivity")
    articles = section.all("article")
    assert [article.all("h3")[0].text for article in articles] == list(run.results)
    for article, each in zip(articles, result.forecasts, strict=True):
        assert len(article.all("svg")) == 3
        labels = [svg.attributes["aria-label"].split(": ") for svg in article.all("svg")]
        assert [title for title, _ in labels] == [
            "Variance explained",
            "Contribution to variance (approximate)",
            "Tornado",
        ]
        assert labels[0][1].split(", ") == [influence.assumption for influence in each.influences[:BARS]]
        assert labels[2][1].split(", ") == [bar.assumption for bar in each.bars[:BARS]]
        for influence in each.influences:
            assert influence.explained.value in article.numbers


def test_each_limit_is_moved(run, result, page_of):
    (section,) = page_of(run).all("section", id="limits")
    assert len(section.all("article")) == len(result.filter_limits) == 3
    for article, limit in zip(section.all("article"), result.filter_limits, strict=True):
        assert limit.filter in article.all("h3")[0].text
        for point in limit.points:
            assert point.limit in article.numbers
        if limit.points:
            assert len(article.all("svg")) == 1  # both forecasts are in ft


def test_nothing_to_say_is_no_section(make, page_of):
    assumptions = [make.uniform("a", "A1", 0.0, 1.0, frozen=True, base=0.5)]
    run = make.simulate({"A1": 0.5, "B1": "=A1*2"}, assumptions, [make.forecast("x", "B1")], trials=50)
    result = sensitivities(run)
    assert limits(result) == EMPTY
    assert dependence(result, run.model.workbook) != EMPTY
    page = page_of(run)
    assert page.all("section", id="limits") == []
    assert "No assumption moves it." in page.all("section", id="sensitivity")[0].text
