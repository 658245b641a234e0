"""The books of other fields give what quadrature, exact moments and publications give; 200,000 trials of each."""

from __future__ import annotations

import math
from functools import cache
from itertools import combinations

import numpy as np
import pytest
import typed_cells
from scipy import integrate, stats
from simulated import simulated
from typed_cells import named_cells, with_typed

from templates.build import TEMPLATES, editions
from templates.editions import Edition
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.diagnostics.checking import base_checks

TRIALS = 200_000
OTHERS = [name for name, template in TEMPLATES.items() if template.group]


@pytest.fixture(scope="module")
def long_run(model_of):
    """`long_run(name)`: 200,000 trials of a committed workbook."""
    return cache(lambda name: simulated(model_of(name), TRIALS))


def given(name, units=Edition.IMPERIAL):
    """Symbol -> the parameters of an assumption, or the value of a fixed input."""
    template = editions(TEMPLATES[name])[units]
    return {row.symbol: row.parameters or row.base for row in template.inputs}


def is_near(answer, truth, sd, trials=TRIALS):
    """Whether a mean of so many trials lies within 4 standard errors of the truth."""
    return abs(answer - truth) < 4 * sd / math.sqrt(trials)


def is_share(answer, truth, trials=TRIALS):
    return is_near(answer, truth, math.sqrt(truth * (1 - truth)), trials)


def gauss(n, low=0.0, high=1.0):
    """Nodes and weights of a rule over (low, high)."""
    x, w = np.polynomial.legendre.leggauss(n)
    return low + (high - low) * (x + 1) / 2, w * (high - low) / 2


# Kinds

KINDS = {
    "beam": {"Fails in 50 years": Kind.YES_NO, "Moment, share of the resistance": Kind.PERCENT},
    "tolerance-stack": {"Too tight in use": Kind.YES_NO, "Gap in use, share of the greatest allowed": Kind.PERCENT},
    "mass-calibration": {"Conforms to its class": Kind.YES_NO},
    "project": {
        "Cost of the project": Kind.CURRENCY,
        "Finish": Kind.DATE,
        "Over budget": Kind.YES_NO,
        "Cost, share of the budget": Kind.PERCENT,
    },
    "warranty": {"Cost of all claims": Kind.CURRENCY, "A unit leads to a paid claim": Kind.YES_NO},
}


@pytest.mark.parametrize("name", KINDS)
def test_answers_show_what_they_are(name, model_of):
    result = {each.name: each.kind for each in model_of(name).forecasts}
    assert KINDS[name].items() <= result.items()


@pytest.mark.parametrize("name", OTHERS)
def test_no_word_of_crashes_stands_in_them(name, read):
    texts = [str(cell.value) for sheet in read(name).sheets.values() for cell in sheet.cells.values()]
    for word in ("crash", "vehicle", "reconstruction", "impact", "physics check", "the paper", "scene"):
        assert not [text for text in texts if word in text.casefold()]


# Beam


def beam_failure(units):
    """P(the loads exceed the resistance | it carried the test load), by quadrature over all but the live load."""
    p = given("beam", units)
    lever = p["span"] ** 2 / 8
    factor = p["Z_x"] / p.get("in_per_ft", p.get("unit"))
    dead = stats.norm(p["dead"]["Mean"], p["dead"]["Mean"] * p["dead"]["CoV %"] / 100)
    spread = p["live"]["Mean"] * p["live"]["CoV %"] / 100 * math.sqrt(6) / math.pi
    live = stats.gumbel_r(p["live"]["Mean"] - np.euler_gamma * spread, spread)
    sigma = math.sqrt(math.log1p((p["fy"]["CoV %"] / 100) ** 2))
    median = p["fy"]["Mean"] / math.exp(sigma**2 / 2)
    u, w = gauss(40)
    factors = [stats.norm(q["Mean"], q["Mean"] * q["CoV %"] / 100) for q in (p["fabrication"], p["professional"])]
    d, f, k = np.meshgrid(dead.ppf(u), *(each.ppf(u) for each in factors), indexing="ij")
    weight = w[:, None, None] * w[None, :, None] * w[None, None, :]
    least = stats.norm.cdf(np.log(p["q_test"] * lever / (f * k * factor) / median) / sigma)
    failed = 0.0
    for node, share in zip(*gauss(60), strict=True):
        strength = median * np.exp(sigma * stats.norm.ppf(least + (1 - least) * node))
        failed += share * float(np.sum(weight * (1 - least) * live.sf(f * k * strength * factor / lever - d)))
    kept = float(np.sum(weight * (1 - least)))
    return failed / kept, kept


