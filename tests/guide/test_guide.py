"""The guide can be followed: its commands run in order, and print what it shows; its numbers are those of the runs."""

from __future__ import annotations

import importlib.util
import re
import shlex
import sys
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from fewer_sheets import SHORT, fill_sheets, keep_few_trials, leave_out
from simulated import simulated
from typed_cells import model_of

from templates.writer.cached import computed
from xlmc.cli import main
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "guide.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"(?:<!-- (.*?) -->\n)?```(sh|text)\n(.*?)```", GUIDE, re.DOTALL)
PROSE = " ".join(re.sub(r"```.*?```", "", GUIDE, flags=re.DOTALL).split())

EDITS = {
    "after exchanging the limits of alpha_1": ({("Inputs", "G8"): 191, ("Inputs", "H8"): 181}, "check"),
    "after typing 35 under Threshold": ({("Results wanted", "E8"): 35}, "simulate"),
}
"""A comment above a block of output -> cells that are changed first, and the command that then prints it."""

TRAPEZOID = {"F": "Trapezoid", "G": 0.60, "J": 0.70, "K": 0.85, "H": 0.95}
CHANGES = {
    "e_t at most 0.10": {("Results wanted", "D28"): 0.10},
    "e_t at most 0.50": {("Results wanted", "D28"): 0.50},
    "e_t at most 1": {("Results wanted", "D28"): 1},
    "both decelerations Trapezoid: 0.60, 0.70, 0.85, 0.95": {
        ("Inputs", f"{column}{row}"): value for row in (11, 17) for column, value in TRAPEZOID.items()
    },
    "decelerations correlated by 0.8: one road": {("Results wanted", "C49"): 0.8},
}

CHECKS = ("energy", "closing", "angles", "forward", "restitution", "friction", "run-out", "all")
"""The rows of the physics checks at the end of sheet Model."""

LIMITS = "Filter limits"
"""A sheet that has to be computed to know whether there is one."""

MADE = ("my-case", "my-case-results", "my-case-again")


def lines(text):
    return [line.rstrip() for line in text.splitlines() if line.strip()]


def assert_shown(shown, printed):
    """Every line shown was printed, in this order; `…` stands for lines that are left out, nothing else is."""
    rest, gap = lines(printed), False
    for line in lines(shown):
        if line == "…":
            gap = True
            continue
        if gap:
            rest = rest[next((at for at, text in enumerate(rest) if text == line), len(rest)) :]
        assert rest[:1] == [line]
        rest, gap = rest[1:], False
    assert gap or not rest


@pytest.fixture
def typed(monkeypatch, capsys, tmp_path):
    """`typed("xlmc check my-case.xlsx")`: everything printed, in a folder that starts empty."""
    monkeypatch.chdir(tmp_path)

    def run(line, code=0):
        monkeypatch.setattr(sys, "argv", shlex.split(line))
        with pytest.raises(SystemExit) as stopped:
            main()
        captured = capsys.readouterr()
        assert int(stopped.value.code or 0) == code, captured.err
        return captured.out + captured.err

    return run


@pytest.fixture
def short_books(monkeypatch):
    """All sheets, with few trials, and those empty of which no line of the guide shows anything."""
    keep_few_trials(monkeypatch)
    leave_out(monkeypatch, LIMITS)
    fill_sheets(monkeypatch, *SHORT)


@pytest.mark.usefixtures("short_books")
def test_the_guide_leads_from_an_empty_folder_to_the_result(typed, case, variant, tmp_path):
    printed = ""
    for after, kind, text in BLOCKS:
        if kind == "sh":
            printed = "".join(typed(line) for line in lines(text))
            if "planar-impact my-case.xlsx" in text:
                made = tmp_path / "my-case.xlsx"
                assert made.read_bytes() == (ROOT / "templates" / "planar-impact.xlsx").read_bytes()
                made.write_bytes(case.read_bytes())  # that template, with what the guide types into it
        elif after:
            cells, command = EDITS[after]
            shown = typed(f"xlmc {command} {variant(cells)}", code=2 if command == "check" else 0)
            assert all(line in lines(shown) for line in lines(text))
        else:
            assert_shown(text, printed)
    books = {name: openpyxl.load_workbook(tmp_path / f"{name}.xlsx", read_only=True) for name in MADE}
    first, again = (
        dict(row[1:3] for row in books[name]["Record"].iter_rows(max_row=6, values_only=True)) for name in MADE[1:]
    )
    assert first["SHA-256 of the accepted trials"] == again["SHA-256 of the accepted trials"]
    assert first["Command that repeats it"] in GUIDE
    own = books["my-case"].sheetnames
    added = books["my-case-results"].sheetnames[len(own) :]
    assert books["my-case-results"].sheetnames[: len(own)] == own
    assert [name for name in (*added, LIMITS) if f"**{name}**" not in GUIDE] == []
    for book in books.values():
        book.close()


def test_the_guide_tells_the_papers_ranges_and_filters(tables):
    spec = importlib.util.spec_from_file_location("build_examples", ROOT / "examples" / "build.py")
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    message = {symbol: (float(low), float(high)) for symbol, _, low, high, _ in tables["ranges"]}
    assert message == {symbol: (low, high) for symbol, (low, high, _) in build._TABLE_1.items()}
    assert sorted(because for *_, because in tables["filters"]) == sorted(build.INTERSECTION.because.values())
    assert [new for _, new in tables["names"]] == list(build.INTERSECTION.vehicles)


