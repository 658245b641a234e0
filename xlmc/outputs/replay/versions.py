"""What a newer xlmc computes differently from the one that made a run, and how to install the older one."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.loop.version import __version__

if TYPE_CHECKING:
    from xlmc.analysis.results.record import Record

__all__ = ["RULES", "Rule", "install", "recorded_version", "rules_since"]


@dataclass(frozen=True, slots=True)
class Rule:
    """One way in which results changed.

    Attributes:
        since: the first version that computes so.
        sentence: what it does now, in words.
        met: the pattern of a formula, or of another content of a cell, that it may concern.
        beside: a pattern that another cell must match, too; None if one is enough.
    """

    since: str
    sentence: str
    met: re.Pattern[str]
    beside: re.Pattern[str] | None = None


def _calls(*names: str) -> re.Pattern[str]:
    """Make a pattern for calls of these functions, with or without the marks of a newer Excel's functions in files."""
    return re.compile(rf"(?<![\w.])(?:_xl\w+\.)*(?:{'|'.join(map(re.escape, names))})\(", re.IGNORECASE)


_COMPARED: Final = re.compile(r"=.*[<>=]")
_LAST_SUM: Final = re.compile(r"=.*[+-]")
_CHOICES: Final = ("IF", "IFS", "SWITCH", "CHOOSE", "IFERROR", "IFNA")
_BESIDE: Final = ("INDEX", "IRR", "MODE", "CORREL", "LINEST", "TREND", "PROB", "LOOKUP", "XLOOKUP", "SUMPRODUCT")
_TOOLPAK: Final = re.compile(
    r"(?<![\w.])(?:EDATE|EOMONTH|WEEKNUM|YEARFRAC|(?:NET)?WORKDAYS?(?:\.INTL)?|ISODD|ISEVEN|MROUND|QUOTIENT|SQRTPI"
    r"|FACTDOUBLE|CONVERT|DELTA|GESTEP|ERFC?|EFFECT|NOMINAL|DOLLAR(?:DE|FR)|CUM(?:IPMT|PRINC)|XNPV|XIRR|FVSCHEDULE"
    r"|SERIESSUM|(?:PRICE|YIELD)(?:DISC|MAT)?|DISC|INTRATE|RECEIVED|M?DURATION|ACCRINTM?|COMPLEX|BESSEL[IJKY]"
    r"|(?:BIN|DEC|HEX|OCT)2[A-Z]+|IM[A-Z0-9]+|COUP[A-Z]+|TBILL[A-Z]+|ODD[FL][A-Z]+|AMOR[A-Z]+)\(",
    re.IGNORECASE,
)
_WHOLE: Final = re.compile(r"=.*\$?[A-Z]{1,3}:\$?[A-Z]{1,3}\b|=.*\$?\d+:\$?\d+\b")

_FEW_VALUES: Final = re.compile(
    r"(?<!\w)(?:CB\.|Risk)?(?:Yes-?No|Bernoulli|(?:Neg(?:ative)? ?)?Bin(?:om(?:ial)?)?|Poisson|Geomet(?:ric)?"
    r"|Hyper-?geo(?:metric)?|Hypergeo|(?:Discrete|Int|D) ?Uniform|Discrete|Custom|Empirical|Resampled|Resample)(?!\w)",
    re.IGNORECASE,
)
_DRAWN: Final = re.compile(r"(?<![\w.])(?:RAND|RANDBETWEEN|RANDARRAY|Risk\w+|CB\.\w+)\(", re.IGNORECASE)
_CORRELATED: Final = re.compile(r"correlation|RiskCorrmat|Risk(?:In)?DepC|CB\.Correl", re.IGNORECASE)

