"""The words that a report uses, in the words of docs/glossary.md."""

from __future__ import annotations

from typing import Final

__all__ = ["GLOSSARY", "WORDS_OF_EVIDENCE", "WORDS_OF_SCENARIOS"]

GLOSSARY: Final = (
    (
        "Trial",
        "one possible {case}. One value is drawn for each uncertain input, and the workbook is calculated with them.",
    ),
    (
        "Assumption",
        "an uncertain input: a cell with a range and a distribution, from which each trial draws its value.",
    ),
    ("Forecast", "a cell whose values are wanted: the answer."),
    (
        "Filter",
        "a cell with limits that a possible {case} must meet{such_as}. A trial that is "
        "outside the limits of a filter is rejected.",
    ),
    ("Accepted", "a trial is accepted if it meets all filters. All answers are those of the accepted trials."),
    ("Check", "a cell that must be TRUE. It changes nothing in a run; it says where the workbook contradicts itself."),
    ("Base case", "the workbook as it is, each assumption at the value in its own cell."),
    (
        "Distribution",
        "how likely the values of an assumption are. Uniform: all values in the range are equally likely.",
    ),
    (
        "Standard error",
        "written ±: how far a printed number typically lies from the number that infinitely many trials would give. "
        "The two differ by less than twice ± in about 95 of 100 runs. ± does not say whether the model is right.",
    ),
    (
        "Standard deviation",
        "SD: how far the values of the accepted trials spread around their mean. More trials do not make it smaller; "
        "they make its ± smaller.",
    ),
    (
        "Percentile",
        "or quantile: the 75th percentile (75 % quantile) is the value that 75 % of the accepted trials do not exceed.",
    ),
    (
        "95 % interval",
        "two ends, calculated so that the true number lies between them in 95 of 100 runs.",
    ),
    (
        "Correlation",
        "here always Spearman's rank correlation of two quantities: 1 where one always rises with the other, −1 where "
        "it always falls, 0 where it does neither.",
    ),
    (
        "Threshold",
        "a limit that matters, such as a legal one; the results say how probable it is that a forecast exceeds it.",
    ),
    (
        "Seed",
        "the number that the random draws start from. The same workbook with the same seed gives the same numbers.",
    ),
    ("SHA-256", "a fingerprint of a file or of some of its parts. If one byte changes, so does the fingerprint."),
)
"""Word -> what it means."""

WORDS_OF_EVIDENCE: Final = (
    (
        "Evidence",
        "a measured number and its error, about a quantity that the model computes. Either only trials that agree "
        "with it are kept, or each trial counts with the chance that it agrees (weights).",
    ),
    (
        "Effective trials",
        "the number of trials of equal weight that would say as much as the weighted ones. Errors and intervals "
        "follow from it.",
    ),
)
WORDS_OF_SCENARIOS: Final = (
    (
        "Scenario",
        "the workbook with other contents in some of its cells, run with the same random numbers as the workbook as "
        "it is.",
    ),
)
"""Words of reports that have these sections."""
