"""The window in Chromium: every control is clicked, dragged, typed into and read, and by keys alone."""

from __future__ import annotations

import json
import threading
import time
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from xml.etree import ElementTree

import openpyxl
from live_books import book_of_dates, book_of_decisions, book_of_readings, simple, wide_book
from openpyxl.worksheet.table import Table
from simulated import simulated
from websockets.sync.server import serve

from xlmc.montecarlo.definitions.scenarios import Frozen, Limits, Numbers
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.server import bound_socket

FRICTION, DISTANCE = "Vehicle 1 friction on wet asphalt", "Vehicle 1 post-impact travel distance to rest"
WIDTHS = ((1400, 1000), (1280, 900), (1024, 800), (768, 1024), (390, 844), (375, 812))
LOOKED_AT = {
    (1400, "charts"),
    (1280, "matters"),
    (1024, "pairs"),
    (1024, "step"),
    (375, "step"),
    (768, "tables"),
    (390, "scenarios"),
    (375, "studies"),
}
"""By axe, which takes three seconds a look."""

EVIL = "<img src=x onerror=window.stolen=1>"

AXE = next(
    (
        path
        for folder in (Path(__file__).resolve().parents[3] / ".venv" / "validator", Path("/usr/share/nodejs"))
        if (path := folder / "node_modules" / "axe-core" / "axe.min.js").exists()
    ),
    None,
)
"""`npm install --prefix .venv/validator axe-core@4.10.2` brings it."""


class Page:
    """The window of a server in the browser."""

    def __init__(self, browser, server):
        self.browser, self.server = browser, server
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        browser.get(server.server.link)
        self.loaded()

    def run(self, script, *given):
        return self.browser.execute_script(script, *given)

    def until(self, condition):
        """Wait for something: the page looks itself, which is cheaper than to be asked."""
        result = self.browser.execute_async_script(
            "const done = arguments[0], end = Date.now() + 100_000;"
            f"const look = () => {{ if ({condition}) done(true); else if (Date.now() > end) done(false);"
            " else setTimeout(look, 10); };"
            "look();"
        )
        assert result, condition

    def loaded(self):
        """Wait for the first answer of a window that is being opened."""
        end = time.monotonic() + 120
        while not self.run("return document.body?.dataset.stage === 'rest' && Live.state !== undefined"):
            assert time.monotonic() < end
            time.sleep(0.03)

    def at_rest(self, do):
        """Do something that changes the state, and wait for its answer: each move has one, or a newer one has."""
        before = int(self.run("return document.body.dataset.version"))
        do()
        self.until(
            f"Number(document.body.dataset.version) > {before} && document.body.dataset.stage === 'rest'"
            " && Live.state.version === Number(document.body.dataset.version) && Live.moves.size === 0"
        )

    def all(self, selector):
        return self.browser.find_elements("css selector", selector)

    def one(self, selector):
        (result,) = self.all(selector)
        return result

    def of(self, selector, condition, *given):
        """The first element that fits: one question to the browser, and not one for each element."""
        result = self.run(
            f"const [all, ...given] = arguments; "
            f"return [...document.querySelectorAll(all)].find((each) => {condition})",
            selector,
            *given,
        )
        assert result is not None, (selector, given)
        return result

    def card(self, name):
        return self.of("article.card", "each.ariaLabel === given[0]", name)

    def slider(self, label):
        return self.of("[role=slider]", "each.ariaLabel === given[0]", label)

    def button(self, text, within="body"):
        return self.of(f"{within} button", "each.checkVisibility() && each.innerText.trim() === given[0]", text)

    def click(self, result):
        """Press the mouse's button on the middle of it, where nothing else may lie."""
        at = self.run(
            "const [found] = arguments;"
            "found.scrollIntoView({ block: 'center', behavior: 'instant' });"
            "const { x, y, width, height } = found.getBoundingClientRect();"
            "const at = { x: x + width / 2, y: y + height / 2 };"
            "return found.contains(document.elementFromPoint(at.x, at.y)) ? at : null",
            result,
        )
        assert at is not None, f"{result.get_attribute('outerHTML')} is hidden"
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            button = {} if kind == "mouseMoved" else {"button": "left", "clickCount": 1}
            self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, **at, **button})

    def type(self, box, text):
        control, delete, enter = "\ue009", "\ue017", "\ue007"
        self.run("arguments[0].scrollIntoView({block: 'center'})", box)
        box.send_keys(control, "a", control, delete, text, enter)

    def box(self, card, label):
        fits = "given[0].contains(each) && each.closest('.number-box').innerText.trim().startsWith(given[1])"
        return self.of(".number-box input", fits, card, label)

    def tab(self, key):
        self.click(self.one(f"#tab-{key}"))

    @property
    def stand(self):
        return self.one("#stand").text

    @property
    def changes(self):
        return self.run("return Live.state.changes")


def accepted(book, *changes):
    """What the line at the top says of a run of the workbook with changes."""
    run = simulated(applied(load(book), changes))
    return f"{run.trials:,} trials, {run.accepted:,} accepted"


def saved_svg(page, button):
    """What a button saves."""
    page.run("Copies.save = (blob) => blob.text().then((text) => { window.saved = text; })")
    page.click(button)
    page.until("window.saved")
    return page.run("const { saved } = window; delete window.saved; return saved")


