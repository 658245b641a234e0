"""Two models of one answer: which tells more, and whether they agree. In the small books y is uniform."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies.comparison import compare
from xlmc.analysis.studies.comparison.paired_statistics import Accepted, range_of
from xlmc.analysis.studies.comparison.rivalry import RivalVerdict
from xlmc.analysis.studies.comparison.verdicts import verdict_text

SIZE = {"trials": 20_000, "seed": 1}
NEAR = {"m_1": (870, 890), "alpha_1": (-3, 3), "beta_1": (346, 356), "s_1": (6.4, 7.4), "f_1": (0.65, 0.75)}
NEAR |= {"m_2": (1580, 1620), "beta_2": (177, 187), "s_2": (13.8, 15.4), "f_2": (0.65, 0.75)}
CRUSHED = {"EES_1": (59, 73), "EES_2": (38, 46)}
"""Close to the head-on case of Schreier and Nelson; momentum alone also needs the second approach, 184° ± 3°."""
SQUARE = {"m_1": (1480, 1520), "alpha_1": (-3, 3), "beta_1": (73, 83), "s_1": (6.8, 7.6), "f_1": (0.65, 0.75)}
SQUARE |= {"m_2": (1480, 1520), "beta_2": (73, 83), "s_2": (6.8, 7.6), "f_2": (0.65, 0.75)}
CREEPING = {"EES_1": (32, 40), "EES_2": (32, 40), "phi_1": (5, 15), "phi_2": (-15, -5)}
CREEPING |= {"I_1": (2300, 2500), "I_2": (2300, 2500)}
"""Vehicle 1 at some 15 km/h before the front of one at 70: hardly any closing momentum beyond that across."""


def test_the_answer_with_the_smaller_spread_tells_more(answering):
    result = compare(answering("a", 0, 1), answering("b", 0.4, 0.6), **SIZE)
    (each,) = result.rivals
    assert each.rivalry.own == (("a",), ("b",))
    assert each.rivalry.sharper == 1
    for spread, widths in ((each.rivalry.deviation, (12**-0.5, 0.2 * 12**-0.5)), (each.rivalry.width, (0.51, 0.102))):
        for one, width in zip((spread.first, spread.second), widths, strict=True):
            assert abs(one.value - width) < 4 * one.error
    assert each.cause is None  # no cause is looked for: neither is the other made simpler
    assert result.runs == 2
    (text,) = verdict_text(result)
    assert text.startswith("y: b.xlsx tells more, with a standard deviation of 0.058")
    assert text.endswith("of a.xlsx. The two answers agree.")


@pytest.mark.parametrize(
    ("low", "expected"),
    [
        (0.3, RivalVerdict.AGREE),  # of b − a, a tenth of a tenth is below 0: P = 0.7²/2 doubled is 0.49
        (0.95, RivalVerdict.STRAINED),  # 0.05²/2 doubled is 0.0025
        (0.99, RivalVerdict.CONTRADICT),  # 0.0001
        (2.0, RivalVerdict.CONTRADICT),  # in no trial
    ],
)
def test_two_answers_contradict_where_0_is_far_out_among_their_differences(answering, low, expected):
    result = compare(answering("a", 0, 1), answering("b", low, low + 1), **SIZE)
    (each,) = result.rivals
    chance = max(0.0, 1.0 - low) ** 2
    assert abs(each.rivalry.chance - chance) <= 4 * (2 * chance / 20_000) ** 0.5  # twice a share of 20,000 trials
    assert each.rivalry.agreement is expected
    assert each.rivalry.sharper is None  # as wide
    assert "neither tells more, as far as these trials say" in verdict_text(result)[0]


def test_one_book_may_answer_twice(filled_in):
    """Marks and throw of one pedestrian: the two are told apart by the forecasts' names."""
    book, mine, theirs = (
        filled_in("pedestrian", {}),
        *(f"Vehicle impact speed, from the {what}" for what in ("marks", "throw")),
    )
    result = compare(book, book, pairs={mine: theirs}, **SIZE)
    (each,) = result.rivals
    assert (each.rivalry.sharper, each.rivalry.agreement) == (0, RivalVerdict.AGREE)
    (text,) = [line for line in verdict_text(result) if "tells more" in line]
    assert text.startswith(f"{mine} ({theirs}): '{mine}' tells more, with a standard deviation of ")
    assert f" mph of '{theirs}'. The two answers agree." in text


def test_few_trials_contradict_nothing(answering):
    result = compare(answering("a", 0, 1), answering("b", 2, 3), trials=500, seed=1)
    assert result.rivals[0].rivalry.agreement is RivalVerdict.TOO_FEW
    assert "Too few trials are accepted by both" in verdict_text(result)[0]


def test_a_model_that_only_leaves_something_out_is_no_rival(planar, momentum):
    result = compare(planar, momentum, "1 mph", trials=20_000, seed=1, causes=False)
    assert not result.rivals
    assert all(each.rivalry is None for each in result.forecasts)


def test_rivals_that_agree_within_the_tolerance_are_enough(answering):
    result = compare(answering("a", 0, 1), answering("b", 0, 1), "0.1", **SIZE)
    assert not result.rivals
    assert verdict_text(result) == ["The two books agree for y to 0.1."]


def test_energy_tells_more_than_momentum_where_approaches_are_near_parallel(filled_in):
    result = compare(
        filled_in("momentum-energy-si", NEAR | CRUSHED),
        filled_in("momentum-si", NEAR | {"alpha_2": (181, 187)}),
        **SIZE,
    )
    speeds = [each for each in result.rivals if each.first.name.endswith("impact speed")]
    assert [each.rivalry.sharper for each in speeds] == [0, 0]
    assert all(each.rivalry.agreement is RivalVerdict.AGREE for each in speeds)
    width = speeds[0].rivalry.width
    assert width.first.value < 4 < 100 < width.second.value  # km/h
    assert verdict_text(result)[0] == (
        "Each book computes 8 answers from inputs that the other has not: momentum-energy-si.xlsx tells more of 7; all "
        "agree."
    )


def test_momentum_tells_more_than_energy_where_hardly_any_closing_momentum_is_left(filled_in):
    result = compare(
        filled_in("momentum-energy-si", SQUARE | CREEPING),
        filled_in("momentum-si", SQUARE | {"alpha_2": (87, 93)}),
        **SIZE,
    )
    (slow,) = [each for each in result.rivals if each.first.name == "Vehicle 1 impact speed"]
    assert slow.rivalry.sharper == 1
    assert slow.rivalry.agreement is RivalVerdict.AGREE
    assert slow.rivalry.deviation.first.value > 1.3 * slow.rivalry.deviation.second.value


def test_the_error_of_a_width_is_its_spread_between_runs():
    rng = np.random.default_rng(5)
    result = [range_of(Accepted(np.arange(2000), rng.normal(size=2000)), 0.51).estimate for _ in range(200)]
    spread = np.std([each.value for each in result], ddof=1)  # known to 1/√400 = 5 %
    assert np.mean([each.error for each in result]) == pytest.approx(spread, rel=4 * 0.05)
    assert np.mean([each.value for each in result]) == pytest.approx(2 * 0.690309, abs=4 * spread / 200**0.5)