def test_following_the_guide_is_the_worked_example(run):
    example = simulated(load(ROOT / "examples" / "intersection.xlsx"))
    assert run.accepted == example.accepted
    for name, result in example.results.items():
        np.testing.assert_allclose(run[name].values, result.values, rtol=1e-12)


@pytest.mark.parametrize("change", ["nothing", *CHANGES])
def test_what_a_change_does(run, changed, change):
    result = simulated(model_of(changed(CHANGES[change]))) if change in CHANGES else run
    means = (result[name].mean.value for name in ("Nissan delta-V", "Nissan impact speed"))
    message = " | ".join([change, f"{result.accepted:,}", *(f"{mean:.2f}" for mean in means)])
    assert f"| {message} |" in GUIDE, message


def within(values, low, high):
    return (values >= low.value) & (values <= high.value)


def test_numbers_in_sentences(run):
    nissan, chevrolet = run["Nissan delta-V"], run["Chevrolet impact speed"]
    (low, high), (lowest, highest) = nissan.central(0.51), nissan.central(0.95)
    faster = chevrolet.probability_above(35).value
    inside = [within(result.values, *result.central(0.51)) for result in (nissan, chevrolet)]
    by_e_t, by_direction = int(run.tally.only[1]), int(run.tally.only[2])
    few = simulated(run.model, trials=2000, seed=999)
    slow = few["Nissan impact speed"].mean
    simpler = simulated(load(ROOT / "examples" / "intersection-momentum.xlsx"))
    base = run.model.workbook.sheets["Results wanted"].cells[28, 2].value
    beta = run.frame()["Chevrolet departure angle"].mean()
    message = [
        f"between {low.value:.1f} and {high.value:.1f} mph",
        f"between {lowest.value:.1f} and {highest.value:.1f} mph",
        f"faster than 35 mph is {faster:.0%}".replace("%", " %"),
        f"{faster:.0%} of the possible".replace("%", " %"),
        f"{nissan.mean.value:.3f} ± {nissan.mean.error:.3f} mph",
        f"speed is {np.corrcoef(nissan.values, chevrolet.values)[0, 1]:.2f}",
        f"only {np.logical_and(*inside).mean():.0%} of the trials lie in the ranges of both".replace("%", " %"),
        f"The {run.accepted:,} accepted trials are",
        f"only {run.accepted / run.trials:.1%} were accepted".replace("%", " %"),
        f"they alone reject {by_e_t:,} trials, and the Nissan's direction alone rejects {by_direction}",
        f"accepts {few.accepted} trials",
        f"reads {slow.value:.2f} ± {slow.error:.2f} mph",
        f"Nissan delta-V {simpler['Nissan delta-V'].mean.value:.2f}",
        f"impact speed {simpler['Nissan impact speed'].mean.value:.2f} mph",
        f"e_t is {base:.2f}",
        f"those near {beta:.1f}°",
    ]
    assert [each.name for each in run.model.filters][1:3] == ["Restitution, tangential", "Nissan impact speed"]
    missing = [phrase for phrase in message if phrase not in PROSE]
    assert not missing


def test_a_wrong_angle_turns_checks_false(workbook, changed):
    """The values that the case shows were computed as the others are."""
    right, wrong = workbook.sheets, computed(changed({("Inputs", "D8"): 278}))
    assert right["Inputs"].cells[3, 1].value.startswith("All physics checks hold at the base case")
    assert "physics check fails" in wrong["Inputs", 2, 0]
    failing = {f"D{row + 1}" for (sheet, row, column), value in wrong.items() if sheet == "Model" and value is False}
    checks = {f"D{row}": check for row, check in enumerate(CHECKS, 129)}
    in_order = sorted(failing, key=lambda cell: int(cell[1:]))
    assert [checks[cell] for cell in in_order] == ["angles", "forward", "restitution", "all"]
    assert all(right["Model"].cells[int(cell[1:]), 4].value is True for cell in checks)


def test_an_accepted_trial_can_be_typed_into_the_workbook(run, changed):
    trial = run.frame().iloc[0]
    typed_in = {("Inputs", f"D{row}"): float(trial[name]) for row, name in enumerate(list(trial.index[:17]), 6)}
    values = computed(changed(typed_in))
    for forecast in run.model.forecasts:
        sheet, row, column = forecast.cell
        assert values[sheet, row - 1, column - 1] == pytest.approx(trial[forecast.name], rel=1e-12)


def test_the_check_of_near_parallel_approaches_says_what_the_guide_says(workbook):
    cells = workbook.sheets["Model"].cells.items()
    notes = [content.value for (_, column), content in cells if column == 8 and content.value]
    assert any("9 % at δ = 10° and 94 % at 1°" in note for note in notes)
    assert "9 % at δ = 10° and by 94 % at δ = 1°" in PROSE


def test_links_within_the_guide_lead_to_its_headings():
    headings = re.findall(r"^#+ (.+)$", GUIDE, re.MULTILINE)
    anchors = {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
    links = re.findall(r"\]\(#([^)]+)\)", GUIDE)
    assert len(links) >= 12
    assert set(links) <= anchors