@pytest.mark.parametrize(("name", "units"), [("beam", Edition.IMPERIAL), ("beam-si", Edition.SI)])
def test_a_beam_fails_as_often_as_quadrature_says(name, units, long_run):
    run = long_run(name)
    failure, kept = beam_failure(units)
    assert 0.001 < failure < 0.01
    assert is_share(run.accepted / TRIALS, kept)
    assert is_share(run["Fails in 50 years"].statistics.mean.value, failure, run.accepted)


# Tolerance stack


def moments(p):
    """Mean and variance of an assumption."""
    if "Std dev" in p:
        return p["Mean"], p["Std dev"] ** 2
    low, high = p["Low"], p["High"]
    if "Likeliest" in p:
        likeliest = p["Likeliest"]
        square = low**2 + high**2 + likeliest**2 - low * high - low * likeliest - high * likeliest
        return (low + likeliest + high) / 3, square / 18
    return (low + high) / 2, (high - low) ** 2 / 12


def test_the_gap_has_the_variance_of_its_parts(long_run):
    run, p = long_run("tolerance-stack-si"), given("tolerance-stack", Edition.SI)
    parts = {each: moments(p[each]) for each in ("housing", "bearing", "spacer", "gear", "ring")}
    mean = parts["housing"][0] - sum(m for m, _ in list(parts.values())[1:])
    variance = sum(v for _, v in parts.values())
    result = run["Gap as assembled"].statistics
    assert is_near(result.mean.value, mean, math.sqrt(variance))
    assert result.standard_deviation.value == pytest.approx(math.sqrt(variance), rel=0.01)
    shares = {row.assumption: row for row in sensitivities(run)["Gap as assembled"].influences}
    names = {row.symbol: row.name for row in editions(TEMPLATES["tolerance-stack"])[Edition.SI].assumptions}
    for symbol, (_, part) in parts.items():
        row = shares[names[symbol]]
        for index in (row.first_order, row.total):
            assert index.value == pytest.approx(part / variance, abs=4 * index.error + 1e-12)


def test_parts_are_too_tight_as_often_as_their_densities_say(long_run):
    """Given the three of the temperature, the gap in use is a sum of scaled parts, whose density is a convolution."""
    p, step = given("tolerance-stack", Edition.SI), 0.0005
    grid = np.arange(-1, 1, step)
    wave = np.fft.fftfreq(len(grid), step) * 2 * np.pi

    def shape(part, scale):
        """The characteristic function of a part about its mean."""
        q = p[part]
        if "Std dev" in q:
            return np.exp(-((wave * scale * q["Std dev"]) ** 2) / 2)
        half = (q["High"] - q["Low"]) / 2 * scale
        if "Likeliest" in q:
            return np.sinc(wave * half / 2 / np.pi) ** 2
        return np.sinc(wave * half / np.pi)

    tight = 0.0
    means = {part: moments(p[part])[0] for part in ("housing", "bearing", "spacer", "gear", "ring")}
    x, w = gauss(8)
    for i, j, k in np.ndindex(8, 8, 8):
        warming, a_housing, a_parts = (
            p[each]["Low"] + (p[each]["High"] - p[each]["Low"]) * x[at]
            for each, at in (("warming", i), ("a_housing", j), ("a_parts", k))
        )
        outer, inner = 1 + a_housing * warming / 1e6, 1 + a_parts * warming / 1e6
        mean = means["housing"] * outer - inner * sum(means[part] for part in list(means)[1:])
        spectrum = shape("housing", outer)
        for part in list(means)[1:]:
            spectrum = spectrum * shape(part, inner)
        density = np.fft.fftshift(np.fft.ifft(spectrum).real) / step
        tight += w[i] * w[j] * w[k] * float(np.sum(density[grid < p["gap_min"] - mean]) * step)
    assert 1e-4 < tight < 1e-2
    assert is_share(long_run("tolerance-stack-si")["Too tight in use"].statistics.mean.value, tight)


