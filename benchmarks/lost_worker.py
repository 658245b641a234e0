"""A wide book on a Dask cluster of this machine, of whose workers one is killed: `python benchmarks/lost_worker.py`.

The book has 3,000 assumptions and 500 forecasts, the largest row of `growth_of_outputs.py`. It runs without a cluster,
then on two workers, each a process, and then again while one of them is killed and one stands still for two seconds.
What is printed is whether every accepted trial and every draw is the same to the last bit, and the seconds of each run.
"""

from __future__ import annotations

import argparse
import hashlib
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from books import write_wide
from distributed import LocalCluster

import xlmc

__all__ = ["main"]


@contextmanager
def worker(address: str) -> Iterator[subprocess.Popen[bytes]]:
    """Start a worker in a process that nobody starts again."""
    command = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--no-nanny", "--nthreads", "1"]
    with subprocess.Popen(
        [*command, "--no-dashboard"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def fingerprint(run: xlmc.Simulation) -> str:
    """Return the SHA-256 of every number that the run kept."""
    result = hashlib.sha256()
    frame = run.frame()
    for name in frame.columns:
        result.update(np.ascontiguousarray(frame[name].to_numpy()).tobytes())
    return result.hexdigest()


def timed(what: str, ask: Callable[[], xlmc.Simulation]) -> str:
    """Run, print the seconds, and return the fingerprint."""
    start = time.perf_counter()
    run = ask()
    seconds = time.perf_counter() - start
    print(f"{what}: {seconds:.1f} s, {run.accepted:,} accepted, {fingerprint(run)[:16]}", flush=True)
    return fingerprint(run)


def main(given: Sequence[str] | None = None) -> None:
    """Run the book in three ways, and say whether the bits are the same."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--assumptions", type=int, default=3_000)
    parser.add_argument("--forecasts", type=int, default=500)
    parser.add_argument("--trials", type=int, default=30_000)
    asked = parser.parse_args(given)
    with tempfile.TemporaryDirectory() as folder:
        book = Path(folder, "wide.xlsx")
        write_wide(book, asked.assumptions, asked.forecasts)
        model = xlmc.load(book)
        options: dict[str, Any] = {"trials": asked.trials, "seed": 1}
        alone = timed("no cluster", lambda: model.simulate(**options))
        with LocalCluster(n_workers=0, dashboard_address=":0", protocol="tcp") as cluster:
            address = cluster.scheduler_address
            with worker(address) as first, worker(address) as second:
                cluster.get_client().wait_for_workers(2, timeout=120)
                calm = timed("two workers", lambda: model.simulate(scheduler=address, **options))

                def disturb(standing: xlmc.Progress) -> None:
                    if standing.share > 0.3 and first.poll() is None:
                        first.kill()
                        second.send_signal(signal.SIGSTOP)
                        time.sleep(2.0)
                        second.send_signal(signal.SIGCONT)

                lost = timed(
                    "one killed, one slow", lambda: model.simulate(scheduler=address, progress=disturb, **options)
                )
                print(f"the first worker was {'killed' if first.poll() else 'not killed'}")
        print("the same bits" if alone == calm == lost else "OTHER BITS")
        sys.exit(alone != calm or alone != lost)


if __name__ == "__main__":
    main()
