"""A million draws of each form of @RISK's distributions against SciPy or an independent sampler.

`python benchmarks/risk_draws.py [DRAWS]` writes each form into a workbook as a call, draws it with xlmc, and prints how
many standard errors mean, variance and Kolmogorov and Smirnov's distance are away from the oracle. A distance D of n
draws counts as √n·D/0.27 less its mean, 0.87/0.27: its limit law has these moments. Where there is no variance, or no
fourth moment to tell the error of one, there is a dash. Copulas: Kendall's tau of their formulas, and the share of
trials with both below 0.01, and above 0.99. It ends with code 1 where anything is 4 or more standard errors away.
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from openpyxl import Workbook
from scipy import stats
from scipy.integrate import quad

import xlmc

DRAWS = 1_000_000
SEED = 999
FEW = 20_000

EXACT = {
    "RiskBetaSubj(0,2,3,10)": stats.beta(1.8, 4.2, 0, 10),
    "RiskBurr12(1,2,3,1.5)": stats.burr12(3, 1.5, 1, 2),
    "RiskCauchy(10,2)": stats.cauchy(10, 2),
    "RiskChiSq(7)": stats.chi2(7),
    "RiskDagum(1,2,3,1.5)": stats.burr(3, 1.5, 1, 2),
    "RiskErf(2)": stats.norm(0, 0.25 * math.sqrt(2)),
    "RiskErlang(3,2)": stats.gamma(3, scale=2),
    "RiskExtvalueMin(5,2)": stats.gumbel_l(5, 2),
    "RiskF(3,12)": stats.f(3, 12),
    "RiskFatigueLife(1,2,0.5)": stats.fatiguelife(0.5, 1, 2),
    "RiskFrechet(1,2,6)": stats.invweibull(6, 1, 2),
    "RiskHypSecant(10,2)": stats.hypsecant(10, 4 / math.pi),
    "RiskInvGauss(3,5)": stats.invgauss(0.6, 0, 5),
    "RiskJohnsonMoments(10,2,0,3)": stats.norm(10, 2),
    "RiskJohnsonSB(1,2,10,20)": stats.johnsonsb(1, 2, 10, 10),
    "RiskJohnsonSU(-1,2,10,3)": stats.johnsonsu(-1, 2, 10, 3),
    "RiskLaplace(10,2)": stats.laplace(10, math.sqrt(2)),
    "RiskLevy(1,2)": stats.levy(1, 2),
    "RiskLogLogistic(1,2,6)": stats.fisk(6, 1, 2),
    "RiskPareto2(2,6)": stats.lomax(6, 0, 2),
    "RiskPearson5(6,2)": stats.invgamma(6, 0, 2),
    "RiskPearson6(3,7,2)": stats.betaprime(3, 7, 0, 2),
    "RiskRayleigh(3)": stats.rayleigh(scale=3),
    "RiskReciprocal(1,100)": stats.loguniform(1, 100),
    "RiskTrigen(1,2,3,0.125,0.875)": stats.triang(0.5, 0, 4),
    "RiskLaplace(10,2,RiskTruncate2(15,),RiskShift(5))": stats.expon(15, math.sqrt(2)),
    "RiskNormal(5,2,RiskTruncate(4,8),RiskShift(10))": stats.truncnorm(-0.5, 1.5, 15, 2),
    "RiskReciprocal(1,100,RiskTruncateP(0.25,0.75))": stats.loguniform(100**0.25, 100**0.75),
    "RiskJohnsonSU(-1,2,10,3,RiskShift(-3))": stats.johnsonsu(-1, 2, 7, 3),
    "RiskInvGauss(3,5,RiskTruncate(,3))": None,
    "RiskDoubleTriang(0,4,10,0.76)": None,
    "RiskKumaraswamy(2,3,0,1)": None,
    "RiskCumulD(0,5,{1,2,4},{0.7,0.3,0.1})": None,
    "RiskCompound(RiskPoisson(5),RiskExpon(1000),500,2000)": None,
    "RiskCompound(RiskNegbin(4,0.5),RiskLognorm(10,5))": None,
}


def independent(formula: str, rng: np.random.Generator, n: int) -> np.ndarray:
    """Draws by other means: NumPy's samplers, rejection, and inverse functions written out."""
    match formula.split("(")[0], formula:
        case "RiskInvGauss", _:
            drawn = rng.wald(3, 5, 3 * n)
            return drawn[drawn <= 3][:n]
        case "RiskDoubleTriang", _:
            return np.where(rng.random(n) < 0.76, rng.triangular(0, 4, 4, n), rng.triangular(4, 4, 10, n))
        case "RiskKumaraswamy", _:
            return np.sqrt(rng.beta(1, 3, n))
        case "RiskCumulD", _:
            return np.interp(rng.random(n), [0, 0.3, 0.7, 0.9, 1], [0, 1, 2, 4, 5])
        case _, text if "Poisson" in text:
            counts = rng.poisson(5, n)
            amounts = np.clip(rng.exponential(1000, counts.sum()) - 500, 0, 2000)
        case _:
            counts = rng.negative_binomial(4, 0.5, n)
            amounts = rng.lognormal(math.log(10) - math.log(1.25) / 2, math.sqrt(math.log(1.25)), counts.sum())
    return np.bincount(np.repeat(np.arange(n), counts), amounts, n)


def drawn(formulas: dict[str, str], n: int, extra: dict[str, object]) -> dict[str, np.ndarray]:
    """The draws of calls, by cell."""
    book = Workbook()
    sheet = book.active
    sheet.title = "S"
    for address, value in {
        **extra,
        **{cell: f'=RiskOutput("{cell}")+{text}' for cell, text in formulas.items()},
    }.items():
        sheet[address] = value
    with tempfile.TemporaryDirectory() as folder:
        book.save(Path(folder) / "book.xlsx")
        run = xlmc.load(Path(folder) / "book.xlsx").simulate(trials=n, seed=SEED)
        return {cell: run[cell].values for cell in formulas}


