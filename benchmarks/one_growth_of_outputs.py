"""All that is asked of one book, in this process: the task as JSON on stdin, the cost of each step as JSON on stdout.

The task names the steps that are wanted; the book is loaded and run whatever they are.

A step's cost is the processor time of this process and of its threads, and the largest memory while it ran, with all
that earlier steps left: the kernel's mark is set back before each.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any

import xlmc
from xlmc.analysis.results.saved import keep, open_run

_CLEAR, _STATUS = Path("/proc/self/clear_refs"), Path("/proc/self/status")


def main() -> None:
    """Ask for everything once, in the order in which a person would."""
    given = json.loads(sys.stdin.readline())
    book, folder = Path(given["path"]), Path(given["folder"])
    result: dict[str, Any] = {"version": xlmc.__version__}
    wanted = {"load", "run", *given["steps"]}

    def step(name: str, ask: Callable[[], Any]) -> Any:
        if name not in wanted:
            return None
        if _CLEAR.exists():
            _CLEAR.write_text("5", encoding="utf-8")
        start = process_time()
        answer = ask()
        result[name] = {"seconds": process_time() - start, "megabytes": _peak()}
        print(f"{name} {result[name]['seconds']:.2f} s", file=sys.stderr, flush=True)
        return answer

    model = step("load", lambda: xlmc.load(book))
    step("check", lambda: xlmc.check(book))
    run = step("run", lambda: model.simulate(seed=1, **given["options"]))
    result["trials"], result["accepted"] = run.trials, run.accepted
    step("statistics", lambda: [each.statistics for each in run.results.values()])
    step("sensitivity", lambda: xlmc.sensitivities(run))
    step("sheets", lambda: run.save(folder / "out.xlsx", overwrite=True))
    step("page", lambda: run.save_page(folder / "out.html", overwrite=True))
    step("report", lambda: run.save_report(folder / "out.docx", overwrite=True))
    step("save", lambda: keep(run._run, folder / "out.xlmcrun", overwrite=True))
    step("open", lambda: open_run(folder / "out.xlmcrun"))
    step("replay", lambda: xlmc.replay(folder / "out.xlmcrun"))
    result["bytes"] = {each.suffix: each.stat().st_size for each in folder.glob("out.*")}
    print(json.dumps(result), flush=True)


def _peak() -> float | None:
    """The largest resident memory since the mark was set back, in MB; None where the system does not say."""
    if not _STATUS.exists():
        return None
    lines = dict(line.split(":", 1) for line in _STATUS.read_text(encoding="utf-8").splitlines() if ":" in line)
    return int(lines["VmHWM"].split()[0]) / 1024


if __name__ == "__main__":
    main()
