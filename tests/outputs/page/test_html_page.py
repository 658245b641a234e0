from __future__ import annotations

import base64
import gzip
import hashlib
import re

import pytest
from fewer_sheets import leave_out_fits
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.api import Simulation
from xlmc.errors import WorkbookError
from xlmc.montecarlo.columns import column_store, on_disk
from xlmc.outputs.page import html_page, page_text, payload, save_page
from xlmc.outputs.summary import error_sentence

RUNS = ["run", "none_accepted", "one_accepted"]
EVIL = "</script><img src=x onerror=alert(1)>"
MOST_BYTES = 3_000_000


def numbers_of(sheet):
    return sorted(
        float(value) for row in sheet.iter_rows(values_only=True) for value in row if type(value) in (int, float)
    )


@pytest.mark.parametrize("name", RUNS)
def test_the_page_is_well_formed_and_asks_for_nothing(request, page_of, name):
    page = page_of(request.getfixturevalue(name))
    for node in page.all():
        for key, value in node.attributes.items():
            assert key != "src", node
            assert not key.startswith("on"), node
            if key == "href":
                assert value == "data:," or value.startswith("#"), node
                assert value == "data:," or page.all(id=value[1:]), value
    assert not re.search(r"@import|url\(", "".join(style.text for style in page.all("style")))


@pytest.mark.parametrize("name", RUNS)
def test_the_policy_allows_what_is_in_it_and_nothing_else(request, page_of, name):
    page = page_of(request.getfixturevalue(name))
    (meta,) = page.all("meta", http_equiv="Content-Security-Policy")
    policy = dict(part.split(" ", 1) for part in meta.attributes["content"].split("; "))
    assert policy["default-src"] == "'none'"
    for kind, tag in (("script-src", "script"), ("style-src", "style")):
        inner = [node.text for node in page.all(tag) if node.attributes.get("type") != "application/json"]
        hashes = [f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in inner]
        assert policy[kind].split(" ") == hashes
    assert set(policy) == {"default-src", "script-src", "style-src", "img-src", "base-uri", "form-action"}
    assert not [node for node in page.all() if "style" in node.attributes]


@pytest.mark.parametrize("name", RUNS[1:])
def test_the_same_run_gives_the_same_page(request, text_of, name):
    run = request.getfixturevalue(name)
    assert page_text(run) == text_of(run)


def test_another_run_threads_and_results_on_disk_give_the_same_page(run, text_of, monkeypatch):
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    again = simulated(run.model, jobs=2)
    assert on_disk(again.trial_index)
    assert page_text(again) == text_of(run)


def test_the_answer_says_what_its_errors_mean(run, page_of):
    assert error_sentence(run.model.workbook) in page_of(run).all("section", id="answer")[0].text


def test_no_line_ends_between_a_number_and_its_percent_sign_or_error(text_of, run):
    page = re.sub(r"<(script|style|code|svg)\b.*?</\1>|<[^>]*>", "", text_of(run), flags=re.DOTALL)
    assert len(re.findall(r"\d\u00a0%", page)) > 20
    assert not re.search(r"\d %|± \d", page)


def test_assumptions_are_the_numbers_of_the_sheet(run, book, page_of):
    (section,) = page_of(run).all("section", id="assumptions")
    of_sheet = numbers_of(book["Assumptions"])
    for number in section.numbers:
        assert number in of_sheet
    assert "frozen" in section.text
    assert "not needed" in section.text


def test_the_record_is_the_whole_record(run, page_of, monkeypatch):
    leave_out_fits(monkeypatch)
    (section,) = page_of(run, command="xlmc simulate it").all("section", id="record")
    record = make_record(run, "xlmc simulate it")
    result = {node.attributes["data-key"]: node.text for node in section.all("dd")}
    assert len(section.all("details")) == len(record.sections)
    for part in record.sections:
        for entry in part.entries:
            shown = result[f"{part.key}.{entry.key}"]
            if isinstance(entry.value, (int, float)) and not isinstance(entry.value, bool):
                assert float(shown) == entry.value
            elif isinstance(entry.value, str) and entry.value:
                assert shown == entry.value
        if part.table is not None and part.table.rows:
            (details,) = section.all("details", data_section=part.key)
            assert len(details.all("tr")) == len(part.table.rows) + 1


def test_warnings_come_first(none_accepted, page_of):
    (section,) = page_of(none_accepted).all("section", id="answer")
    warning = section.all("p", class_="warning")[0]
    assert warning.text.startswith("Do not use these results as they are: no trial was accepted")
    assert [child for child in section.children if child != "\n"].index(warning) == 1


