"""How numbers of forecasts are written, by their kind and by the number format of their cell."""

from __future__ import annotations

import math

import pytest

from xlmc.montecarlo.definitions.forms import PLAIN, Form, kind_of_format, span_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import Estimate

FORMS = {
    "plain": Form(),
    "whole": Form(Kind.WHOLE),
    "percent": Form(Kind.PERCENT),
    "yes": Form(Kind.YES_NO),
    "dollars": Form(Kind.CURRENCY, '"$"#,##0'),
    "euros": Form(Kind.CURRENCY, "#,##0 €"),
    "day": Form(Kind.DATE, "yyyy-mm-dd"),
    "time": Form(Kind.DATE, "d.m.yyyy h:mm"),
    "hour": Form(Kind.DATE, "d.m.yyyy h"),
    "span": Form(Kind.DATE, "[h]:mm:ss"),
    "1904": Form(Kind.DATE, "yyyy-mm-dd", date1904=True),
    "iso": Form(Kind.DATE),
}


@pytest.mark.parametrize(
    ("code", "kind"),
    [
        ("0%", Kind.PERCENT),
        ("0.00", None),
        ("General", None),
        ("Standard;0", None),
        ("@", None),
        ("[h]:mm", Kind.DATE),
        ("[mm]:ss", Kind.DATE),
        ("h:mm", Kind.DATE),
        ("[$-409]d-mmm-yy", Kind.DATE),
        ('#,##0 "days"', None),
        ("0.0 d", None),  # a number with a letter behind it
        ('"y"0', None),
        ("\\d0", None),
        ("€#,##0", Kind.CURRENCY),
        ("[$CHF] 0.00", Kind.CURRENCY),
        ("0.00 USD", Kind.CURRENCY),
        ("kr 0", Kind.CURRENCY),
        ("0 zł", Kind.CURRENCY),
        ("_($* #,##0_)", Kind.CURRENCY),
        ("(#,##0)", None),
        ("0;0%", None),  # what negative numbers have does not count
    ],
)
def test_what_a_format_says(code, kind):
    assert kind_of_format(code) is kind


@pytest.mark.parametrize(
    ("form", "value", "all_digits", "one_decimal", "six_digits", "beside_an_axis"),
    [
        ("plain", -1234.5678, "-1,234.5678", "-1,234.6", "-1,234.57", "-1,234.57"),
        ("plain", -0.0004, "-0.0004", "0.0", "-0.0004", "0.00"),
        ("plain", 1e-7, "1e-07", "1e-07", "1e-07", "1e-07"),
        ("plain", 0.0, "0", "0.0", "0", "0.00"),
        ("percent", 0.25, "25 %", "25.0 %", "25 %", "25 %"),
        ("percent", -1234.5678, "-123,456.78 %", "-123,456.8 %", "-123,457 %", "-123,457 %"),
        ("yes", 1.0, "100 %", "100.0 %", "100 %", "100 %"),
        ("dollars", -1234.5678, "-$1,234.5678", "-$1,234.6", "-$1,234.57", "-$1,234.57"),
        ("euros", 0.25, "0.25 €", "0.2 €", "0.25 €", "0.25 €"),
        ("day", 45000.5, *["2023-03-15"] * 4),
        ("time", 45000.5, *["15.3.2023 12:00"] * 4),
        ("span", 0.25, *["6:00:00"] * 4),
        ("1904", 45000.5, *["2027-03-16"] * 4),
        ("iso", 45000.5, *["2023-03-15"] * 4),
        ("day", 2e16, *["2e+16"] * 4),  # no date
    ],
)
def test_numbers(form, value, all_digits, one_decimal, six_digits, beside_an_axis):
    written = FORMS[form]
    assert [written.number(value), written.number(value, 1)] == [all_digits, one_decimal]
    assert [written.rough(value), written.tick(value, 2)] == [six_digits, beside_an_axis]


@pytest.mark.parametrize(
    ("code", "text"),
    [
        ('#,##0,,"M €"', "2,500,000 €"),  # the cell shows millions, and xlmc the whole amount
        ('"$"#,##0.0,"k"', "$2,500,000"),
        ('0.0,, "M" [$USD]', "2,500,000 USD"),
        ('"$"#,##0.0"M"', "$2,500,000M"),  # the cell itself holds millions
        ('"$"#,##0" a year"', "$2,500,000 a year"),
        ("#,##0", "2,500,000"),
    ],
)
def test_words_beside_money_say_what_the_number_is(code, text):
    assert Form(Kind.CURRENCY, code).number(2.5e6) == text


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("form", ["plain", "day", "percent"])
def test_what_is_no_number_is_not_written(form, value):
    assert FORMS[form].number(value) == FORMS[form].rough(value) == ""


