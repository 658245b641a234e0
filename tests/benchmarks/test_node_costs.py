from __future__ import annotations

import node_costs
import pytest

from xlmc.engine.llvm import program


def test_costs_are_told_by_kind(capsys, monkeypatch):
    pytest.importorskip("llvmlite")
    monkeypatch.setattr(node_costs, "FEW", 1)
    monkeypatch.setattr(node_costs, "MANY", 3)
    chosen = program.loops_pay
    node_costs.main(["--quick"])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(" | ")[0] for line in lines[2:]] == ["| a number", "| sum"]
    assert program.loops_pay is chosen
