"""What a measurement was made on: processor, its vector features, memory, system, versions, date, and what else ran."""

from __future__ import annotations

import os
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import sleep
from typing import Any

__all__ = ["describe", "sentence"]

FEATURES = ("sse4_2", "avx", "avx2", "fma", "avx512f", "avx512dq", "avx512vl", "asimd", "sve")
PACKAGES = ("numpy", "scipy", "pandas", "numba", "formulas", "openpyxl", "xlsxwriter", "matplotlib")


def describe(compiler: str | None = None) -> dict[str, Any]:
    """Everything that a reader needs to judge a figure. `compiler`: the C compiler's path."""
    info = _cpu_info()
    return {
        "date": datetime.now(UTC).isoformat(timespec="minutes"),
        "processor": info.get("model name") or platform.processor() or platform.machine(),
        "family, model": ", ".join(info[key] for key in ("cpu family", "model") if key in info),
        "cores": os.cpu_count(),
        "features": [flag for flag in FEATURES if flag in (info.get("flags") or info.get("Features") or "").split()],
        "memory, GB": _memory(),
        "system": f"{platform.system()} {platform.machine()}",
        "busy before": _busy(),
        "python": platform.python_version(),
        "packages": _versions(),
        "compiler": _first_line([compiler, "--version"]) if compiler else None,
    }


def sentence(machine: dict[str, Any]) -> str:
    """The description in words."""
    busy = machine["busy before"]
    packages = ", ".join(f"{name} {number}" for name, number in machine["packages"].items())
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['memory, GB']} GB, "
        f"{' '.join(machine['features'])}; {machine['system']}; Python {machine['python']}, {packages}; "
        f"{machine['compiler'] or 'no C compiler'}. Measured on {machine['date'][:10]}"
        f"{'' if busy is None else f'; of the cores {busy:.2f} were at other work before the start'}."
    )


def _cpu_info() -> dict[str, str]:
    path = Path("/proc/cpuinfo")
    if not path.exists():
        return {}
    pairs = (line.partition(":") for line in path.read_text(encoding="utf-8").split("\n\n")[0].splitlines())
    return {key.strip(): value.strip() for key, _, value in pairs}


def _memory() -> int | None:
    try:
        return round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30)
    except (AttributeError, ValueError):
        return None


def _busy() -> float | None:
    """How many cores are at work while this process waits a second; None where the system does not tell."""
    path = Path("/proc/stat")
    if not path.exists():
        return None
    before = _ticks(path)
    sleep(1.0)
    idle, total = (now - then for now, then in zip(_ticks(path), before, strict=True))
    return round((1 - idle / total) * (os.cpu_count() or 1), 2)


def _ticks(path: Path) -> tuple[int, int]:
    """Of all cores since the start, idle or waiting for a disk, and in all."""
    _, *ticks = path.read_text(encoding="utf-8").splitlines()[0].split()
    counts = [int(count) for count in ticks[:8]]  # the guests' after them are among the first
    return counts[3] + counts[4], sum(counts)


def _versions() -> dict[str, str]:
    result = {}
    for package in PACKAGES:
        try:
            result[package] = version(package)
        except PackageNotFoundError:
            continue
    return result


def _first_line(command: list[str]) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0]