def distances(x: np.ndarray, formula: str, rng: np.random.Generator) -> tuple[float | None, float | None, float]:
    """Standard errors of mean, variance and Kolmogorov and Smirnov's distance; None where one has no error."""
    n, oracle = len(x), EXACT[formula]
    if oracle is None:
        other = independent(formula, rng, n)
        size = math.sqrt(n * len(other) / (n + len(other)))
        ks = stats.ks_2samp(x, other).statistic
        means = (x.mean() - other.mean()) / math.sqrt(x.var() / n + other.var() / len(other))
        spread, others = (x - x.mean()) ** 2, (other - other.mean()) ** 2
        return (
            means,
            (spread.mean() - others.mean()) / math.sqrt(spread.var() / n + others.var() / len(other)),
            _ks(ks, size),
        )
    mean, variance, kurtosis = (float(each) for each in oracle.stats("mvk"))
    ks = stats.kstest(x, oracle.cdf).statistic
    first = (x.mean() - mean) / math.sqrt(variance / n) if math.isfinite(variance) else None
    second = None
    if math.isfinite(kurtosis):
        second = (np.mean((x - mean) ** 2) - variance) / (variance * math.sqrt((kurtosis + 2) / n))
    return first, second, _ks(ks, math.sqrt(n))


def _ks(distance: float, root: float) -> float:
    return (distance * root - 0.8687) / 0.2603


def copulas(n: int) -> Iterator[tuple[str, float, float, float]]:
    """Name, and standard errors of Kendall's tau and of the shares of both tails."""
    frank = 1 - 4 / 5 * (1 - quad(lambda t: t / np.expm1(t), 0, 5)[0] / 5)
    clayton = lambda u, v: (u**-2 + v**-2 - 1) ** -0.5  # noqa: E731
    gumbel = lambda u, v: math.exp(-math.hypot(math.log(u), math.log(v)))  # noqa: E731
    joint = {
        "Clayton": (clayton, 0.5),
        "Gumbel": (gumbel, 0.5),
        "Frank": (lambda u, v: -math.log1p(np.expm1(-5 * u) * np.expm1(-5 * v) / np.expm1(-5)) / 5, frank),
        "Gaussian": (lambda u, v: _elliptic(stats.multivariate_normal(cov=HALF), stats.norm, u, v), 1 / 3),
        "t": (lambda u, v: _elliptic(stats.multivariate_t(shape=HALF, df=3, seed=1), stats.t(3), u, v), 1 / 3),
    }
    for name, (both, tau) in joint.items():
        extra = {"K1": name, "L1": "Theta", "M1": 5 if name == "Frank" else 2, "L2": "df", "M2": 3}
        extra |= {"K3": 1, "K4": 0.5, "L4": 1} if name in ("Gaussian", "t") else {}
        for reflected in ("", "R") if name in ("Clayton", "Gumbel") else ("",):
            calls = {f"A{i}": f"RiskUniform(0,1,RiskCopula(K1:M4,{i}))" for i in (1, 2)}
            u, v = drawn(calls, n, {**extra, "K1": name + reflected}).values()
            if reflected:
                u, v = 1 - u, 1 - v
            result = stats.kendalltau(u[:FEW], v[:FEW]).statistic
            low, high = both(0.01, 0.01), 1 - 2 * 0.99 + both(0.99, 0.99)
            shares = np.mean((u <= 0.01) & (v <= 0.01)), np.mean((u > 0.99) & (v > 0.99))
            errors = [(s - p) / math.sqrt(p * (1 - p) / n) for s, p in zip(shares, (low, high), strict=True)]
            yield name + reflected, (result - tau) / (2 / 3 * math.sqrt(2 / FEW) * 1.0), *errors


HALF = [[1.0, 0.5], [0.5, 1.0]]


def _elliptic(law: object, margin: object, u: float, v: float) -> float:
    at = np.array([margin.ppf(u), margin.ppf(v)])  # type: ignore[attr-defined]
    return float(law.cdf(at) if isinstance(law, type(stats.multivariate_normal())) else law.cdf(at, maxpts=10**6))  # type: ignore[attr-defined]


def main(n: int) -> int:
    """Print the table; 1 where anything is 4 or more standard errors away."""
    rng, worst = np.random.default_rng(1), 0.0
    print(f"{n:,} draws; standard errors away from SciPy or an independent sampler\n")
    print(f"{'form':58} {'mean':>7} {'variance':>9} {'K-S':>6}")
    for row, formula in enumerate(EXACT, start=1):  # a cell of its own gives each a random stream of its own
        (x,) = drawn({f"A{row}": formula}, n, {}).values()
        result = distances(x, formula, rng)
        worst = max([worst, *(abs(each) for each in result[:2] if each is not None), result[2]])
        shown = ["–" if each is None else f"{each:.1f}" for each in result]
        print(f"{formula:58} {shown[0]:>7} {shown[1]:>9} {shown[2]:>6}")
    print(f"\n{'copula':12} {'tau':>7} {'both low':>9} {'both high':>10}")
    for name, *errors in copulas(n):
        worst = max(worst, *map(abs, errors))
        print(f"{name:12} {errors[0]:7.1f} {errors[1]:9.1f} {errors[2]:10.1f}")
    print(f"\nfarthest: {worst:.1f}")
    return int(worst >= 4)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else DRAWS))
