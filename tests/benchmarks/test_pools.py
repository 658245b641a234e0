from __future__ import annotations

import json
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pools

from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.scheduling import processes

FOUND = json.loads((Path(pools.HERE) / "results" / "pools.json").read_text(encoding="utf-8"))["found"]
ROWS = {
    "case study, the process waits from before": ("case-study, numpy", ", warm"),
    "case study, the process is started in the run": ("case-study, numpy", ", anew"),
    "skid, which keeps every trial, waiting": ("skid, numpy", ", warm"),
    "skid, started": ("skid, numpy", ", anew"),
    "case study, engine formulas, waiting": ("case-study, formulas", ", warm"),
    "case study, a whole program with one run": ("case-study, whole program", ""),
}


def test_the_reason_for_processes_of_our_own_is_what_was_measured():
    message = re.findall(r"^ {4}(case study.*?|skid.*?) {3,}([\d.]+) +([\d.]+)$", processes.__doc__, re.MULTILINE)
    assert {row for row, *_ in message} == {*ROWS}
    for row, *figures in message:
        case, kind = ROWS[row]
        measured = pools.speeds(FOUND[case]["seconds"])
        assert [float(figure) for figure in figures] == [measured[f"{way}{kind}"]["own"][1] for way in pools.WAYS[1:]]


class Numbers:
    def runner(self):
        return self

    def run(self, task):
        return task.start


def test_the_prototype_gives_all_blocks_in_order():
    tasks = (Task(start, 1, False) for start in range(300))
    with ThreadPoolExecutor(2) as pool:
        assert list(pools.by_pool(pool, Numbers(), Numbers(), 2, 300, tasks)) == list(range(300))
