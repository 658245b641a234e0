"""Whether the shipped books give the same numbers as when this was last recorded: a witness for changes of the code.

    python benchmarks/witness.py                  compare with results/witness.json; exit code 1 where something differs
    python benchmarks/witness.py --record         write that file anew
    python benchmarks/witness.py --books skid     only these books

Of every book, engine and sampling method: the accepted trials, draws and forecasts, and the statistics; of every book,
what the result workbook holds, without its record. They are compared to the last bit where the machine has the
processor features that the record was made with, and else to 1e-12 of the numbers.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import platform
import sys
import tempfile
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from xlmc.api import Simulation
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.outputs.json_document import document

__all__ = ["differences", "features", "main", "recorded", "witnessed"]

ROOT: Final = Path(__file__).resolve().parents[1]
RECORDED: Final = ROOT / "benchmarks" / "results" / "witness.json"

ENGINES: Final = ("numpy", "jit")
SAMPLINGS: Final = ("mc", "lhs", "sobol")
RUNS: Final = tuple((engine, sampling) for engine in ENGINES for sampling in SAMPLINGS)
TRIALS: Final = 20_000
SEED: Final = 7
CLOSE: Final = 1e-12
_DIGITS: Final = 16

_OF_THE_RUN: Final = ("record", "seal", "notices")
"""Parts of the document that name the program, the machine and the day."""

Json = dict[str, Any]


def books(names: Iterable[str] = ()) -> dict[str, Path]:
    """The committed books, by name; those of `names`, or all."""
    sys.path.insert(0, str(ROOT / "tests" / "session"))
    from committed_books import BOOKS

    return {name: BOOKS[name] for name in names or BOOKS}


def features() -> Json:
    """What the last bits depend on: the vector features that NumPy uses, and its version."""
    from numpy._core._multiarray_umath import __cpu_features__  # the only place where NumPy tells

    used = sorted(name for name, has in __cpu_features__.items() if has)
    return {"machine": platform.machine(), "features": used, "numpy": np.__version__}


def witnessed(path: Path, *, parts: bool = True, runs: Iterable[tuple[str, str]] = RUNS) -> Json:
    """What the runs of a book give: `{"numpy mc": {...}, ..., "parts": {...}}`.

    Args:
        path: of the book.
        parts: whether to look at the result workbook, which is that of the run `numpy mc`.
        runs: engine and sampling method of each.
    """
    model = load(path)
    result: Json = {}
    for engine, sampling in runs:
        run = run_model(model, RunOptions.of(trials=TRIALS, seed=SEED, engine=engine, sampling=sampling))
        result[f"{engine} {sampling}"] = _of_run(run)
        if parts and (engine, sampling) == ("numpy", "mc"):
            result["parts"] = dict(_parts(run))
    return result


def _of_run(run: RunResult) -> Json:
    columns = {**run.inputs, **run.forecasts}
    trials = hashlib.sha256()
    for name, values in columns.items():
        trials.update(name.encode())
        trials.update(np.ascontiguousarray(values).tobytes())
    messages = {key: part for key, part in document(run).items() if key not in _OF_THE_RUN}
    return {
        "accepted": run.accepted,
        "trials": trials.hexdigest()[:_DIGITS],
        "statistics": _digest(json.dumps(messages, sort_keys=True).encode()),
        "numbers": {name: _numbers(values) for name, values in run.forecasts.items()},
    }


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:_DIGITS]


def _numbers(values: np.ndarray[Any, Any]) -> list[float | None]:
    """Mean, standard deviation, least, median and largest; None for each that is no number."""
    if not values.size:
        return []
    result = [values.mean(), values.std(), values.min(), np.median(values), values.max()]
    return [float(number) if math.isfinite(number) else None for number in result]


def _parts(run: RunResult) -> Iterator[tuple[str, str]]:
    """The parts of the result workbook and their digests, without those that name the day or the version."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "results.xlsx"
        Simulation(run).save(path)
        with zipfile.ZipFile(path) as package:
            for name in package.namelist():
                if name.startswith(("xl/worksheets/", "xl/charts/", "xl/drawings/")) and name.endswith(".xml"):
                    content = package.read(name)
                    if b"run.fingerprint" not in content:  # the record
                        yield name, _digest(content)


def _text(result: Json) -> str:
    """A line for each run, so that a comparison of two versions shows which."""
    lines = [
        f"{json.dumps(name)}: {{\n" + ",\n".join(f" {json.dumps(run)}: {json.dumps(of)}" for run, of in book.items())
        for name, book in result.items()
    ]
    return f'{{"made on": {json.dumps(features())},\n"books": {{\n' + "},\n".join(lines) + "}}}\n"


def recorded() -> Json:
    """What was recorded last."""
    result: Json = json.loads(RECORDED.read_text(encoding="utf-8"))
    return result


def differences(before: Json, after: Json, *, bits: bool) -> Iterator[str]:
    """What differs between two witnesses of a book, in words. `bits`: to the last bit, or to 1e-12 of the numbers."""
    for name in dict.fromkeys([*before, *after]):
        old, new = before.get(name), after.get(name)
        if old is None or new is None:
            yield f"{name}: {'new' if old is None else 'missing'}"
        elif name == "parts":
            if bits:
                yield from _changed_parts(old, new)
        else:
            yield from (f"{name}: {what}" for what in _changed(old, new, bits))


def _changed(old: Json, new: Json, bits: bool) -> Iterator[str]:
    if bits:
        yield from (key for key in ("accepted", "trials", "statistics") if old[key] != new[key])
    elif old["accepted"] != new["accepted"]:
        yield "accepted"
    if list(old["numbers"]) != list(new["numbers"]):
        yield "forecasts"
        return
    for name, numbers in old["numbers"].items():
        if not all(map(_close, numbers, new["numbers"][name])):
            yield f"{name} from {numbers} to {new['numbers'][name]}"


def _close(x: float | None, y: float | None) -> bool:
    return x == y if x is None or y is None else math.isclose(x, y, rel_tol=CLOSE, abs_tol=CLOSE)


def _changed_parts(old: dict[str, str], new: dict[str, str]) -> Iterator[str]:
    changed = [name for name in dict.fromkeys([*old, *new]) if old.get(name) != new.get(name)]
    if changed:
        yield f"{len(changed)} of {len(old)} parts of the result workbook, first {changed[0]}"


def main(arguments: list[str] | None = None) -> int:
    """Compare or record; see the module."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", action="store_true", help="write what is found, and compare nothing")
    parser.add_argument("--books", nargs="+", default=(), metavar="NAME", help="names without .xlsx; all by default")
    given = parser.parse_args(arguments)
    result = {}
    for name, path in books(given.books).items():
        result[name] = witnessed(path)
        print(name, "done", file=sys.stderr, flush=True)
    if given.record:
        kept = recorded()["books"] if given.books and RECORDED.exists() else {}
        RECORDED.write_text(_text({**kept, **result}), encoding="utf-8")
        return 0
    before = recorded()
    bits = before["made on"] == features()
    known = before["books"]
    messages = [
        f"{name}: {what}"
        for name in result
        if name in known
        for what in differences(known[name], result[name], bits=bits)
    ]
    messages += [f"{name}: is not recorded yet" for name in result if name not in known]
    print(
        "\n".join(messages)
        if messages
        else f"{len(result)} books give the same {'bits' if bits else 'numbers'} as recorded"
    )
    return int(bool(messages))


if __name__ == "__main__":
    sys.exit(main())