def rectangular_sum(widest, probability):
    """A quantile of the sum of three rectangular quantities of standard deviation 1 and one that is wider."""
    half, step = math.sqrt(3) * widest, 0.001
    one = (np.abs(np.arange(-math.sqrt(3), math.sqrt(3) + step / 2, step)) <= math.sqrt(3)).astype(float)
    three = np.convolve(np.convolve(one, one), one)
    t = (np.arange(len(three)) - (len(three) - 1) / 2) * step
    three /= three.sum()
    x = np.linspace(-half - t[-1], half + t[-1], 4001)
    cdf = np.array([three @ np.clip((at - t + half) / (2 * half), 0, 1) for at in x])
    return float(np.interp(probability, cdf, x))


@pytest.mark.parametrize("widest", [1, 10], ids=["four alike", "one ten times as wide"])
def test_a_stack_of_four_is_a_sum_of_rectangular_quantities(widest, read):
    """With four alike, JCGM 101:2008, 9.2.3: a standard uncertainty of 2.0, and 95 % within ±3.88."""
    deviation, end = math.sqrt(3 + widest**2), rectangular_sum(widest, 0.975)
    if widest == 1:
        assert (round(deviation, 1), round(end, 2)) == (2.0, 3.88)
    book, typed = read("tolerance-stack"), {}
    at = named_cells(book)
    header = {content.value: place[1] for place, content in book.sheets["Inputs"].cells.items() if place[0] == 5}

    def row(symbol, **columns):
        return {
            Cell("Inputs", at[symbol].row, header[name.replace("_", " ")]): value for name, value in columns.items()
        }

    for symbol in ("housing", "warming", "a_housing", "a_parts"):
        typed |= {symbol: 0, **row(symbol, Frozen=True)}
    for symbol in ("bearing", "spacer", "gear", "ring"):
        half = math.sqrt(3) * (widest if symbol == "ring" else 1)
        blank = dict.fromkeys(("Likeliest", "Mean", "Std_dev"))
        typed |= {symbol: 0, **row(symbol, Distribution="Uniform", Low=-half, High=half, **blank)}
    result = simulated(typed_cells.model_of(with_typed(book, typed)), TRIALS)["Gap as assembled"]
    assert is_near(result.statistics.mean.value, 0, deviation)
    assert result.statistics.standard_deviation.value == pytest.approx(deviation, rel=0.01)
    np.testing.assert_allclose(np.quantile(result.values, [0.025, 0.975]), [-end, end], atol=0.01 * deviation)


# Calibration of a weight


def test_a_calibration_gives_what_quadrature_over_its_densities_gives(long_run):
    """Given the densities the deviation is normal: its distribution is a mean of normal ones."""
    p = given("mass-calibration")
    result = long_run("mass-calibration")["Deviation from the nominal mass"]
    x, w = gauss(24)
    air, weight, reference = (
        p[each]["Low"] + (p[each]["High"] - p[each]["Low"]) * x for each in ("rho_a", "rho_W", "rho_R")
    )
    a, b, c = np.meshgrid(air, weight, reference, indexing="ij")
    share = w[:, None, None] * w[None, :, None] * w[None, None, :]
    mean = p["m_Rc"]["Mean"] - p["m_nom"] + p["dm_Rc"]["Mean"]
    buoyancy = (p["m_Rc"]["Mean"] + p["dm_Rc"]["Mean"]) * (a - p["rho_a0"]) * (1 / b - 1 / c)
    spread = math.hypot(p["m_Rc"]["Std dev"], p["dm_Rc"]["Std dev"])
    deviation = math.sqrt(spread**2 + float(np.sum(share * buoyancy**2)) - float(np.sum(share * buoyancy)) ** 2)
    assert is_near(result.statistics.mean.value, mean + float(np.sum(share * buoyancy)), deviation)
    assert result.statistics.standard_deviation.value == pytest.approx(deviation, rel=0.007)
    for quantile in (0.025, 0.975):
        at = np.quantile(result.values, quantile)
        below = float(np.sum(share * stats.norm.cdf((at - mean - buoyancy) / spread)))
        assert is_share(below, quantile)