def test_by_mouse(chromium, running, tmp_path):
    from selenium.webdriver import ActionChains

    case = wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=2, most=19.0)
    page = Page(chromium, running(book=case))
    assert "#" not in chromium.current_url
    assert chromium.get_cookies() == []
    assert accepted(case) in page.stand

    knob = page.slider(f"High of {FRICTION}")
    page.run("arguments[0].scrollIntoView({block: 'center'})", knob)
    drag = ActionChains(chromium, duration=30).click_and_hold(knob).move_by_offset(12, 0).move_by_offset(12, 2)
    page.at_rest(lambda: drag.release().perform())
    high = float(knob.get_attribute("aria-valuenow"))
    assert high > 0.8
    assert accepted(case, Numbers(FRICTION, {"high": high})) in page.stand
    message = page.all(".moved")[0].text
    assert message.startswith("Answer 1: speed at the beginning: mean ")
    assert " → " in message
    assert "changed" in page.card(FRICTION).get_attribute("class")

    page.at_rest(lambda: page.type(page.box(page.card(FRICTION), "High"), "0.9"))
    assert page.changes == [f"{FRICTION}: High 0.8 → 0.9"]
    switch = page.card(DISTANCE).find_element("css selector", "[role=switch]")
    page.at_rest(lambda: page.click(switch))
    page.at_rest(lambda: page.type(page.box(page.card(DISTANCE), "at"), "51"))
    filters = page.card("Filter Plausible 1")
    page.at_rest(lambda: page.type(page.box(filters, "At most"), "19.5"))
    changes = (
        Numbers(FRICTION, {"high": 0.9}),
        Frozen(DISTANCE, 51.0),
        Limits("Plausible 1", {"at_most": 19.5}),
    )
    assert accepted(case, *changes) in page.stand
    assert "rejects " in filters.text

    page.type(page.all(".boxes .share")[0], "90")
    of_one = 100.0 / int(page.stand.partition(" trials, ")[2].split()[0].replace(",", ""))  # a range holds whole trials
    assert abs(float(page.all(".certainty")[0].text.split()[0]) - 90.0) <= of_one
    page.click(page.all(".views input[value=cumulative]")[0])
    page.click(page.all(".line")[0])
    page.all(".percentiles")[0].send_keys("5, 95\ue007")
    page.click(page.all(".fit")[0])
    page.until("document.querySelector('.fit').options.length > 2")

    drawing = ElementTree.fromstring(saved_svg(page, page.button("Save SVG", ".forecast")))
    parts = [each.tag.rpartition("}")[2] for each in drawing.iter()]
    assert "image" not in parts
    assert parts.count("path") > 8
    texts = [each.text for each in drawing.iter() if each.tag.endswith("text")]
    assert {"mph", "0", "Accepted trials, %"} & set(texts)
    assert drawing.find("{http://www.w3.org/2000/svg}title").text.startswith("Chart of Answer 1")

    page.tab("matters")
    page.until("document.querySelectorAll('#panel-matters svg').length > 2")
    page.tab("pairs")
    page.until("document.querySelector('.pair-said').textContent.includes('rank correlation')")
    page.tab("tables")
    page.until("document.querySelectorAll('#panel-tables table').length > 5")
    page.tab("scenarios")
    page.one("#scenario-name").send_keys("dry road\ue007")
    page.until("Live.state.scenarios.length === 1")
    page.click(page.button("Compare all in one table"))
    page.until("document.querySelectorAll('#panel-scenarios table').length > 2")
    assert "dry road" in page.all("#panel-scenarios table")[0].text
    assert page.stand.startswith("Done: ")
    assert not page.one("#stop").is_displayed()
    page.at_rest(lambda: page.click(page.button("All as in the workbook")))
    assert accepted(case) in page.stand
    shows = "return [...document.querySelectorAll('.scenarios button')].filter((each) => each.innerText === 'Show')"
    page.at_rest(lambda: page.click(page.run(shows)[1]))
    assert len(page.changes) == 4
    chromium.refresh()
    page.loaded()
    assert len(page.changes) == 4
    assert accepted(case, *changes) in page.stand

    page.tab("studies")
    before = case.read_bytes()
    news = "document.querySelector('#news').textContent.includes('{}')"
    page.click(page.button("JSON"))
    page.until(news.format("case-dry road-results.json"))
    page.click(page.button("A copy of the workbook"))
    page.until(news.format("case-dry road.xlsx"))
    page.click(page.button("The workbook itself …"))
    assert chromium.switch_to.active_element.text == "Type them in"
    page.click(page.button("Leave it"))
    assert chromium.switch_to.active_element.text == "The workbook itself …"
    assert case.read_bytes() == before
    page.click(page.button("The workbook itself …"))
    page.at_rest(lambda: page.click(page.button("Type them in")))
    assert page.changes == []
    assert case.with_name("case-before.xlsx").read_bytes() == before != case.read_bytes()
    assert accepted(case) in page.stand
    assert accepted(case.with_name("case-before.xlsx"), *changes) in page.stand
    assert not page.button("A copy of the workbook").is_enabled()
    page.click(page.button("JSON"))
    page.until("document.querySelector('#news').textContent.includes('case-results.json')")
    assert case.with_name("case-results.json").exists()
    page.click(page.button("Verify against Excel"))
    page.until("document.querySelector('#panel-studies [role=status]').textContent.startsWith('xlmc verify, ')")
    assert page.one("#panel-studies pre").text


