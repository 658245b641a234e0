"""Changes of a JSON document: one value, any deep, becomes another, goes, or gets another name."""

from __future__ import annotations

import copy
import random
from typing import Any

from fuzzing import hostile

__all__ = ["edited"]


def edited(rng: random.Random, document: object) -> str:
    """Change the document in one place; what was done, empty where it holds nothing."""
    places = list(_places(document))
    if not places:
        return ""
    holder, key, path = rng.choice(places)
    if rng.random() < 0.12 and isinstance(holder, dict):
        del holder[key]
        new: object = "gone"
    elif rng.random() < 0.05 and isinstance(holder, dict):
        new = hostile.text(rng)[:50]
        holder[new] = holder.pop(key)
    else:
        new = holder[key] = _value(rng, holder[key], places)
    return f"{path} -> {str(new)[:60]!r}"


def _places(document: object, path: str = "") -> Any:
    pairs: Any = ()
    if isinstance(document, dict):
        pairs = list(document.items())
    elif isinstance(document, list):
        pairs = list(enumerate(document))
    for key, value in pairs:
        yield document, key, f"{path}.{key}"
        yield from _places(value, f"{path}.{key}")


def _value(rng: random.Random, old: object, places: list[Any]) -> object:
    kind = rng.random()
    if kind < 0.3:
        return rng.choice([None, True, False, 0, -1, 1, "", "x", [], {}, [1], {"a": 1}, 1.5, -0.0, [[]], "1", [None]])
    if kind < 0.55:
        numbers = [
            float("nan"),
            float("inf"),
            1e308,
            2**31,
            2**63,
            2**64,
            10**30,
            -(10**30),
            1e-308,
            0.5,
            10**400,
            10**9,
            10**12,
        ]
        return rng.choice(numbers)
    if kind < 0.65 and isinstance(old, int | float) and not isinstance(old, bool) and not _is_vast(old):
        return rng.choice([old + 1, old - 1, -old, old * 1000, float(old), str(old), old / 3])
    if kind < 0.75 and isinstance(old, str):
        return rng.choice([old.upper(), old + "x", old * 100, "../" + old, old[:1], [old]])
    if kind < 0.85:
        holder, key, _ = rng.choice(places)
        return copy.deepcopy(holder.get(key)) if isinstance(holder, dict) else None  # itself would make a circle
    return hostile.text(rng)[:500].encode("utf-8", "replace").decode()


def _is_vast(number: float) -> bool:
    """Whether it is an integer that no float holds."""
    return isinstance(number, int) and abs(number) > 10**300
