from __future__ import annotations

import os
import re
import shutil
import signal
import time
import urllib.request

import pytest
from committed_books import EXAMPLES


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_it_prints_a_link_serves_and_ends_with_ctrl_c(started, tmp_path, monkeypatch):
    book = shutil.copy(EXAMPLES["collinear-head-on"], tmp_path / "case.xlsx")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("HOME", str(tmp_path))
    running = started("open", book, "--no-browser")
    link = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", running.out.readline())[0]
    end = time.monotonic() + 120
    while True:
        try:
            with urllib.request.urlopen(link) as answer:
                assert answer.status == 200
            break
        except OSError:
            assert time.monotonic() < end
            time.sleep(0.01)
    os.kill(running.number, signal.SIGINT)
    outcome = running.ended()
    assert (outcome.code, outcome.err) == (0, "")
    assert "The window is closed" in outcome.out
    assert sorted(os.listdir(tmp_path)) == ["case.xlsx"]  # nobody opened the book, so nothing was kept


def test_what_cannot_be_opened_is_told(xlmc, tmp_path):
    outcome = xlmc("open", "nothing.xlsx", "--no-browser")
    assert outcome.code == 2
    assert "nothing.xlsx: there is no such file" in outcome.err
    assert xlmc("open", "--port", "0").code == 2
