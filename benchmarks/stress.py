"""Where equations, samplers, statistics and stop rules fail, measured on xlmc and drawn.

`python benchmarks/stress.py` measures every part at full size, writes `results/stress-*.json`, makes the tables of
docs/stress.md and draws its charts into docs/pictures/stress; `python benchmarks/stress.py forms few` does two parts,
`--draw-only` draws again what was measured before. No figure depends on the machine, but for the last digits of sines.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

HERE = Path(__file__).resolve().parent
sys.path += [
    str(HERE.parent),
    str(HERE),
]  # the templates, whose forms are measured; `stressing`, when not run from here

from stressing import draw_rounding, draw_statistics, full_size, page

__all__ = ["PAGE", "PARTS", "PICTURES", "RESULTS", "Part"]

PAGE: Final = HERE.parent / "docs" / "stress.md"
PICTURES: Final = HERE.parent / "docs" / "pictures" / "stress"
RESULTS: Final = HERE / "results"


class Part(NamedTuple):
    """What is measured and drawn at once.

    Attributes:
        measure: gives what was found, as JSON has it; takes a factor by which there are fewer runs.
        draw: writes its pictures into a folder.
        pictures: their names.
    """

    measure: Callable[[int], Mapping[str, Any]]
    draw: Callable[[Mapping[str, Any], Path], list[Path]]
    pictures: tuple[str, ...]


PARTS: Final[Mapping[str, Part]] = {
    "forms": Part(full_size.forms, draw_rounding.draw, tuple(draw_rounding.CHARTS)),
    "samplers": Part(full_size.samplers, draw_statistics.samplers, ("filtered",)),
    "shares": Part(full_size.shares, draw_statistics.shares, ("acceptance",)),
    "tails": Part(full_size.tails, draw_statistics.tails, ("tails",)),
    "correlations": Part(full_size.correlations, draw_statistics.correlations, ("correlations",)),
    "counts": Part(full_size.counts, draw_statistics.counts, ("counts",)),
    "few": Part(full_size.few, draw_statistics.few, ("few",)),
    "stops": Part(full_size.stops, draw_statistics.stops, ("stops",)),
}


def main() -> None:
    """Measure and draw."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []], default=[], help="by default all")
    parser.add_argument("--draw-only", action="store_true", help="draw what was measured before")
    parser.add_argument("--fewer", type=int, default=1, metavar="N", help="a N-th of the runs")
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--pictures", type=Path, default=PICTURES)
    parser.add_argument("--page", type=Path, default=PAGE, help="whose tables are made anew")
    given = parser.parse_args()
    for name in given.parts or PARTS:
        part, path = PARTS[name], given.results / f"stress-{name}.json"
        if not given.draw_only:
            path.write_text(json.dumps(part.measure(given.fewer), separators=(",", ":")) + "\n", encoding="utf-8")
        for picture in part.draw(json.loads(path.read_text(encoding="utf-8")), given.pictures):
            print(f"{name}: {picture}", flush=True)
    if given.page.exists():
        given.page.write_text(page.filled(given.page.read_text(encoding="utf-8"), given.results), encoding="utf-8")


if __name__ == "__main__":
    main()
