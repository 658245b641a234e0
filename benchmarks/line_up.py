"""Who takes part: every contestant's file, options and variants, and the books it can do."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import peers
from books import BOOKS, march_cells
from hand_written_march import SEARCHES

__all__ = ["Entry", "line_up"]

CASE, SKID = "case-study", "skid"
MARCHES = tuple(book for book in BOOKS if march_cells(book))
CHUNKS = {"numpy": (2_048, 4_096, 8_192, 16_384, 32_768), "numba": (2_048, 4_096, 8_192), "c": (1_024, 2_048, 4_096)}
"""Chunks that the hand-written ones are tried with: where compiled loops were never faster is left out."""


@dataclass(frozen=True)
class Entry:
    """A contestant.

    Attributes:
        name: as in tables.
        family: `xlmc`, `hand` or `peer`.
        module: its file in `contestants/`.
        python: the interpreter that runs it.
        books: those that it can do.
        variants: book -> options, of which the fastest is measured; `{}` alone for all others.
    """

    name: str
    family: str
    module: str
    python: Path = Path(sys.executable)
    books: Sequence[str] = tuple(BOOKS)
    variants: Mapping[str, Sequence[dict[str, Any]]] = field(default_factory=dict)


def line_up(library: Path | None, engines: Sequence[str], home: Path = peers.HOME) -> tuple[list[Entry], list[str]]:
    """Who can take part here, and in words who cannot.

    Args:
        library: hand.c, built; None where there is no compiler.
        engines: of xlmc.
        home: the peers' environment.
    """
    entries = [_xlmc(name) for name in engines]
    absent = []
    entries.append(_hand("hand/NumPy", "numpy", ("plain", "buffered")))
    entries += _of_the_skid(engines)
    if importlib.util.find_spec("numba"):
        entries += [_hand("hand/numba", "numba", ("polynomial",)), _hand("hand/numba, libm", "numba", ("libm",))]
    else:
        absent.append("hand/numba: numba is not installed (pip install 'xlmc[jit]')")
    if library:
        entries.append(_hand("hand/C", "c", ("",), library=str(library)))
    else:
        absent.append("hand/C: no C compiler was found (set CC)")
    entries.append(Entry("formulas", "peer", "formulas_model"))
    gone = peers.missing(home)
    for name, label in (("ironcalc", "IronCalc"), ("formualizer", "formualizer")):
        if name in gone:
            absent.append(f"{label}: not installed; --install puts it into {home}")
        else:
            entries.append(Entry(label, "peer", f"{name}_book", python=peers.python(home)))
    return entries, absent


def _xlmc(engine: str) -> Entry:
    """An engine of ours; `formulas` evaluates 16 trials at least, which takes minutes on the larger books."""
    books = (CASE, SKID) if engine == "formulas" else tuple(BOOKS)
    options: Sequence[dict[str, Any]] = [{"engine": engine}]
    return Entry(f"xlmc/{engine}", "xlmc", "xlmc_engine", books=books, variants=dict.fromkeys(books, options))


def _of_the_skid(engines: Sequence[str]) -> list[Entry]:
    """Where nothing is rejected, it counts what is kept, and what the formulas say."""
    kept = {"draws_kept": True}
    plain = [{"language": "numpy", "chunk": chunk} for chunk in CHUNKS["numpy"]]
    by_hand = {
        "hand/NumPy, other formulas": [variant | {"kernel": "identity"} for variant in plain],
        "hand/NumPy, draws kept": [variant | {"kernel": "formulas"} | kept for variant in plain],
    }
    entries = [Entry(name, "hand", "hand", books=(SKID,), variants={SKID: all_}) for name, all_ in by_hand.items()]
    for engine in (engine for engine in engines if engine != "formulas"):
        options = {SKID: [{"engine": engine} | kept]}
        entries.append(Entry(f"xlmc/{engine}, draws kept", "xlmc", "xlmc_engine", books=(SKID,), variants=options))
    return entries


def _hand(name: str, language: str, kernels: Sequence[str], **more: str) -> Entry:
    """A hand-written contestant; `kernels` are those of the case study."""
    plain = [{"language": language, "chunk": chunk, **more} for chunk in CHUNKS[language]]
    case = [variant | {"kernel": kernel} for kernel in kernels for variant in plain]
    if kernels == ("libm",):  # the skid sheet has no sine to be different in
        return Entry(name, "hand", "hand", books=(CASE,), variants={CASE: case})
    of_skid = "formulas" if language == "numpy" else kernels[-1]
    variants = {CASE: case, SKID: [variant | {"kernel": of_skid} for variant in plain]}
    if language in ("numpy", "c"):
        march = [variant | {"kernel": search} for search in SEARCHES for variant in plain]
        variants |= dict.fromkeys(MARCHES, march)
    if language == "numpy":
        variants |= {book: [variant | {"kernel": ""} for variant in plain] for book in ("powers", "wide")}
    return Entry(name, "hand", "hand", books=tuple(variants), variants=variants)
