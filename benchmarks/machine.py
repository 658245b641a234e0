"""What a measurement was made on: processor, its vector features, memory, system, versions, date, and what else ran."""

from __future__ import annotations

import os
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
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
        "load before": round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None,
        "python": platform.python_version(),
        "packages": _versions(),
        "compiler": _first_line([compiler, "--version"]) if compiler else None,
    }


def sentence(machine: dict[str, Any]) -> str:
    """The description in words."""
    packages = ", ".join(f"{name} {number}" for name, number in machine["packages"].items())
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['memory, GB']} GB, "
        f"{' '.join(machine['features'])}; {machine['system']}; Python {machine['python']}, {packages}; "
        f"{machine['compiler'] or 'no C compiler'}. Measured on {machine['date'][:10]}; load average before "
        f"the start: {machine['load before']}."
    )


def _cpu_info() -> dict[str, str]:
    path = Path("/proc/cpuinfo")
    if not path.exists():
        return {}
    pairs = (line.partition(":") for line in path.read_text().split("\n\n")[0].splitlines())
    return {key.strip(): value.strip() for key, _, value in pairs}


def _memory() -> int | None:
    try:
        return round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30)
    except (AttributeError, ValueError):
        return None


def _versions() -> dict[str, str]:
    found = {}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found


def _first_line(command: list[str]) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0]