def test_what_acts_only_together_has_a_total_effect_and_none_alone(long_run):
    """The variance of (ρa − 1.2)(1/ρW − 1/ρR) is a product; the rest is a sum of two normal ones."""
    p = given("mass-calibration")
    _, air = moments(p["rho_a"])

    def inverse(q):
        low, high = q["Low"], q["High"]
        mean, square = math.log(high / low) / (high - low), 1 / (low * high)
        return mean, square - mean**2

    (w_mean, w), (r_mean, r) = inverse(p["rho_W"]), inverse(p["rho_R"])
    product = 1e10 * air * (w + r + (w_mean - r_mean) ** 2)
    variance = 0.05**2 + 0.02**2 + product
    run = long_run("mass-calibration")
    rows = {row.assumption: row for row in sensitivities(run)["Deviation from the nominal mass"].influences}
    alone, together = rows["Density of the air"].first_order, rows["Density of the air"].total
    assert alone.value == pytest.approx(1e10 * air * (w_mean - r_mean) ** 2 / variance, abs=4 * alone.error)
    assert together.value == pytest.approx(product / variance, abs=4 * together.error)
    assert together.value > 0.4
    reference = rows["Conventional mass of the reference weight"].first_order
    assert reference.value == pytest.approx(0.05**2 / variance, abs=4 * reference.error)
    assert run["Deviation from the nominal mass"].statistics.variance.value == pytest.approx(variance, rel=0.015)


# Project

ACTIVITIES = ("design", "supply", "site", "build", "tests")
RISKS = ("ground", "permit", "price", "rework")


def triangular(p):
    width = p["High"] - p["Low"]
    return stats.triang((p["Likeliest"] - p["Low"]) / width, p["Low"], width)


def joint(one, two, rank):
    """The covariance of two quantities whose rank correlation a Gaussian copula gives."""
    r = 2 * math.sin(math.pi * rank / 6)
    x, w = np.polynomial.hermite_e.hermegauss(80)
    w = w / math.sqrt(2 * math.pi)
    first = one.ppf(stats.norm.cdf(x))
    second = two.ppf(stats.norm.cdf(r * x[:, None] + math.sqrt(1 - r * r) * x))
    return float(w @ (first * (second @ w))) - one.mean() * two.mean()


def later(one, two):
    """Mean and variance of the later of two, and the probability that the first is it."""
    t = np.linspace(min(one.support()[0], two.support()[0]), max(one.support()[1], two.support()[1]), 200_001)
    both = one.cdf(t) * two.cdf(t)
    mean = t[-1] - integrate.trapezoid(both, t)
    square = t[-1] ** 2 - integrate.trapezoid(2 * t * both, t)
    return mean, square - mean**2, integrate.trapezoid(one.pdf(t) * two.cdf(t), t)


def test_a_project_has_the_mean_and_the_deviation_of_its_parts(long_run):
    run, p = long_run("project"), given("project")
    time = {each: triangular(p[f"t_{each}"]) for each in ACTIVITIES}
    cost = {each: triangular(p[f"c_{each}"]) for each in ACTIVITIES}
    mean, variance, critical = later(time["supply"], time["site"])
    days = mean + sum(time[each].mean() for each in ("design", "build", "tests"))
    days_variance = variance + sum(time[each].var() for each in ("design", "build", "tests"))
    money = sum(each.mean() for each in cost.values())
    money_variance = sum(each.var() for each in cost.values())
    for risk in RISKS:
        q, event, delay = p[f"r_{risk}"]["Probability"], triangular(p[f"i_{risk}"]), triangular(p[f"l_{risk}"])
        both = event.mean() + p["daily"] * delay.mean()
        days, money = days + q * delay.mean(), money + q * event.mean()
        days_variance += q * delay.var() + q * (1 - q) * delay.mean() ** 2
        money_variance += q * (event.var() + p["daily"] ** 2 * delay.var()) + q * (1 - q) * both**2
    quiet = variance + sum(time[each].var() for each in ("design", "build", "tests"))
    money, money_variance = money + p["daily"] * days, money_variance + p["daily"] ** 2 * quiet
    at = {f"t_{each}": time[each] for each in ACTIVITIES} | {f"c_{each}": cost[each] for each in ACTIVITIES}
    rows = {frozenset((row.first, row.second)): row.correlation for row in TEMPLATES["project"].correlations}
    for one, two in combinations(at, 2):
        rank = rows.get(frozenset((one, two)), 0)
        if rank and "t_site" not in (one, two):
            weight = math.prod(p["daily"] if each.startswith("t") else 1 for each in (one, two))
            money_variance += 2 * weight * joint(at[one], at[two], rank)
    money_variance += 2 * p["daily"] * later_with_cost(time, cost["site"], rows[frozenset(("t_site", "c_site"))])
    result = run["Cost of the project"].statistics
    assert is_near(result.mean.value, money, math.sqrt(money_variance))
    assert result.standard_deviation.value == pytest.approx(math.sqrt(money_variance), rel=0.006)
    result = run["Duration"].statistics
    assert is_near(result.mean.value, days, math.sqrt(days_variance))
    assert result.standard_deviation.value == pytest.approx(math.sqrt(days_variance), rel=0.006)
    assert is_share(run["Procurement decides the finish"].statistics.mean.value, critical)


