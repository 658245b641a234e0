"""Chromium for tests that look at pages."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal

__all__ = ["Browser"]

_CHROMIUM = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--in-process-gpu",
    "--disable-extensions",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--window-size=1280,1000",
)


class Browser:
    """One Chromium for all tests, and a new one where it, or its driver, has ended: a busy machine ends them.

    It logs what scripts complain of, and with `requests` also what each page asks for, which takes time with every
    message that a page gets.
    """

    def __init__(self, profiles, *, requests):
        self._profiles, self._running = profiles, None
        self._logged = {"browser": "ALL"} | ({"performance": "ALL"} if requests else {})

    def __call__(self):
        if self._running is not None and not self._answers():
            self.quit()
        if self._running is None:
            self._running = self._started()
        return self._running

    def _answers(self):
        from selenium.common.exceptions import WebDriverException
        from urllib3.exceptions import HTTPError

        try:
            return self._running.execute_script("return 6 * 7") == 42
        except (WebDriverException, HTTPError, OSError):
            return False

    def _started(self):
        from selenium import webdriver

        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for argument in (*_CHROMIUM, f"--user-data-dir={self._profiles.mktemp('profile')}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", self._logged)
        service = webdriver.ChromeService(shutil.which("chromedriver"), popen_kw={"start_new_session": True})
        result = webdriver.Chrome(options=options, service=service)
        result.set_script_timeout(120)
        return result

    def quit(self):
        """End the browser and its driver, whatever is left of them."""
        running, self._running = self._running, None
        if running is None:
            return
        with contextlib.suppress(Exception):  # there may be nobody left to ask
            running.quit()
        running.service.stop()
        if hasattr(os, "killpg"):
            with contextlib.suppress(ProcessLookupError):  # a driver that was killed leaves its browser behind
                os.killpg(running.service.process.pid, signal.SIGKILL)
