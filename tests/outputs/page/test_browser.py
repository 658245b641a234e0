"""The page in Chromium, its grabbers moved by a driver: the certainty shown is that of the accepted trials."""

from __future__ import annotations

import contextlib
import math
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from simulated import simulated

from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.statistics import format_estimate, proportion
from xlmc.montecarlo.statistics.estimate import t_quantile

CASE = Path(__file__).resolve().parents[3] / "examples" / "intersection.xlsx"
EVIL = "</script><img src=x onerror=window.stolen=1>"


@pytest.fixture
def many(make):
    """A run of more trials than the page holds of a forecast."""
    cells = {"A1": 0.5, "B1": "=A1*A1", "B2": "=A1*3"}
    forecasts = [make.forecast("square", "B1"), make.forecast("triple", "B2", units="m")]
    return make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts, trials=60_000)


@pytest.fixture(scope="module")
def other(make):
    """A second run with a forecast of `run`."""
    return make.simulate(
        {"A1": 2.0, "A4": 10.0, "B1": "=A1*8+A4"},
        [make.uniform("a", "A1", 0.0, 3.0, base=2.0)],
        [make.forecast("area", "B1", units="ft")],
        trials=3000,
    )


@pytest.fixture
def at_rest(opened, run):
    """`at_rest()`: the first forecast of `run` as it opens, for tests that change no more than its range and its view.

    They share one page, which is loaded again where another was opened since.
    """

    def ready():
        browser = opened(run)
        browser.execute_script(
            "for (const end of ['.views input', '.reset']) document.querySelector(end).click(); scrollTo(0, 0)"
        )
        chart = Chart(browser)
        assert chart.ends == tuple(end.value for end in run["area"].central())
        return chart

    return ready


@pytest.fixture
def opened(chromium, shown):
    """`opened(run)`: the page of a run in the browser, where it may be open since an earlier test."""

    def ready(run, **options):
        wanted = [id(run), *map(id, options.values())]
        if chromium.execute_script("return window.opened ?? null") != wanted:
            shown(run, **options).execute_script("window.opened = arguments[0]", wanted)
        return chromium

    return ready


READ = """
const root = arguments[0], said = root.querySelector(".certainty"), { low, high, count } = said.dataset;
const boxes = Object.fromEntries(["low", "high", "share"].map((key) => [key, root.querySelector(`.boxes .${key}`)]));
return {
  ends: [low, high], count, said: said.innerText.replaceAll("\\n", " "),
  boxes: Object.fromEntries(Object.entries(boxes).map(([key, box]) => [key, box.value])),
  faulty: Object.keys(boxes).filter((key) => boxes[key].getAttribute("aria-invalid") === "true"),
  fault: root.querySelector(".fault").innerText,
  lefts: Object.fromEntries(["low", "high"].map((which) => [which, left(which)])),
};
function left(which) { return root.querySelector(`.grabber.${which}`).getBoundingClientRect().x; }
"""
"""All that one forecast shows of its range, in one message to the browser: each takes some milliseconds."""

GRIP = """
const grip = arguments[0].querySelector(`.grabber.${arguments[1]} .grip`);
grip.scrollIntoView({ block: "center" });
return grip;
"""


