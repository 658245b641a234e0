"""A study of where a workbook loses digits or becomes huge within the ranges of its assumptions, and by how much.

Three things are kept apart. What a cell *amplifies* comes from its derivatives: it is in the problem, and no other form
of the formula cures it. What *rounding* does comes from evaluations with random rounding, and from trials computed
again with 50 digits. What is *wrong in form* (a lost quadrant, a jump) is read off the formulas.
"""

from xlmc.analysis.studies.stability.digit_findings import CellDigits, Finding, Level, Stability, Where
from xlmc.analysis.studies.stability.find import stability

__all__ = ["CellDigits", "Finding", "Level", "Stability", "Where", "stability"]
