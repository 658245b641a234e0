"""`@cases("given, expected", [(1, 2), …])`: one test that tries every case and names each that fails.

It stands where `pytest.mark.parametrize` could, for cases that take milliseconds: a test of its own costs some more.
All cases share the fixtures of the one test. `pytest --apart` makes each case a test of its own, to run one by name.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Sequence

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--apart", action="store_true", help="make each case of `@cases` a test of its own")


def pytest_configure(config: pytest.Config) -> None:
    cases.apart = config.getoption("--apart")


def cases(names: str | Sequence[str], values: Iterable[object], ids: Sequence[str] | None = None) -> Callable:
    """As `pytest.mark.parametrize`, in one test; one above the other, they try each case with each.

    Raises:
        ValueError: there is no case, or one has another number of values than there are names.
        TypeError: when run: a case asks to be skipped, which would leave the others untried.
    """
    if cases.apart:
        return pytest.mark.parametrize(names, values, ids=ids)
    keys = [name.strip() for name in names.split(",") if name.strip()] if isinstance(names, str) else list(names)
    one = len(keys) == 1 and not (isinstance(names, str) and "," in names)
    given = [value.values if hasattr(value, "marks") else (value,) if one else tuple(value) for value in values]
    if not given or any(len(case) != len(keys) for case in given):
        raise ValueError(f"each case needs values for {', '.join(keys)}")

    def with_cases(test: Callable) -> Callable:
        @functools.wraps(test)
        def of_every_case(**fixtures: object) -> None:
            failed = []
            for number, case in enumerate(given):
                arguments = dict(zip(keys, case, strict=True))
                try:
                    test(**fixtures, **arguments)
                except pytest.skip.Exception as skipped:
                    raise TypeError("a case cannot be skipped: leave it out of the cases") from skipped
                except (Exception, pytest.fail.Exception) as failure:
                    shown = ", ".join(f"{name}={value!r:.200}" for name, value in arguments.items())
                    failure.add_note(f"case {ids[number] if ids else number}: {shown}")
                    failed.append(failure)
            if len(failed) == 1:
                raise failed[0]
            if failed:
                raise BaseExceptionGroup(f"{len(failed)} of {len(given)} cases", failed)

        signature = inspect.signature(test)
        kept = [parameter for name, parameter in signature.parameters.items() if name not in keys]
        of_every_case.__signature__ = signature.replace(parameters=kept)
        return of_every_case

    return with_cases


cases.apart = False