def test_names_are_never_markup(make, page_of, monkeypatch):
    leave_out_fits(monkeypatch)
    odd = [EVIL, "a'b\"c<d>&[e]", "$title ${data} $", "\u202eright to left"]
    cells = {f"A{n}": 0.5 for n in range(1, 5)} | {f"B{n}": f"=A{n}*2" for n in range(1, 5)}
    cells |= {f"C{n}": f"=A{n}" for n in range(1, 5)}
    numbered = list(enumerate(odd, 1))
    run = make.simulate(
        cells,
        [
            make.uniform(name, f"A{n}", 0.0, 1.0, base=0.5, units=name, source=name, notes={name: name})
            for n, name in numbered
        ],
        [make.forecast(name, f"B{n}", units=name, threshold=1.0, notes={name: name}) for n, name in numbered],
        [make.filter(name, f"C{n}", at_most=0.9, because=name) for n, name in numbered],
        trials=200,
    )
    page = page_of(run)
    assert page.all("img") == []
    assert len(page.all("script")) == len(page_of(make.simulate(*_plain(make))).all("script"))
    heads = {node.text for node in page.all("th")}
    assert set(odd) <= heads
    assert {node.text for node in page.all("h3")} >= set(odd)


def _plain(make):
    return {"A1": 0.5, "B1": "=A1"}, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("x", "B1")]


def test_it_is_written_whole_and_replaced(none_accepted, text_of, tmp_path):
    path, text = tmp_path / "page.html", text_of(none_accepted)
    assert save_page(none_accepted, path, command="old") == path
    assert save_page(none_accepted, path) == path
    assert path.read_text("utf-8").startswith(text)
    assert path.read_text("utf-8").removeprefix(text).startswith("\n<!-- xlmc-seal book=")
    assert list(tmp_path.iterdir()) == [path]


def test_half_a_surrogate_pair_can_be_written(make, tmp_path):
    cells, assumptions, _ = _plain(make)
    Simulation(make.simulate(cells, assumptions, [make.forecast("\ud800", "B1")], trials=10)).save_page(
        tmp_path / "p.html"
    )
    assert "&#55296;" in (tmp_path / "p.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("page.xlsx", "must end in .html.*'page.html'"),
        ("page", "must end in .html"),
        ("missing/page.html", "no folder"),
    ],
)
def test_where_a_page_cannot_go(run, tmp_path, name, message):
    with pytest.raises(WorkbookError, match=message):
        save_page(run, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("forecasts", "trials"), [(1, 60_000), (50, 2000)])
def test_large_runs_stay_small(make, monkeypatch, forecasts, trials):
    """The forecasts are multiples of the first, and the fits of all are as long as its own."""
    fits, result = payload.fitted_curves, []
    monkeypatch.setattr(payload, "fitted_curves", lambda *given: result or result.extend(fits(*given)) or result)
    cells = {"A1": 0.5} | {f"B{n}": f"=A1*{n}/3" for n in range(1, forecasts + 1)}
    asked = [make.forecast(f"f{n}", f"B{n}") for n in range(1, forecasts + 1)]
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], asked, trials=trials)
    assert len(page_text(run).encode()) < MOST_BYTES


def test_statistics_stand_beside_each_chart(page_of, run):
    page = page_of(run)
    for article, result in zip(page.all("article", class_="forecast"), run.results.values(), strict=True):
        (table,) = article.all("table", class_="beside")
        results = result.statistics
        expected = [results.mean, results.standard_deviation, results.minimum]
        expected += [*(results.percentiles[each] for each in (5.0, 25.0, 50.0, 75.0, 95.0)), results.maximum]
        values = [float(node.attributes["value"]) for node in table.all("data")]
        assert values == [each.value for each in expected]


def test_a_large_page_packs_what_it_shows_when_asked(run, page_of, monkeypatch):
    whole = page_text(run)
    monkeypatch.setattr(html_page, "_LARGE", 0)
    packed = page_text(run)
    assert len(packed) < len(whole)
    result = re.findall(r'data-packed="([^"]+)"', packed)
    sections = [gzip.decompress(base64.b64decode(each)).decode() for each in result]
    assert len(sections) == 6
    assert [each for each in sections if each not in whole] == []
    data = re.search(r'id="payload">"([^"]+)"</script>', packed)[1]
    assert gzip.decompress(base64.b64decode(data)).decode() in whole


def test_many_assumptions_and_forecasts_make_no_heavy_page(make):
    assumptions = [make.uniform(f"input {i}", f"A{i + 1}", 0.9 + i, 1.1 + i) for i in range(300)]
    cells = {f"A{i + 1}": 1.0 + i for i in range(300)}
    sums = {f"B{j + 1}": "=" + "+".join(f"{n + 1}*A{1 + (7 * j + 11 * n) % 300}" for n in range(12)) for j in range(60)}
    forecasts = [make.forecast(f"output {j}", f"B{j + 1}", units="m") for j in range(60)]
    text = page_text(make.simulate(cells | sums, assumptions, forecasts, trials=1000))
    assert len(text) < 3_000_000
    assert len(re.findall(r"<[a-z]", text)) < 15_000
