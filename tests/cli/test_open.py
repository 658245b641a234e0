from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.request

import pytest
from committed_books import EXAMPLES


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_it_prints_a_link_serves_and_ends_with_ctrl_c(tmp_path):
    book = shutil.copy(EXAMPLES["collinear-head-on"], tmp_path / "case.xlsx")
    command = [sys.executable, "-m", "xlmc", "open", str(book), "--no-browser"]
    given = os.environ | {"XDG_STATE_HOME": str(tmp_path / "state"), "HOME": str(tmp_path)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=given) as running:
        link = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", running.stdout.readline())[0]
        end = time.monotonic() + 120
        while True:
            try:
                with urllib.request.urlopen(link) as answer:
                    assert answer.status == 200
                break
            except OSError:
                assert time.monotonic() < end
                time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=120)
    assert (running.returncode, err) == (0, "")
    assert "The window is closed" in out
    assert sorted(os.listdir(tmp_path)) == ["case.xlsx"]  # nobody opened the book, so nothing was kept


def test_what_cannot_be_opened_is_told(xlmc, tmp_path):
    outcome = xlmc("open", "nothing.xlsx", "--no-browser")
    assert outcome.code == 2
    assert "nothing.xlsx: there is no such file" in outcome.err
    assert xlmc("open", "--port", "0").code == 2