_TINY: Final = re.compile(r"\dE-[123]\d\d\b|\^-|(?<![\w.])(?:EXP|POWER)\(", re.IGNORECASE)
_SMALL_LETTERS: Final = re.compile(r"=.*(?<![\w.])[A-Z]\w*[a-z]\w*\(")
"""Calls by a name that is none of Excel's: those are in capitals in a file."""
_REFUSED: Final = (
    *("BAHTTEXT", "REGEXTEST", "REGEXEXTRACT", "REGEXREPLACE", "GROUPBY", "PIVOTBY", "TRIMRANGE"),
    *("FORECAST.ETS", "FORECAST.ETS.CONFINT", "FORECAST.ETS.SEASONALITY", "FORECAST.ETS.STAT"),
)

_SHOWN: Final = re.compile(r"(?<![\w.])(?:_xl\w+\.|\[\d+\]!)*(?:Risk|CB\.)\w+\(", re.IGNORECASE)

_TEXTS: Final = re.compile(r'=.*(?:"|&|(?<![\w.])(?:TEXT|CONCAT|LOOKUP|VLOOKUP|XLOOKUP|INDEX|CHOOSE|LEFT|RIGHT|MID)\()')
"""Formulas that may give a text."""

_DATE: Final = re.compile(r'=.*"[^"]*\d[^"]*[-/.: ][^"]*\d[^"]*"')
_CRITERIA: Final = ("COUNTIF", "COUNTIFS", "SUMIF", "SUMIFS", "AVERAGEIF", "AVERAGEIFS", "MAXIFS", "MINIFS")
_DATABASE: Final = (
    *("DSUM", "DPRODUCT", "DAVERAGE", "DMIN", "DMAX", "DVAR", "DVARP", "DSTDEV", "DSTDEVP", "DGET"),
    *("DCOUNT", "DCOUNTA"),
)
_AT_THE_ENDS: Final = (
    *("BETA.INV", "BETAINV", "BINOM.INV", "CRITBINOM", "NEGBINOM.DIST", "NEGBINOMDIST", "SERIESSUM"),
    *("PMT", "PV", "FV", "IPMT", "PPMT"),
)
_ARRAYS: Final = _calls("ANCHORARRAY", "FILTER", "UNIQUE", "SORT", "SORTBY", "SEQUENCE", "OFFSET", "INDIRECT", "CELL")
_ANY: Final = re.compile("=")

