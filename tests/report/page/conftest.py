"""Pages read back: as elements by the standard library, and in Chromium where it is installed."""

from __future__ import annotations

import contextlib
import json
import re
import shutil
from dataclasses import dataclass, field
from html.parser import HTMLParser

import pytest
from needed_programs import missing

from xlmc.report.page import page_text

_VOID = frozenset({"meta", "link", "input", "br", "img"})

_CHROMIUM = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--window-size=1280,1000",
)


@dataclass
class Node:
    """An element, with everything in it in order."""

    tag: str
    attributes: dict[str, str | None]
    children: list[Node | str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(child if isinstance(child, str) else child.text for child in self.children)

    def all(self, tag: str | None = None, **attributes: str) -> list[Node]:
        wanted = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items()}
        found = []
        for child in self.children:
            if isinstance(child, Node):
                fits = all(child.attributes.get(key) == value for key, value in wanted.items())
                found += [child] if fits and tag in (None, child.tag) else []
                found += child.all(tag, **attributes)
        return found

    @property
    def numbers(self) -> list[float]:
        """The full values of all numbers shown in it."""
        return [float(each.attributes["value"] or "nan") for each in self.all("data")]


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open = [Node("", {})]

    def handle_starttag(self, tag, attributes):
        node = Node(tag, dict(attributes))
        self.open[-1].children.append(node)
        if tag not in _VOID:
            self.open.append(node)

    def handle_endtag(self, tag):
        assert self.open[-1].tag == tag, f"<{self.open[-1].tag}> is ended by </{tag}>"
        self.open.pop()

    def handle_data(self, data):
        self.open[-1].children.append(data)


def read(text):
    """The page as elements; every one that begins must end, in order."""
    reader = _Reader()
    reader.feed(text)
    reader.close()
    assert len(reader.open) == 1
    return reader.open[0]


@pytest.fixture(scope="session")
def page_of():
    """A run's page as elements."""
    return lambda simulation, **options: read(page_text(simulation, **options))


@pytest.fixture(scope="session")
def payload_of(page_of):
    """What the charts of a run's page are drawn from."""
    return lambda simulation: json.loads(page_of(simulation).all("script", id="payload")[0].text)


class _Browser:
    """One Chromium for all tests, and a new one where it, or its driver, has ended: a busy machine ends them."""

    def __init__(self, profiles):
        self._profiles, self._running = profiles, None

    def __call__(self):
        if self._running is not None and not self._answers():
            self.quit()
        if self._running is None:
            self._running = self._started()
        return self._running

    def _answers(self):
        from selenium.common.exceptions import WebDriverException
        from urllib3.exceptions import HTTPError

        try:
            return self._running.execute_script("return 6 * 7") == 42
        except (WebDriverException, HTTPError, OSError):
            return False

    def _started(self):
        from selenium import webdriver

        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for argument in (*_CHROMIUM, f"--user-data-dir={self._profiles.mktemp('profile')}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        return webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))

    def quit(self):
        """End the browser and its driver, whatever is left of them."""
        running, self._running = self._running, None
        if running is None:
            return
        with contextlib.suppress(Exception):  # there may be nobody left to ask
            running.quit()
        running.service.stop()


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Gives a browser that answers."""
    pytest.importorskip("selenium.webdriver")
    if reason := missing("chromium", "chromedriver"):
        pytest.skip(reason)
    found = _Browser(tmp_path_factory)
    yield found
    found.quit()


@pytest.fixture
def chromium(browser):
    """A browser that answers, or a skipped test where there is none."""
    return browser()


@pytest.fixture
def shown(chromium, tmp_path):
    """Opens a run's page in the browser; whatever it complained of by the end of the test is an error."""

    def show(simulation, **options):
        path = tmp_path / "page.html"
        simulation.save_page(path, **options)
        chromium.get("about:blank")
        for log in ("browser", "performance"):
            chromium.get_log(log)
        chromium.get(path.as_uri())
        return chromium

    yield show
    assert [entry["message"] for entry in chromium.get_log("browser")] == []


@pytest.fixture(scope="session")
def requests_of():
    """The addresses that a browser asked for since its log was last read."""

    def requests(browser):
        events = (json.loads(entry["message"])["message"] for entry in browser.get_log("performance"))
        return [
            re.sub(r"^data:.*", "data:", event["params"]["request"]["url"])
            for event in events
            if event["method"] == "Network.requestWillBeSent"
        ]

    return requests
