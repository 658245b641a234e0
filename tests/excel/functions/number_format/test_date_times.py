from __future__ import annotations

import pytest

from xlmc.excel.functions.number_format import UnknownFormat, parse_format

AFTERNOON = 43835.60796296  # Sunday, 5 January 2020, 14:35:28

DATES = [
    ("d-m-y", AFTERNOON, "5-1-20"),
    ("dd/mm/yyyy", AFTERNOON, "05/01/2020"),
    ("ddd, mmm d, yyy", AFTERNOON, "Sun, Jan 5, 2020"),
    ("DDDD D MMMM YYYY", AFTERNOON, "Sunday 5 January 2020"),
    ("mmmmm", AFTERNOON, "J"),
    ("e", AFTERNOON, "2020"),
    ("e-m", AFTERNOON, "2020-1"),
    ("bb bbbb", AFTERNOON, "63 2563"),
    ("gyyyy", AFTERNOON, "2020"),
    ("yyyy-mm-dd", 0, "1900-01-00"),
    ("ddd", 0, "Sat"),
    ("yyyy-mm-dd", 60, "1900-02-29"),
    ("yyyy-mm-dd", 61, "1900-03-01"),
    ("yyyy-mm-dd", 2958465, "9999-12-31"),
    ("yyyy-mm-dd", 2958465.99999421, "9999-12-31"),
    ("yyyy-mm-dd", 2958465.99999422, "refused"),
    ("yyyy-mm-dd", -0.00001, "refused"),
    ("yyyy-mm-dd", 1e300, "refused"),
    ("[$-409]mmm yy", AFTERNOON, "Jan 20"),
    ("[$-en-GB]mmm yy", AFTERNOON, "Jan 20"),
    ("[$-407]d.m.yyyy", AFTERNOON, "5.1.2020"),
    ("[$-F800]dddd, mmmm dd, yyyy", AFTERNOON, "Sunday, January 5, 2020"),
    ("[$-F400]h:mm:ss AM/PM", AFTERNOON, "2:35:28 PM"),
]
TIMES = [
    ("h:m:s", AFTERNOON, "14:35:28"),
    ("hh:mm AM/PM", AFTERNOON, "02:35 PM"),
    ("h am/pm", 0.25, "6 AM"),
    ("h a/p", AFTERNOON, "2 p"),
    ("h A/P", 0, "12 A"),
    ("AM/PM", 0.5, "PM"),
    ("mm:ss", AFTERNOON, "35:28"),
    ("m/d h:mm", AFTERNOON, "1/5 14:35"),
    ("h:mmm", AFTERNOON, "14:Jan"),
    ("d h m", AFTERNOON, "5 14 35"),
    ("h:mm", 0.999999, "0:00"),
    ("h:mm", 59.4 / 86400, "0:00"),
    ("h:mm:ss", 59.6 / 86400, "0:01:00"),
    ("s.0", 59.96 / 86400, "0.0"),
    ("ss.000", 1.2345 / 86400, "01.235"),
    ("h .00 .000", 0.70707, "16 .84 .848"),
    ("d.m.yyyy", AFTERNOON, "5.1.2020"),
]
DURATIONS = [
    ("[h]:mm", 1.5, "36:00"),
    ("[h]:mm:ss", 2.9999999999999996, "72:00:00"),
    ("[mm]:ss", 0.05, "72:00"),
    ("[ss]", 1, "86400"),
    ("[hhh]", 1, "024"),
    ("[hhh]", -1, "-024"),
    ("[h]:mm", -1, "refused"),
]


@pytest.mark.parametrize(("code", "value", "text"), DATES + TIMES + DURATIONS)
def test_dates_and_times(written, code, value, text):
    assert written(code, value) == text


@pytest.mark.parametrize(
    ("value", "text"), [(0, "1904-01-01 Fri"), (1.5, "1904-01-02 Sat"), (-1, "-1904-01-02 Sat"), (2957004, "refused")]
)
def test_the_1904_system(written, value, text):
    assert written("yyyy-mm-dd ddd", value, True) == text


@pytest.mark.parametrize("code", ["y 0", "h #", "[h] ?", "d .#", "mm%", "mm@", "0.0M", "AM/PM 0"])
def test_dates_and_digits_do_not_mix(written, code):
    assert written(code, 1) == "refused"


@pytest.mark.parametrize("code", ["[$-407]mmmm", "[$-fr-FR]dddd", "[DBNum1]0"])
def test_other_languages_are_not_known(code):
    with pytest.raises(UnknownFormat, match="known"):
        parse_format(code)