def test_by_keys_alone(chromium, running, tmp_path):
    from selenium.webdriver.common.keys import Keys

    page = Page(chromium, running(book=simple(tmp_path / "case.xlsx")))

    def press(*keys):
        chromium.switch_to.active_element.send_keys(*keys)

    def focus_on(fits, most=150):
        """Press Tab until something fits; what the same call to the browser presses behind that does nothing."""
        page.run(
            f"window.reached = null; window.seeking?.abort(); window.seeking = new AbortController();"
            "const { signal } = window.seeking;"
            "document.addEventListener('focusin', ({ target: each }) => {"
            f" if ({fits}) window.reached ??= each; }}, {{ signal }});"
            "document.addEventListener('keydown', (event) => {"
            " if (window.reached && event.key === 'Tab') event.preventDefault(); }, { capture: true, signal });"
        )
        for _ in range(most // 10):
            press(Keys.TAB * 10)
            if result := page.run("if (window.reached) window.seeking.abort(); return window.reached"):
                return result
        raise AssertionError("it cannot be reached by Tab")

    page.run("document.body.tabIndex = -1; document.body.focus()")
    knob = focus_on("each.role === 'slider' && each.ariaDisabled === 'false'")
    before = float(knob.get_attribute("aria-valuenow"))
    page.at_rest(lambda: press(Keys.ARROW_RIGHT))
    assert float(knob.get_attribute("aria-valuenow")) > before
    assert len(page.changes) == 1
    page.at_rest(lambda: press(Keys.ARROW_LEFT))
    assert page.changes == []
    focus_on("each.matches('input[type=text]:enabled')")
    page.at_rest(lambda: press(Keys.ARROW_UP))
    assert len(page.changes) == 1
    switch = focus_on("each.role === 'switch'")
    page.at_rest(lambda: press(Keys.SPACE))
    assert switch.is_selected()
    page.at_rest(lambda: press(Keys.SPACE))
    focus_on("each.role === 'tab'")
    press(Keys.ARROW_RIGHT)
    assert page.one("#tab-matters").get_attribute("aria-selected") == "true"
    for _ in range(4):
        press(Keys.ARROW_RIGHT)
    assert page.one("#panel-scenarios").is_displayed()
    focus_on("each.id === 'scenario-name'")
    press("by keys", Keys.ENTER)
    page.until("Live.state.scenarios.length === 1")
    page.tab("charts")
    focus_on("each.ariaLabel === 'Lower end of the range of Distance while responding'")
    article = page.of(".forecast", "each.innerText.startsWith('Distance while responding')")
    certainty = article.find_element("css selector", ".certainty")
    low = float(certainty.get_attribute("data-low"))
    press(Keys.ARROW_LEFT)
    assert float(certainty.get_attribute("data-low")) < low


def violations(chromium):
    """What axe finds on the page as it is."""
    return chromium.execute_async_script(
        "axe.run(document, {resultTypes: ['violations']}).then(({violations}) => "
        "arguments[0](violations.map(({id, nodes}) => [id, nodes.map(({html}) => html.slice(0, 200))])))"
    )


def test_the_dark_and_forced_colours(chromium, running, tmp_path):
    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=2)))
    page.at_rest(lambda: page.type(page.box(page.card(FRICTION), "High"), "1.2"))
    if AXE is not None:
        chromium.execute_cdp_cmd("Runtime.evaluate", {"expression": AXE.read_text(encoding="utf-8")})

    def emulate(**features):
        given = [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]
        chromium.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": given})

    try:
        emulate(prefers_color_scheme="dark")
        look = "const {{ {0} }} = getComputedStyle(document.querySelector(arguments[0])); return {0}".format
        assert page.run(look("backgroundColor"), "body") == "rgb(22, 28, 35)"
        assert page.run(look("backgroundColor"), ".chart") == "rgb(255, 255, 255)"  # as it is copied and printed
        for tab in ("charts", "matters", "pairs", "tables", "step", "scenarios", "studies"):
            page.run("Live.right.choose(arguments[0])", tab)
            if tab in ("matters", "tables", "step"):
                page.until(f"document.querySelectorAll('#panel-{tab} table').length")
            assert AXE is None or violations(chromium) == [], tab
        emulate(forced_colors="active")
        page.run("Live.right.choose('charts')")
        assert page.run(look("outlineStyle"), "#tabs [aria-selected=true]") == "solid"
    finally:
        chromium.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def test_a_skip_link_leads_past_the_cards(chromium, running, tmp_path):
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.keys import Keys

    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx")))
    page.run("document.activeElement.blur(); scrollTo(0, 0)")
    ActionChains(chromium).send_keys(Keys.TAB, Keys.ENTER).perform()
    assert page.run("return document.activeElement.id") == "tab-charts"
    stops = 0
    while not page.run("return document.activeElement.closest('.forecast') !== null"):
        ActionChains(chromium).send_keys(Keys.TAB).perform()
        stops += 1
        assert stops <= 15
    page.run("scrollTo(0, 2000)")
    assert page.run(
        "const { top } = document.getElementById('tabs').getBoundingClientRect(); return top >= 0 && top < 300"
    )


def test_names_of_a_hostile_workbook_are_text_and_at_every_width_nothing_overflows(chromium, running, tmp_path):
    book = openpyxl.load_workbook(simple(tmp_path / "case.xlsx"))
    for sheet in book:
        for table in sheet.tables.values():
            if table.name in ("xlmc_assumptions", "xlmc_forecasts", "xlmc_filters"):
                for row in list(sheet[table.ref])[1:]:
                    row[0].value = f"{EVIL} {row[0].row}"
    path = tmp_path / f"{EVIL.replace('/', '')}.xlsx"
    book.save(path)
    page = Page(chromium, running(book=path))
    if AXE is not None:
        chromium.execute_cdp_cmd("Runtime.evaluate", {"expression": AXE.read_text(encoding="utf-8")})
    for width, height in WIDTHS:
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        chromium.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        for tab in ("charts", "matters", "pairs", "tables", "step", "scenarios", "studies"):
            page.run("Live.right.choose(arguments[0])", tab)
            if tab in ("matters", "tables", "step"):
                page.until(f"document.querySelectorAll('#panel-{tab} table').length")
            fits, moving, unnamed = page.run(
                "return [document.documentElement.scrollWidth <= innerWidth, document.getAnimations().length,"
                " [...document.querySelectorAll('button, input, select, [role=slider], [role=tab]')]"
                ".filter((each) => each.checkVisibility() && !each.textContent.trim() && !each.ariaLabel"
                " && !each.labels?.length).map((each) => each.outerHTML)]"
            )
            assert fits, (width, tab)
            assert moving == 0  # whoever wants less motion has it
            assert unnamed == [], (width, tab)
            if AXE is not None and (width, tab) in LOOKED_AT:
                assert violations(chromium) == [], (width, tab)
    chromium.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert EVIL in page.one("#left").text
    assert page.run("return window.stolen") is None
    assert page.all("img") == []


def test_trials_are_stepped_through_by_keys(chromium, running, tmp_path):
    page = Page(chromium, running(book=simple(tmp_path / "case.xlsx")))
    page.tab("step")
    at = "document.querySelector('#panel-step .made')?.innerText.includes('{}')".format
    page.until(at("Trial 1 is "))
    back, on = page.button("Previous trial"), page.button("Next trial")
    assert [back.get_attribute("aria-disabled"), on.get_attribute("aria-disabled")] == ["true", "false"]
    for _ in range(2):
        on.send_keys("\ue007")
    page.until(at("Trial 3 is "))
    assert page.run("return document.activeElement.innerText") == "Next trial"
    back.send_keys("\ue007")
    page.until(at("Trial 2 is "))
    box = page.one("#panel-step input")
    page.type(box, "999999999")
    page.until("document.querySelector('#panel-step input').value.length > 2")
    page.until(
        at("is ") + " && document.querySelector('#panel-step button + label + span + button').ariaDisabled === 'true'"
    )
    last = box.get_attribute("value")
    page.until(at(f"Trial {last} is "))
    page.type(box, "no number")
    assert box.get_attribute("value") == last


