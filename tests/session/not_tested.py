"""The last lines of a run say what was not tested, and why."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable

import pytest


def _reason(report: pytest.TestReport | pytest.CollectReport) -> str:
    message = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
    return message.removeprefix("Skipped: ")


def untested(reports: Iterable[pytest.TestReport | pytest.CollectReport]) -> list[str]:
    """For each reason a line with the files it kept from being tested, and how many of their tests."""
    files: dict[str, Counter[str]] = defaultdict(Counter)
    for report in reports:
        files[_reason(report)][report.nodeid.partition("::")[0]] += 1
    return [f"{_of(files[reason])}: {reason}" for reason in sorted(files)]


def _of(tests: Counter[str]) -> str:
    return ", ".join(f"{name} ({number})" for name, number in sorted(tests.items()))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if reports := terminalreporter.stats.get("skipped", []):
        terminalreporter.section("Not tested here")
        for line in untested(reports):
            terminalreporter.write_line(line)
