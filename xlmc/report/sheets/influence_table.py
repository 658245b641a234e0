"""The table of influences of one forecast, and its charts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from xlmc.report import number_format
from xlmc.report.sheets import cells
from xlmc.report.sheets.bar_charts import bar_chart
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.ranges import TableAt
from xlmc.studies.sensitivity.noise import Noise, noise

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.report.sheets.page import Page
    from xlmc.statistics import Estimate
    from xlmc.studies.sensitivity import ForecastSensitivity, Influence

__all__ = ["BARS", "ROWS", "influence_captions", "influence_charts", "write_influences"]

BARS: Final = 10
"""On a chart: as many as have readable names."""

ROWS: Final = 40
"""In a table."""

_EXPLAINED, _DEPENDENCE, _RANK, _CONTRIBUTION, _FIRST, _TOTAL = 2, 5, 8, 10, 12, 14
"""The columns of the values; their errors follow them."""


def write_influences(page: Page, found: ForecastSensitivity, sobol: bool) -> TableAt:
    """Write the table; where its rows to draw stand is returned."""
    headers = ["Assumption", "Units", "Variance explained", "±", "Noise up to", "Dependence", "±", "Noise up to"]
    headers += ["Rank correlation", "±", "Contribution to variance", "±"]
    shown = found.influences[:ROWS]
    header = page.row
    weak = noise(found)
    page.table(
        [*headers, *(["First order", "±", "Total effect", "±"] if sobol else [])],
        [_row(one, its, sobol) for one, its in zip(shown, weak, strict=False)],
    )
    return TableAt(page.sheet.get_name(), header, header + 1, header + min(len(shown), BARS))


def _row(found: Influence, weak: Noise, sobol: bool) -> list[Shown]:
    row = [
        cells.text(found.assumption, "name"),
        cells.text(found.units),
        *_with_floor(found.explained, found.explained_floor, weak.explained),
        *_with_floor(found.dependence, found.dependence_floor, weak.dependence),
        *_as_noise(cells.estimate(found.rank_correlation), weak.correlation),
        *_as_noise(cells.share(found.contribution), weak.correlation),
    ]
    for index, is_noise in ((found.first_order, weak.first_order), (found.total, weak.total)) if sobol else ():
        row += [cells.BLANK, cells.BLANK] if index is None else _as_noise(cells.share(index), is_noise)
    return row


def _with_floor(found: Estimate, floor: float, is_noise: bool) -> list[Shown]:
    shown = _as_noise(cells.share(found), is_noise)
    return [*shown, Shown(floor, number_format.share_paired(found), "error")]


def _as_noise(shown: list[Shown], is_noise: bool) -> list[Shown]:
    """A value and its error; the value, where it is noise, shows as that word: the cell keeps the number."""
    return [replace(shown[0], format=number_format.NOISE), *shown[1:]] if is_noise else shown


def influence_charts(book: Workbook, at: TableAt, found: ForecastSensitivity, sobol: bool) -> list[Any]:
    """Variance explained, dependence or total effects, rank correlation and contribution to variance."""
    of = noise(found)[:BARS]
    weak, unseen = [each.explained for each in of], [each.dependence for each in of]
    flat, lone = [each.correlation for each in of], [each.total for each in of]
    second = (
        bar_chart(
            book, at, "Total effect (Sobol)", "Share of the variance, alone and with others", _TOTAL, _TOTAL + 1, lone
        )
        if sobol
        else bar_chart(book, at, "Dependence", "Cramér–von Mises index", _DEPENDENCE, _DEPENDENCE + 1, unseen)
    )
    rank = "Rank correlation with the forecast (Spearman)"
    share = "Squared rank correlations, scaled to 100 %, with their sign"
    return [
        bar_chart(book, at, "Variance explained", "Share of the variance", _EXPLAINED, _EXPLAINED + 1, weak),
        second,
        bar_chart(book, at, "Rank correlation", rank, _RANK, _RANK + 1, flat, "0.0"),
        bar_chart(book, at, "Contribution to variance (approximate)", share, _CONTRIBUTION, _CONTRIBUTION + 1, flat),
    ]


def influence_captions(found: ForecastSensitivity, pairs: int) -> list[str]:
    """One a chart: what it is and what it is not."""
    explained = (
        "Variance explained: how much of the forecast's variance would go, on average, if the assumption's true value "
        "were known. From the accepted trials as they are, so it holds with filters and correlations; shares need not "
        "add up to 100 %. Pale, and the word noise in the table: no more than trials alone would show."
    )
    dependence = (
        "Dependence: 0 only if no part of the forecast's distribution depends on the assumption, 100 % if nothing else "
        "matters. Unlike variance explained it also sees what widens the forecast or acts only together with others; "
        "it is not a share of the variance."
    )
    total = (
        f"Total effect (Sobol), from {pairs:,} pairs of trials of their own: the variance that would be left, on "
        "average, if all other assumptions were known. It counts what the assumption does together with others, so the "
        "effects add up to 100 % or more."
    )
    rank = (
        f"Rank correlation on {found.trials:,} accepted trials: whether the forecast rises or falls with the "
        "assumption. It is blind to effects that rise and fall, and is not a share of anything."
    )
    contribution = (
        "Contribution to variance as Crystal Ball shows it: squared rank correlations scaled to 100 %. Approximate, "
        "and wrong where filters or correlations tie assumptions together or an effect rises and falls: trust variance "
        "explained then."
    )
    return [explained, total if pairs else dependence, rank, contribution]