def test_a_workbook_with_sixty_assumptions_and_twelve_answers_stays_usable(chromium, running, tmp_path):
    page = Page(chromium, running(book=wide_book(tmp_path / "wide.xlsx")))
    for width, height in ((1400, 1000), (768, 1024), (375, 812)):
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        chromium.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        assert page.run("return document.documentElement.scrollWidth <= innerWidth"), width
        top = page.run("scrollTo(0, 0); return document.querySelector('canvas').getBoundingClientRect().top")
        assert top < height * 0.9, width  # a chart is in sight, so that its handle is not moved blindly
    chromium.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    shown = "[...document.querySelectorAll('#assumptions .card')].filter((each) => each.checkVisibility()).length"
    words, changed = page.all("#find input")
    assert page.run(f"return {shown}") == 60
    words.send_keys("vehicle 7 ")
    assert page.run(f"return {shown}") == 3
    assert page.one("#find [role=status]").text == "3 of 60"
    name = "Vehicle 7 friction on wet asphalt"
    page.at_rest(lambda: page.type(page.box(page.card(name), "High"), "0.9"))
    words.clear()
    page.run("arguments[0].value = ''; arguments[0].dispatchEvent(new Event('input'))", words)
    page.click(changed)
    assert page.run(f"return {shown}") == 1
    page.click(changed)

    assert page.one("#answer").text.startswith("Answer 1: speed at the beginning: ")
    summary = page.one(".choosing summary")
    assert summary.text == "Shown: 3 of 12 answers"
    page.click(summary)
    page.click(page.all(".which input")[11])
    assert summary.text == "Shown: 4 of 12 answers"
    page.until("document.querySelectorAll('.place').length === 4")
    aside = page.one(".further summary")
    assert aside.text == "16 sentences on answers without a chart"
    page.click(aside)
    assert "Answer 7: speed at the beginning" in page.one(".further").text


def test_the_start_page_opens_what_is_there_and_what_is_dropped(chromium, running, tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    simple(folder / "mine.xlsx")
    server = running(folder=folder)
    chromium.get(server.server.link)
    end = time.monotonic() + 120
    while not (links := chromium.find_elements("css selector", "#books a")):
        assert time.monotonic() < end
    assert [each.text for each in links] == ["mine.xlsx"]
    chromium.find_element("id", "file").send_keys(str(simple(tmp_path / "other.xlsx")))
    while "/book/" not in chromium.current_url:
        assert time.monotonic() < end
        time.sleep(0.05)
    while not chromium.execute_script("return document.body?.dataset.stage === 'rest'"):
        assert time.monotonic() < end
        time.sleep(0.05)
    assert chromium.find_element("id", "book").text == "other.xlsx"


@contextmanager
def listening(heard, answer, port=0):
    """Another program of this machine that speaks WebSocket, on any port; it keeps what it hears."""

    def speak(socket):
        for text in socket:
            heard.append(text)
            socket.send(answer(json.loads(text)))

    with serve(speak, sock=bound_socket(port)) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield
        server.shutdown()
    thread.join(120)


class Quiet(SimpleHTTPRequestHandler):
    """Serves a folder."""

    def log_message(self, *_):
        """Say nothing."""


def test_a_page_of_another_local_server_gets_nothing(chromium, running, tmp_path):
    server = running(book=simple(tmp_path / "case.xlsx"))
    Page(chromium, server)
    folder = tmp_path / "pages"
    folder.mkdir()
    folder.joinpath("index.html").write_text("<!doctype html><title>another</title>", encoding="utf-8")
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder)) as other:
        thread = threading.Thread(target=other.serve_forever)
        thread.start()
        chromium.get(f"http://127.0.0.1:{other.server_port}/index.html")
        other.shutdown()
    thread.join(120)
    result = chromium.execute_async_script(
        "const [host, key, done] = arguments;"
        "const tried = async (path, given) => {"
        " try { return await (await fetch(`http://${host}${path}`, given)).text(); } catch { return null; } };"
        "const opened = (path) => new Promise((end) => { const socket = new WebSocket(`ws://${host}${path}`);"
        " socket.onopen = () => end(true); socket.onclose = () => end(false); });"
        "(async () => done([document.cookie, sessionStorage.length, await tried('/'), await tried(`/book/${key}`),"
        " await tried('/drop?name=a.xlsx', { method: 'POST', body: 'PK' }),"
        " await opened(`/live/${key}`), await opened('/start')]))();",
        server.host,
        server.library.only,
    )
    assert result == ["", 0, None, None, None, False, False]
    assert not server.library.keeper.dropped.exists()
    assert {entry["level"] for entry in chromium.get_log("browser")} <= {"SEVERE"}  # that it was refused


def test_a_page_says_nothing_to_another_server_on_its_port(chromium, running, tmp_path):
    server = running(book=simple(tmp_path / "case.xlsx"))
    page = Page(chromium, server)
    secret = server.server.guard.secret
    assert page.run("return sessionStorage.getItem('xlmc')") == secret
    server.server.end()
    page.until("document.body.classList.contains('over')")
    server.ended()
    heard = []
    with listening(heard, lambda message: json.dumps({"kind": "proof", "nonce": "", "proof": "0" * 64}), server.port):
        entered = chromium.execute_async_script(
            "const done = arguments[0], socket = new WebSocket(`ws://${location.host}/live/any`);"
            "socket.onopen = async () => done(await Entry.enter(socket)); socket.onerror = () => done('no connection');"
        )
    assert entered is False
    assert [json.loads(each)["kind"] for each in heard] == ["hello"]
    assert secret not in heard[0]


def test_a_link_that_was_used_says_so(chromium, running, tmp_path):
    server = running(folder=tmp_path)
    link = server.server.link
    chromium.get(link)
    end = time.monotonic() + 120
    while not chromium.find_element("id", "folder").text:
        assert time.monotonic() < end
    chromium.execute_script("sessionStorage.clear()")
    for address, words in ((link, "used already"), (f"http://{server.host}/", "Open the link")):
        chromium.get("about:blank")
        chromium.get(address)
        while words not in chromium.find_element("id", "troubles").text:
            assert time.monotonic() < end


