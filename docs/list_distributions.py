"""Write docs/distributions.md, and its pictures, from the registry: `python docs/list_distributions.py`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions import FAMILIES, Family, ParameterSpec
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import plain
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers

PAGE = Path(__file__).with_name("distributions.md")
PICTURES = PAGE.parent / "pictures" / "distributions"

EXAMPLES: dict[str, tuple[float, ...]] = {
    "Uniform": (2, 6),
    "Triangular": (2, 3, 6),
    "Trapezoid": (2, 3, 4, 6),
    "Normal": (0, 1),
    "Beta": (0, 1, 2, 4),
    "BetaPERT": (2, 3, 6),
    "Exponential": (1,),
    "Gamma": (0, 1, 3),
    "Logistic": (0, 1),
    "Lognormal": (0, 3, 1.5),
    "Lognorm2": (0, 1, 0.5),
    "Maximum Extreme": (0, 1),
    "Minimum Extreme": (0, 1),
    "Pareto": (1, 3),
    "Student's t": (0, 1, 3),
    "Trigen": (2, 3, 6, 10, 90),
    "Weibull": (0, 2, 2),
    "BetaSubj": (0, 2, 3, 10),
    "Burr12": (0, 2, 3, 1.5),
    "Cauchy": (0, 1),
    "Dagum": (0, 2, 3, 1.5),
    "DoubleTriang": (0, 4, 10, 0.76),
    "F": (6, 20),
    "Fatigue life": (0, 2, 0.7),
    "Frechet": (0, 2, 3),
    "Hyperbolic secant": (0, 1),
    "Inverse Gaussian": (0, 2, 4),
    "Johnson moments": (0, 1, 0.8, 4.5),
    "Johnson SB": (0, 1, 0.5, 0.5),
    "Johnson SU": (0, 1, -1, 1.5),
    "Kumaraswamy": (0, 1, 2, 4),
    "Laplace": (0, 1),
    "Levy": (0, 1),
    "Log-logistic": (0, 2, 3),
    "Pareto2": (0, 2, 3),
    "Pearson5": (0, 2, 3),
    "Pearson6": (0, 2, 3, 4),
    "Reciprocal": (1, 10),
    "Cumul": (0, 5),
    "CumulD": (0, 5),
    "General": (0, 5),
    "Histogrm": (0, 4),
    "Binomial": (0.3, 12),
    "Discrete Uniform": (1, 6),
    "Geometric": (0.3,),
    "Geomet": (0.3,),
    "Hypergeometric": (10, 8, 30),
    "Negative Binomial": (0.4, 3),
    "Negbin": (0.4, 3),
    "Poisson": (4,),
    "Yes-No": (0.3,),
    "Custom": (),
    "Discrete": (),
    "DUniform": (),
    "Empirical": (),
    "Empirical smoothed": (),
}
"""The parameters of the picture of each family."""

DATA: dict[str, list[list[float]]] = {
    "Cumul": [[1, 0.3], [2, 0.7], [4, 0.9]],
    "CumulD": [[1, 0.7], [2, 0.3], [4, 0.1]],
    "General": [[1, 2], [3, 1]],
    "Histogrm": [[1], [4], [2], [1]],
    "Custom": [[1, 2, 1], [2, 4, 3], [5, 6, 1]],
    "Discrete": [[1, 0.2], [2, 0.5], [5, 0.3]],
    "DUniform": [[1], [2], [5]],
    "Empirical": [[1.1], [1.3], [1.4], [1.8], [2.6]],
    "Empirical smoothed": [[1.1], [1.3], [1.4], [1.8], [2.6]],
}

WIDTH, HEIGHT, FLOOR = 260, 96, 80

HEAD = """\
# Distributions

What `Distribution` in the assumptions table may be. Case, blanks, hyphens and underscores do not matter, in names and
in headings. Each parameter has a column of its own; a heading in brackets means the same. A parameter may be a formula,
even one that depends on other assumptions. `Lower cutoff` and `Upper cutoff` truncate any of them but Custom.

