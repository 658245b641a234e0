"""Data classes of `xlmc.data_classes` do what those of the standard library do."""

import copy
import dataclasses
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field
from inspect import signature
from typing import Any

import pytest

from xlmc import data_classes

KINDS = [
    {},
    {"frozen": True},
    {"slots": True},
    {"frozen": True, "slots": True},
    {"frozen": True, "slots": True, "eq": False},
    {"frozen": True, "slots": True, "repr": False},
    {"frozen": True, "order": True},
]


class Plain:
    """The class that both make a data class of."""

    a: float
    b: list[int] = field(default_factory=list, hash=False)
    c: str = "c"
    d: int = field(default=4, init=False)
    e: int = field(default=5, kw_only=True, repr=False)
    f: int = field(default=6, compare=False)
    g: dict[str, int] = field(default_factory=dict, init=False, compare=False)

    def __post_init__(self) -> None:
        """Change a field, as a frozen class can."""
        object.__setattr__(self, "f", self.f + 1)


def _made(by: Callable[..., Any], options: dict[str, bool], base: type = Plain) -> Any:
    own = {name: value for name, value in vars(base).items() if name not in ("__dict__", "__weakref__")}
    return by(**options)(type("Made", (), own))


def _both(options: dict[str, bool]) -> tuple[Any, Any]:
    return _made(data_classes.dataclass, options), _made(dataclasses.dataclass, options)


@pytest.mark.parametrize("options", KINDS, ids=str)
def test_instances_print_compare_and_hash_alike(options: dict[str, bool]) -> None:
    ours, theirs = _both(options)
    assert str(signature(ours)) == str(signature(theirs))
    assert ours.__match_args__ == theirs.__match_args__
    for arguments, named in [((1.0,), {}), ((2.0, [1], "z"), {"e": 7, "f": 8})]:
        one, other = ours(*arguments, **named), theirs(*arguments, **named)
        assert dataclasses.asdict(one) == dataclasses.asdict(other)
        if options.get("repr", True):
            assert repr(one) == repr(other)
        assert (one == ours(*arguments, **named)) is (other == theirs(*arguments, **named))
        assert (one == dataclasses.replace(one, a=9.0)) is (other == dataclasses.replace(other, a=9.0))
        assert one != other
        if options.get("frozen") and options.get("eq", True):
            assert hash(one) == hash(other)
        assert (ours.__hash__ is None) is (theirs.__hash__ is None)


@pytest.mark.parametrize("options", [each for each in KINDS if each.get("frozen")], ids=str)
def test_frozen_ones_refuse_changes(options: dict[str, bool]) -> None:
    one = _made(data_classes.dataclass, options)(1.0)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'a'"):
        one.a = 2.0
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'a'"):
        del one.a
    assert one.a == 1.0


def test_ordered_ones_are_ordered_by_their_fields() -> None:
    ours, theirs = _both({"frozen": True, "order": True})
    first, second = ((1.0, [1]), (1.0, [2]))
    for compare in ("__lt__", "__le__", "__gt__", "__ge__"):
        assert getattr(ours(*first), compare)(ours(*second)) is getattr(theirs(*first), compare)(theirs(*second))
    assert ours(*first).__lt__(1) is NotImplemented


def test_methods_of_the_class_stay() -> None:
    class Own:
        a: int

        def __eq__(self, other: object) -> bool:
            return True

        def __repr__(self) -> str:
            return "own"

    for made in (_made(by, {"frozen": True}, Own) for by in (data_classes.dataclass, dataclasses.dataclass)):
        assert made(1) == 2
        assert repr(made(1)) == "own"
        assert hash(made(1)) == hash((1,))


@data_classes.dataclass(frozen=True, slots=True)
class Base:
    """A record that others extend."""

    a: int


@data_classes.dataclass(frozen=True, slots=True)
class Derived(Base):
    """One with a field more; it may hold itself in a list."""

    b: list[object]


def test_records_inherit_copy_pickle_and_print_themselves_within() -> None:
    one = Derived(1, [2])
    assert copy.deepcopy(one) == pickle.loads(pickle.dumps(one)) == one != Base(1)
    one.b.append(one)
    assert repr(one) == "Derived(a=1, b=[2, ...])"
