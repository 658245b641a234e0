"""Small books with rare acceptance whose probability is known exactly, for rare_regions.py and rare_thin.py.

Twelve have their accepted trials in several regions: branches of other scales, two curved layers, a switch. Eight are
ordinary: one region. The probabilities lie between 10⁻⁷ and 10⁻⁵. Eleven more ask for a thin bent layer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from scipy import integrate
from scipy.special import ndtr, ndtri

from xlmc.excel.address import parse_address
from xlmc.excel.workbook.workbook import CellContent, Formula, Sheet, Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, Definitions, Filter, Forecast
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["ORDINARY", "SEVERAL", "THIN", "RareBook"]

SHEET = "Model"


@dataclass(frozen=True)
class RareBook:
    """One formula in B1, whose filter it is, over assumptions in A1, A2, …

    Attributes:
        words: what it is.
        formula: of B1.
        drawn: the assumptions: a distribution and its parameters each.
        limits: of the filter; none where B1 must be TRUE.
        truth: the probability that a trial is accepted.
        correlation: of every pair of assumptions.
        further: filters beside it, in B2 and so on: a formula and limits each.
    """

    words: str
    formula: str
    drawn: tuple[Mapping[str, Any], ...]
    limits: Mapping[str, float]
    truth: float
    correlation: float = field(default=0.0)
    further: tuple[tuple[str, Mapping[str, float]], ...] = field(default=())

    @property
    def model(self) -> CompiledModel:
        """The book, read; its forecast is A1."""
        names = [f"A{place}" for place in range(1, len(self.drawn) + 1)]
        cells = {parse_address(name, SHEET): CellContent(1.0) for name in names}
        judged = parse_address("B1", SHEET)
        filters = [
            (parse_address(f"B{row}", SHEET), *each)
            for row, each in enumerate([(self.formula, self.limits), *self.further], 1)
        ]
        cells |= {cell: CellContent(None, Formula(text, cell.row, cell.column)) for cell, text, _ in filters}
        sheet = Sheet(SHEET, "xl/worksheets/sheet1.xml", {(c.row, c.column): held for c, held in cells.items()})
        book = Workbook("book.xlsx", {SHEET: sheet}, (), ())
        places = [parse_address(name, SHEET) for name in names]
        assumptions = tuple(
            Assumption(
                f"a{i}",
                cell,
                row=cell,
                base=1.0,
                distribution=given["distribution"],
                given={key: float(value) for key, value in given.items() if key != "distribution"},
            )
            for i, (cell, given) in enumerate(zip(places, self.drawn, strict=True), 1)
        )
        pairs = [(a.name, b.name) for i, a in enumerate(assumptions) for b in assumptions[i + 1 :]]
        asked = tuple(Correlation(*pair, self.correlation, judged) for pair in pairs if self.correlation)
        kept = tuple(
            Filter("judged" if cell == judged else f"judged {cell.a1}", cell, cell, **dict(limits))
            for cell, _, limits in filters
        )
        forecasts = (Forecast("x", places[0], places[0]),)
        return CompiledModel(book, Definitions(assumptions, forecasts, kept, asked), Path("b.xlsx"))


def normal(mean: float = 0.0, spread: float = 1.0) -> dict[str, Any]:
    """As an assumption."""
    return {"distribution": "Normal", "mean": mean, "std_dev": spread}


UNIT: dict[str, Any] = {"distribution": "Uniform", "low": 0.0, "high": 1.0}
NON_NEGATIVE = {"at_least": 0.0}


def coin(chance: float = 0.5) -> dict[str, Any]:
    """A Yes-No."""
    return {"distribution": "Yes-No", "probability": chance}


def edge(chance: float) -> float:
    """What a standard normal exceeds with that chance; at six digits, as it stands in the formula."""
    return round(-float(ndtri(chance)), 6)


def tail(start: float) -> float:
    """P(z > start)."""
    return float(ndtr(-start))


def branches(ratio: float, share: float, *, seen: bool) -> RareBook:
    """Two branches of a coin whose shortfalls differ in scale by a ratio; the share of the larger scale's.

    Args:
        ratio: of the scales.
        share: of the accepted trials, in the branch of the larger scale.
        seen: whether the formula has an IF, or only multiplies by the coin.
    """
    small, large = edge(4e-6 * (1.0 - share)), edge(4e-6 * share)
    formula = f"IF(A3=1,A1-{small},{ratio:g}*(A2-{large}))"
    if not seen:
        formula = f"A3*(A1-{small})+(1-A3)*{ratio:g}*(A2-{large})"
    words = f"two branches, scales 1:{ratio:g}, {1 - share:.0%} and {share:.0%} of the accepted"
    truth = 0.5 * (tail(small) + tail(large))
    return RareBook(words, formula, (normal(), normal(), coin()), NON_NEGATIVE, truth)


REACH, BEND, HALF = 3.9, 0.25, 0.04


def layers() -> float:
    """P(|u·v| ≤ HALF), u = x - REACH - BEND·y², v = y + REACH + BEND·x²: two parabolas that do not meet.

    Either layer is as thick as 2·HALF over what the other factor is there: exact but for terms of the order of HALF².
    """

    def density(x: float, y: float) -> float:
        return math.exp(-0.5 * (x * x + y * y)) / (2.0 * math.pi)

    def first(y: float) -> float:
        x = REACH + BEND * y * y
        return density(x, y) * 2.0 * HALF / abs(y + REACH + BEND * x * x)

    def second(x: float) -> float:
        y = -REACH - BEND * x * x
        return density(x, y) * 2.0 * HALF / abs(x - REACH - BEND * y * y)

    return sum(
        float(integrate.quad(each, -8.0, 8.0, epsabs=0.0, epsrel=1e-10, limit=400)[0]) for each in (first, second)
    )


CURVED = RareBook(
    "two disjoint curved layers",
    f"(A1-{REACH}-{BEND}*A2^2)*(A2+{REACH}+{BEND}*A1^2)",
    (normal(), normal()),
    {"at_least": -HALF, "at_most": HALF},
    layers(),
)

SWITCH = RareBook(
    "a switch of three branches",
    "CHOOSE(A4,A1-4.6,100*(A2-4.7),0.01*(A3-4.8))",
    (normal(), normal(), normal(), {"distribution": "Discrete Uniform", "low": 1.0, "high": 3.0}),
    NON_NEGATIVE,
    (tail(4.6) + tail(4.7) + tail(4.8)) / 3.0,
)

SEVERAL: dict[str, RareBook] = {
    "speeds or weights": RareBook(
        "an IF over speeds or weights",
        "IF(A3=1,A1-68.3,A2-153200)",
        (normal(45.0, 5.0), normal(60000.0, 20000.0), coin()),
        NON_NEGATIVE,
        0.5 * (tail(4.66) + tail(4.66)),
    ),
    "larger of two": RareBook(
        "the larger of two",
        "MAX(A1-4.75,50*(A2*ABS(A2)-22.5625))",
        (normal(), normal()),
        NON_NEGATIVE,
        1.0 - (1.0 - tail(4.75)) ** 2,
    ),
    **{f"1:{ratio} even": branches(ratio, 0.5, seen=True) for ratio in (2, 4, 10, 100)},
    **{
        f"1:{ratio} uneven": branches(ratio, share, seen=False)
        for ratio, share in ((2, 0.1), (4, 0.9), (10, 0.1), (100, 0.9))
    },
    "curved": CURVED,
    "switch": SWITCH,
}
"""Several regions."""


def of_product(edge_: float) -> float:
    """P(ab > edge) of two uniforms."""
    return 1.0 - edge_ + edge_ * math.log(edge_)


def bent() -> float:
    """P(|x - y²/10| ≤ 0.002, z ≥ 2.9) of standard normals."""

    def along(y: float) -> float:
        return (
            math.exp(-0.5 * y * y)
            / math.sqrt(2.0 * math.pi)
            * float(ndtr(y * y / 10 + 0.002) - ndtr(y * y / 10 - 0.002))
        )

    return tail(2.9) * float(integrate.quad(along, -10.0, 10.0, epsabs=0.0, epsrel=1e-10)[0])


def shifted(start: float, shift: float, chance: float) -> float:
    """P(z + shift·coin > start)."""
    return chance * tail(start - shift) + (1.0 - chance) * tail(start)


def correlated(start: float) -> float:
    """P(the sum of six normals > start) with Spearman correlations of 0.5, Pearson's being 2 sin(π/12)."""
    return tail(start / math.sqrt(6.0 + 30.0 * 2.0 * math.sin(math.pi / 12.0)))


