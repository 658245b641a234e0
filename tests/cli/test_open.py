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
    running = started("open", book, "--no-browser", "--memory", "2,000")
    link = re.search(r"http://127\.0\.0\.1:\d+/book/\w+#\w+\.[\w-]+", running.out.readline())[0]
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


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_the_browser_is_started_with_a_file_of_the_users_own_and_not_with_the_link(started, tmp_path, monkeypatch):
    book = shutil.copy(EXAMPLES["collinear-head-on"], tmp_path / "case.xlsx")
    browser, seen = tmp_path / "browser.sh", tmp_path / "seen"
    browser.write_text(
        f'#!/bin/sh\nls -l "${{1#file://}}" > {seen}.part\necho "$1" >> {seen}.part\n'
        f'cat "${{1#file://}}" >> {seen}.part\nmv {seen}.part {seen}\n',
        encoding="utf-8",
    )
    browser.chmod(0o700)
    monkeypatch.setenv("BROWSER", f"{browser} %s")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    running = started("open", book)
    link = re.search(r"http://\S+", running.out.readline())[0]
    end = time.monotonic() + 120
    while not seen.exists():
        assert time.monotonic() < end
        time.sleep(0.01)
    rights, address, page = seen.read_text(encoding="utf-8").split("\n", 2)
    assert rights.startswith("-rw------- ")
    assert address.startswith("file:///")
    assert link.partition("#")[2] not in address
    assert f"0;url={link}" in page
    os.kill(running.number, signal.SIGINT)
    assert running.ended().code == 0
    assert not os.path.exists(address.removeprefix("file://"))


def test_what_cannot_be_opened_is_told(xlmc, tmp_path):
    outcome = xlmc("open", "nothing.xlsx", "--no-browser")
    assert outcome.code == 2
    assert "nothing.xlsx: There is no such file" in outcome.err
    assert xlmc("open", "--port", "0").code == 2
    assert xlmc("open", "--memory", "20").code == 2
