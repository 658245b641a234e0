"""Names of assumptions as keywords of Python: `road_friction` for `Road friction`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["assumption_named", "keyword"]

_NO_LETTER: Final = re.compile(r"[\W_]+")


def keyword(name: str) -> str:
    """Return a name as a keyword: letters and digits, other signs as underscores.

    >>> keyword("Nissan delta-V, mph")
    'nissan_delta_v_mph'
    """
    return _NO_LETTER.sub("_", name.casefold()).strip("_")


def assumption_named(model: CompiledModel, name: str) -> str:
    """Return the name of an assumption as defined, from that name whatever its case, or from its keyword.

    Raises:
        SimulationError: there is none, or several have this keyword.
    """
    names = [a.name for a in model.assumptions]
    found = [each for each in names if name_key(each) == name_key(name)]
    found = found or [each for each in names if keyword(each) == keyword(name)]
    if len(found) == 1:
        return found[0]
    if found:
        message = f"{name!r} may be {' or '.join(map(repr, found))}"
        raise SimulationError(message, hint="Give a dict with the name itself: with_({name: …})")
    raise SimulationError(f"there is no assumption {name!r}", hint=did_you_mean(name, names))