@pytest.mark.parametrize(
    ("form", "result", "estimate", "value", "spread"),
    [
        ("plain", (1.23456, 0.012), "1.235 ± 0.012", "1.235", "1.235 ± 0.012"),
        ("plain", (-48210.0, 870.0), "-48,210 ± 870", "-48,210", "-48,210 ± 870"),
        ("plain", (5.0, 0.0), "5", "5", "5"),
        ("plain", (3.2, None), "3.2", "3.2", "3.2"),
        ("plain", (math.nan, 1.0), "", "", ""),
        ("whole", (5.0, 0.0), "5", "5", "5"),
        ("whole", (5.25, 0.01), "5.250 ± 0.010", "5.250", "5.250 ± 0.010"),
        ("percent", (0.0544, 0.0032), "5.44 ± 0.32 %", "5.44 %", "5.44 ± 0.32 %"),
        ("dollars", (-48210.0, 870.0), "-$48,210 ± 870", "-$48,210", "-$48,210 ± 870"),
        ("day", (46082.0, 1.2), "2026-03-01 ± 1.2 days", "2026-03-01", "46,082.0 ± 1.2 days"),
        ("day", (46082.0, None), "2026-03-01", "2026-03-01", "46,082 days"),
        ("day", (0.0, None), "1900-01-00", "1900-01-00", "0 days"),
        ("span", (0.0, 0.0), "0:00:00", "0:00:00", "0 s"),
        ("span", (0.25, 0.01), "6:00:00 ± 14 min", "6:00:00", "6.00 ± 0.24 h"),
        ("day", (0.0, 0.25), "1900-01-00 ± 6.0 h", "1900-01-00", "0.0 ± 6.0 h"),
        ("day", (math.nan, None), "", "", ""),
    ],
)
def test_numbers_with_errors(form, result, estimate, value, spread):
    written, given = FORMS[form], Estimate(*result)
    assert (written.estimate(given), written.value(given), written.spread(given)) == (estimate, value, spread)


@pytest.mark.parametrize("error", [1e-13, 1e-14, 1e-16, 3e-17, 1e-300])
def test_no_digit_is_written_that_a_number_does_not_have(error):
    like = Estimate(20.0, error)
    assert PLAIN.beside(20.0, like) == PLAIN.value(like) == PLAIN.number(20.0, 17) == "20"
    assert PLAIN.beside(-0.3, Estimate(-0.3, error / 1e3)) == "-0.3"


def test_a_number_beside_another_has_its_digits():
    plain = FORMS["plain"]
    assert plain.beside(2.0, Estimate(1.0, 0.012)) == "2.000"
    assert plain.beside(2.123456789, Estimate(1.0, None)) == "2.12346"
    assert (
        plain.beside(2.123456789, Estimate(1.0, 0.0)) == "2.12345679"
        or plain.beside(2.25, Estimate(1.0, 0.0)) == "2.25"
    )


@pytest.mark.parametrize(
    ("form", "low", "high", "text"),
    [
        ("plain", (172.5312, 0.7), (243.16, 0.97), "172.53 ± 0.70 to 243.16 ± 0.97"),
        ("plain", (1.0, 0.1), (2.0, 0.012), "1.00 ± 0.10 to 2.00 ± 0.01"),
        ("plain", (1.0, None), (2.0, 0.3), "1.00 to 2.00 ± 0.30"),
        ("plain", (1.0, None), (2.0, 0.0), "1.00 to 2"),
        ("plain", (1.0, 0.0), (2.25, 0.0), "1.00 to 2.25"),
        ("whole", (105.0, 0.0), (127.0, 0.0), "105 to 127"),
        ("percent", (105 / 116, 0.0), (127 / 116, 0.0), "90.517 % to 109.483 %"),
        ("percent", (0.1234567, 0.0), (127 / 116, 0.0), "12.34567 % to 109.48276 %"),
        ("dollars", (0.0, 0.0), (1e6 / 3, 0.0), "$0 to $333,333"),
        ("plain", (1e-9, 0.0), (2.5e-9, 0.0), "1e-09 to 2.5e-09"),
        ("percent", (1.0, None), (2.0, 0.3), "100 % to 200 ± 30 %"),
        ("day", (46082.0, 0.7), (46112.0, None), "2026-03-01 ± 17 h to 2026-03-31"),
    ],
)
def test_ranges(form, low, high, text):
    assert FORMS[form].ends(Estimate(*low), Estimate(*high), Estimate(1.0, 0.1)) == text


def test_decimals_of_two_numbers_are_those_of_the_larger_error():
    plain = FORMS["plain"]
    assert plain.decimals_of_both(Estimate(1.0, 0.1), Estimate(2.0, 0.012)) == 2
    assert plain.decimals_of_both(Estimate(1.0, None), Estimate(2.0, 0.012)) == 3
    assert plain.decimals_of_both(Estimate(1.0, None), Estimate(2.0, 0.0)) is None
    assert plain.decimals_of_both(Estimate(1e17, 0.1), Estimate(2.0, 0.012)) is None


DAY, HOUR, MINUTE, SECOND = 1.0, 1 / 24, 1 / 1440, 1 / 86_400


