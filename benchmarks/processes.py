"""A measurement in a fresh process: the task in, the answer out, or why there is none."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import asdict
from pathlib import Path
from typing import Any

from contest import Answer, Task

__all__ = ["answer_of", "ask"]

HERE = Path(__file__).resolve().parent
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


def ask(python: Path, module: str, task: Task, limit: float) -> Answer | str:
    """The answer, or in words why there is none. `limit`: seconds for the whole process."""
    answer = answer_of(python, "one_contestant.py", {"module": module, "task": asdict(task)}, limit)
    return answer if isinstance(answer, str) else Answer(**answer)


def answer_of(python: Path, script: str, given: dict[str, Any], limit: float) -> dict[str, Any] | str:
    """What a script beside this one prints last, or in words why there is nothing; both are JSON."""
    paths = os.pathsep.join(filter(None, (str(HERE.parent), os.environ.get("PYTHONPATH"))))
    command = [str(python), "-W", "ignore", str(HERE / script)]
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": paths, "XLMC_KEEP_CODE": "0"}
    try:
        done = subprocess.run(
            command, input=json.dumps(given), capture_output=True, text=True, timeout=limit, env=environment
        )
    except subprocess.TimeoutExpired:
        return f"no answer within {limit:.0f} s"
    if done.returncode:
        return f"failed: {(done.stderr.strip() or 'no message').splitlines()[-1]}"
    answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return answer