class Chart:
    """One forecast on the page."""

    def __init__(self, browser, index=0):
        self.browser = browser
        self.root = self.all("article.forecast", browser)[index]

    def all(self, selector, within=None):
        return (within or self.root).find_elements("css selector", selector)

    def one(self, selector):
        (result,) = self.all(selector)
        return result

    def drag(self, which, pixels):
        from selenium.webdriver import ActionChains

        grip = self.browser.execute_script(GRIP, self.root, which)
        chain = ActionChains(self.browser, duration=1).click_and_hold(grip)
        chain.move_by_offset(pixels // 2, 0).move_by_offset(pixels - pixels // 2, 3).release().perform()

    def press(self, which, *keys):
        self.one(f".grabber.{which} .grip").send_keys(*keys)

    def type(self, box, text):
        control, delete, enter = "\ue009", "\ue017", "\ue007"
        self.one(f".boxes .{box}").send_keys(control, "a", control, delete, text, enter)

    def read(self):
        result = self.browser.execute_script(READ, self.root)
        return SimpleNamespace(**result | {"ends": tuple(map(float, result["ends"])), "count": float(result["count"])})

    @property
    def ends(self):
        return self.read().ends

    @property
    def count(self):
        return self.read().count

    @property
    def said(self):
        return self.read().said


def in_words(values, low, high):
    """The certainty as `xlmc.montecarlo.statistics` has it, in the words of the page."""
    count = int(np.count_nonzero((values >= low) & (values <= high)))
    share = proportion(count, values.size)
    known = f"{100 * share.value:.0f}" if share.value in (0.0, 1.0) else None
    return count, f"{known or format_estimate(100 * share.value, 100 * share.error)} %", share.interval


def check(chart, values):
    """What the page says of the range between its grabbers is what NumPy counts there."""
    read = chart.read()
    count, words, interval = in_words(values, *read.ends)
    assert read.count == count
    assert read.said.startswith(f"{words} of the accepted trials lie ")
    assert f": {count:,} of {values.size:,}; 95 % interval " in read.said
    result = re.search(r"interval (\S+) to (\S+) %", read.said)
    decimals = len(result[1].partition(".")[2])
    assert result[1] == f"{100 * interval[0]:.{decimals}f}"
    assert result[2] == f"{100 * interval[1]:.{decimals}f}"


def test_nothing_is_asked_of_a_network_and_nothing_could_be(chromium, opened, run, requests_of):
    chromium.get("about:blank")
    chromium.get_log("performance")
    address = opened(run).current_url
    chart = Chart(chromium)
    chart.drag("low", 20)
    chart.one(".views input[value=cumulative]").click()
    asked = set(requests_of(chromium))
    assert address in asked
    assert asked <= {address, "data:"}
    assert chromium.get_log("browser") == []
    refused = chromium.execute_async_script(
        """
        const done = arguments[0], refused = [];
        addEventListener("securitypolicyviolation", (event) => refused.push(event.effectiveDirective));
        fetch("https://example.org/").catch(() => 0);
        const image = Object.assign(new Image(), {src: "https://example.org/a.png"});
        const script = document.createElement("script");
        script.textContent = "window.stolen = 1";
        document.body.append(image, script);
        const look = () => {
          if (refused.length < 3) return setTimeout(look, 20);
          image.remove();
          script.remove();
          done([refused.sort(), window.stolen ?? null]);
        };
        look();
        """
    )
    assert refused == [["connect-src", "img-src", "script-src-elem"], None]
    chromium.get_log("browser")


def test_it_opens_at_the_central_range(at_rest, run):
    browser = at_rest().browser
    for index, result in enumerate(run.results.values()):
        chart = Chart(browser, index)
        check(chart, result.values)
        read = chart.read()
        assert read.ends == tuple(end.value for end in result.central())
        assert read.boxes["share"] == "51"
        for box, end in zip(("low", "high"), result.central(), strict=True):
            assert read.boxes[box] == format_estimate(end.value, end.error).partition(" ± ")[0]


@pytest.mark.parametrize(("which", "pixels"), [("low", 60), ("low", -45), ("high", -70), ("high", 33)])
def test_certainty_follows_a_dragged_grabber(at_rest, run, which, pixels):
    chart, values = at_rest(), run["area"].values
    before = chart.read()
    chart.drag(which, pixels)
    after = chart.read()
    moved, still = (0, 1) if which == "low" else (1, 0)
    assert (after.ends[moved] - before.ends[moved]) * pixels > 0
    assert after.ends[still] == before.ends[still]
    assert after.lefts[which] == pytest.approx(before.lefts[which] + pixels, abs=3)  # the step that ends move in
    assert float(after.boxes[which]) == after.ends[moved]
    assert after.boxes["share"] == in_words(values, *after.ends)[1].split(" ")[0]
    check(chart, values)


def test_a_grabber_does_not_pass_the_other(at_rest, run):
    chart = at_rest()
    chart.drag("low", 400)
    low, high = chart.ends
    assert low == high
    check(chart, run["area"].values)


def test_a_grabber_at_the_edge_takes_in_all_that_lies_beyond(at_rest, run):
    chart, values = at_rest(), run["area"].values
    edges, lefts = chart.one(".u-over").rect, chart.read().lefts
    chart.drag("low", round(edges["x"] - lefts["low"]) - 5)
    chart.drag("high", round(edges["x"] + edges["width"] - lefts["high"]) + 5)
    read = chart.read()
    assert read.ends == (-np.inf, np.inf)
    assert (read.boxes["low"], read.boxes["high"]) == ("−∞", "∞")
    check(chart, values)
    assert f"{values.size:,} of {values.size:,}" in read.said


def test_grabbers_move_with_the_keyboard(at_rest, run):
    chart, values = at_rest(), run["area"].values
    chart.type("low", "14")
    grip = chart.one(".grabber.low .grip")
    for keys, end in (
        (["\ue014"], 14.01),  # right
        (["\ue014", "\ue014"], 14.03),
        (["\ue012"], 14.02),  # left
        (["\ue00e"], 14.12),  # page up
        (["\ue00f"], 14.02),  # page down
        (["\ue008", "\ue014"], 14.12),  # shift and right
    ):
        chart.press("low", *keys)
        read = chart.read()
        assert read.ends[0] == pytest.approx(end, abs=1e-12)
        assert grip.get_dom_attribute("aria-valuetext") == read.boxes["low"]
        check(chart, values)
    chart.press("low", "\ue011")  # home
    chart.press("high", "\ue010")  # end
    assert chart.ends == (-np.inf, np.inf)
    check(chart, values)


def test_a_typed_certainty_sets_a_central_range(at_rest, run):
    chart, values = at_rest(), run["area"].values
    for percent in ("90", "51", "0", "0.5", "99.7", "100", "33.3 %"):
        chart.type("share", percent)
        share = float(percent.split(" ")[0])
        wanted = np.percentile(values, [50 - share / 2, 50 + share / 2])
        read = chart.read()
        assert read.ends == pytest.approx(wanted, rel=1e-12)
        assert float(read.boxes["share"]) == share
        check(chart, values)


def test_typed_ends_are_taken_as_they_are(at_rest, run):
    chart, values = at_rest(), run["area"].values
    chart.type("low", "13.25")
    chart.type("high", "1.9e1")
    read = chart.read()
    assert read.ends == (13.25, 19.0)
    assert read.lefts["low"] < read.lefts["high"]
    check(chart, values)
    chart.type("high", "")
    assert chart.ends == (13.25, np.inf)
    check(chart, values)


@pytest.mark.parametrize(
    ("box", "text", "why"),
    [
        ("low", "many", "Type a number."),
        ("low", "99", "must not lie above"),
        ("high", "1,5,1", "Type a number."),
        ("share", "101", "between 0 and 100"),
        ("share", "", "Type a number."),
    ],
)
def test_what_cannot_be_meant_is_refused_and_said(at_rest, box, text, why):
    chart = at_rest()
    before = chart.read()
    chart.type(box, text)
    refused = chart.read()
    assert why in refused.fault
    assert refused.faulty == [box]
    assert (refused.ends, refused.said) == (before.ends, before.said)
    assert at_rest().read() == before
    assert (before.fault, before.faulty) == ("", [])


def test_the_button_returns_to_the_central_range(at_rest):
    chart = at_rest()
    before = chart.read()
    chart.type("low", "12")
    assert chart.ends != before.ends
    chart.one(".reset").click()
    assert chart.read() == before


def test_another_chart_leaves_the_grabbers_where_they_are(at_rest, run):
    chart, values = at_rest(), run["area"].values
    for view in ("cumulative", "reverse"):
        chart.drag("low", -40)
        before = chart.read()
        chart.one(f".views input[value={view}]").click()
        after = chart.read()
        assert after.ends == before.ends
        assert list(after.lefts.values()) == pytest.approx(list(before.lefts.values()), abs=2)
        chart.drag("high", 20)
        assert chart.ends[1] > before.ends[1]
        check(chart, values)


def test_the_pointer_is_told_what_it_is_at(at_rest, run):
    from selenium.webdriver import ActionChains

    chart, values = at_rest(), run["area"].values
    over = chart.one(".u-over")
    chart.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", over)
    ActionChains(chart.browser).move_to_element(over).perform()
    result = re.fullmatch(r"(\S+) to below (\S+) ft: (\S+) trials, (\S+) %", chart.one(".readout").text)
    inside = np.count_nonzero((values >= float(result[1])) & (values < float(result[2])))
    assert int(result[3]) == inside
    assert result[4] == f"{100 * inside / values.size:.2f}"
    chart.one(".views input[value=cumulative]").click()
    ActionChains(chart.browser).move_to_element_with_offset(chart.one(".u-over"), 30, 0).perform()
    assert re.fullmatch(r"Up to \S+ ft: \S+ ± \S+ %", chart.one(".readout").text)


@pytest.mark.parametrize("trials", [1, 7, 40, 2499, 10**7])
def test_shares_are_those_of_the_statistics(at_rest, trials):
    """For any count, as for the few of which one may be dragged to: the same value, error and interval."""
    counts = sorted({count for few in range(14) for count in (few, trials - few, trials * few // 13) if few <= trials})
    script = "return arguments[0].map(count => shareOf(count, arguments[1], arguments[2]))"
    messages = at_rest().browser.execute_script(script, counts, trials, t_quantile(math.inf, 0.95))
    for count, share in zip(counts, messages, strict=True):
        expected = proportion(count, trials)
        known = (share["value"], share["error"], share["low"], share["high"])
        assert known == pytest.approx((expected.value, expected.error, *expected.interval), rel=1e-9, abs=1e-15)


def test_a_fitted_distribution_is_drawn_and_named(at_rest):
    from selenium.webdriver.support.select import Select

    chart = at_rest()
    browser = chart.browser
    fits = Select(chart.one("select.fit"))
    pixels = "return arguments[0].querySelector('canvas').toDataURL()"
    for view in ("frequency", "cumulative", "reverse"):
        chart.one(f".views input[value={view}]").click()
        fits.select_by_index(0)
        assert chart.one(".fitted").text == ""
        before, certainty = browser.execute_script(pixels, chart.root), chart.said
        fits.select_by_index(1)
        assert browser.execute_script(pixels, chart.root) != before
        assert chart.one(".fitted").text.startswith(f"Red line: {fits.options[1].text} (")
        assert chart.said == certainty
    fits.select_by_index(0)
    points = browser.execute_script(
        "return fittedLine({ shares: [0, 0.25, 0.5, 0.75, 1], parts: 2 }, { edges: [0, 2, 4] }, 100, 1, 'frequency')"
    )
    assert points == [[0.5, 50], [1.5, 50], [2.5, 50], [3.5, 50]]  # a uniform one: 50 trials in either bar


def test_a_table_is_copied_as_a_table(at_rest):
    browser = at_rest().browser
    browser.execute_script(
        "window.copied = null;"
        "document.addEventListener('copy', () => { copied = String(getSelection()); }, { capture: true })"
    )
    browser.find_element("css selector", "#answer button.copy").click()
    lines = [line for line in browser.execute_script("return copied").splitlines() if line.strip()]
    assert lines[0].split("\t")[0] == "Forecast"
    assert any(line.startswith("area\t") for line in lines)
    assert browser.execute_script("return String(getSelection())") == ""


def test_the_links_to_the_parts_stay_in_sight(at_rest):
    browser = at_rest().browser
    browser.execute_script("document.getElementById('record').scrollIntoView()")
    top = "return Math.round(document.querySelector('nav').getBoundingClientRect().top)"
    assert browser.execute_script(top) == 0
    heading = "return document.querySelector('#record h2').getBoundingClientRect().top"
    height = "return document.querySelector('nav').getBoundingClientRect().height"
    assert browser.execute_script(heading) >= browser.execute_script(height) - 1


def test_on_paper_is_what_is_open_and_nothing_is_to_be_pressed(at_rest):
    browser = at_rest().browser
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        for selector, displayed in (("details[open] summary", True), ("details:not([open]) summary", False)):
            result = browser.find_elements("css selector", selector)
            assert result
            assert {each.is_displayed() for each in result} == {displayed}
        for selector in ("nav", ".boxes", ".reset", ".views"):
            assert not browser.find_element("css selector", selector).is_displayed()
        for selector in (".chart canvas", ".certainty", "#statistics table", ".readout", ".overlay .legend"):
            assert browser.find_element("css selector", selector).is_displayed()
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def test_a_narrow_screen_needs_no_scrolling_aside(at_rest, run):
    browser = at_rest().browser
    metrics = {"width": 360, "height": 740, "deviceScaleFactor": 1, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    try:
        chart = Chart(browser)
        browser.execute_async_script(
            "const wide = () => innerWidth > 360 || document.documentElement.scrollWidth > 360;"
            "const look = () => wide() ? setTimeout(look, 20) : arguments[0]();"
            "requestAnimationFrame(look)"
        )
        chart.drag("low", 20)
        check(chart, run["area"].values)
    finally:
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_all_tables_are_opened_and_closed_at_once(opened, run):
    browser = opened(run)
    count = "return document.querySelectorAll('details%s').length"
    for key, left in (("open", ":not([open])"), ("closed", "[open]")):
        assert browser.execute_script(count % left) > 0
        browser.find_element("css selector", f"button[data-all={key}]").click()
        assert browser.execute_script(count % left) == 0


def test_every_chart_is_saved_as_a_picture_with_its_own_styles(opened, run):
    browser = opened(run)
    browser.execute_script(
        "window.saved = []; window.follow = HTMLAnchorElement.prototype.click;"
        "HTMLAnchorElement.prototype.click = function () { saved.push([this.download, this.href]); }"
    )
    buttons = [each for each in browser.find_elements("css selector", "button.copy") if each.text == "Save picture"]
    charts = browser.find_elements("css selector", ".chart, svg.drawn")
    assert len(buttons) == len(charts) > 3
    for button in buttons:
        browser.execute_script("arguments[0].click()", button)
    names = browser.execute_async_script(
        "const [wanted, done] = arguments;"
        "const look = () => saved.length < wanted ? setTimeout(look, 20) : done(saved.map(([name]) => name));"
        "look()",
        len(charts),
    )
    assert {"area-Variance-explained.svg", "area-chart.png"} <= set(names)
    drawn = dict(browser.execute_script("return saved"))["area-Variance-explained.svg"]
    blobs = "return Copies.standalone(document.querySelector('svg.drawn')).text()"
    svg = browser.execute_script(blobs)
    assert drawn.startswith("blob:")
    assert svg.startswith("<svg")
    assert "--dark: #2f6da8" in svg
    assert "Variance explained" in svg
    browser.execute_script("HTMLAnchorElement.prototype.click = window.follow")


def test_bars_are_drawn_together_and_percentiles_marked(at_rest, run):
    chart = at_rest()
    browser = chart.browser
    merged = browser.execute_script("return merged({ edges: [0, 1, 2, 3], counts: [5, 6, 7] }, 2)")
    assert (merged["edges"], merged["counts"]) == ([0, 2, 3], [11, 7])
    pixels = "return arguments[0].querySelector('canvas').toDataURL()"
    before, certainty = browser.execute_script(pixels, chart.root), chart.said
    chart.one("select.together").send_keys("four")
    after = browser.execute_script(pixels, chart.root)
    assert after != before
    assert chart.said == certainty
    chart.one("input.percentiles").send_keys("5, 50;95 %\t")
    assert browser.execute_script(pixels, chart.root) != after
    shown_at = dict(re.findall(r"· · (\d+) % ([-\d.]+)", chart.one(".readout").text))
    for percent, text in shown_at.items():
        exact = np.percentile(run["area"].values, float(percent))
        assert float(text) == pytest.approx(exact, abs=0.01 * np.ptp(run["area"].values))
    assert sorted(shown_at, key=float) == ["5", "50", "95"]
    message = chart.one(".readout").text
    chart.one("input.percentiles").send_keys(", half\t")
    assert "from 0 to 100" in chart.one(".fault").text
    assert chart.one(".readout").text == message
    assert "Mean" in message
    chart.one("input.line[value=Mean]").click()
    assert "Mean" not in chart.one(".readout").text
    browser.execute_script("window.opened = null")  # nobody shall find it so


def test_many_trials_are_counted_to_within_what_is_said(shown, many):
    browser = shown(many)
    for index, result in enumerate(many.results.values()):
        chart, values = Chart(browser, index), result.values
        check(chart, values)  # the forecast's own range is exact
        for step in (35, -61, 17):
            chart.drag("low", step)
            read = chart.read()
            doubt = int(re.search(r"about .* off by (\d+) at most", read.said)[1])
            exact, _, _ = in_words(values, *read.ends)
            assert abs(read.count - exact) <= doubt <= 2 * values.size / 19_999
        chart.type("share", "80")
        wanted = np.percentile(values, [10, 90])
        # a gap holds at most two trials, whose distance is some 1/60,000 of the range
        assert chart.ends == pytest.approx(wanted, rel=1e-3)


def test_whole_numbers_move_in_whole_steps_and_belong_to_the_range_that_ends_at_them(shown, make):
    assumptions = [make.uniform("a", "A1", 0.0, 10.0, base=5.0)]
    run = make.simulate({"A1": 5.0, "B1": "=ROUND(A1,0)"}, assumptions, [make.forecast("whole", "B1")], trials=3000)
    chart, values = Chart(shown(run)), run["whole"].values
    chart.type("low", "3")
    chart.type("high", "6")
    check(chart, values)
    chart.press("high", "\ue014")
    assert chart.ends == (3.0, 7.0)
    check(chart, values)
    chart.drag("low", 60)
    assert chart.ends[0] == 4.0
    check(chart, values)
    from selenium.webdriver import ActionChains

    grip, over = chart.one(".grabber.high .grip"), chart.one(".u-over")
    ActionChains(chart.browser).move_to_element(grip).move_by_offset(0, -over.rect["height"] // 2).perform()
    seven = int(np.count_nonzero(values == 7))
    assert chart.one(".readout").text == f"7: {seven} trials, {100 * seven / values.size:.2f} %"


def test_names_are_shown_and_not_run(shown, make):
    assumptions = [make.uniform(EVIL, "A1", 0.0, 1.0, base=0.5, units=EVIL, source=EVIL)]
    forecasts = [make.forecast(EVIL, "B1", units=EVIL), make.forecast(f"{EVIL}2", "B1", units=EVIL)]
    filters = [make.filter(EVIL, "B1", at_most=0.9, because=EVIL)]
    browser = shown(make.simulate({"A1": 0.5, "B1": "=A1"}, assumptions, forecasts, filters, trials=500))
    chart = Chart(browser)
    chart.drag("low", 10)
    assert EVIL in chart.said
    assert chart.one("h3").text == EVIL
    assert EVIL in browser.find_element("css selector", "#overlay .legend").text
    assert browser.execute_script("return [document.images.length, window.stolen ?? null]") == [0, None]


@pytest.mark.parametrize("name", ["none_accepted", "one_accepted"])
def test_few_trials_are_no_trouble(request, shown, name):
    run = request.getfixturevalue(name)
    browser = shown(run)
    charts = browser.find_elements("css selector", "article.forecast")
    assert len(charts) == (0 if name == "none_accepted" else 1)
    if charts:
        chart = Chart(browser)
        assert chart.count == 1
        chart.drag("high", -50)
        chart.type("share", "50")
        assert chart.count == 1


def test_a_second_run_is_drawn_and_counted(opened, run, other):
    browser = opened(run, beside=other)
    chart = Chart(browser)
    for low, high in ((chart.ends), (12.0, 20.0)):
        chart.type("low", str(low))
        chart.type("high", str(high))
        check(chart, run["area"].values)
        count, words, _ = in_words(other["area"].values, *chart.ends)
        assert chart.one(".second").text == f"Second run: {words} ({count:,} of 3,000)."
    line = browser.execute_script(
        "return secondLine(new Trials({ trials: 4, values: [0, 1, 1.5, 3], counts: null, gaps: null }), "
        "{ edges: [0, 1, 2, 3, 4] }, 8, 'frequency')"
    )
    assert line == [[0, 0], [0, 2], [1, 2], [1, 4], [2, 4], [2, 0], [3, 0], [3, 2], [4, 2], [4, 0]]


def test_pictures_are_copied_and_tables_saved(opened, run, other):
    browser = opened(run, beside=other)
    browser.execute_cdp_cmd(
        "Browser.grantPermissions", {"permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"]}
    )
    for what in (
        "Copies.onWhite(document.querySelector('.chart canvas'))",
        "Copies.painted(document.querySelector('svg.drawn'))",
    ):
        copied = f"Copies.copyPicture(async () => {what}).then(arguments[0])"
        assert browser.execute_async_script(copied) is True
    browser.execute_script(
        "window.saved = []; Copies.save = (blob, name) => blob.text().then((text) => saved.push([name, text]));"
        "const buttons = [...document.querySelectorAll('#second button')];"
        "buttons.filter((each) => each.textContent === 'Save table').forEach((each) => each.click())"
    )
    [(name, text), *_] = browser.execute_async_script(
        "const look = () => saved.length ? arguments[0](saved) : setTimeout(look, 20); look()"
    )
    assert name == "Beside-a-second-run.csv"
    lines = [line.split(",") for line in text.splitlines()]
    assert lines[0][-3:] == ["First", "Second", "Difference"]
    assert [line[2] for line in lines[1:3]] == ["Mean", "Standard deviation"]  # the name stands in each line
    assert {(line[0], line[1]) for line in lines[1:]} == {('"area', ' ft"')}


def test_the_case_study_prints_on_15_pages(shown):
    """There is no sixteenth one: to ask for that alone takes half as long as to print all."""
    from selenium.common.exceptions import WebDriverException

    browser = shown(simulated(load(CASE), trials=50_000))
    with pytest.raises(WebDriverException, match="Page range exceeds page count"):
        browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "pageRanges": "16"})


def test_a_browser_that_ended_costs_no_other_test(browser, monkeypatch):
    """A machine without memory ends one or its driver; what comes after gets a new one."""
    from selenium.common.exceptions import WebDriverException

    first = browser()
    assert browser() is first
    started = []
    with monkeypatch.context() as patch:  # a start takes seconds, and the next test that needs one has it anyway
        patch.setattr(browser, "_started", lambda: started.append(browser._running))
        with contextlib.suppress(WebDriverException):  # it may end before it has answered
            first.execute_cdp_cmd("Browser.close", {})
        assert not browser._answers()
        first.service.process.kill()
        first.service.process.wait()
        assert not browser._answers()
        assert browser() is None
    assert started == [None]


def test_a_large_page_opens_its_parts_and_finds_forecasts(chromium, shown, make, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.page.html_page._LARGE", 0)
    assumptions = [make.uniform("x", "A1", 0.0, 1.0, base=0.5)]
    forecasts = [make.forecast(f"output {j}", f"B{j + 1}") for j in range(20)]
    cells = {"A1": 0.5} | {f"B{j + 1}": f"=A1*{j + 1}" for j in range(20)}
    browser = shown(make.simulate(cells, assumptions, forecasts, trials=200))
    number = "return document.querySelectorAll(arguments[0]).length"
    assert browser.execute_script(number, ".chart canvas") < 20  # those in view alone
    assert browser.execute_script(number, "#sensitivity svg") == 0
    browser.execute_script("document.querySelector('button[data-all=open]').click()")
    opened = "const done = arguments[0], look = () => document.querySelector('[data-packed]') ? setTimeout(look, 20)"
    browser.execute_async_script(f"{opened} : done(); look()")
    assert browser.execute_script(number, "#sensitivity svg") > 0
    box = browser.find_element("css selector", "#forecasts input[type=search]")
    box.send_keys("output 17")
    assert browser.execute_script(number, ".forecast:not([hidden])") == 1
    assert browser.execute_script(number, ".index a:not([hidden])") == 1
