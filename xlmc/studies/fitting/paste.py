"""A fitted distribution as a row of the table `xlmc_assumptions`."""

from __future__ import annotations

from xlmc.studies.fitting.fit import Fitted

__all__ = ["row_to_paste"]

_DIGITS = 6


def row_to_paste(fitted: Fitted, name: str, source: str) -> dict[str, str]:
    """Heading -> what stands under it; parameters to six digits, more than a fit ever determines."""
    parameters = {heading: f"{value:.{_DIGITS}g}" for heading, value in fitted.parameters.items()}
    return {"Name": name, "Distribution": fitted.name, **parameters, "Source": source}
