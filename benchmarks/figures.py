"""The figures, drawn from the results: speed against accuracy, and the contestants' speeds beside xlmc's."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from accuracy import STATISTICS
from growth import TRIALS, seconds_of, slope

__all__ = ["draw_accuracy", "draw_growth", "draw_rates"]

# Okabe and Ito's palette, told apart by people who see red and green alike; the markers tell them apart without colour.
STYLES: dict[str, tuple[str, str]] = {
    "xlmc/numpy": ("#0072B2", "o"),
    "xlmc/jit": ("#56B4E9", "s"),
    "xlmc/formulas": ("#999999", "v"),
    "hand/NumPy": ("#000000", "D"),
    "hand/numba": ("#CC79A7", "^"),
    "hand/numba, libm": ("#882255", "<"),
    "hand/C": ("#009E73", "P"),
    "formulas": ("#D55E00", "X"),
    "IronCalc": ("#E69F00", "h"),
    "formualizer": ("#8A7A00", "*"),
}
FAMILIES = {"xlmc": ("#0072B2", "xlmc"), "hand": ("#6B7785", "written by hand"), "peer": ("#E69F00", "peers")}
TITLES = {
    "case-study": "Case study: 17 assumptions, 42 cells, 3 filters",
    "skid": "Skid sheet: 3 assumptions, 4 cells",
    "cells-1000": "1,000 cells, 12 assumptions",
    "cells-20000": "20,000 cells, 12 assumptions",
    "powers": "Powers, exponentials, logarithms: 24 assumptions, 50 cells, 8 forecasts",
    "wide": "Wide book: 1,000 assumptions, 200 forecasts",
}
PANELS = {
    "mean": "Mean",
    "SD": "Standard deviation",
    "24.5 %": "Lower end of the 51 % range",
    "75.5 %": "Upper end of the 51 % range",
}


def draw_accuracy(results: Path, target: Path) -> None:
    """Error against seconds, log–log, one panel a statistic."""
    from matplotlib.ticker import LogLocator

    curves = json.loads(results.read_text(encoding="utf-8"))["found"]
    plot = _pyplot()
    figure, axes = plot.subplots(2, 2, figsize=(11, 9.4), sharex=True, sharey=True, layout="constrained")
    for k, (axis, name) in enumerate(zip(axes.flat, STATISTICS, strict=True)):
        for contestant, curve in curves.items():
            colour, marker = STYLES.get(contestant, ("#444444", "."))
            error = [row[k] for row in curve["errors"]]
            line = "--" if curve["by rate"] else "-"
            axis.plot(curve["seconds"], error, line, color=colour, marker=marker, ms=6, lw=1.5, label=contestant)
        _slope(axis, curves, k)
        axis.set(xscale="log", yscale="log", title=PANELS[name])
        axis.grid(which="major", color="#D5DBE3", lw=0.7)
        axis.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.yaxis.set_minor_formatter("")
    for axis in axes[:, 0]:
        axis.set_ylabel("RMS error, mph")
    for axis in axes[1]:
        axis.set_xlabel("time of the run, s")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    seeds, ladder = max(curve["seeds"] for curve in curves.values()), next(iter(curves.values()))["trials"]
    figure.suptitle(
        f"Speed against accuracy: the case study at {ladder[0]:,} to {ladder[-1]:,} trials\n"
        f"root mean square over {seeds} seeds and the four forecasts; "
        "dashed: time from the measured cost of a trial",
        fontsize=12,
    )
    figure.savefig(target, dpi=150)
    plot.close(figure)


def _slope(axis: Any, curves: dict[str, Any], k: int) -> None:
    """A grey line of slope −1/2, what theory says of independent trials, below the leftmost curve."""
    fastest = min(curves.values(), key=lambda curve: curve["seconds"][-1])
    x = fastest["seconds"][0], fastest["seconds"][-1]
    at = 0.45 * fastest["errors"][-1][k]
    axis.plot(x, [at * (x[1] / x[0]) ** 0.5, at], ":", color="#6B7785", lw=2, label="slope −1/2 (theory)")


def draw_rates(results: Path, target: Path) -> None:
    """Trials per second of every contestant over those of xlmc/numpy, one panel a book where that was measured."""
    books = json.loads(results.read_text(encoding="utf-8"))["found"]
    result: dict[str, Any] = {book: records for book, records in books.items() if _shown(records)}
    if not result:
        return
    plot = _pyplot()
    heights = [max(len(_shown(records)), 2) for records in result.values()]
    figure, axes = plot.subplots(
        len(result), 1, figsize=(10, 1.2 + 0.34 * sum(heights) + 0.8 * len(result)), layout="constrained", sharex=True,
        gridspec_kw={"height_ratios": heights}, squeeze=False,
    )  # fmt: skip
    for axis, (book, records) in zip(axes[:, 0], result.items(), strict=True):
        _bars(axis, records)
        axis.set_title(TITLES.get(book, book), loc="left", fontsize=11)
    axes[-1, 0].set_xlabel("trials per second, as a multiple of xlmc/numpy's in the same round")
    handles = [plot.Rectangle((0, 0), 1, 1, color=colour) for colour, _ in FAMILIES.values()]
    figure.legend(
        handles, [label for _, label in FAMILIES.values()], loc="outside lower center", ncols=3, frameon=False
    )
    figure.suptitle("Trials per second, side by side", fontsize=13)
    figure.savefig(target, dpi=150)
    plot.close(figure)


GROWTH = {
    "cells": "Formula cells (time steps, 12 assumptions)",
    "trials": "Trials (case study)",
    "forecasts": "Forecasts (100 assumptions)",
    "assumptions": "Assumptions (1 forecast)",
}
_LINES = (
    ("loading", ("numpy",), "loading", "#6B7785", "-"),
    ("first", ("numpy", "jit"), "first block, {}", None, "--"),
    ("a trial", ("numpy", "jit"), f"{TRIALS:,} trials, {{}}", None, "-"),
    ("run", ("numpy", "jit"), "run, {}", None, "-"),
)
"""What is measured, of which engines, its label, its colour or that of the engine, its line."""


def draw_growth(results: Path, target: Path) -> None:
    """Seconds over size, log–log, one panel a series, the slope of the last decade beside each line."""
    result = json.loads(results.read_text(encoding="utf-8"))["found"]
    plot = _pyplot()
    figure, axes = plot.subplots(2, 2, figsize=(11.5, 9.4), layout="constrained")
    for axis, (name, title) in zip(axes.flat, GROWTH.items(), strict=True):
        for column, engines, label, own, line in _LINES:
            for engine in engines:
                sizes, seconds = seconds_of(result.get(name, {}).get(engine, []), column)
                if not sizes:
                    continue
                colour, marker = STYLES[f"xlmc/{engine}"]
                grown = slope(sizes, seconds)
                text = label.format(engine) + ("" if grown is None else f": slope {grown:.2f}")
                axis.plot(sizes, seconds, line, color=own or colour, marker=marker, ms=5, lw=1.5, label=text)
        axis.set(xscale="log", yscale="log", xlabel=name, ylabel="seconds")
        axis.set_title(title, fontsize=11)
        axis.grid(which="major", color="#D5DBE3", lw=0.7)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=8, frameon=False)
    figure.suptitle("How the cost grows; slopes are of the last decade, 1 is proportional", fontsize=13)
    figure.savefig(target, dpi=150)
    plot.close(figure)


def _shown(records: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    return [(name, record) for name, record in records.items() if "to xlmc/numpy" in record]


def _bars(axis: Any, records: dict[str, Any]) -> None:
    shown = sorted(_shown(records), key=lambda item: item[1]["rate"])
    ratios = [record["to xlmc/numpy"] for _, record in shown]
    colours = [FAMILIES[record["family"]][0] for _, record in shown]
    axis.barh(range(len(shown)), [r - 1 for r in ratios], left=1, color=colours, height=0.68)
    axis.axvline(1, color="#1F3044", lw=1)
    axis.plot(1, ratios.index(1.0), "o", color=FAMILIES["xlmc"][0], ms=9)
    axis.set_xscale("log")
    axis.set_yticks(range(len(shown)), [name for name, _ in shown])
    axis.set_xlim(3e-6, 3e3)
    axis.grid(axis="x", color="#D5DBE3", lw=0.7)
    axis.set_axisbelow(True)
    for side in ("top", "right", "left"):
        axis.spines[side].set_visible(False)
    for place, ((_, record), ratio) in enumerate(zip(shown, ratios, strict=True)):
        text = f"×{ratio:.2g}" if ratio >= 0.095 else f"1/{_round(1 / ratio)}"
        label, slow = f"{text}   {_speed(record['rate'])}", ratio < 1
        axis.annotate(
            label, (max(ratio, 1), place), (9, 0), textcoords="offset points", va="center", ha="left", fontsize=9,
            color="#1F3044" if slow else "#000000",
        )  # fmt: skip


def _round(value: float) -> str:
    return f"{float(f'{value:.2g}'):,.0f}"


def _speed(rate: float) -> str:
    return f"{_round(rate) if rate >= 10 else f'{rate:.2g}'} trials/s"


def _pyplot() -> Any:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    return pyplot
