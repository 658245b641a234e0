"""Make the pictures of the live window: `python docs/make_live_picture.py [FOLDER]`.

`examples/intersection.xlsx` is opened, a range is moved, two states are kept as scenarios and compared, and Chromium
asked for what it shows. Needs Chromium with its driver, Selenium and Pillow.
"""

from __future__ import annotations

import io
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from selenium import webdriver
from selenium.webdriver import ActionChains

HERE = Path(__file__).resolve().parent
CASE = HERE.parent / "examples" / "intersection.xlsx"
FOLDER = HERE / "pictures"

_COLOURS = 96
_CHROMIUM = ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1400,1060")


def make(pictures: Path) -> list[Path]:
    """Write the pictures into a folder; their paths are returned."""
    with TemporaryDirectory() as folder:
        book = shutil.copy(CASE, Path(folder, "my-case.xlsx"))
        command = [sys.executable, "-m", "xlmc", "open", str(book), "--no-browser"]
        given = os.environ | {"XDG_STATE_HOME": folder}
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=given) as server:
            try:
                assert server.stdout is not None
                (link,) = re.findall(r"http\S+", server.stdout.readline())
                shots = _shots(link, folder)
            finally:
                server.terminate()
    for name, shot in shots.items():
        with Image.open(io.BytesIO(shot)) as image:
            few = image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
            few.save(pictures / f"{name}.png", optimize=True)
    return [pictures / f"{name}.png" for name in shots]


def _shots(link: str, folder: str) -> dict[str, bytes]:
    """Name of each picture -> it."""
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or ""
    for argument in (*_CHROMIUM, f"--user-data-dir={folder}/profile"):
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
    try:
        browser.get(link)
        _at_rest(browser)
        time.sleep(1.0)
        knob = browser.find_elements("css selector", ".card .knob.upper")[5]
        browser.execute_script("arguments[0].closest('.card').scrollIntoView({block: 'center'})", knob)
        ActionChains(browser, duration=30).click_and_hold(knob).move_by_offset(-70, 0).release().perform()
        time.sleep(1.0)
        _at_rest(browser)
        return {"live-window": _seen(browser), "live-scenarios": _scenarios(browser)}
    finally:
        browser.quit()


def _scenarios(browser: webdriver.Chrome) -> bytes:
    """Two kept states, compared in one table."""
    browser.execute_script("""
        Live.wire.say({ kind: "keep", name: "friction lower" });
        Live.wire.say({ kind: "reset", of: "assumption", name: "" });
        Live.wire.set("filter", "Restitution, tangential", "at_most", 0.5, false);
        Live.wire.say({ kind: "keep", name: "e_t at most 0.50" });
        Live.wire.say({ kind: "show", name: "" });
        Live.right.choose("scenarios");
    """)
    time.sleep(1.0)
    _at_rest(browser)
    browser.execute_script("Live.wire.say({ kind: 'compare' })")
    _until(browser, "document.querySelectorAll('#panel-scenarios table').length > 2")
    return _seen(browser)


def _seen(browser: webdriver.Chrome) -> bytes:
    browser.execute_script("document.activeElement.blur(); scrollTo(0, 0)")
    time.sleep(0.5)
    return bytes(browser.get_screenshot_as_png())


def _at_rest(browser: webdriver.Chrome) -> None:
    _until(browser, "document.body?.dataset.stage === 'rest'")


def _until(browser: webdriver.Chrome, condition: str) -> None:
    end = time.monotonic() + 60.0
    while not browser.execute_script(f"return {condition}"):
        if time.monotonic() > end:
            raise SystemExit("The window does not come to rest")
        time.sleep(0.1)


if __name__ == "__main__":
    for path in make(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER):
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")
