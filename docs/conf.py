"""The pages of docs/ as a site: `sphinx-build -W docs build/docs`."""

from pathlib import Path

project = "xlmc"
author = "The xlmc authors"
release = next(
    line.split('"')[1]
    for line in (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8").splitlines()
    if line.startswith("version = ")
)
extensions = ["myst_parser"]
myst_heading_anchors = 4
exclude_patterns = ["__pycache__"]
html_theme = "alabaster"
html_theme_options = {"description": "Monte Carlo simulation of Excel workbooks", "page_width": "1100px"}