def test_a_page_whose_program_has_ended_says_so_and_asks_no_more(chromium, running, tmp_path):
    server = running(book=simple(tmp_path / "case.xlsx"))
    page = Page(chromium, server)
    page.run(
        "window.made = 0; window.WebSocket = class extends EventTarget {"
        " static OPEN = 1; constructor() { super(); made += 1; } };"
    )
    server.server.end()
    page.until("document.body.classList.contains('over')")
    assert "xlmc has ended" in page.one("#stand").text
    assert page.run("return document.querySelector('#left').inert")
    page.run("dispatchEvent(new Event('online')); Live.wire.set('assumption', 'a', 'low', 1, false);")
    assert page.run("return [made, Live.wire.waiting.length]") == [0, 0]


def test_a_page_whose_program_was_killed_tries_some_times_and_gives_up(chromium, running, tmp_path):
    page = Page(chromium, running(book=simple(tmp_path / "case.xlsx")))
    page.run(
        "window.made = 0; const own = Live.wire.socket;"
        "window.WebSocket = class extends EventTarget { static OPEN = 1; constructor() { super(); made += 1;"
        " setTimeout(() => this.dispatchEvent(new CloseEvent('close', { code: 1006 }))); } };"
        "own.close();"
    )
    page.until("document.body.classList.contains('over')")
    assert page.run("return made") == 3
    assert "xlmc has ended" in page.one("#stand").text


TYPED = {
    "6,700": 6700,
    "6 700": 6700,
    "6\u202f700": 6700,
    "1,234,567.5": 1234567.5,
    "1.234.567": 1234567,
    "6.700,5": 6700.5,
    "1'000": 1000,
    "1.5e3": 1500,
    "1,5E3": 1500,
    "=6600+100": 6700,
    "=6,600+2*50": 6700,
    "=-2^2": 4,
    "=(1+2)*10%": 0.3,
    "0,7": 0.7,
    "0,700": 0.7,
    "6,70": 6.7,
    "\u22123,5": -3.5,
    "6.700": 6.7,
    "1e999": "too large",
    "6,7,0": "several ways",
    "6 70": "several ways",
    "=1/0": "cannot be computed",
    "=2+": "cannot be computed",
    "=" + "(" * 5_000: "characters",
    "0x10": "no number",
    "1/2": "no number",
    "inf": "finite",
    "": "Type a number",
}
RANGES = {
    "0.6 to 0.8": [0.6, 0.8],
    "0.8 – 0.6": [0.6, 0.8],
    "6,600 to 6,800": [6600, 6800],
    "0,7 ± 0,1": [0.6, 0.8],
    "0.7 ± 10 %": [0.63, 0.77],
    "-20 +- 10%": [-22, -18],
    "=6600+-100": None,
    "0.7 ±": None,
    "to 0.7": None,
    "0.7": None,
}


def test_numbers_are_taken_as_people_type_them_or_refused_with_a_reason(chromium, running, tmp_path):
    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1)))
    for text, expected in TYPED.items():
        value, why = page.run("return [typed(arguments[0], null), whyNoNumber(arguments[0])]", text)
        if isinstance(expected, str):
            assert value is None or text == "inf", text
            assert expected in why, (text, why)
        else:
            assert abs(value - expected) < 1e-12, (text, value)
    for text, expected in RANGES.items():
        result = page.run("return typedRange(arguments[0])", text)
        assert (result and [result["low"], result["high"]]) == expected, (text, result)

    card = page.card(FRICTION)
    page.at_rest(lambda: page.type(page.box(card, "Low"), "0.65 to 0.9"))
    assert page.changes == [f"{FRICTION}: Low 0.6 → 0.65", f"{FRICTION}: High 0.8 → 0.9"]
    page.at_rest(lambda: page.type(page.box(card, "High"), "0.7 ± 10 %"))
    assert page.changes == [f"{FRICTION}: Low 0.6 → 0.63", f"{FRICTION}: High 0.8 → 0.77"]
    page.at_rest(lambda: page.type(page.box(page.card(DISTANCE), "Low"), "50 ± 5"))
    assert f"{DISTANCE}: Low 40 → 45" in page.changes
    page.at_rest(lambda: page.type(page.box(page.card("Filter Plausible 1"), "At most"), "6 to 20"))
    assert "Plausible 1: at most 60 → 20" in page.changes

    box = page.box(card, "Low")
    page.type(box, "much")
    assert box.get_attribute("aria-invalid") == "true"
    assert "no number" in page.run(
        "return document.getElementById(arguments[0]).textContent", box.get_attribute("aria-describedby")
    )
    page.at_rest(lambda: page.type(box, "=0.5+0,1"))
    assert box.get_attribute("aria-invalid") is None
    mean = page.box(page.card("Vehicle 1 approach speed"), "Mean")
    page.type(mean, "30 ± 2")
    assert "one number" in page.run("return arguments[0].closest('.number-box').innerText", mean)


def test_a_state_that_is_not_possible_greys_the_answers_of_the_one_before(chromium, running, tmp_path):
    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1)))
    box = page.box(page.card(FRICTION), "High")
    page.type(box, "0.1")
    page.until("document.body.classList.contains('faulty')")
    assert page.stand == "This state is not possible: the answers are of the state before"
    assert "above High" in page.one("#troubles").text
    grey = page.run("return getComputedStyle(document.querySelector('.statements li')).color")
    page.run("Live.wire.say({ kind: 'save', what: 'json' })")
    page.until("document.querySelector('#troubles').textContent.includes('This state cannot be run')")
    page.at_rest(lambda: page.type(box, "0.9"))
    assert page.run("return document.querySelectorAll('#troubles p').length") == 0
    assert page.stand.startswith("Done: ")
    assert page.run("return getComputedStyle(document.querySelector('.statements li')).color") != grey

    lowest = page.run("return Live.right.panels.values().next().value.panel.forecast.values.at(-1)")
    page.at_rest(lambda: page.type(page.box(page.card("Filter Plausible 1"), "At least"), repr(lowest)))
    assert "1 accepted" in page.stand
    assert page.stand.endswith("too few for an answer")
    red = "rgb(156, 0, 6)"
    for place in ("#stand", ".beside td", "#answer", ".statements li"):
        assert page.run("return getComputedStyle(document.querySelector(arguments[0])).color", place) == red, place


