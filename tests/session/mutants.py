"""Defects planted one at a time: do the tests find each?

python tests/session/mutants.py            plants all, in a copy of `xlmc/`, and says which tests find them
python tests/session/mutants.py ROOM …     those of these rooms

A mutant replaces one text, which stands once in `xlmc/`, by another, and runs the tests that mirror its module until
the first fails. A test that fails without the defect, too, finds nothing: it ends the whole, to be mended first. A
mutant that lives shows what no test holds: write the test, or say in `MUTANTS` why none can.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

__all__ = ["MUTANTS", "Mutant", "modules_with"]

ROOT = Path(__file__).resolve().parents[2]
MOST_SECONDS = 3_600


class Mutant(NamedTuple):
    """A defect.

    Attributes:
        before, after: the text that is replaced, and by what.
        tests: folders and files below `tests/`, in the order of trying.
    """

    before: str
    after: str
    tests: tuple[str, ...]


MUTANTS = {
    # address, columns
    "rows of an area": Mutant(
        "return self.bottom - self.top + 1", "return self.bottom - self.top", ("test_address.py",)
    ),
    "a column keeps its gaps": Mutant("return values[~np.isnan(values)]", "return values", ("columns",)),
    "ties of a sorted column": Mutant("_repeat(folder, splitters[", "_repeat(folder, 0 * splitters[", ("columns",)),
    # workbook
    "a changed result is replaced": Mutant(
        'return None if seal.whole else "it was changed since xlmc wrote it"', "return None", ("workbook",)
    ),
    "ids of pointers": Mutant('ids = [f"rId{last + 1 + ', 'ids = [f"rId{1 + ', ("workbook",)),
    "two seals": Mutant("if len(seals) != 1:", "if not seals:", ("workbook",)),
    # formula
    "what a formula reads": Mutant("looked_at = name in LOOKED_AT", "looked_at = False", ("formula", "evaluation")),
    "a circle through itself": Mutant('connection="strong"', 'connection="weak"', ("formula",)),
    # functions
    "errors of conditions": Mutant("if errors is not None and errors.any():", "if False:", ("functions", "evaluation")),
    "criteria that differ": Mutant(
        '"<=": np.less_equal,\n    ">": np.greater,', '"<=": np.less,\n    ">": np.greater,', ("functions",)
    ),
    "15 digits": Mutant(
        "return x == y or round_to_15_digits(x) == round_to_15_digits(y)", "return x == y", ("functions",)
    ),
    "payments at the start": Mutant("per - 1, pmt, pv, when", "per, pmt, pv, when", ("functions/financial",)),
    "a blank branch": Mutant(
        "np.where(value.kinds == BLANK, np.uint8(NUMBER), value.kinds)", "value.kinds", ("functions", "evaluation")
    ),
    # distributions
    "cutoffs far out": Mutant(
        "self._in_upper_half = self._below[0] > 0.5", "self._in_upper_half = self._below[0] > 2.0", ("distributions",)
    ),
    "order of cutoffs": Mutant(
        'if not lower < upper:\n            message = f"Lower cutoff',
        'if lower > upper:\n            message = f"Lower cutoff',
        ("distributions", "definitions"),
    ),
    # statistics
    "no share is 0 ± 0": Mutant("return z / (2.0 * (trials + z * z))", "return 0.0", ("statistics",)),
    "trials until accepted": Mutant("p = (successes - 1) / (trials - 1)", "p = successes / trials", ("statistics",)),
    "few replicates": Mutant(
        "widening = t_quantile(dof, confidence) / t_quantile(np.inf, confidence)", "widening = 1.0", ("statistics",)
    ),
    "ends of a skewed interval": Mutant(
        "value - high * error, value - low * error", "value + low * error, value + high * error", ("statistics",)
    ),
    # sampling
    "where a stream stands": Mutant("self._at = start + count", "self._at = start", ("sampling",)),
    "normals of ranks": Mutant(
        "pearson = 2 * np.sin(np.pi / 6 * target)", "pearson = 1.0 * target", ("sampling", "run")
    ),
    "dimensions of Sobol": Mutant("if number >> bit & 1]", "if number >> bit & 2]", ("sampling",)),
    # definitions
    "limits that contradict": Mutant(
        'if low > high or (floor, ceiling) != ("at_least", "at_most"):', "if low > high:", ("definitions",)
    ),
    "a relative tolerance": Mutant(
        "return (value / 100.0 if relative else value), relative", "return value, relative", ("definitions", "run")
    ),
    "limits of checks": Mutant(
        'if given is not None:\n        message = f"A check has',
        'if False:\n        message = f"A check has',
        ("definitions", "cli"),
    ),
    # evaluation
    "order of IFS": Mutant("for test, value in reversed(pairs):", "for test, value in pairs:", ("evaluation",)),
    "CHOOSE beyond its end": Mutant(
        "inside = 1 <= which < len(arguments)", "inside = 1 <= which <= len(arguments)", ("evaluation",)
    ),
    "branches that can err": Mutant("or node.function.facts.never_errs", "or True", ("evaluation",)),
    "blocks that fit": Mutant(
        "        block //= 2\n    return", "        block = 1\n    return", ("evaluation", "run")
    ),
    # run
    "rejected by one filter": Mutant(
        "tally.only[:] = _count(bits & _exactly_one(bits))", "tally.only[:] = _count(bits)", ("run",)
    ),
    "the last accepted trial": Mutant(
        "return int(block.accepted[missing - 1]) - start + 1",
        "return int(block.accepted[missing - 1]) - start",
        ("run",),
    ),
    "undecided is not FALSE": Mutant(
        "return false if column.codes is None else false & (column.codes == 0)", "return false", ("run",)
    ),
    "a filter that is an error": Mutant(
        "return fails if column.codes is None else fails | (column.codes > 0)", "return fails", ("run",)
    ),
    "looks of a rule": Mutant("math.ceil(self._blocks * _GROWTH)", "self._blocks + 1", ("run",)),
    # results
    "missing numbers in the fingerprint": Mutant("np.where(np.isnan(part), np.nan, part)", "part", ("results",)),
    # studies
    "direction of a contribution": Mutant(
        "squares = np.nan_to_num(r) ** 2", "squares = np.nan_to_num(r)", ("studies",)
    ),
    "held alone": Mutant(
        "if cost.judgement.verdict is Verdict.WITHIN)",
        "if cost.judgement.verdict is not Verdict.WITHIN)",
        ("studies", "cli/test_screen.py"),
    ),
    "what is undecided": Mutant(
        "if cost.judgement.verdict is Verdict.UNDECIDED)",
        "if cost.judgement.verdict is Verdict.WITHIN)",
        ("studies", "cli/test_screen.py"),
    ),
    # report
    "formulas in a CSV": Mutant(
        '_STARTS_A_FORMULA: Final = ("=", "+",',
        '_STARTS_A_FORMULA: Final = ("+",',
        ("report", "cli/test_hostile_names.py"),
    ),
    "units like a reference": Mutant('return text.replace("!", "!\\u2060")', "return text", ("report",)),
    # replay
    "rounding elsewhere": Mutant(
        "_ROUNDING * max(size, scale) if self.elsewhere else 0.0", "_ROUNDING * max(size, scale)", ("replay",)
    ),
    # live
    "a link is good once": Mutant("                self._tokens.discard(known)\n", "", ("live",)),
    "a page from elsewhere": Mutant('origin.lower() == f"http://{host.lower()}"', "True", ("live",)),
    # cli
    "the exit code of a signal": Mutant(
        "raise SystemExit(_FROM_SIGNAL + number)", "raise SystemExit(number)", ("cli", "faults")
    ),
}


def modules_with(text: str) -> list[Path]:
    """The modules that hold a text, each as often as it stands in it."""
    return [path for path, whole in _texts().items() for _ in range(whole.count(text))]


@cache
def _texts() -> dict[Path, str]:
    return {path: path.read_text("utf-8") for path in sorted((ROOT / "xlmc").rglob("*.py"))}


def room_of(mutant: Mutant) -> str:
    """The room of the module that holds it."""
    return modules_with(mutant.before)[0].relative_to(ROOT / "xlmc").parts[0].removesuffix(".py")


def killer(mutant: Mutant) -> str | None:
    """The test that finds a mutant; None where none does."""
    (path,) = modules_with(mutant.before)
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "xlmc", Path(folder, "xlmc"), ignore=shutil.ignore_patterns("__pycache__"))
        Path(folder, "templates").symlink_to(ROOT / "templates")  # which the package looks for beside itself
        changed = Path(folder, path.relative_to(ROOT))
        whole = changed.read_text("utf-8")
        changed.write_text(whole.replace(mutant.before, mutant.after), "utf-8")
        found = next((found for tests in mutant.tests if (found := _first_failure(f"tests/{tests}", folder))), None)
        changed.write_text(whole, "utf-8")
        if found and _first_failure(found, folder) == found:
            raise SystemExit(f"{found} fails without a defect, too: mend it first")
    return found


def _first_failure(tests: str, folder: str) -> str | None:
    """The first of these tests that fails where `xlmc/` lies in that folder."""
    command = [sys.executable, "-P", "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", tests]
    path = os.pathsep.join(filter(None, (folder, os.environ.get("PYTHONPATH"))))
    done = subprocess.run(
        command,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=MOST_SECONDS,
        check=False,
    )
    if done.returncode == 0:
        return None
    lines = (line.partition(" ") for line in done.stdout.splitlines())
    failed = [said.partition(" - ")[0] for what, _, said in lines if what in ("FAILED", "ERROR")]
    return failed[0] if failed else f"{tests} (exit code {done.returncode})"


def report(rooms: Sequence[str]) -> Iterator[tuple[str, str, str | None]]:
    """Room, name and killer of the mutants of these rooms, or of all."""
    for name, mutant in MUTANTS.items():
        room = room_of(mutant)
        if not rooms or room in rooms:
            yield room, name, killer(mutant)


def main() -> None:
    """Plant them; exit code 1 where one lives."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's background ignores, and tests send
    alive = 0
    for room, name, found in report(sys.argv[1:]):
        alive += found is None
        print(f"{room:14}{name:36}{found or 'LIVES'}", flush=True)
    print(f"{alive} live" if alive else "every mutant was found")
    sys.exit(alive > 0)


if __name__ == "__main__":
    main()
