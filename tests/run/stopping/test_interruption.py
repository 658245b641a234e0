from __future__ import annotations

import signal
import threading

import pytest

from xlmc.run.stopping import Interruption


def press():
    signal.raise_signal(signal.SIGINT)


@pytest.fixture(autouse=True)
def usual_handler():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_the_first_is_noted_where_there_is_something_to_keep():
    with Interruption(wanted=True) as interruption:
        interruption.keeping = True
        assert not interruption.asked
        press()
        assert interruption.asked
        with pytest.raises(KeyboardInterrupt):
            press()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_with_nothing_to_keep_it_is_an_error_at_once():
    with Interruption(wanted=True), pytest.raises(KeyboardInterrupt):
        press()


def test_where_it_is_not_wanted_nothing_changes():
    with Interruption(wanted=False) as interruption:
        interruption.keeping = True
        with pytest.raises(KeyboardInterrupt):
            press()


def test_where_it_is_ignored_it_stays_so():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with Interruption(wanted=True) as interruption:
        interruption.keeping = True
        press()
        assert not interruption.asked
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_other_threads_hear_no_signals():
    found = []

    def enter():
        with Interruption(wanted=True):
            found.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert found == [signal.default_int_handler]