def test_changes_are_undone_by_keys_and_a_drag_is_given_up_with_esc(chromium, running, tmp_path):
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.keys import Keys

    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1)))
    assert not page.one("#undo").is_enabled()
    box = page.box(page.card(FRICTION), "High")
    page.at_rest(lambda: page.type(box, "0.9"))
    page.at_rest(lambda: page.type(box, "0.95"))
    page.at_rest(lambda: ActionChains(chromium).key_down(Keys.CONTROL).send_keys("z").key_up(Keys.CONTROL).perform())
    assert page.changes == [f"{FRICTION}: High 0.8 → 0.9"]
    assert float(box.get_attribute("value")) == 0.9
    page.at_rest(lambda: ActionChains(chromium).key_down(Keys.CONTROL).send_keys("y").key_up(Keys.CONTROL).perform())
    assert page.changes == [f"{FRICTION}: High 0.8 → 0.95"]
    for _ in range(2):
        page.at_rest(lambda: page.click(page.one("#undo")))
    assert page.changes == []
    assert not page.one("#undo").is_enabled()
    assert page.one("#redo").is_enabled()

    knob = page.slider(f"High of {FRICTION}")
    page.run("arguments[0].scrollIntoView({block: 'center'})", knob)
    drag = ActionChains(chromium, duration=30).click_and_hold(knob).move_by_offset(12, 0).move_by_offset(12, 2)
    page.at_rest(lambda: drag.send_keys(Keys.ESCAPE).move_by_offset(5, 0).release().perform())
    assert float(knob.get_attribute("aria-valuenow")) == 0.8
    assert page.changes == []
    assert not page.one("#undo").is_enabled()


def test_the_tabs_are_of_the_answers_that_are_chosen_and_can_be_stopped(chromium, running, tmp_path):
    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx", assumptions=30, forecasts=5)))
    page.tab("matters")
    page.until("document.querySelectorAll('#sensitivity article').length >= 3")
    headings = "[...document.querySelectorAll('#sensitivity article > h3')].map((each) => each.textContent)"
    assert page.run(f"return {headings}.length") == 3
    page.click(page.all(".which input")[4])
    page.until(f"{headings}.includes('Answer 5: speed at the beginning')")
    page.tab("tables")
    page.until("document.querySelectorAll('#panel-tables .forecast-statistics').length === 4")


def test_the_probability_above_a_threshold_is_said_at_once_and_follows(chromium, running, tmp_path):
    book = wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1)
    page = Page(chromium, running(book=book))

    def message(threshold, *changes):
        (values,) = simulated(applied(load(book), changes)).forecasts.values()
        return int((values > threshold).sum()), values.size

    share = "document.querySelector('.beyond').textContent"
    page.at_rest(lambda: page.type(page.one(".above"), "18,5"))
    above, trials = message(18.5)
    exact = page.run("return Live.right.panels.values().next().value.panel.trials.reached(18.5, true).doubt")
    result = page.run(f"return {share}")
    assert result.startswith("P = ")
    count = int(result.partition("(")[2].removeprefix("about ").split()[0].replace(",", ""))
    assert abs(count - above) <= exact + 0.5
    assert f"of {trials:,})" in result
    page.at_rest(lambda: page.type(page.box(page.card(FRICTION), "High"), "1.2"))
    above, _ = message(18.5, Numbers(FRICTION, {"high": 1.2}))
    count = int(page.run(f"return {share}").partition("(")[2].removeprefix("about ").split()[0].replace(",", ""))
    assert abs(count - above) <= 3
    page.type(page.one(".above"), "much")
    assert "no number" in page.run(f"return {share}")


def test_a_reading_is_dragged_limits_go_and_answers_are_stated_otherwise(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_readings(tmp_path / "case.xlsx")))

    def message():
        return set(page.changes)

    at_40 = page.card("Filter at 40 ft")
    page.at_rest(lambda: page.type(page.box(at_40, "Reading"), "32 ± 2.5"))
    assert message() == {"at 40 ft: reading 31 → 32", "at 40 ft: plus or minus 3 → 2.5"}
    assert "reads 32, uniform (Plus or minus 2.5): from 29.5 to 34.5" in at_40.text
    page.at_rest(lambda: page.slider("reading of at 40 ft").send_keys("\ue014"))
    assert page.run("return Live.state.filters.find(({ name }) => name === 'at 40 ft').limits[0].value") > 32
    page.type(page.box(page.card("Filter witness"), "Reading"), "60 ± 5")
    assert "another way" in page.card("Filter witness").text
    page.at_rest(lambda: page.click(page.button("As in the workbook", ".card.changed")))
    page.at_rest(lambda: page.type(page.box(page.card("v"), "Upper cutoff"), " "))
    assert message() == {"v: Upper cutoff 38 → none"}
    box = page.box(page.card("v"), "Upper cutoff")
    assert (box.get_attribute("value"), box.get_attribute("placeholder")) == ("", "none")
    page.at_rest(lambda: page.click(page.one("#undo")))
    assert float(box.get_attribute("value")) == 38.0
    possible = page.card("Filter possible")
    page.at_rest(lambda: page.type(page.box(possible, "At most"), " "))
    page.type(page.box(possible, "At least"), " ")
    page.until("document.querySelector('#troubles').textContent.includes('would have no limit')")
    assert message() == {"possible: at most 80 → none"}
    page.at_rest(lambda: page.click(page.one("#undo")))

    speed = page.of("article.forecast", "each.querySelector('h3').innerText === given[0]", "speed")
    above, central = (speed.find_element("css selector", place) for place in (".above", ".central"))
    assert (above.get_attribute("value"), central.get_attribute("value")) == ("35", "51")
    page.at_rest(lambda: page.type(above, "32"))
    page.until("document.querySelector('.statements').innerText.includes('P(speed > 32')")
    page.type(central, "100")
    assert central.get_attribute("aria-invalid") is not None
    page.at_rest(lambda: page.type(central, "90"))
    assert central.get_attribute("aria-invalid") is None
    assert message() == {"speed: threshold 35 → 32", "speed: central range 51 % → 90 %"}
    assert "Central 90 % range" in speed.text
    page.at_rest(lambda: page.type(above, " "))
    assert above.get_attribute("value") == ""
    page.at_rest(lambda: page.click(page.button("As in the workbook", ".threshold")))
    assert page.changes == []
    assert (above.get_attribute("value"), central.get_attribute("value")) == ("35", "51")