def later_with_cost(time, cost, rank):
    """The covariance of the later of procurement and site works with the cost of these, which site works go with."""
    supply, site = time["supply"], time["site"]
    t = np.linspace(0, supply.support()[1], 4_001)
    grid, step = supply.cdf(t), t[1] - t[0]

    class Later:
        """E[max(supply, site) | site], as a quantity that rises with site."""

        @staticmethod
        def mean():
            return later(supply, site)[0]

        @staticmethod
        def ppf(u):
            s = site.ppf(u)
            below = np.concatenate(([0.0], np.cumsum((grid[1:] + grid[:-1]) * step / 2)))
            expected = np.where(s < t[-1], t[-1] - (below[-1] - np.interp(s, t, below)), s)
            return np.maximum(expected, s)

    return joint(Later, cost, rank)


def test_a_finish_is_a_working_day(long_run):
    result = np.unique(long_run("project")["Finish"].values)
    assert (np.mod(result, 7) >= 2).all()  # days 0 and 1 of 7 are a Saturday and a Sunday
    assert len(result) > 50


# Warranty


def claim(p, power=1):
    """E[p^power] of the probability of a paid claim, over scale and shape."""
    x, w = np.polynomial.hermite_e.hermegauss(40)
    w = w / math.sqrt(2 * math.pi)
    sigma = math.sqrt(math.log1p((p["eta"]["CoV %"] / 100) ** 2))
    eta = p["eta"]["Mean"] * np.exp(sigma * x - sigma**2 / 2)
    shape = p["shape"]["Mean"] + p["shape"]["Std dev"] * x
    paid = (1 - p["share_refused"]) * -np.expm1(-((p["term"] / eta[:, None]) ** shape))
    return float(w @ paid**power @ w)


def test_a_warranty_costs_what_its_integral_says(long_run):
    run, p = long_run("warranty"), given("warranty")
    (table,) = TEMPLATES["warranty"].data
    prices = np.array(table.rows)
    repair = float(prices[:, 0] @ prices[:, 1])
    once, twice, sold = claim(p), claim(p, 2), p["sold"]
    assert is_share(run["A unit leads to a paid claim"].statistics.mean.value, once)
    square = once * float(prices[:, 0] ** 2 @ prices[:, 1])
    deviation = math.sqrt(square - (once * repair) ** 2)
    assert is_near(run["Warranty cost of a unit sold"].statistics.mean.value, once * repair, deviation)
    claims = run["Paid claims of all units sold"].statistics
    spread = math.sqrt(sold * (once - twice) + sold**2 * (twice - once**2))
    assert is_near(claims.mean.value, sold * once, spread)
    assert claims.standard_deviation.value == pytest.approx(spread, rel=0.006)
    assert is_near(run["Cost of all claims"].statistics.mean.value, sold * once * repair, spread * repair)


def test_probabilities_of_repairs_that_do_not_add_up_are_told(read):
    book = read("warranty")
    (row,) = (at[0] for at, content in book.sheets["Inputs"].cells.items() if content.value == 0.55)
    model = typed_cells.model_of(with_typed(book, {Cell("Inputs", row, 2): 0.5}))
    (failing,) = (check.fault for check in base_checks(model) if not check.holds)
    assert "The probabilities of the repairs add up to 1" in failing
