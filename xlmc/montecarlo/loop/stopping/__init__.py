"""When a run ends: rules that look at its blocks in their order, and what is said of it afterwards.

No rule draws or evaluates anything: it is given what a block holds. As blocks come in the same order whoever runs them,
a rule that looks at nothing but blocks ends the run at the same trial for any number of threads.
"""

from xlmc.montecarlo.loop.stopping.progress import Progress, ProgressTracker
from xlmc.montecarlo.loop.stopping.rule import Observed, StopRule
from xlmc.montecarlo.loop.stopping.stopped import Stopped
from xlmc.montecarlo.loop.stopping.watch import (
    RULES,
    Interruption,
    Watch,
    chosen_rule,
    may_end_early,
    refuse_other_sampling,
)

__all__ = [
    "RULES",
    "Interruption",
    "Observed",
    "Progress",
    "ProgressTracker",
    "StopRule",
    "Stopped",
    "Watch",
    "chosen_rule",
    "may_end_early",
    "refuse_other_sampling",
]
