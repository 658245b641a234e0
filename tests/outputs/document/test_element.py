from __future__ import annotations

from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st

from xlmc.outputs.document.element import EMPTY, Html, element, join, void


def read(source):
    """What a parser makes of it: starts, ends and texts."""
    result = []
    parser = HTMLParser()
    parser.handle_starttag = lambda tag, attributes: result.append((tag, attributes))
    parser.handle_endtag = lambda tag: result.append(f"/{tag}")
    parser.handle_data = result.append
    parser.feed(source)
    parser.close()
    texts = "".join(each for each in result if isinstance(each, str) and each != "/p")
    return [each for each in result if not isinstance(each, str) or each == "/p"], texts


@given(st.text(), st.text())
def test_no_text_is_markup(text, value):
    text = text.replace("\r", "")  # a parser makes a line feed of it
    result, texts = read(element("p", text, title=value).source)
    assert result == [("p", [("title", value)]), "/p"]
    assert texts == text


def test_what_is_html_stays_so():
    inner = element("b", "a & b")
    assert element("p", inner, " < ", inner).source == "<p><b>a &amp; b</b> &lt; <b>a &amp; b</b></p>"
    assert join([Html("<i></i>"), "<"]) == Html("<i></i>&lt;")
    assert join([]) == EMPTY


def test_attributes():
    assert element("td", colspan=None, data_key="a.b", class_="x").source == '<td data-key="a.b" class="x"></td>'
    assert void("input", type="radio", name="n", checked="").source == '<input type="radio" name="n" checked="">'
