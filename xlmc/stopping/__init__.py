"""When a run ends: rules that look at its blocks in their order, one a file, and what is said of it afterwards.

No rule draws or evaluates anything: it is given what a block holds. As blocks come in the same order whoever runs them,
a rule that looks at nothing but blocks ends the run at the same trial for any number of threads.
"""

from xlmc.stopping.choose import chosen_rule, may_end_early, refuse_other_sampling
from xlmc.stopping.interruption import Interruption
from xlmc.stopping.rule import Observed, Rule
from xlmc.stopping.standing import Standing, Teller
from xlmc.stopping.stopped import Stopped
from xlmc.stopping.watch import Watch

__all__ = [
    "Interruption",
    "Observed",
    "Rule",
    "Standing",
    "Stopped",
    "Teller",
    "Watch",
    "chosen_rule",
    "may_end_early",
    "refuse_other_sampling",
]
