from __future__ import annotations

import engine_rates
import pytest


def test_a_line_a_book(capsys):
    pytest.importorskip("llvmlite")
    engine_rates.main(["--quick", "--books", "skid", "benchmark skid"])
    lines = [line.split("|")[1:-1] for line in capsys.readouterr().out.splitlines()]
    assert [line[0].strip() for line in lines] == ["book", "---", "skid", "benchmark skid"]
    for _, by_numpy, by_jit, ratio, rounds in lines[2:]:
        assert min(float(figure.replace(",", "")) for figure in (by_numpy, by_jit, ratio)) > 0
        assert rounds.split()[1:] == ["of", "1"]


def test_all_books_are_measured(tmp_path):
    paths = engine_rates.paths(tmp_path)
    assert {*engine_rates.COMMITTED, *engine_rates.MADE} == set(paths)
    assert paths["skid"] != paths["benchmark skid"]
    assert all(path.exists() for path in paths.values())