RULES: Final = (
    *(
        Rule("0.2.0", sentence, met)
        for sentence, met in (
            ("= <> < <= > >= between numbers compare 15 significant digits, as in Excel", _COMPARED),
            ("the + or - that a formula ends with gives 0 where it cancels but for the last bits", _LAST_SUM),
            (
                "ranges within INDEX, IRR, MODE, LINEST and kin are computed cell by cell in plain formulas",
                _calls(*_BESIDE),
            ),
            (
                "a choice that varies between ranges of different sizes gives the one it chooses, whole",
                _calls(*_CHOICES),
            ),
            ("SUBTOTAL 1 to 11 leaves out the rows that a filter hides", _calls("SUBTOTAL")),
            (
                'the criterion "<>23" counts the text "23"',
                _calls("COUNTIF", "COUNTIFS", "SUMIF", "SUMIFS", "AVERAGEIF"),
            ),
            ("whole columns and rows keep their size, empty cells included", _WHOLE),
            (
                "an array within a cell of an array is #CALC!; arrays side by side are filled up with #N/A",
                _calls("LAMBDA"),
            ),
            ("EDATE, WEEKNUM, ISODD and kin give #VALUE! for a range of several cells", _TOOLPAK),
            ("TRUNC rounds, exactly, the 15 digits that Excel shows", _calls("TRUNC")),
            ("LCM leaves out empty cells", _calls("LCM")),
            ("BITLSHIFT and BITRSHIFT give #NUM! above 48 bits", _calls("BITLSHIFT", "BITRSHIFT")),
            ("MIRR gives -1 where nothing is received, and #DIV/0! at -100 %", _calls("MIRR")),
            ("CONVERT keeps the digits of small absolute temperatures", _calls("CONVERT")),
            ("YEARFRAC counts 1900 as a leap year, as Excel's calendar does", _calls("YEARFRAC")),
            ("CUMIPMT and CUMPRINC truncate the type of payment", _calls("CUMIPMT", "CUMPRINC")),
            ("FORMULATEXT shows the formula of its own cell, as Excel does", _calls("FORMULATEXT")),
            ("PERCENTOF and ASC give what Excel gives", _calls("PERCENTOF", "ASC")),
            ("functions that xlmc has no body for, such as FORECAST.ETS and REGEXTEST, are refused", _calls(*_REFUSED)),
            ("OFFSET that leads to several ranges at once is refused", _calls("OFFSET")),
            ("ISREF of a choice that varies between cells is refused", _calls("ISREF")),
            ("CB.GetCertaintyFN gives percent", _calls("CB.GetCertaintyFN")),
            (
                "RiskMean and kin of another simulation than the first are not available",
                _calls("RiskMean", "RiskPercentile"),
            ),
        )
    ),
    Rule("0.3.0", "numbers below 2.2250738585072014E-308 in size are 0", _TINY),
    Rule("0.3.0", "a LAMBDA that is named like a function of Excel is not called by that name", _SMALL_LETTERS),
    Rule("0.3.0", "INDEX of several errors gives the first", _calls("INDEX")),
    Rule("0.3.0", "intervals of means and standard deviations allow for the skewness of the forecast", _ANY),
    Rule("0.3.0", "a search for rare trials looks into every branch, solves thin layers, and draws other trials", _ANY),
    Rule(
        "0.3.0",
        "assumptions that take few values have the rank correlation asked for, ties counted, or the most they can have",
        _FEW_VALUES,
        _CORRELATED,
    ),
    Rule(
        "0.4.0",
        "SUBTOTAL and AGGREGATE leave out the same of each of several ranges",
        _calls("SUBTOTAL", "AGGREGATE"),
    ),
    Rule("0.4.0", "IFERROR and IFNA see the errors of arrays whose size is drawn", _calls("IFERROR", "IFNA")),
    Rule("0.4.0", "A1# shows 0 for the empty cells of a range whose size is drawn", _calls("ANCHORARRAY")),
    Rule("0.5.1", "INDEX of several rows and columns with one number gives #REF!", _calls("INDEX")),
    Rule("0.5.1", "BETA.INV takes the probability 1, and gives the upper end", _calls("BETA.INV", "BETAINV")),
    Rule(
        "0.6.0",
        "the engine jit computes EXP, LN, LOG10, LOG and powers itself, to one unit in the last bit",
        re.compile(r"\^|(?<![\w.])(?:EXP|LN|LOG|LOG10|POWER)\(", re.IGNORECASE),
    ),
    Rule("0.6.0", "the error of the standard error of a mean may differ in its last bit", _ANY),
    Rule(
        "0.8.0",
        "running totals give the error of a later cell where the first cells overflow",
        _calls("SUM", "PRODUCT", "AVERAGE"),
    ),
    Rule("0.9.0", "the engine jit leaves workbooks to numpy where native loops do not pay: last bits may differ", _ANY),
    Rule(
        "0.9.0",
        "the engine jit sees the errors that logical values of ranges are in some trials",
        _calls("SUM", "AVERAGE", "MIN", "MAX", "SUMPRODUCT", "COUNT"),
    ),
    Rule("0.9.0", "parameters whose formulas another program could not compute are calculated", _ANY),
    Rule("0.10.0", "all cells of a dynamic array vary, also as A1#, OFFSET, INDIRECT and CELL see them", _ARRAYS),
    Rule("0.10.0", "formulas that name cells which a dynamic array may fill, beyond those saved, are refused", _ARRAYS),
    Rule("0.10.0", "errors of percentiles that many trials share are smaller with Latin hypercube and Sobol", _ANY),
    Rule(
        "0.10.0",
        "the engine jit rounds in its loops: the last bits of what stands beside it may differ",
        _calls("INT", "ROUND", "ROUNDUP", "ROUNDDOWN", "TRUNC", "MROUND", "QUOTIENT", "MOD", "ISEVEN", "ISODD"),
    ),
    Rule("0.11.0", "a name of the whole workbook that names another means that of the whole workbook", _ANY),
    Rule("0.11.0", "a text that is a date is read by the calendar from 1904 where the workbook has it", _DATE),
    Rule(
        "0.11.0",
        "INDIRECT in the style R1C1 reads ranges, whole rows and columns, names and tables",
        _calls("INDIRECT"),
    ),
    Rule(
        "0.11.0",
        "ranges that a choice or a lookup leads to by a condition that varies keep their empty cells and texts",
        _calls(*_CHOICES, "INDEX", "XLOOKUP"),
    ),
    Rule(
        "0.11.0", "thresholds and settings that formulas give are calculated where their saved values may be old", _ANY
    ),
    Rule("0.12.0", "a run until accepted trials may search for them from 8,388,608 plain trials on", _ANY),
    Rule(
        "0.12.0", "ranges are rounded outwards until they are more probable than not; a yes/no has a probability", _ANY
    ),
    Rule("0.12.0", "cells that read a broken link to another workbook are #REF!", re.compile(r"\[\d+\]")),
    Rule("0.12.0", "what stands beside formulas that nothing calculated is no saved value", _ANY),
    Rule("0.12.0", "shares of variance are found in finer classes where a forecast jumps or bends", _ANY),
    Rule("0.12.0", "of more than 20 assumptions, those are measured that matter most for each forecast", _ANY),
    Rule("0.12.0", "yes/no answers have the interval of their share", _ANY),
    Rule("0.12.0", "without filters the share of accepted trials is exact", _ANY),
    Rule("0.12.0", "yes/no answers, and differences of them, have the interval of their share", _ANY),
    Rule("0.12.0", "parameters without scatter, such as a standard deviation of 0, draw their one value", _ANY),
    Rule(
        "0.12.0", "the mode of whole numbers has whole ends of its interval, and no error where these are equal", _ANY
    ),
    Rule("0.12.0", "SUBTOTAL leaves out every hidden row of a sheet with an active filter", _calls("SUBTOTAL")),
    Rule(
        "0.12.0",
        "criteria compare numbers at 15 digits",
        _calls(*_CRITERIA, *_DATABASE),
    ),
    Rule("0.12.0", "MATCH with -1 ends at the first equal or smaller cell", _calls("MATCH")),
    Rule("0.12.0", "INDEX of several areas with an empty last argument is #VALUE!", _calls("INDEX")),
    Rule("0.12.0", "LOOKUP searches the first of several columns", _calls("LOOKUP")),
    Rule(
        "0.12.0",
        "AVERAGEA and its like count no logicals in arrays",
        _calls("AVERAGEA", "MAXA", "MINA", "VARA", "VARPA", "STDEVA", "STDEVPA"),
    ),
    Rule(
        "0.12.0",
        "probabilities of 0 or 1, rates of -100 % and below, and 0^0 in a series give Excel's errors",
        _calls(*_AT_THE_ENDS),
    ),
    Rule("0.12.0", "database functions compare headings as texts", _calls(*_DATABASE)),
    Rule("0.12.0", "a ~ in a pattern takes any next character as it is", re.compile("~")),
    Rule("0.12.0", "SWITCH takes no empty cell for a logical", _calls("SWITCH")),
    Rule("0.12.0", "TEXTBEFORE and TEXTAFTER round the number of a delimiter down", _calls("TEXTBEFORE", "TEXTAFTER")),
    Rule("0.12.0", "OFFSET of less than one row or column leads where Excel's does", _calls("OFFSET")),
    Rule("0.12.0", "INDIRECT reads rows with zeros before them", _calls("INDIRECT")),
    Rule(
        "0.12.0",
        "percentiles in cells of values that repeat are among the values",
        _calls("RiskPercentile", "RiskPercentileD", "RiskPtoX", "RiskPtoXD", "RiskQtoX", "CB.GetForePercentFN"),
    ),
    Rule("0.12.0", "trials that do not use a draw without a distribution count", _calls(*_CHOICES)),
    Rule("0.12.0", "GETPIVOTDATA is read from the pivot table", _calls("GETPIVOTDATA")),
    Rule("0.12.0", "texts of dates with spaces around them are no numbers", _ANY),
    Rule("0.12.0", "cells that draw or mark an answer below RiskTheo… or a result show their base case", _SHOWN),
    Rule("0.12.0", "numbers and base cases of truncated discrete draws are sums over their values", _FEW_VALUES),
    Rule("0.12.0", "the sheet XLRisk says trials, seed, sampling, and what RiskLognorm means", _SHOWN),
    Rule("0.12.0", "results that are asked by other cells are computed from what these cells show of the run", _SHOWN),
    Rule("0.12.0", "results of an input by its name, and of further simulations, are shown", _SHOWN),
    Rule(
        "0.12.0", "a column Use of xlmc_filters says whether a row is used", re.compile(r"^\W*use\W*$", re.IGNORECASE)
    ),
    Rule("0.12.0", "a forecast whose answers are texts counts them, where its trials were lost", _TEXTS),
    Rule("0.12.0", "a number known before the run is no yes/no answer; of one its share alone is told", _ANY),
    Rule("0.12.0", "pairs of forecasts count a yes/no answer as above its limit where it is a yes", _ANY),
    Rule("0.12.0", "comparisons judge yes/no answers and texts by their shares alone", _ANY),
    Rule("0.12.0", "data tables over a draw keep the values that Excel calculated", _SHOWN),
    Rule("0.12.0", "draws in cells are called by the label beside them", _DRAWN),
    Rule("0.12.0", "percentages and money of assumptions are written as their cells show them", _ANY),
    Rule("0.12.0", "TRUE and FALSE that no assumption reaches are yes and no, exactly", _ANY),
    Rule("0.12.0", "inverse functions of RAND() take every value of a range in array formulas", _calls("RAND")),
    Rule("0.12.0", "data tables that hold other values than their formulas give are computed", _ANY),
    Rule("0.12.0", "adjustment weights of matrices of rank correlations are honoured", _calls("RiskCorrmat")),
    Rule("0.12.0", "an answer made of tests, 1 and 0 is a yes/no answer where it never varies, too", _COMPARED),
    Rule(
        "0.12.0", "INDEX of several areas takes an empty last argument for 0 wherever its row varies", _calls("INDEX")
    ),
    Rule("0.12.0", "of more than 100 assumptions, fewer draws before filtering are summarised", _ANY),
    Rule(
        "0.12.0",
        "large arrays of constants in a sum of products are added up before the run, to other last bits",
        _calls("SUM", "SUMPRODUCT"),
    ),
)
"""The rules in the order of versions."""