Quantiles are computed in double precision with SciPy's special functions, upper tails from the probability above, so
that a distribution cut off far out keeps its digits. Impossible parameters, such as Low above High, are refused with
the cell; a trial in which they vary and become impossible is lost to an error. The same holds for parameters so extreme
that a draw would exceed the largest number of a workbook, 1.8E308: Student's t with 0.01 degrees of freedom, Pareto
with shape 0.01. With cutoffs at both ends these are allowed.

Cauchy has no mean, and Levy an infinite one; so have some others for some shapes, which they say below. The mean of
draws then never settles: report the median and percentiles instead. A notice says so.

The pictures show the density, or the probability of each value, for the parameters that are written below.
"""

PERCENTILES = """\
## Percentiles in place of parameters

Instead of some or all of its parameters, {families} may be given percentiles: columns named `P10`, `P50`, `P97.5`, any
number above 0 and below 100. As many percentiles are needed as parameters are left blank; a blank Location is 0, unless
there is a percentile for it too. `P10` is the value that 10 % of the draws do not exceed, before any cutoff. So
Triangular with `P10`, `Likeliest` and `P90` is Crystal Ball's alternate form, and @RISK's TriangAlt.

Location and scale have closed formulas; a shape is the root of one equation, and limits such as Low and High are solved
for together. If no parameters give the percentiles, or if every shape does (Student's t with symmetric percentiles),
the row is refused. If several fit, the one whose shape is nearest to 1 is taken, or else the narrowest. Percentiles may
be formulas, but must not depend on another assumption.
"""


def page() -> str:
    """The page's text.

    Raises:
        SystemExit: a family has no parameters for its picture.
    """
    missing = [name for name in FAMILIES if name not in EXAMPLES]
    if missing:
        raise SystemExit(
            f"give EXAMPLES, in docs/list_distributions.py, parameters for the picture of: {', '.join(missing)}"
        )
    parts = [HEAD, _table(), *(_section(family) for family in FAMILIES.values())]
    names = [family.name for family in FAMILIES.values() if family.roles]
    parts.append(PERCENTILES.format(families=f"{', '.join(names[:-1])} and {names[-1]}"))
    parts.append("This page is written by `python docs/list_distributions.py`.\n")
    return "\n".join(parts)


def _table() -> str:
    rows = [f"| {family.name} | {', '.join(_columns(family)) or '–'} |" for family in FAMILIES.values()]
    return "\n".join(("| distribution | columns |", "|---|---|", *rows, ""))


def _columns(family: Family) -> list[str]:
    return [f"`{spec.heading}`" for spec in family.parameters] + ["`Data`"] * bool(family.data)


def picture_name(family: Family) -> str:
    """The file that shows the family."""
    return f"{plain(family.name).replace(chr(39), '')}.svg"


def _section(family: Family) -> str:
    lines = [f"## {family.name}", "", f"![{family.name}](pictures/distributions/{picture_name(family)})", ""]
    shown = ", ".join(
        f"{spec.heading} {show(value)}" for spec, value in zip(family.parameters, EXAMPLES[family.name], strict=True)
    )
    lines += [f"Drawn: {shown}", ""] if shown else []
    lines += [f"* {_parameter(spec)}" for spec in family.parameters]
    lines += [f"* `Data`: {family.data.content}"] if family.data else []
    lines += [f"* also: {', '.join(family.aliases)}"] * bool(family.aliases)
    lines += [f"* {family.formula}"] * bool(family.formula)
    lines += [f"* elsewhere: {'; '.join(family.elsewhere)}"] * bool(family.elsewhere)
    lines += [f"* source: {family.source}"] * bool(family.source)
    return "\n".join((*lines, ""))


def _parameter(spec: ParameterSpec) -> str:
    others = f" ({', '.join(spec.headings[1:])})" if len(spec.headings) > 1 else ""
    default = "" if spec.default is None else f": {spec.default:g} if left blank"
    return f"`{spec.heading}`{others}{default}"


def picture(family: Family) -> str:
    """The density, or the probabilities of single values, as SVG."""
    params = EXAMPLES[family.name]
    built = family.built(np.array(DATA[family.name], dtype=float)) if family.name in DATA else family
    drawn = list(_sticks(built, params)) or [_curve(built, params)]
    title = f"{family.name}: {', '.join(map(show, params))}" if params else family.name
    return "\n".join(
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}"'
            ' font-family="sans-serif" font-size="10">',
            f"<title>{title}</title>",
            *drawn,
            f'<path d="M0 {FLOOR}H{WIDTH}" stroke="#888"/>',
            *_labels(*_reach(built, params)),
            "</svg>\n",
        )
    )


def _reach(family: Family, params: tuple[float, ...]) -> tuple[float, float]:
    """The part that is drawn: nearly all of it, less of a heavy tail."""
    low, median, high = (float(family.ppf(p, *params)) for p in (0.004, 0.5, 0.996))
    quarter, three_quarters = (float(family.ppf(p, *params)) for p in (0.25, 0.75))
    span = 6 * (three_quarters - quarter) or 2.0
    low, high = max(low, median - span), min(high, median + span)
    least, most = (float(end) for end in family.support(*params))
    near = 0.15 * (high - low)
    low, high = least if low - least < near else low, most if most - high < near else high
    return (low - 0.5, high + 0.5) if high - low < 1e-9 or isinstance(family, WholeNumbers) else (low, high)


def _sticks(family: Family, params: tuple[float, ...]) -> Iterator[str]:
    """A line for each single value that has a probability; none for a family without."""
    u = (np.arange(4000) + 0.5) / 4000
    values, counts = np.unique(family.ppf(u, *params), return_counts=True)
    if len(values) > 60:
        return
    low, high = _reach(family, params)
    for value, share in zip(values.tolist(), (counts / counts.max()).tolist(), strict=True):
        if low <= value <= high:
            x = _across(value, low, high)
            yield f'<path d="M{x:.1f} {FLOOR}V{FLOOR - 70 * share:.1f}" stroke="#2a6f97" stroke-width="4"/>'


def _curve(family: Family, params: tuple[float, ...]) -> str:
    low, high = _reach(family, params)
    x = np.linspace(low - 0.02 * (high - low), high + 0.02 * (high - low), 261)
    density = np.diff(family.cdf(x, *params)) / np.diff(x)
    top = density.max()
    points = [
        f"{_across(at, low, high):.1f} {FLOOR - 70 * height / top:.1f}"
        for at, height in zip(((x[1:] + x[:-1]) / 2).tolist(), density.tolist(), strict=True)
    ]
    ends = _across(x[0], low, high), _across(x[-1], low, high)
    line = f"M{ends[0]:.1f} {FLOOR}L{'L'.join(points)}L{ends[1]:.1f} {FLOOR}Z"
    return f'<path d="{line}" fill="#a9cfe3" stroke="#2a6f97" stroke-width="1.5"/>'


def _across(value: Any, low: float, high: float) -> float:
    return float(14 + (WIDTH - 28) * (value - low) / (high - low))


def _labels(low: float, high: float) -> Iterator[str]:
    """Round numbers below the axis."""
    step = 10.0 ** np.floor(np.log10((high - low) / 2))
    step *= max(factor for factor in (1, 2, 5) if factor * step <= (high - low) / 2)
    for k in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1):
        at = _across(k * step, low, high)
        text = show(round(k * step, 9)).replace("-", "−")
        yield f'<path d="M{at:.1f} {FLOOR}v3" stroke="#888"/>'
        yield f'<text x="{at:.1f}" y="{HEIGHT - 3}" text-anchor="middle" fill="#555">{text}</text>'


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    PICTURES.mkdir(parents=True, exist_ok=True)
    for each in EXAMPLES:
        (PICTURES / picture_name(FAMILIES[each])).write_text(picture(FAMILIES[each]), encoding="utf-8")
