from __future__ import annotations

import sys
from subprocess import run

import pytest

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.montecarlo.distributions import FAMILIES, family_named
from xlmc.montecarlo.distributions.spelling import plain


@pytest.mark.parametrize(
    ("typed", "name"),
    [
        ("Uniform", "Uniform"),
        (" uniform ", "Uniform"),
        ("NORMAL", "Normal"),
        ("gaussian", "Normal"),
        ("Triangular", "Triangular"),
        ("triangle", "Triangular"),
        ("Triang", "Triangular"),
        ("Trapezoid", "Trapezoid"),
        ("trapezoidal", "Trapezoid"),
        ("Beta PERT", "BetaPERT"),
        ("pert", "BetaPERT"),
        ("Beta General", "Beta"),
        ("Expon", "Exponential"),
        ("Log-normal", "Lognormal"),
        ("lognorm", "Lognormal"),
        ("LogNorm2", "Lognorm2"),
        ("max extreme", "Maximum Extreme"),
        ("Extvalue", "Maximum Extreme"),
        ("Minimum Extreme", "Minimum Extreme"),
        ("Student's t", "Student's t"),
        ("Student’s T", "Student's t"),
        ("student", "Student's t"),
        ("Histogram", "Histogrm"),
        ("IntUniform", "Discrete Uniform"),
        ("negative binomial", "Negative Binomial"),
        ("negbin", "Negbin"),
        ("Geomet", "Geomet"),
        ("YesNo", "Yes-No"),
        ("Bernoulli", "Yes-No"),
        ("custom", "Custom"),
        ("Discrete", "Discrete"),
        ("DUniform", "DUniform"),
        ("EMPIRICAL SMOOTHED", "Empirical smoothed"),
        ("kde", "Empirical smoothed"),
    ],
)
def test_names_people_type(typed, name):
    assert family_named(typed) is FAMILIES[name]


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        ("Unifrom", "Did you mean Uniform?"),
        ("Trapezium", "Did you mean Trapezoid?"),
        ("Wiebull", "Did you mean Weibull?"),
    ],
)
def test_unknown_name(typed, hint):
    with pytest.raises(DefinitionError) as caught:
        family_named(typed, where=Cell("Inputs", 4, 3))
    assert caught.value.message == f"'{typed}' is not a distribution of this version"
    assert caught.value.where == "Inputs!C4"
    assert caught.value.hint.startswith(hint)


def test_no_name_means_two_distributions():
    spellings = [plain(name) for family in FAMILIES.values() for name in (family.name, *family.aliases)]
    assert len(set(spellings)) == len(spellings)


def test_a_name_like_no_other_lists_them_all():
    with pytest.raises(DefinitionError) as caught:
        family_named("Zipf")
    assert caught.value.hint == f"Use one of {', '.join(FAMILIES)}"


def test_keys_and_headings_are_consistent_across_families():
    meaning = {}
    for family in FAMILIES.values():
        for spec in family.parameters:
            for heading in spec.headings:
                if (family.name, heading) != ("Poisson", "Mean"):  # its rate is its mean
                    assert meaning.setdefault(plain(heading), spec.key) == spec.key
    assert meaning["min"] == "low"
    assert meaning["standarddeviation"] == "std_dev"


def test_scipy_is_imported_only_when_needed():
    code = (
        "import sys, xlmc.montecarlo.statistics; from xlmc.montecarlo.distributions import FAMILIES as F;"
        " F['Uniform'].ppf(.5, 0, 1);"
        "assert not any(m.startswith('scipy') for m in sys.modules);"
        "F['Normal'].ppf(.5, 0, 1); assert 'scipy.special' in sys.modules and 'scipy.stats' not in sys.modules"
    )
    assert run([sys.executable, "-c", code], check=False, capture_output=True, text=True).stderr == ""
