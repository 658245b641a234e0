"""Physics checks: cells that turn red where the base case contradicts physics."""

from __future__ import annotations

from templates.description import ALL_CHECKS, Equation, Role, Section

__all__ = ["check", "checks_section"]


def check(symbol: str, name: str, formula: str, reference: str, note: str) -> Equation:
    """A TRUE/FALSE cell; `note` says what FALSE means and where to look."""
    return Equation(symbol, "", name, "", formula, reference, note, Role.CHECK, "General")


def checks_section(number: int, *rows: Equation, called: str = "Physics checks") -> Section:
    """The checks under their heading, and the cell that says whether all of them hold."""
    every = check(ALL_CHECKS, "All checks hold", f"AND({','.join(row.symbol for row in rows)})", "", "")
    return Section(f"{number}  {called}, at the base case", (*rows, every))