@pytest.mark.parametrize(
    ("form", "error", "step"),
    [
        ("plain", 1.0, None),
        ("whole", 1.9, 1.0),
        ("whole", 2.0, None),
        ("day", 0.0, DAY),
        ("day", 2.0, DAY),
        ("day", 30.0, 20 * DAY),
        ("day", 1e6, 10_000 * DAY),
        ("time", 1e-5, MINUTE),
        ("time", 0.5, 6 * HOUR),
        ("hour", 1e-5, HOUR),
        ("span", 1e-5, SECOND),
        ("span", 4 * SECOND, 2 * SECOND),
        ("iso", 0.0, DAY),
    ],
)
def test_steps_in_which_numbers_are_stated(form, error, step):
    result = FORMS[form].step(error)
    assert result is None if step is None else result == pytest.approx(step)


@pytest.mark.parametrize(
    ("width", "rounded"),
    [(0.0001, 10 * SECOND), (0.04, HOUR), (0.3, 6 * HOUR), (1.2, DAY), (3.4, 5 * DAY), (40, 50 * DAY)],
)
def test_bars_of_dates_have_round_widths(width, rounded):
    assert FORMS["day"].rounded_width(width) == pytest.approx(rounded)
    assert FORMS["plain"].rounded_width(width) == width


def test_what_formats_of_dates_show():
    assert {name: FORMS[name].shows for name in ("day", "time", "hour", "span", "iso")} == {
        "day": "day", "time": "time", "hour": "time", "span": "span", "iso": "day"
    }  # fmt: skip
    assert FORMS["iso"].moment_code == "yyyy-mm-dd"
    assert FORMS["time"].moment_code == "d.m.yyyy h:mm"
    assert (FORMS["day"].epoch, FORMS["1904"].epoch) == (25_569, 24_107)  # 1 January 1970
    assert FORMS["day"].number(25_569.0) == FORMS["1904"].number(24_107.0) == "1970-01-01"


@pytest.mark.parametrize(
    ("days", "error", "text", "exact"),
    [
        (1.0, None, "1.0 days", "1 day"),
        (2.0, None, "2.0 days", "2 days"),
        (-2.5, None, "-2.5 days", "-2.5 days"),
        (0.99, None, "24 h", "23.76 h"),
        (1 / 24, None, "1.0 h", "1 h"),
        (0.04, None, "58 min", "57.6 min"),
        (1 / 1440, None, "1.0 min", "1 min"),
        (0.0006, None, "52 s", "51.84 s"),
        (0.0, None, "0 s", "0 s"),
        (12.31, 0.042, "12.310 ± 0.042 days", None),
        (0.5, 0.1, "12.0 ± 2.4 h", None),
    ],
)
def test_spans(days, error, text, exact):
    assert span_text(days, error) == text
    if exact is not None:
        assert span_text(days, exact=True) == FORMS["day"].width(days) == exact


def test_days_share_no_axis_with_times_of_day():
    days, spans, numbers = (
        (FORMS["day"], FORMS["time"]),
        (FORMS["span"], Form(Kind.DATE, "h:mm AM/PM")),
        (PLAIN, FORMS["whole"]),
    )
    assert [len({each.axis for each in group}) for group in (days, spans, numbers)] == [1, 1, 1]
    assert len({each.axis for each in (days[0], spans[0], PLAIN, FORMS["percent"], FORMS["euros"])}) == 5


@pytest.mark.parametrize(
    ("form", "words"),
    [("day", "before after not after"), ("time", "before after not after"), ("span", "below above at most"),
     ("dollars", "below above at most")],
)  # fmt: skip
def test_one_day_is_before_another(form, words):
    assert " ".join(FORMS[form].side(each) for each in ("below", "above", "at most")) == words


@pytest.mark.parametrize(
    ("code", "order"),
    [("dd/mm/yyyy", "dmy"), ("m/d/yy h:mm", "mdy"), ("[$-409]d-mmm-yy", "dmy"), ("yyyy-mm-dd hh:mm", "ymd"),
     ('dddd, "am" d. mmmm yyyy', "dmy"), ("mmm-yy", "ymd"), ("h:mm d.m.yy", "dmy")],
)  # fmt: skip
def test_a_format_says_in_which_order_days_are_typed(code, order):
    assert Form(Kind.DATE, code).order == order


@pytest.mark.parametrize(
    ("code", "units", "text"),
    [
        ('#,##0 "€"', "EUR", "4,660"),
        ('#,##0 "EUR"', "€", "4,660"),
        ('"$"#,##0', "US$", "4,660"),
        ('"$"#,##0', "USD", "4,660"),
        ('"$"#,##0', "EUR", "$4,660"),
        ('"$"#,##0', "", "$4,660"),
        ('"$"#,##0', "a year", "$4,660"),
        ('"$"#,##0"/h"', "USD", "$4,660/h"),
        ("0%", "EUR", "466,000 %"),
    ],
)
def test_a_currency_is_said_once_beside_units_that_name_it(code, units, text):
    form = Form(kind_of_format(code), code).beside_units(units)
    assert form.number(4660.0) == text
    assert form.kind is kind_of_format(code)