def recorded_version(record: Record) -> str:
    """Return the xlmc that made a run; of records that do not name it, nothing."""
    try:
        return str(record["software.xlmc"])
    except KeyError:
        return ""


def rules_since(version: str, contents: Iterable[str]) -> tuple[Rule, ...]:
    """Return the rules that changed after a version and that may concern a workbook.

    Args:
        version: the one that made a run, such as `0.1.0`.
        contents: of the cells that the run needed.
    """
    texts = tuple(contents)
    return tuple(
        rule
        for rule in RULES
        if _parts(version) < _parts(rule.since) <= _parts(__version__)
        and all(any(one.search(text) for text in texts) for one in (rule.met, rule.beside) if one is not None)
    )


def install(version: str) -> str:
    """Say what to type, in a clone of xlmc's repository, to have a version beside this one."""
    folder = f"../xlmc-{version}"
    return (
        f"git worktree add {folder} v{version} && python3 -m venv {folder}/.venv && "
        f"{folder}/.venv/bin/pip install {folder}"
    )


def _parts(version: str) -> tuple[int, ...]:
    """Read a version as numbers that can be compared; what is no number ends it."""
    return tuple(int(part) for part in re.match(r"\d*(?:\.\d+)*", version)[0].split(".") if part)  # type: ignore[index]
