from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor

import books
import engine_rates
import pytest


def test_a_line_a_book(capsys, monkeypatch):
    """In this process; another one is sent the function and sends back the rates."""
    pytest.importorskip("llvmlite")
    rates = engine_rates.Rates(2.0, 1.0, (2.0,))
    assert pickle.loads(pickle.dumps((engine_rates.measured, rates))) == (engine_rates.measured, rates)
    monkeypatch.setattr(engine_rates, "ProcessPoolExecutor", lambda workers, _: ThreadPoolExecutor(workers))
    engine_rates.main(["--quick", "--books", "benchmark skid"])
    lines = [line.split("|")[1:-1] for line in capsys.readouterr().out.splitlines()]
    assert [line[0].strip() for line in lines] == ["book", "---", "benchmark skid"]
    for _, by_numpy, by_jit, ratio, rounds in lines[2:]:
        assert min(float(figure.replace(",", "")) for figure in (by_numpy, by_jit, ratio)) > 0
        assert rounds.split()[1:] == ["of", "1"]


def test_all_books_are_measured(tmp_path, monkeypatch):
    """The small ones of those that are made: the others take a second to write."""
    assert set(engine_rates.MADE.values()) == set(books.BOOKS)
    small = {f"benchmark {name}": name for name in ("skid", "case-study", "powers")}
    assert small.items() <= engine_rates.MADE.items()
    monkeypatch.setattr(engine_rates, "MADE", small)
    paths = engine_rates.paths(tmp_path)
    assert {*engine_rates.COMMITTED, *small} == set(paths)
    assert paths["skid"] != paths["benchmark skid"]
    assert all(path.exists() for path in paths.values())