ORDINARY: dict[str, RareBook] = {
    "sum": RareBook("a sum of three normals", "A1+A2+A3", (normal(),) * 3, {"at_least": 8.2}, tail(8.2 / 3**0.5)),
    "product": RareBook("a product of two uniforms", "A1*A2", (UNIT,) * 2, {"above": 0.998}, of_product(0.998)),
    "corner": RareBook(
        "four of eight uniforms in a corner", "MIN(A1:A4)+0*SUM(A5:A8)", (UNIT,) * 8, {"at_least": 0.965}, 0.035**4
    ),
    "smaller of two": RareBook("the smaller of two", "MIN(A1,A2)", (normal(),) * 2, {"at_least": 3.1}, tail(3.1) ** 2),
    "bent": RareBook("a bent layer", "AND(ABS(A1-A2^2/10)<=0.002,A3>=2.9)", (normal(),) * 3, {}, bent()),
    "correlated": RareBook(
        "a sum of six correlated normals",
        "SUM(A1:A6)",
        (normal(),) * 6,
        {"above": 21.5},
        correlated(21.5),
        correlation=0.5,
    ),
    "shifted": RareBook(
        "a coin that hardly matters",
        "A1+0.1*A2",
        (normal(), coin(0.3)),
        {"at_least": 4.8},
        shifted(4.8, 0.1, 0.3),
    ),
    "branch": RareBook(
        "an IF that hardly matters",
        "A1*IF(A2>0,1.02,1)",
        (normal(),) * 2,
        {"at_least": 4.8},
        0.5 * (tail(4.8) + tail(4.8 / 1.02)),
    ),
}
"""One region."""


