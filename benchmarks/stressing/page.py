"""The tables of docs/stress.md, made from the results and put between its markers."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from tables import placed

from stressing.forms import FORMS
from stressing.sweeps import SWEEPS
from xlmc.montecarlo.sampling.sampling_methods import METHODS

__all__ = ["TABLES", "filled"]

Found = Mapping[str, Any]


def filled(text: str, results: Path) -> str:
    """The page with its tables made anew, of those parts that there are results of."""
    for part, table in TABLES.items():
        path = results / f"stress-{part}.json"
        if path.exists():
            text = placed(text, f"stress {part}", table(json.loads(path.read_text(encoding="utf-8"))))
    return text


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]], left: int = 1) -> str:
    rules = ["---"] * left + ["---:"] * (len(headings) - left)
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (headings, rules, *rows))


def _forms(result: Found) -> str:
    """Largest relative error along each sweep, printed → rewritten."""
    rows = []
    for name, sweep in SWEEPS.items():
        errors = result[name]["errors"]["numpy"]
        cells = [f"{_power(errors[form.printed])} → {_power(errors[form.rewritten])}" for form in FORMS]
        rows.append([sweep.title, *cells])
    return _table(["sweep", *(f"({form.number})" for form in FORMS)], rows)


def _power(errors: Sequence[float]) -> str:
    """The largest; half a turn or more is wrong rather than inexact."""
    largest = max(errors)
    return "wrong" if largest > 0.5 else f"{largest:.0e}".replace("e-0", "e-")


def _correlations(result: Found) -> str:
    rows = []
    for matrix in result["matrices"]:
        asked, used, drawn = (
            ", ".join(f"{pair[key]:.3g}" if key == "asked" else f"{pair[key]:.4f}" for pair in matrix["found"])
            for key in ("asked", "aimed", "found")
        )
        rows.append([matrix["name"], asked, used, drawn, "yes" if matrix["notices"] else "no"])
    return _table(["three assumptions", "asked for", "used", "drawn", "notice"], rows, 5)


def _few(result: Found) -> str:
    """Coverage in percent, of a few numbers of trials."""
    sizes = (2, 3, 10, 30, 100, 1000)
    cells = {(cell["forecast"], cell["trials"]): cell["found"] for cell in result["cells"]}
    shown = [n for n in sizes if ("normal", n) in cells]
    rows = []
    for forecast in ("normal", "exponential"):
        for statistic in cells[forecast, shown[0]]:
            counts = [cells[forecast, n][statistic] for n in shown]
            texts = [f"{100 * held / given:.0f}" if given else "none" for given, held in counts]
            rows.append([forecast, statistic, *texts])
    return _table(["forecast", "statistic", *(f"{n:,} trials" for n in shown)], rows, 2)


def _stops(result: Found) -> str:
    rows = [
        [
            row["forecast"],
            f"{row['needed']:,.0f}",
            f"{100 * row['held'] / row['ended']:.1f}",
            f"{100 * row['fixed']['held'] / row['runs']:.1f}",
            f"{row['bias']:+.2f} ± {row['error of bias']:.2f}",
            f"{row['fixed']['bias']:+.2f}",
            f"{row['length'] / row['needed']:.2f}",
        ]
        for row in result["precise"]
    ]
    headings = ["forecast", "accepted trials needed", "intervals that hold, %", "without a rule", "bias, in errors"]
    headings += ["without a rule", "run over needed"]
    return _table(headings, rows)


def _samplers(result: Found) -> str:
    """The worst of the statistics but SD, and SD, by accepted trials a replicate and by method."""
    cells: dict[tuple[float, float], dict[str, Mapping[str, Any]]] = {}
    for cell in result["cells"]:
        expected = round(cell["acceptance"] * cell["trials"] / 16, 1)
        near = next((key for key in cells if key[0] == cell["acceptance"] and abs(key[1] / expected - 1) < 0.1), None)
        cells.setdefault(near or (cell["acceptance"], expected), {})[cell["method"]] = cell
    rows = []
    for (acceptance, expected), by_method in cells.items():
        shares = {name: 100 * np.array(cell["hits"]) / cell["given"] for name, cell in by_method.items()}
        spread = next(iter(by_method.values()))["statistics"].index("SD")
        others = [f"{np.delete(share, spread).min():.1f}" for share in shares.values()]
        runs = f"{next(iter(by_method.values()))['runs']:,}"
        rows.append([f"{acceptance:g}", f"{expected:g}", *others, *(f"{s[spread]:.1f}" for s in shares.values()), runs])
    methods = [METHODS[name].name for name in next(iter(cells.values()))]
    headings = [f"{what}, {method}" for what in ("worst but SD", "SD") for method in methods]
    return _table(["acceptance", "accepted / 16", *headings, "runs"], rows)


TABLES: Final[Mapping[str, Callable[[Found], str]]] = {
    "forms": _forms,
    "samplers": _samplers,
    "correlations": _correlations,
    "few": _few,
    "stops": _stops,
}
"""Part -> what makes its table."""
