"""Which examples hypothesis tries: the same ones everywhere, or new ones with `--hypothesis-profile explore`.

Under the profile `fixed` a test's examples follow from the test's source and hypothesis's version alone: not from
chance, from failures of earlier runs, or from the constants of whichever modules happen to be imported. They are a
fifth of the number that the test sets, so that the whole suite is quick; `explore` tries ten times that number.
"""

from __future__ import annotations

import inspect
import os
from functools import cache
from types import SimpleNamespace

import pytest
from hypothesis import is_hypothesis_test, settings
from hypothesis.internal import entropy, reflection
from hypothesis.internal.conjecture import providers

FIXED, EXPLORE, SHARE, FACTOR = "fixed", "explore", 5, 10
VARIABLE = "HYPOTHESIS_PROFILE"
_USED = "_hypothesis_internal_use_settings"

settings.register_profile(FIXED, settings.get_profile("default"), deadline=None, derandomize=True, database=None)
settings.register_profile(EXPLORE, settings.get_profile("default"), deadline=None, print_blob=True)


def _without_constants_of_modules() -> None:
    none = providers.Constants()
    providers._get_local_constants = lambda: none


def _read_sources_once() -> None:
    """Read and tokenize a test's source once, not twice for each of its parameters: a sixth of the time of such tests.

    What a test's examples follow from stays the same.
    """
    reflection._clean_source = cache(reflection._clean_source)
    reflection.inspect = SimpleNamespace(**vars(inspect) | {"getsource": cache(inspect.getsource)})


def _leave_the_generator_of_numpy() -> None:
    """No generator of NumPy's is global here (ruff's NPY002): it is not seeded and put back for each example."""
    entropy.NP_RANDOM = entropy.NP_RANDOM or object()


@pytest.hookimpl(tryfirst=True)  # before hypothesis loads what its own options ask for
def pytest_configure(config: pytest.Config) -> None:
    name = config.getoption("--hypothesis-profile") or os.environ.get(VARIABLE) or FIXED
    if name not in (FIXED, EXPLORE):
        raise pytest.UsageError(f"there is no hypothesis profile {name!r}: choose {FIXED} or {EXPLORE}")
    settings.load_profile(name)
    _read_sources_once()
    _leave_the_generator_of_numpy()
    if name == FIXED:
        _without_constants_of_modules()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Under `fixed` every test has a fifth of its examples, under `explore` ten times as many."""
    explores = settings.get_current_profile_name().startswith(EXPLORE)
    tests = {id(item.obj): item.obj for item in items if isinstance(item, pytest.Function)}
    for test in filter(is_hypothesis_test, tests.values()):
        own = getattr(test, _USED)
        number = FACTOR * own.max_examples if explores else -(-own.max_examples // SHARE)
        setattr(test, _USED, settings(own, max_examples=number))
