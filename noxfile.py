"""The checks, one session each: `nox` runs them all, `nox -s lint` one. `.ci/run` and the workflows call them.

Each session makes an environment of its own; with `--no-venv --no-install` it uses the one that runs nox.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

import nox

nox.needs_version = ">=2024.10"
nox.options.sessions = ["tests", "lint", "types", "docs", "examples", "package", "changelog"]
nox.options.reuse_existing_virtualenvs = True

ROOT = Path(__file__).parent
PYTHONS = ["3.11", "3.12", "3.13", "3.14"]
DIST = ROOT / "dist"


@nox.session
def tests(session: nox.Session) -> None:
    """Run the tests; arguments go to pytest."""
    session.install("-e", ".[test]")
    session.run("pytest", "-n", "auto", "--dist", "worksteal", *session.posargs)


@nox.session(python=PYTHONS)
def versions(session: nox.Session) -> None:
    """Install the wheel in a fresh environment of each Python, and run the README's first command outside the tree."""
    wheel = next(DIST.glob("*.whl"), None)
    if wheel is None:
        session.error("there is no wheel: run nox -s package first")
    session.install(str(wheel))
    with tempfile.TemporaryDirectory() as folder:
        book = shutil.copy(ROOT / "examples" / "intersection.xlsx", folder)
        session.chdir(folder)
        session.run("xlmc", "--version")
        session.run("xlmc", "new", "skid", "case.xlsx")
        session.run("xlmc", "simulate", book, "--trials", "20000", "--quiet")
        session.run("python", "-c", "import xlmc; print(xlmc.load('intersection.xlsx').simulate(1000))")


@nox.session
def lint(session: nox.Session) -> None:
    """Look at style, layers and spelling."""
    session.install("-e", ".[test,release]")
    session.run("ruff", "check", ".")
    session.run("ruff", "format", "--check", ".")
    session.run("lint-imports")
    workflows = sorted(map(str, (ROOT / ".github" / "workflows").glob("*.yml")))
    session.run("check-jsonschema", "--builtin-schema", "vendor.github-workflows", *workflows)
    session.run("codespell", "xlmc", "docs", "examples", "templates", *map(str, ROOT.glob("*.md")))


@nox.session
def types(session: nox.Session) -> None:
    """Check the types of the package, and of an example as users write it, with two checkers."""
    session.install("-e", ".[test,release]")
    session.run("mypy")
    session.run("mypy", "--strict", "examples/typed_usage.py")
    session.run("pyright")


@nox.session
def docs(session: nox.Session) -> None:
    """Build the site; a warning or a broken link between pages is an error."""
    session.install("-e", ".[docs]")
    session.run("sphinx-build", "-q", "-W", "--keep-going", "docs", os.environ.get("XLMC_SITE", "build/docs"))


@nox.session
def examples(session: nox.Session) -> None:
    """Run every script of examples/ and the README's first command."""
    session.install("-e", ".[test]")
    with tempfile.TemporaryDirectory() as folder:
        for script in sorted((ROOT / "examples").glob("*.py")):
            session.run("python", str(script), folder)
        session.run("xlmc", "check", "examples/intersection.xlsx")
        session.run("xlmc", "simulate", "examples/intersection.xlsx", "-j", "2", "-o", f"{folder}/results.xlsx")


@nox.session
def package(session: nox.Session) -> None:
    """Build wheel and source archive into dist/, look at what is in them, and build LibreOffice's menu into build/."""
    session.install("-e", ".[release]")
    shutil.rmtree(DIST, ignore_errors=True)
    session.run("python", "-m", "build", "--outdir", str(DIST))
    built = sorted(map(str, DIST.iterdir()))
    session.run("twine", "check", "--strict", *built)
    session.run("check-wheel-contents", *(each for each in built if each.endswith(".whl")))
    session.run("python", "packaging/libreoffice/build.py")


@nox.session
def changelog(session: nox.Session) -> None:
    """Show what the fragments in changes/ would add to the changelog."""
    session.install("-e", ".[release]")
    session.run("towncrier", "build", "--draft", "--version", "next", "--date", "today")
