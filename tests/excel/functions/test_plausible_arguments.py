"""Trials do not mix, with arguments for which functions of finance and dates have values; cf. `test_registry`."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import from_objects

early, middle, late = (st.integers(low, low + 999).map(float) for low in (39000, 40000, 41000))
day = st.integers(0, 45000).map(float) | st.floats(30000, 45000) | st.just(-3.0)
rate = st.floats(0, 0.2) | st.sampled_from([0.0, -0.1, 0.5, 1e-9])
amount = st.floats(1, 200) | st.sampled_from([0.0, -100.0, 100.0])
count = st.integers(1, 20).map(float) | st.floats(0.5, 20)
few = st.integers(1, 4).map(float)
frequency = st.sampled_from([1.0, 2.0, 4.0, 3.0])
basis = st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
due = st.sampled_from([0.0, 1.0])
yes = st.booleans()
weekend = st.sampled_from([1.0, 7.0, 11.0, "1010000", "1111111", 9.0, None])
unit = st.sampled_from(["Y", "m", "D", "MD", "YM", "YD", "?"])
moment = st.sampled_from(["1/2/2020", "13:45", "2020-01-15 13:45", "soon"])
flows = st.floats(-100, 100) | st.sampled_from([None, 0.0, 50.0, -50.0])
later_days = st.integers(40001, 42000).map(float)

BONDS = {"PRICE": rate, "YIELD": amount}
DISCOUNTS = ("DISC", "INTRATE", "PRICEDISC", "RECEIVED", "YIELDDISC")
COUPONS = ("COUPDAYBS", "COUPDAYS", "COUPDAYSNC", "COUPNCD", "COUPNUM", "COUPPCD")

PLAUSIBLE = {
    **dict.fromkeys(("PV", "FV", "PMT", "NPER"), (rate, count, amount, amount, due)),
    "RATE": (count, amount, amount.map(float.__neg__), amount, due, rate),
    **dict.fromkeys(("IPMT", "PPMT"), (rate, few, count, amount, amount, due)),
    "ISPMT": (rate, few, count, amount),
    **dict.fromkeys(("CUMIPMT", "CUMPRINC"), (rate, count, amount, few, few, due)),
    "RRI": (count, amount, amount),
    "PDURATION": (rate, amount, amount),
    **dict.fromkeys(("EFFECT", "NOMINAL"), (rate, count)),
    **dict.fromkeys(("DOLLARDE", "DOLLARFR"), (amount, count)),
    "FVSCHEDULE": (amount, [rate]),
    "NPV": (rate, [flows], [flows]),
    "IRR": ([flows], rate),
    "MIRR": ([flows], rate, rate),
    "XNPV": (rate, [flows], [later_days]),
    "XIRR": ([flows], [later_days], rate),
    "SLN": (amount, amount, count),
    "SYD": (amount, amount, count, few),
    "DB": (amount, amount, count, few, st.integers(1, 12).map(float)),
    "DDB": (amount, few, count, few, few),
    "VDB": (amount, few, count, few, count, few, yes),
    **dict.fromkeys(("AMORLINC", "AMORDEGRC"), (amount, early, middle, few, few, st.floats(0.05, 0.5), basis)),
    "ACCRINT": (early, middle, middle, rate, amount, frequency, basis, yes),
    "ACCRINTM": (early, middle, rate, amount, basis),
    **dict.fromkeys(COUPONS, (early, middle, frequency, basis)),
    **{name: (early, late, rate, third, amount, frequency, basis) for name, third in BONDS.items()},
    **dict.fromkeys(("DURATION", "MDURATION"), (early, late, rate, rate, frequency, basis)),
    **dict.fromkeys(DISCOUNTS, (early, late, rate, amount, basis)),
    **dict.fromkeys(("PRICEMAT", "YIELDMAT"), (middle, late, early, rate, amount, basis)),
    **dict.fromkeys(
        ("ODDFPRICE", "ODDFYIELD"), (middle, st.just(43100.0), early, late, rate, amount, amount, frequency, basis)
    ),
    **dict.fromkeys(("ODDLPRICE", "ODDLYIELD"), (middle, late, early, rate, amount, amount, frequency, basis)),
    **dict.fromkeys(("TBILLEQ", "TBILLPRICE", "TBILLYIELD"), (st.integers(40700, 40999).map(float), late, rate)),
    "DATE": (st.integers(-5, 3000).map(float), st.integers(-30, 30).map(float), st.floats(-50, 50)),
    "DATEDIF": (early | day, late | day, unit),
    **dict.fromkeys(("DATEVALUE", "TIMEVALUE"), (moment,)),
    **dict.fromkeys(("YEAR", "MONTH", "DAY", "HOUR", "MINUTE", "SECOND", "ISOWEEKNUM"), (day,)),
    "DAYS": (day, day),
    "DAYS360": (day, day, yes),
    **dict.fromkeys(("EDATE", "EOMONTH"), (day, st.floats(-50, 50))),
    "TIME": (count, count, count),
    **dict.fromkeys(("WEEKDAY", "WEEKNUM"), (day, st.sampled_from([1.0, 2.0, 3.0, 11.0, 14.0, 17.0, 21.0, 4.0]))),
    "YEARFRAC": (day, day, basis),
    "NETWORKDAYS": (middle, day, [middle]),
    "WORKDAY": (middle, st.integers(-60, 60).map(float), [middle]),
    "NETWORKDAYS.INTL": (middle, day, weekend, [middle]),
    "WORKDAY.INTL": (middle, st.integers(-60, 60).map(float), weekend, [middle]),
}


def _bits(item: object) -> object:
    return struct.pack("d", item) if isinstance(item, float) else item


@pytest.mark.parametrize("name", PLAUSIBLE)
@given(data=st.data())
@settings(max_examples=15, deadline=None)
def test_trials_together_are_the_trials_alone(name, data):
    n, k = data.draw(st.integers(2, 4)), data.draw(st.integers(1, 4))
    arguments = []
    for strategy in PLAUSIBLE[name]:
        in_cells = isinstance(strategy, list)
        items = np.empty((data.draw(st.sampled_from([1, n])), *((1, k) if in_cells else ())), object)
        of_one = strategy[0] if in_cells else strategy
        items.ravel()[:] = data.draw(st.lists(of_one, min_size=items.size, max_size=items.size))
        arguments.append(from_objects(items))
    together = function_named(name)(arguments).objects()
    for i in range(n):
        alone = function_named(name)([argument.take(np.array([i])) for argument in arguments]).objects()
        assert _bits(together[i if together.shape[0] == n else 0]) == _bits(alone[0])