def test_a_kind_of_distribution_is_chosen_by_its_picture(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_readings(tmp_path / "case.xlsx")))
    card = page.card("t")
    page.click(card.find_element("css selector", ".kinds summary"))
    page.at_rest(lambda: page.click(page.button("Normal", "article[aria-label='t'] .gallery")))
    assert page.changes == ["t: kind Uniform → Normal"]
    of_all = "return [...arguments[0].querySelectorAll('.numbers > .number-box')]"
    boxes = f"{of_all}.map((each) => each.innerText.split(/\\s/)[0])"
    assert page.run(boxes, card) == ["Mean", "Std"]
    page.at_rest(lambda: page.type(page.box(card, "Mean"), "2.1"))
    assert "Normal: Mean 2.1" in card.text
    page.at_rest(lambda: page.slider("Mean of t").send_keys("\ue014"))
    page.at_rest(lambda: page.click(page.button("Uniform", "article[aria-label='t'] .gallery")))
    assert page.changes == []
    assert page.run(boxes, card) == ["Low", "High"]
    pressed = "return [...arguments[0].querySelectorAll('.gallery [aria-pressed=true]')].map((each) => each.innerText)"
    assert page.run(pressed, card) == ["Uniform"]
    page.at_rest(lambda: page.click(page.one("#undo")))
    assert page.run(pressed, card) == ["Normal"]


def test_a_correlation_is_typed(chromium, running, tmp_path):
    book = openpyxl.load_workbook(book_of_readings(tmp_path / "case.xlsx"))
    sheet = book.create_sheet("Tied")
    for line in (["First", "Second", "Correlation"], ["t", "v", 0.5]):
        sheet.append(line)
    sheet.add_table(Table(displayName="xlmc_correlations", ref="A1:C2"))
    book.save(tmp_path / "case.xlsx")
    page = Page(chromium, running(book=tmp_path / "case.xlsx"))
    card = page.card("t and v")
    box = page.box(card, "Rank correlation")
    assert box.get_attribute("value") == "0.50"
    page.at_rest(lambda: page.type(box, "-0.7"))
    assert page.changes == ["t and v: correlation 0.5 → -0.7"]
    page.type(box, "1.5")
    assert "from -1 to 1" in card.text
    page.at_rest(lambda: page.click(page.button("As in the workbook", "article[aria-label='t and v']")))
    assert page.changes == []
    assert box.get_attribute("value") == "0.50"


def test_ranges_of_one_unit_stand_side_by_side(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_decisions(tmp_path / "case.xlsx")))
    rows = (
        "return [...document.querySelectorAll('.trend tbody tr')].map((each) => each.querySelector('th bdi').innerText)"
    )
    assert page.run(rows) == ["margin", "way"]  # metres; the speed has another unit
    text = "return document.querySelectorAll('.trend small')[1].innerText"
    low, high = map(float, page.run(text).removesuffix(" m").split(" to "))
    assert 12.0 < low < high < 26.0
    before = page.run(text)
    page.at_rest(lambda: page.slider("Value of limit").send_keys("\ue014"))
    page.run("document.querySelector('.trend').scrollIntoView({ block: 'end' })")
    page.until(f"document.querySelectorAll('.trend small')[1].innerText !== {before!r}")
    page.click(
        page.of("fieldset.which input", "each.checkVisibility() && each.closest('label').innerText === 'margin'")
    )
    page.until("document.querySelector('.trend').hidden")


def test_a_scatter_of_the_matrix_is_shown_large(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_decisions(tmp_path / "case.xlsx")))
    page.tab("pairs")
    page.until("document.querySelectorAll('.matrix svg').length === 3")
    heads = page.run("return [...document.querySelectorAll('.matrix thead th')].map((each) => each.innerText)")
    assert heads == ["margin", "way", "speed"]
    cells = "return [...document.querySelectorAll('.matrix .shares')].map((each) => each.innerText)"
    assert all(text.endswith(" %") for text in page.run(cells))
    page.click(page.of(".matrix button", "each.ariaLabel === given[0]", "Show speed against way"))
    page.until("document.querySelector('.pair-said').innerText.includes('accepted trials')")
    assert page.run("return Live.right.pairs.selects.map((each) => each.value)") == ["way", "speed"]
    page.click(
        page.of("fieldset.which input", "each.checkVisibility() && each.closest('label').innerText === 'margin'")
    )
    page.until("document.querySelectorAll('.matrix svg').length === 1")


def test_a_chart_is_zoomed_to_its_range_and_back(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_readings(tmp_path / "case.xlsx")))
    panel = "const { panel } = Live.right.panels.get('speed'); "
    ends = f"{panel}return [panel.ends, panel.top, panel.state.low, panel.state.high]"
    whole, _, low, high = page.run(ends)
    zoom = page.of(".zoom", "each.ariaLabel === given[0]", "Zoom to the range of speed")
    page.click(zoom)
    zoomed = page.run(ends)[0]
    assert whole[0] < zoomed[0] < low < high < zoomed[1] < whole[1]
    assert zoom.get_attribute("aria-pressed") == "true"
    page.at_rest(lambda: page.slider("High of t").send_keys("\ue014"))
    assert page.run(ends)[0] == zoomed
    page.click(page.of(".views input", "each.value === given[0]", "cumulative"))
    assert page.run(ends)[:2] == [zoomed, 100]
    page.click(page.of(".views input", "each.value === given[0]", "frequency"))
    page.click(zoom)
    assert page.run(ends)[0] == whole