def density(x: float) -> float:
    """Of a standard normal."""
    return math.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)


def integral(of: Callable[[float], float], low: float, high: float) -> float:
    """To ten digits."""
    return float(integrate.quad(of, low, high, epsabs=0.0, epsrel=1e-10, limit=400)[0])


def parabola(half: float) -> float:
    """P(|x - y²/4| ≤ half) of standard normals, for a half below 10⁻³: exact but for terms of the order of half³."""
    return 2.0 * half * integral(lambda y: density(y) * density(y * y / 4.0), -9.0, 9.0)


def within(half: float) -> dict[str, float]:
    """Limits either side of 0."""
    return {"at_least": -half, "at_most": half}


def flat(low: float, high: float) -> dict[str, Any]:
    """A uniform."""
    return {"distribution": "Uniform", "low": low, "high": high}


def momentum(half: float) -> float:
    """P(|1500 a + 1200 b - 2700 c| ≤ half): a and b normal, means of 20 and 15, spreads of 2, c from 10 to 25."""
    mean, spread = (1500 * 20 + 1200 * 15) / 2700, math.hypot(1500 * 2, 1200 * 2) / 2700
    return 2.0 * half / 2700 / 15 * float(ndtr((25 - mean) / spread) - ndtr((10 - mean) / spread))


def two_layers(half: float) -> float:
    """P(|x + y·z - 1| ≤ half, |x - 2z| ≤ half), x and y standard normals, z from 0.5 to 2."""
    return 4.0 * half**2 * integral(lambda z: density(2 * z) * density((1 - 2 * z) / z) / z / 1.5, 0.5, 2.0)


PARABOLA = "A1-A2^2/4"

THIN: dict[str, RareBook] = {
    "1e-3": RareBook(
        "a bent layer of 10⁻³ beside an ordinary rare filter",
        PARABOLA,
        (normal(),) * 3,
        within(5e-4),
        parabola(5e-4) * tail(2.9),
        further=(("A3", {"at_least": 2.9}),),
    ),
    "1e-5": RareBook("a bent layer of 10⁻⁵", PARABOLA, (normal(),) * 2, within(5e-6), parabola(5e-6)),
    "1e-8": RareBook("a bent layer of 10⁻⁸", PARABOLA, (normal(),) * 2, within(5e-9), parabola(5e-9)),
    "product": RareBook(
        "a product and a third one",
        "A1*A2-A3",
        (normal(),) * 3,
        within(1e-6),
        2e-6 * density(0.0) * integral(lambda y: density(y) / math.hypot(1.0, y), -9.0, 9.0),
    ),
    "momentum": RareBook(
        "a balance of momentum",
        "1500*A1+1200*A2-2700*A3",
        (normal(20.0, 2.0), normal(15.0, 2.0), flat(10.0, 25.0)),
        within(0.01),
        momentum(0.01),
    ),
    "rows": RareBook(
        "a layer between two rows",
        PARABOLA,
        (normal(),) * 2,
        NON_NEGATIVE,
        parabola(5e-6),
        further=((PARABOLA, {"at_most": 1e-5}),),
    ),
    "branch": RareBook(
        "a layer in a branch of IF",
        "IF(A3=1,ABS(A1-A2^2/4)<=0.000002,A1>=4.9)",
        (normal(), normal(), coin()),
        {},
        0.5 * parabola(2e-6) + 0.5 * tail(4.9),
    ),
    "bound": RareBook(
        "a layer across the bound of a uniform",
        "A1-1+0.000002*A2",
        (UNIT, normal()),
        within(2e-6),
        2e-6,
    ),
    "sheets": RareBook(
        "two disjoint sheets",
        "A1^2-A2",
        (normal(), flat(1.0, 4.0)),
        within(1e-6),
        2e-6 / 3.0 * integral(lambda y: density(math.sqrt(y)) / math.sqrt(y), 1.0, 4.0),
    ),
    "two layers": RareBook(
        "two layers at once",
        "A1+A2*A3-1",
        (normal(), normal(), flat(0.5, 2.0)),
        within(5e-4),
        two_layers(5e-4),
        further=(("A1-2*A3", within(5e-4)),),
    ),
    "ring": RareBook("a ring", "SQRT(A1^2+A2^2)-5", (normal(),) * 2, within(1e-7), 10.0 * 1e-7 * math.exp(-12.5)),
}
"""Thin bent layers."""
