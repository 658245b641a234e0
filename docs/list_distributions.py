"""Write docs/distributions.md from the registry: `python docs/list_distributions.py`."""

from __future__ import annotations

from pathlib import Path

from xlmc.distributions import FAMILIES, Family, ParameterSpec

PAGE = Path(__file__).with_name("distributions.md")

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
    """The page's text."""
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


def _section(family: Family) -> str:
    lines = [f"## {family.name}", ""]
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


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
