"""The documents say what the program does: their commands, options, functions and Python run here."""

from __future__ import annotations

import importlib.util
import re
import sys
import tomllib
from pathlib import Path

import click
import pytest
from committed_books import BOOKS
from described import undescribed
from fewer_sheets import SHORT, keep_few_trials, keep_sheets, leave_out_fits

import xlmc as package
from xlmc.cli import main, xlmc
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.loop.version import __version__

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMAND_LINE = (ROOT / "docs" / "command-line.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(xlmc.commands))
def test_every_command_and_option_is_documented(name):
    section = COMMAND_LINE.partition(f"## `xlmc {name}")[2].partition("\n## ")[0]
    assert section, name
    shared = {"-q", "--quiet"}  # which the page names once
    assert all(option in COMMAND_LINE.partition("\n## ")[0] for option in shared)
    for parameter in xlmc.commands[name].params:
        if isinstance(parameter, click.Option):
            for option in {*parameter.opts} - shared:
                assert f"`{option}`" in section, option


def script_of_docs(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / "docs" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return script


def test_every_distribution_is_documented():
    script = script_of_docs("list_distributions")
    page = script.page()
    written = (ROOT / "docs" / "distributions.md").read_text(encoding="utf-8")
    assert written == page, "write docs/distributions.md anew: python docs/list_distributions.py"
    assert script.EXAMPLES.keys() == FAMILIES.keys()
    for family in FAMILIES.values():
        assert f"\n## {family.name}\n" in page
        drawn = (script.PICTURES / script.picture_name(family)).read_text(encoding="utf-8")
        assert f"<title>{family.name}" in drawn
        if family.roles or family.data:
            assert family.formula, family.name
            assert family.source, family.name


def test_every_sampling_method_engine_result_sheet_and_distribution_is_described():
    lacking = undescribed()
    assert not lacking, "describe in docs/ what `python tests/session/described.py` prints:\n" + "\n".join(lacking)


def test_every_function_is_documented():
    script = script_of_docs("list_functions")
    written = (ROOT / "docs" / "functions.md").read_text(encoding="utf-8")
    assert written == script.page(), "write docs/functions.md anew: python docs/list_functions.py"
    assert len(script.names()) >= 350


def test_the_readme_has_a_line_for_each_command():
    block = re.search(r"^```sh\n(xlmc new.*?)^```", README, re.DOTALL | re.MULTILINE)
    assert block is not None
    result = [re.fullmatch(r"xlmc ([a-z]+)\b[^#]*? +# [^#]+", line) for line in block[1].splitlines()]
    assert all(result)
    assert {line[1] for line in result} == set(xlmc.commands) - {
        "report",
        "scenario",
        "help",
        "completion",
    }  # after a run, or about commands


def test_ci_runs_the_readmes_test_command():
    command = next(line for line in README.splitlines() if "pytest" in line and "venv" in line)
    assert command in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()


@pytest.fixture
def short_books(monkeypatch):
    """What takes longest to write, and is not looked at here."""
    keep_sheets(monkeypatch, *SHORT)
    keep_few_trials(monkeypatch)
    leave_out_fits(monkeypatch)


@pytest.mark.usefixtures("short_books")
def test_readme_python_runs(tmp_path, monkeypatch):
    block = re.search(r"```python\n(.*?)```", README, re.DOTALL)
    assert block is not None
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    exec(block[1], {})
    assert (tmp_path / "intersection-results.xlsx").exists()


@pytest.mark.usefixtures("short_books")
def test_readme_shows_the_output_of_its_command(tmp_path, monkeypatch, capsys):
    shown = README.partition("```text\n")[2].partition("```")[0]
    command = ["xlmc", "simulate", "examples/intersection.xlsx", "-o", str(tmp_path / "results.xlsx")]
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", command)
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    printed = capsys.readouterr().out
    table = [line.rstrip() for line in printed.splitlines() if "results.xlsx" not in line]
    assert [line.rstrip() for line in shown.splitlines() if "results.xlsx" not in line] == table


def test_the_version_stands_in_pyproject_alone():
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert stated == __version__
    named = [path for path in ROOT.glob("*.cff") if "\nversion:" in path.read_text(encoding="utf-8")]
    named += [
        path
        for path in (ROOT / "xlmc").rglob("*.py")
        if re.search(r"^__version__ = [\"']", path.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    assert not named


def test_links_between_documents_lead_somewhere():
    for page in (*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")):
        for target in re.findall(r"\]\((?!http)([^)#]+)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_every_public_name_is_in_the_reference():
    page = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"^\.\. auto(?:function|class):: (\w+)", page, re.MULTILINE))
    assert listed == set(package.__all__) - {"__version__"}


def test_the_gallery_shows_every_example():
    script = script_of_docs("gallery_of_books")
    examples = {path.relative_to(ROOT).as_posix() for path in BOOKS.values() if path.parent.name == "examples"}
    assert examples <= script.BOOKS.keys()
    assert len(script.BOOKS) >= 15
    assert all((ROOT / book).is_file() for book in script.BOOKS)
