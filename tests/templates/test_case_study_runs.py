"""Figures of the case study of SAE 2001-01-3347 that need a run or a study of its own, computed elsewhere.

A normal error as a filter on one more uniform assumption (the U-row), a conflict behind rare trials, Sobol's total
indices, interval arithmetic on eq. (16), and what is lost where a chain hands on a mean and a standard deviation.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from committed_books import BOOKS
from simulated import simulated
from typed_cells import model_of, named_cells, with_typed

from xlmc.analysis.studies.sensitivity.pick_and_freeze import pick_and_freeze
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

ANSWERS = ("Chevrolet delta-V", "Nissan delta-V", "Chevrolet impact speed", "Nissan impact speed")


@pytest.fixture(scope="module")
def case():
    model = load(BOOKS["intersection"])
    return model, named_cells(model.workbook)


def with_reading(case, reading, percent):
    """The case study with a recorded delta-V of the Chevrolet, in mph, whose error is normal."""
    model, at = case
    row = Evidence("EDR", at["dV1_mph"], at["dV1_mph"], float(reading), "normal", {"percent": float(percent)})
    definitions = replace(model.definitions, filters=(*model.filters, as_filter(row)), evidence=(row,))
    return CompiledModel(model.workbook, definitions, model.path)


def agree(run, means, behind):
    """Whether means are as expected, within 4 standard errors of both and half a digit."""
    for name, (mean, digits) in means.items():
        result = run[name].mean
        assert result.value == pytest.approx(mean, abs=4 * result.error * math.sqrt(1 + behind) + 0.5 * 10.0**-digits)


@pytest.mark.parametrize("way", ["rejection", "weights"])
def test_a_normal_error_keeps_each_trial_with_its_weight(case, way):
    run = simulated(with_reading(case, 12, 5), 600_000, 2001, evidence=way)
    kept = run.acceptance.value * (1 if run.weighting is None else run.weighting.mean)
    assert kept == pytest.approx(0.010851, abs=4 * math.hypot(run.acceptance.error, 0.000023))
    agree(run, dict(zip(ANSWERS, ((11.962, 3), (23.373, 3), (33.499, 3), (4.790, 3)), strict=True)), 1)


def test_a_conflict_behind_rare_trials_is_found_with_the_same_means(case):
    run = simulated(with_reading(case, 16, 5), seed=1, evidence="rejection", until_accepted=10_000, rare="always")
    assert run.accepted >= 10_000
    assert run.acceptance.value == pytest.approx(2.94e-6, abs=4 * run.acceptance.error + 0.005e-6)
    shown = ("Chevrolet delta-V", "Chevrolet impact speed", "Nissan impact speed")
    agree(run, dict(zip(shown, ((13.23, 2), (35.21, 2), (5.56, 2)), strict=True)), 1)


def test_total_indices_without_filters(case):
    model, _ = case
    truths = {
        "Chevrolet delta-V": (
            ("Nissan post-impact deceleration", 0.43),
            ("Chevrolet approach angle", 0.24),
            ("Nissan approach angle", 0.19),
            ("Chevrolet departure angle", 0.105),
            ("Nissan post-impact travel distance", 0.07),
        ),
        "Chevrolet impact speed": (
            ("Chevrolet post-impact deceleration", 0.66),
            ("Nissan post-impact deceleration", 0.18),
            ("Nissan approach angle", 0.08),
        ),
        "Nissan impact speed": (
            ("Chevrolet approach angle", 0.64),
            ("Chevrolet departure angle", 0.27),
            ("Nissan departure angle", 0.07),
        ),
    }
    order = [each.name for each in model.forecasts]
    wanted = {name: [order.index(answer) for answer in truths] for name in model.draws}
    indices = pick_and_freeze(model, wanted, 400_000, 5).indices
    for answer, drivers in truths.items():
        totals = {name: result[order.index(answer)][1] for name, result in indices.items()}
        for name, truth in drivers:
            assert totals[name].value == pytest.approx(truth, abs=4 * totals[name].error + 0.005), (answer, name)
        others = set(totals) - {name for name, _ in drivers}
        assert all(totals[name].value < 0.045 for name in others), answer


class Interval:
    """All values between two ends; operations know nothing of what else a name stands in."""

    def __init__(self, low, high):
        self.low, self.high = low, high

    @staticmethod
    def of(value):
        return value if isinstance(value, Interval) else Interval(value, value)

    def __neg__(self):
        return Interval(-self.high, -self.low)

    def __add__(self, other):
        other = Interval.of(other)
        return Interval(self.low + other.low, self.high + other.high)

    def __sub__(self, other):
        return self + -Interval.of(other)

    def __mul__(self, other):
        other = Interval.of(other)
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval(min(ends), max(ends))

    def __truediv__(self, other):
        other = Interval.of(other)
        assert other.low * other.high > 0
        return self * Interval(1 / other.high, 1 / other.low)

    def of_angle(self, function):
        """The function, which turns at whole quarters, of an angle in degrees."""
        turns = range(math.ceil(self.low / 90), math.floor(self.high / 90) + 1)
        ends = [function(math.radians(each)) for each in (self.low, self.high, *(90 * turn for turn in turns))]
        return Interval(min(ends), max(ends))


def test_interval_arithmetic_tells_the_two_forms_of_the_slower_speed_apart(described):
    """Eq. (16) as printed could be anything; the form of the book comes close to the true ends, -3.24 and 24.88 mph."""
    template = described["intersection"]
    v = {each.symbol: Interval(*each.parameters.values()) for each in template.assumptions}
    g, mph = 32.174, 3600 / 5280
    for j in (1, 2):
        ends = v[f"f_{j}"] * v[f"s_{j}"]
        v[f"V{j}_f"] = Interval(*(math.sqrt(2 * g * end) for end in (ends.low, ends.high)))
        v[f"m_{j}"] = v[f"w_{j}"] / g

    def sine(angle):
        return angle.of_angle(math.sin)

    def cosine(angle):
        return angle.of_angle(math.cos)

    [book] = [each for section in template.sections for each in section.equations if each.symbol == "V2_i"]
    assert book.formula == "-(V2_f*SIN(RADIANS(beta_2-alpha_1))+p_1/m_2)/sin_delta"
    crossing = sine(v["alpha_1"] - v["alpha_2"])
    ratio = v["m_1"] / v["m_2"]
    rewritten = -(v["V2_f"] * sine(v["beta_2"] - v["alpha_1"]) + v["V1_f"] * sine(v["beta_1"] - v["alpha_1"]) * ratio)
    rewritten = rewritten / crossing * mph
    assert (rewritten.low, rewritten.high) == pytest.approx((-3.40, 24.88), abs=0.005)

    m_1, m_2 = v["m_1"], v["m_2"]
    first = v["V1_f"] * sine(v["beta_1"] - v["alpha_2"]) + m_2 / m_1 * v["V2_f"] * sine(v["beta_2"] - v["alpha_2"])
    printed = -m_1 * (first / crossing) * cosine(v["alpha_1"]) + m_1 * v["V1_f"] * cosine(v["beta_1"])
    printed = (printed + m_2 * v["V2_f"] * cosine(v["beta_2"])) / (m_2 * cosine(v["alpha_2"])) * mph
    assert (printed.low, printed.high) == pytest.approx((-693, 876), abs=0.5)


def test_a_mean_and_a_standard_deviation_lose_what_the_trials_have_in_common(read):
    """60 ft of skid, the impact speed handed on as a normal law, the friction drawn anew: .79 are above 48 mph.

    Trials carried through have 49.08, 2.76 and .59 (tests/montecarlo/model/test_joining.py).
    """
    book = read("skid-100-ft")
    at = named_cells(book)
    kind, low, high, mean, deviation, frozen = 6, 7, 8, 12, 13, 16
    friction, speed = (at[symbol] for symbol in ("f_1", "v_end"))
    typed = {at["d_1"]: 60.0, friction: 0.775, speed: 33.16317}
    typed |= {friction._replace(column=low): 0.6, friction._replace(column=high): 0.95}
    typed |= {speed._replace(column=column): None for column in (low, high)}
    typed |= {speed._replace(column=kind): "Normal", speed._replace(column=mean): 33.16317}
    typed |= {speed._replace(column=deviation): 1.76307}
    typed |= {cell._replace(column=frozen): False for cell in (friction, speed)}
    run = simulated(model_of(with_typed(book, typed)), 400_000)
    result = run["Speed at the beginning of the skid"]
    above = np.mean(run.forecasts["Speed at the beginning of the skid"] > 48)
    assert result.mean.value == pytest.approx(49.89, abs=4 * result.mean.error + 0.005)
    assert result.standard_deviation.value == pytest.approx(2.16, abs=4 * result.standard_deviation.error + 0.005)
    assert above == pytest.approx(0.79, abs=4 * math.sqrt(0.79 * 0.21 / run.accepted) + 0.005)
