"""Pages read back: as elements by the standard library, and in Chromium where it is installed."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from html.parser import HTMLParser

import pytest
from chromium_browser import Browser
from needed_programs import missing

from xlmc.outputs.page import page_text

_VOID = frozenset({"meta", "link", "input", "br", "img"})


@dataclass
class Node:
    """An element, with everything in it in order."""

    tag: str
    attributes: dict[str, str | None]
    children: list[Node | str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """All text in it, with spaces where no line may be broken as others."""
        result = "".join(child if isinstance(child, str) else child.text for child in self.children)
        return result if self.tag in ("script", "style") else result.replace("\u00a0", " ")

    def all(self, tag: str | None = None, **attributes: str) -> list[Node]:
        wanted = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items()}
        result = []
        for child in self.children:
            if isinstance(child, Node):
                fits = all(child.attributes.get(key) == value for key, value in wanted.items())
                result += [child] if fits and tag in (None, child.tag) else []
                result += child.all(tag, **attributes)
        return result

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
def text_of():
    """The page of a run, which is made once."""
    made = {}

    def text(simulation, **options):
        key = id(simulation), *((name, id(each)) for name, each in options.items())
        if key not in made:
            made[key] = page_text(simulation, **options), simulation, options  # which keep their ids as long
        return made[key][0]

    return text


@pytest.fixture(scope="session")
def page_of(text_of):
    """A run's page as elements."""
    return lambda simulation, **options: read(text_of(simulation, **options))


@pytest.fixture(scope="session")
def payload_of(page_of):
    """What the charts of a run's page are drawn from."""
    return lambda simulation: json.loads(page_of(simulation).all("script", id="payload")[0].text)


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Gives a browser that answers."""
    pytest.importorskip("selenium.webdriver")
    if reason := missing("chromium", "chromedriver"):
        pytest.skip(reason)
    result = Browser(tmp_path_factory, requests=True)
    yield result
    result.quit()


@pytest.fixture
def chromium(browser):
    """A browser that answers, or a skipped test where there is none."""
    return browser()


@pytest.fixture
def shown(chromium, text_of, tmp_path):
    """Opens a run's page in the browser; whatever it complained of by the end of the test is an error."""

    def show(simulation, **options):
        path = tmp_path / "page.html"
        path.write_text(text_of(simulation, **options), encoding="utf-8")
        chromium.get_log("browser")
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
