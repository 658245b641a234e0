"""The last lines of a long run say which files of tests cost most: processor time, with that of processes they start.

What a fixture costs is a cost of the test that asks for it first. A process counts when a test has waited for its end.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

LONG = 60.0
"""Seconds of processor time from which a run is long."""
NAMED = 12
"""How many files are named."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--costs", metavar="FILE", type=Path, help="write each test's processor time, most first, to FILE")


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Costs(), "costs of tests")


def spent() -> float:
    """Seconds of processor time so far: of this process, and of those it has waited for."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Costs:
    """Seconds of processor time of each test; a worker sends what a phase of a test took with the phase's report."""

    def __init__(self) -> None:
        self.tests: Counter[str] = Counter()
        self._before = 0.0

    def pytest_runtest_logstart(self) -> None:
        self._before = spent()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self) -> Iterator[None]:
        report = yield
        now = spent()
        report.spent, self._before = now - self._before, now
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.tests[report.nodeid] += getattr(report, "spent", 0.0)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
        if path := config.getoption("--costs"):
            path.write_text("".join(f"{cost:.2f}\t{test}\n" for test, cost in self.tests.most_common()), "utf-8")
        if self.tests.total() > LONG:
            terminalreporter.section(f"Processor time: {self.tests.total():.0f} s; most of it")
            for name, cost in costs_of_files(self.tests).most_common(NAMED):
                terminalreporter.write_line(f"{cost:6.1f} s  {name}")


def costs_of_files(tests: Counter[str]) -> Counter[str]:
    """The costs of tests, added up by their files."""
    files: Counter[str] = Counter()
    for name, cost in tests.items():
        files[name.partition("::")[0]] += cost
    return files
