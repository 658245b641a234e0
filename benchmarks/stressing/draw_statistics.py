"""The charts of samplers, statistics and stop rules."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from stressing.charts import COLOURS, binomial_error, coverage_axis, figure, save
from xlmc.montecarlo.loop.forecast_result import FARTHEST_PART, TELLING
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.simulation.simulation import FEW, LEAST_ACCEPTED

__all__ = ["correlations", "counts", "few", "samplers", "shares", "stops", "tails"]

Found = Mapping[str, Any]
MARKERS: Final = "os^Dv<>Ph"
EDGE: Final = "#6B7785"


def _points(axis: Any, x: Any, hits: Any, runs: Any, place: int, label: str) -> None:
    """Shares with two standard errors either way."""
    hits, runs = np.asarray(hits, float), np.asarray(runs, float)
    share = hits / np.maximum(runs, 1)
    axis.errorbar(x, 100 * share, yerr=binomial_error(share, runs), color=COLOURS[place % len(COLOURS)],
                  marker=MARKERS[place % len(MARKERS)], ms=5, lw=1.2, capsize=2, label=label)  # fmt: skip


def samplers(result: Found, folder: Path) -> list[Path]:
    """Coverage against accepted trials a replicate, one panel a statistic."""
    names = ("mean", "SD", "median", "24.5 %", "75.5 %", "acceptance")
    made, axes = figure(2, 3, "Filters that accept 1 in 100: how often 95 % intervals hold the truth", sharex=True)
    for axis, name in zip(axes.flat, names, strict=True):
        coverage_axis(axis, name)
        for place, method in enumerate(("mc", "lhs", "sobol")):
            cells = [c for c in result["cells"] if c["method"] == method and c["acceptance"] == 0.01]
            at = cells[0]["statistics"].index(name)
            given = [c["given"][at] for c in cells]
            _points(axis, [c["accepted"] / 16 for c in cells], [c["hits"][at] for c in cells], given, place,
                    METHODS[method].name)  # fmt: skip
        axis.axvline(LEAST_ACCEPTED, color=EDGE, ls=":", label="fewer: xlmc warns (not Monte Carlo)")
        axis.set_xscale("log")
        _plain(axis)
    for axis in axes[-1]:
        axis.set_xlabel("accepted trials over 16, the number of replicates")
    save(made, axes, folder / "filtered.png")
    return [folder / "filtered.png"]


def _plain(axis: Any) -> None:
    axis.xaxis.set_major_formatter(lambda value, _: f"{value:,.10g}")


def shares(result: Found, folder: Path) -> list[Path]:
    """Exact coverage of acceptances, and what waiting for accepted trials does to the share."""
    made, axes = figure(1, 3, "Acceptance from 1e-2 to 1e-6: exact coverage of its 95 % interval, and its bias")
    first, second, third = axes[0]
    coverage_axis(first, "So many trials, acceptance 1e-4", 80)
    for place, (name, covered) in enumerate(result["fixed"][1]["coverage"].items()):
        line = "-" if name == "xlmc" else "--"
        first.plot(result["fixed"][1]["expected"], 100 * np.array(covered), line, color=COLOURS[place], label=name)
    first.set_xlabel("accepted trials expected")
    coverage_axis(second, "xlmc, every acceptance", 80)
    for place, fixed in enumerate(result["fixed"]):
        second.plot(fixed["expected"], 100 * np.array(fixed["coverage"]["xlmc"]), color=COLOURS[place + 3],
                    label=f"acceptance {fixed['acceptance']:g}")  # fmt: skip
    second.set_xlabel("accepted trials expected")
    third.set(title="--until-accepted N", xlabel="N, accepted trials waited for", ylabel="bias of the share, %")
    for place, (key, label) in enumerate({"N/n": "N / trials", "(N-1)/(n-1)": "(N − 1)/(trials − 1), xlmc"}.items()):
        rows = [row for row in result["waited"] if row["acceptance"] == 1e-4]
        third.plot([r["wanted"] for r in rows], [100 * r[key] for r in rows], color=COLOURS[place + 6],
                   marker=MARKERS[place], label=label)  # fmt: skip
    for axis in axes[0]:
        axis.set_xscale("log")
        _plain(axis)
    third.set_yscale("symlog", linthresh=0.01)
    third.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    save(made, axes, folder / "acceptance.png")
    return [folder / "acceptance.png"]


def tails(result: Found, folder: Path) -> list[Path]:
    """Means of a ratio, its quartile, and what part a single trial has."""
    made, axes = figure(1, 3, "A ratio whose denominator passes 0: its mean does not exist, its quartiles do")
    first, second, third = axes[0]
    for seed in range(6):
        runs = [row for row in result["ladder"] if row["seed"] == seed]
        x = np.array([row["trials"] for row in runs]) * 10 ** (0.1 * (seed - 2.5))
        for axis, value, interval in ((first, "mean", "interval"), (second, "quartile", "quartile interval")):
            y = np.array([row["found"]["ratio"][value] for row in runs])
            ends = np.array([row["found"]["ratio"][interval] for row in runs])
            axis.errorbar(x, y, yerr=np.abs(ends.T - y), color=COLOURS[seed], marker=MARKERS[seed], ms=4, lw=0,
                          elinewidth=1.3, capsize=2, label=f"seed {seed}")  # fmt: skip
    first.set(title="Mean, with its 95 % interval", ylabel="mean of the ratio", yscale="symlog")
    second.axhline(1.0, color="#1F3044", lw=1.2)
    second.set(title="75th percentile, with its 95 % interval", ylabel="75th percentile (truth: 1)")
    for place, name in enumerate(("ratio", "lognormal", "normal")):
        x = [row["trials"] for row in result["ladder"]]
        third.plot(x, [row["found"][name]["farthest"] for row in result["ladder"]], "o", ms=5, alpha=0.7,
                   color=COLOURS[place + 6], label=f"{name}: part of the farthest trial")  # fmt: skip
    third.axhline(FARTHEST_PART, color=EDGE, ls=":")
    third.axvline(TELLING * 0.8, color=EDGE, ls=":")
    third.annotate("above: xlmc says so", (3.2e4, FARTHEST_PART), (0, 4), textcoords="offset points", ha="center",
                   fontsize=9)  # fmt: skip
    third.set(title="What one trial has of the variance", ylabel="part of the sum of squares", yscale="log")
    for axis in axes[0]:
        axis.set(xscale="log", xlabel="trials")
    save(made, axes, folder / "tails.png", columns=5)
    return [folder / "tails.png"]


def correlations(result: Found, folder: Path) -> list[Path]:
    """How far the drawn rank correlations are from those asked for, near ±1."""
    made, axes = figure(
        1, 2, f"Rank correlations near ±1: {result['trials']:,} draws, {len(result['pairs'][0]['found'])} seeds each"
    )
    for axis, sampling in zip(axes[0], ("mc", "lhs"), strict=True):
        for place, side in enumerate((1.0, -1.0)):
            rows = [row for row in result["pairs"] if row["sampling"] == sampling and row["asked"] * side > 0]
            x = np.array([max(1.0 - abs(row["asked"]), 1e-8) for row in rows for _ in row["found"]])
            off = np.array([abs(each["found"] - row["asked"]) for row in rows for each in row["found"]])
            axis.plot(x * (0.85, 1.18)[place], np.maximum(off, 1e-15), "o", ms=4, alpha=0.5, color=COLOURS[place],
                      label="correlation above 0" if side > 0 else "correlation below 0")  # fmt: skip
            expected = [2 * row["found"][0]["error"] + abs(row["found"][0]["expected"] - row["asked"]) for row in rows]
            if place == 0:
                order = np.argsort([-abs(row["asked"]) for row in rows])
                places = np.array([max(1.0 - abs(row["asked"]), 1e-8) for row in rows])[order]
                axis.plot(places, np.array(expected)[order], "-", color="#1F3044", lw=1.2,
                          label="two standard errors of so many draws, and their bias")  # fmt: skip
        axis.set(xscale="log", yscale="log", title=METHODS[sampling].name, ylim=(3e-16, 1e-1))
        axis.set_xlabel("1 − |correlation asked for|; leftmost: exactly ±1")
    axes[0, 0].set_ylabel("|drawn − asked for|, rank correlation")
    save(made, axes, folder / "correlations.png")
    return [folder / "correlations.png"]


def counts(result: Found, folder: Path) -> list[Path]:
    """Percentiles and the mode of whole-number forecasts."""
    made, axes = figure(1, 2, "Forecasts that are whole numbers: ties")
    first, second = axes[0]
    coverage_axis(first, "The percentile (of five) whose interval does worst", 80)
    for place, name in enumerate(dict.fromkeys(cell["family"] for cell in result["cells"])):
        cells = [cell for cell in result["cells"] if cell["family"] == name]
        x, runs = [cell["trials"] for cell in cells], [cell["runs"] for cell in cells]
        _points(first, x, [min(cell["held"]) for cell in cells], runs, place, name)
        _points(second, x, [cell["modes"] for cell in cells], runs, place, name)
    second.set(title="Mode: the most probable value is found", ylabel="runs, %", ylim=(0, 103))
    for axis in axes[0]:
        axis.set(xscale="log", xlabel="accepted trials")
        _plain(axis)
    save(made, axes, folder / "counts.png")
    return [folder / "counts.png"]


def few(result: Found, folder: Path) -> list[Path]:
    """Coverage of every statistic against accepted trials, one panel a forecast."""
    made, axes = figure(1, 3, "Few accepted trials: how often 95 % intervals hold the truth", sharey=True)
    for axis, name in zip(axes[0], ("normal", "uniform", "exponential"), strict=True):
        coverage_axis(axis, f"{name} forecast", 25)
        cells = [cell for cell in result["cells"] if cell["forecast"] == name]
        for place, statistic in enumerate(cells[0]["found"]):
            shown = [cell for cell in cells if cell["found"][statistic][0] >= 0.5 * cell["runs"]]
            _points(axis, [cell["trials"] for cell in shown], [cell["found"][statistic][1] for cell in shown],
                    [cell["found"][statistic][0] for cell in shown], place, statistic)  # fmt: skip
        axis.axvline(FEW, color=EDGE, ls=":", label="fewer: xlmc says so")
        axis.set(xscale="log", xlabel="accepted trials")
        _plain(axis)
    for axis in axes[0, 1:]:
        axis.set_ylabel("")
    save(made, axes, folder / "few.png", columns=5)
    return [folder / "few.png"]


def stops(result: Found, folder: Path) -> list[Path]:
    """What runs that end by themselves hold, and how far they are off."""
    made, axes = figure(1, 3, "Runs that end when their numbers look good enough")
    first, second, third = axes[0]
    coverage_axis(first, "--precision: interval of the mean at the stop", 80)
    for place, name in enumerate(dict.fromkeys(row["forecast"] for row in result["precise"])):
        rows = [row for row in result["precise"] if row["forecast"] == name]
        x = [row["needed"] for row in rows]
        _points(first, x, [row["held"] for row in rows], [row["ended"] for row in rows], place, name)
        second.errorbar(x, [row["bias"] for row in rows], yerr=[2 * row["error of bias"] for row in rows], capsize=2,
                        color=COLOURS[place], marker=MARKERS[place], ms=5, lw=1.2)  # fmt: skip
    second.axhline(0, color="#1F3044", lw=1.2)
    second.set(title="--precision: bias of the mean at the stop", ylabel="bias, in standard errors", ylim=(-0.5, 0.5))
    for axis in (first, second):
        axis.set(xscale="log", xlabel="accepted trials that the precision needs")
        _plain(axis)
    _stable(third, result["stable"])
    save(made, axes, folder / "stops.png", columns=5)
    return [folder / "stops.png"]


def _stable(axis: Any, rows: list[dict[str, Any]]) -> None:
    """The worst of four numbers, with xlmc's least number of sequences and with the standard's."""
    axis.axhline(95.0, color="#1F3044", lw=1.2)
    for least in sorted({row["least"] for row in rows}, reverse=True):
        chosen = [row for row in rows if row["least"] == least]
        label = "as JCGM 101 has it, from 2 sequences" if least == 2 else f"xlmc, from {least} sequences"
        worst = np.array([min(row["within"]) / row["ended"] for row in chosen])
        place = 7 if least == 2 else 0
        axis.errorbar([row["sequences"] for row in chosen], 100 * worst, color=COLOURS[place], capsize=2, ms=6, lw=0,
                      yerr=binomial_error(worst, [row["ended"] for row in chosen]), elinewidth=1.2,
                      marker="s" if least == 2 else "o", label=label)  # fmt: skip
    axis.set(title="--adaptive: the worst of four numbers", xlabel="sequences of 10,000 at the stop, on average")
    axis.set(ylabel="runs within the tolerance of the truth, %", ylim=(60, 101.5))
