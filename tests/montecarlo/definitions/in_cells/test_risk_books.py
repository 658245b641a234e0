"""Twelve books in the way of @RISK's examples, run as they are: mean, deviation and percentiles against exact answers.

Each lies within four standard errors of the exact one. The seed is fixed; a right answer misses with a probability of
6e-5. Errors of percentiles are those of the share below them.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from openpyxl import Workbook
from scipy import integrate, stats
from simulated import simulated

from xlmc.montecarlo.model.loading import load

TRIALS = 20_000


def pert(low, likeliest, high):
    a = 1 + 4 * (likeliest - low) / (high - low)
    return stats.beta(a, 6 - a, low, high - low)


def layer(severity, deductible, limit):
    """Mean and mean square of min(max(X - d, 0), L)."""
    tail = severity.sf
    first = integrate.quad(lambda y: tail(deductible + y), 0, limit)[0]
    return first, integrate.quad(lambda y: 2 * y * tail(deductible + y), 0, limit)[0]


def normal_loss(z):
    """E[max(Z - z, 0)] of a standard normal."""
    return stats.norm.pdf(z) - z * stats.norm.sf(z)


ITEMS = [pert(80, 100, 150), pert(40, 50, 90), pert(10, 15, 30)]
LOMAX = layer(stats.lomax(2.5, scale=100), 50, 400)
LOSS = layer(stats.lognorm(math.sqrt(math.log(2)), scale=10_000 / math.sqrt(2)), 5_000, 40_000)
RESERVES = stats.lognorm(math.sqrt(0.25 + 0.09 + 0.04), scale=math.exp(2 + 1 - 0.5))
D1 = (math.log(100 / 105) + 0.05 + 0.02) / 0.2
PAYOFF = stats.lognorm(0.2, scale=100 * math.exp(0.05 - 0.02))
CALL = integrate.quad(lambda s: (s - 105) ** 2 * PAYOFF.pdf(s), 105, 2000)[0]
CALL_MEAN = 100 * math.exp(0.05) * stats.norm.cdf(D1) - 105 * stats.norm.cdf(D1 - 0.2)
BEST_BID = stats.weibull_min(3, 100, 50 / 4 ** (1 / 3))
ORDER = stats.norm.ppf(0.75)

BOOKS = {
    # three cost items, a risk that may occur, and the whole with its 90 % percentile
    "project cost": (
        {
            "B2": '=RiskPert(80,100,150,RiskName("civil"))',
            "B3": '=RiskPert(40,50,90,RiskName("steel"))',
            "B4": '=RiskPert(10,15,30,RiskName("fees"))',
            "B5": "=RiskBernoulli(0.3)*RiskUniform(10,30)",
            "B6": '=RiskOutput("cost")+SUM(B2:B5)',
        },
        "cost",
        sum(item.mean() for item in ITEMS) + 6,
        math.sqrt(sum(item.var() for item in ITEMS) + 0.3 * (400 + 400 / 12) - 36),
        {},
    ),
    # a range estimate by double triangles, as AACE recommends it
    "range estimate": (
        {
            "A1": "=RiskDoubleTriang(0,4,10,0.76)",
            "A2": "=RiskDoubleTriang(20,30,60,0.4)",
            "A3": '=RiskOutput("contingency")+A1+A2',
        },
        "contingency",
        4 + (0.24 * 6 - 0.76 * 4) / 3 + 30 + (0.6 * 30 - 0.4 * 10) / 3,
        math.sqrt(
            (0.76 * 16 + 0.24 * 36) / 6 - ((0.24 * 6 - 0.76 * 4) / 3) ** 2
            + (0.4 * 100 + 0.6 * 900) / 6 - ((0.6 * 30 - 0.4 * 10) / 3) ** 2
        ),
        {},
    ),
    # two strings of work, the later of which ends the project
    "schedule": (
        {
            "A1": "=RiskErlang(1,4)",
            "A2": "=RiskExpon(4)",
            "A3": '=RiskOutput("end")+MAX(A1:A2)',
        },
        "end",
        6,
        math.sqrt(20),
        {0.5: -4 * math.log(1 - math.sqrt(0.5)), 0.9: -4 * math.log(1 - math.sqrt(0.9))},
    ),
    # oil in place: a product of lognormals is one
    "reserves": (
        {
            "A1": "=RiskLognorm2(2,0.5)",
            "A2": "=RiskLognorm2(1,0.3)",
            "A3": "=RiskLognorm2(-0.5,0.2)",
            "A4": '=RiskOutput("reserves")+A1*A2*A3',
        },
        "reserves",
        RESERVES.mean(),
        RESERVES.std(),
        {0.1: RESERVES.ppf(0.1), 0.5: RESERVES.ppf(0.5), 0.9: RESERVES.ppf(0.9)},
    ),
    # claims of a year above 5,000 each, up to 40,000 each
    "insurance claims": (
        {"A1": '=RiskOutput("claims")+RiskCompound(RiskPoisson(5),RiskLognorm(10000,10000),5000,40000)'},
        "claims",
        5 * LOSS[0],
        math.sqrt(5 * LOSS[1]),
        {},
    ),
    # a reinsured layer of losses with a heavy tail, in cells of their own
    "reinsurance": (
        {
            "A1": "=RiskNegbin(4,0.5)",
            "A2": "=RiskPareto2(100,2.5)",
            "A3": '=RiskOutput("layer")+RiskCompound(A1,A2,B1,B2)',
            "B1": 50,
            "B2": 400,
        },
        "layer",
        4 * LOMAX[0],
        math.sqrt(4 * (LOMAX[1] - LOMAX[0] ** 2) + 8 * LOMAX[0] ** 2),
        {},
    ),
    # two assets and their rank correlation
    "portfolio": (
        {
            "F1": 1, "F2": 0.6, "G2": 1,
            "A1": "=RiskNormal(0.08,0.2,RiskCorrmat(F1:G2,1))",
            "A2": "=RiskNormal(0.05,0.1,RiskCorrmat(F1:G2,2))",
            "A3": '=RiskOutput("return")+0.4*A1+0.6*A2',
        },
        "return",
        0.062,
        math.sqrt(0.08**2 + 0.06**2 + 2 * 0.08 * 0.06 * 2 * math.sin(math.pi * 0.1)),
        {0.05: stats.norm(0.062, math.sqrt(0.01 + 0.0096 * 2 * math.sin(math.pi * 0.1))).ppf(0.05)},
    ),
    # t margins in a t copula are a multivariate t, whose sum is one of t again
    "portfolio with tails": (
        {
            "K1": "t", "L1": "df", "M1": 4, "K2": 1, "K3": 0.5, "L3": 1,
            "A1": "=0.1*RiskStudent(4,RiskCopula($K$1:$M$3,1))",
            "A2": "=0.2*RiskStudent(4,RiskCopula($K$1:$M$3,2))",
            "A3": '=RiskOutput("return")+A1+A2',
        },
        "return",
        0,
        math.sqrt(0.07 * 2),
        {p: math.sqrt(0.07) * stats.t(4).ppf(p) for p in (0.01, 0.05, 0.5, 0.95)},
    ),
    # a call on a share
    "option": (
        {
            "A1": "=100*EXP(0.05-0.02+0.2*RiskNormal(0,1))",
            "A2": '=RiskOutput("payoff")+MAX(A1-105,0)',
        },
        "payoff",
        CALL_MEAN,
        math.sqrt(CALL - CALL_MEAN**2),
        {},
    ),
    # how many to order: the 75 % percentile of the demand itself, and what is sold then
    "newsvendor": (
        {
            "A1": "=RiskNormal(100,20)",
            "A2": "=RiskTheoPtoX(A1,0.75)",
            "A3": '=RiskOutput("left over")+MAX(A2-A1,0)',
        },
        "left over",
        20 * (ORDER + normal_loss(ORDER)),
        20 * math.sqrt(
            (ORDER**2 + 1) * stats.norm.cdf(ORDER) + ORDER * stats.norm.pdf(ORDER) - (ORDER + normal_loss(ORDER)) ** 2
        ),
        {},
    ),
    # a drug passes three stages or does not; its market is a subjective beta
    "stage gates": (
        {
            "A1": "=RiskBinomial(1,0.6)",
            "A2": "=RiskBinomial(1,0.5)",
            "A3": "=RiskBernoulli(0.8)",
            "A4": "=RiskBetaSubj(100,300,400,1100)",
            "A5": '=RiskOutput("value")+A1*A2*A3*A4-50',
        },
        "value",
        0.24 * 400 - 50,
        math.sqrt(0.24 * (stats.beta(1.8, 4.2, 100, 1000).var() + 400**2) - 96**2),
        {},
    ),
    # the lowest of four bids
    "bids": (
        {
            **{f"A{i}": "=RiskWeibull(3,50,RiskShift(100))" for i in range(1, 5)},
            "B1": '=RiskOutput("lowest")+MIN(A1:A4)',
        },
        "lowest",
        BEST_BID.mean(),
        BEST_BID.std(),
        {0.1: BEST_BID.ppf(0.1), 0.9: BEST_BID.ppf(0.9)},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BOOKS)
def test_books_of_risk(tmp_path, name):
    cells, output, mean, deviation, percentiles = BOOKS[name]
    book = Workbook()
    sheet = book.active
    for address, value in cells.items():
        sheet[address] = value
    book.save(tmp_path / "book.xlsx")
    result = simulated(load(tmp_path / "book.xlsx"), trials=TRIALS, seed=999)[output]
    assert result.values.size == TRIALS
    assert abs(result.mean.value - mean) < 4 * deviation / math.sqrt(TRIALS)
    assert abs(result.standard_deviation.value - deviation) < 4 * result.standard_deviation.error
    for share, exact in percentiles.items():
        below = np.mean(result.values <= exact)
        assert abs(below - share) < 4 * math.sqrt(share * (1 - share) / TRIALS), share


def test_there_are_twelve():
    assert len(BOOKS) == 12
