"""The pages of docs/ as a site: `sphinx-build -W docs build/docs`, or `nox -s docs`."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

_PROJECT = tomllib.loads((HERE.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]

project = "xlmc"
author = "The xlmc authors"
release = _PROJECT["version"]
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "gallery_of_books",
]
exclude_patterns = ["__pycache__"]

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "dollarmath"]
nb_execution_mode = "auto"  # every tutorial is run by the build; a cell that fails ends it
nb_execution_timeout = 180
nb_execution_raise_on_error = True
nb_merge_streams = True

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_class_signature = "separated"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_ivar = True
default_role = "code"

html_theme = "furo"
html_title = f"xlmc {release}"
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1F5F99", "color-brand-content": "#1F5F99"},
    "dark_css_variables": {"color-brand-primary": "#7FB2E5", "color-brand-content": "#7FB2E5"},
}
_REPOSITORY = _PROJECT["urls"]["Repository"]
if "HOST.invalid" not in _REPOSITORY:
    html_theme_options |= {"source_repository": _REPOSITORY, "source_branch": "main", "source_directory": "docs/"}
copybutton_prompt_text = r">>> |\$ "
copybutton_prompt_is_regexp = True
