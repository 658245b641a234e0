"""What every run of the tests has, of whichever folder: see `tests/session`."""

from __future__ import annotations

import os

pytest_plugins = ("example_profiles", "not_tested", *(["tree_guard"] if os.environ.get("CI") else []))

# The workers of pytest-xdist and the programs that tests start share the processors, and keep no native code.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(name, "1")
os.environ["XLMC_KEEP_CODE"] = "0"