def test_a_date_is_typed_and_moved_as_a_date(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_dates(tmp_path / "case.xlsx")))
    low = page.box(page.card("start"), "Low")
    assert low.get_attribute("value") == "2026-02-01"
    page.type(low, "soon")
    assert "Type a date, as 2026-03-01." in page.card("start").text
    page.at_rest(lambda: page.type(low, "2026-02-10"))
    page.at_rest(lambda: page.slider("High of start").send_keys("\ue014"))
    assert page.changes == ["start: Low 2026-02-01 → 2026-02-10", "start: High 2026-04-01 → 2026-04-02"]
    assert page.slider("High of start").get_attribute("aria-valuetext") == "2026-04-02"
    page.at_rest(lambda: page.type(low, "2026-02-05 to 2026-03-05"))
    assert page.changes == ["start: Low 2026-02-01 → 2026-02-05", "start: High 2026-04-01 → 2026-03-05"]


def test_as_many_bars_are_drawn_as_are_typed(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_readings(tmp_path / "case.xlsx")))
    bars = (
        "const { panel } = Live.right.panels.get('speed'); const { edges, counts } = panel.bins;"
        "return [counts.length, counts.reduce((sum, n) => sum + n, 0), edges[0], edges.at(-1)]"
    )
    box = partial(page.of, ".bar-count", "each.ariaLabel === given[0]", "Number of bars of speed")
    own, trials, *ends = page.run(bars)
    message = page.run("return document.querySelector('.statements').innerText")
    page.type(box(), str(4 * own))
    assert page.run(bars) == [4 * own, trials, *ends]
    page.type(box(), "7.5")
    assert "whole number of bars" in page.run("return Live.right.panels.get('speed').panel.find('.fault').textContent")
    assert page.run(bars)[0] == 4 * own
    page.at_rest(lambda: page.slider("High of t").send_keys("\ue014"))
    page.browser.refresh()
    page.loaded()
    page.until("Live.right.panels.get('speed').panel")
    assert box().get_attribute("value") == str(4 * own)
    assert page.run(bars)[0] > 3 * own
    page.type(box(), "")
    page.at_rest(lambda: page.click(page.one("#reset")))
    assert page.run(bars) == [own, trials, *ends]
    assert page.run("return document.querySelector('.statements').innerText") == message
    assert box().get_attribute("placeholder") == str(own)


def test_decisions_and_solved_cells_are_moved(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_decisions(tmp_path / "case.xlsx")))
    card = page.card("limit")
    box = page.box(card, "Value")
    assert page.run("return arguments[0].querySelector('.ticks').getAttribute('d').split('M').length - 1", card) == 5
    page.at_rest(lambda: page.slider("Value of limit").send_keys("\ue014"))
    assert page.changes == ["limit: value 50 → 60"]
    assert box.get_attribute("value") == "60"
    page.at_rest(lambda: page.type(box, "55"))
    page.at_rest(lambda: page.click(page.button("As in the workbook", "article[aria-label='limit']")))
    assert page.changes == []
    road = page.one("select[aria-label='Value of road']")
    page.at_rest(lambda: road.send_keys("wet"))
    assert page.changes == ["road: value dry → wet"]
    page.at_rest(lambda: page.click(page.button("As in the workbook", "article[aria-label='road']")))
    assert road.get_attribute("value") == "0"
    solved = page.card("stops")
    assert "M!A4 is solved for in each trial, so that M!B1 equals To" in solved.text
    assert not page.box(solved, "High").is_enabled()
    page.at_rest(lambda: page.type(page.box(solved, "To"), "30"))
    assert page.changes == ["stops: To 40 → 30"]
    page.at_rest(lambda: page.click(page.one("#undo")))
    assert page.box(solved, "To").get_attribute("value") == "40.0"


def test_trials_and_seed_are_typed_and_brought_back(chromium, running, tmp_path):
    page = Page(chromium, running(book=book_of_readings(tmp_path / "case.xlsx")))
    trials, seed = (page.box(page.one("#run"), label) for label in ("Trials", "Seed"))
    page.at_rest(lambda: page.type(trials, "6,000"))
    assert "6,000 trials" in page.one("#stand").text
    page.at_rest(lambda: page.type(seed, "7"))
    run = page.run("return Live.state.run")
    assert (run["trials"], run["seed"]) == (6000, 7)
    page.type(trials, "2.5")
    assert "whole number" in page.one("#run").text
    page.at_rest(lambda: page.click(page.button("As in the workbook", "#run")))
    assert "4,000 trials" in page.one("#stand").text
    page.at_rest(lambda: page.click(page.one("#undo")))
    assert (trials.get_attribute("value"), seed.get_attribute("value")) == ("6000", "7")
    page.at_rest(lambda: page.click(page.one("#reset")))
    assert not page.run("return Live.state.run.changed")


def test_print_prints_the_page_of_results_of_what_is_shown(chromium, running, tmp_path):
    page = Page(chromium, running(book=wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1)))
    page.run(
        "const hand = Live.right.hand; window.printed = [];"
        "hand.print = ({ document: { title, body } }) =>"
        " window.printed.push([title, body.innerText, body.querySelectorAll('canvas').length]);"
    )
    page.tab("studies")
    page.click(page.button("Print"))
    page.until("window.printed.length === 1")
    page.at_rest(lambda: page.type(page.box(page.card(FRICTION), "High"), "1.2"))
    page.click(page.button("Print"))
    page.until("window.printed.length === 2")
    first, second = page.run("return window.printed")
    for title, text, charts in (first, second):
        assert title == "case.xlsx: results of the simulation"
        assert "Results of the simulation" in text
        assert charts >= 1
    assert "copy with changes" not in first[1]
    assert f"{FRICTION}: High 0.8 → 1.2" in second[1]


def test_one_filter_is_switched_off_and_on(chromium, running, tmp_path):
    book = wide_book(tmp_path / "case.xlsx", assumptions=6, forecasts=1, most=18.0)
    page = Page(chromium, running(book=book))
    kept = page.stand
    switch = "[role=switch]", "each.closest('label').innerText.includes(given[0])", "Plausible 1"
    page.at_rest(lambda: page.click(page.of(*switch)))
    assert page.changes == ["Plausible 1: not used"]
    assert page.run("return document.querySelectorAll('article.card.off').length") == 1
    page.at_rest(lambda: page.click(page.of(*switch)))
    assert page.changes == []
    assert page.stand == kept
