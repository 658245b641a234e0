"""When a run ends: rules that look at its blocks in their order, one a file, and what is said of it afterwards.

No rule draws or evaluates anything: it is given what a block holds. As blocks come in the same order whoever runs them,
a rule that looks at nothing but blocks ends the run at the same trial for any number of threads.
"""

from xlmc.run.stopping.choose import RULES, chosen_rule, may_end_early, refuse_other_sampling
from xlmc.run.stopping.interruption import Interruption
from xlmc.run.stopping.rule import Observed, Rule
from xlmc.run.stopping.standing import Standing, Teller
from xlmc.run.stopping.stopped import Stopped
from xlmc.run.stopping.watch import Watch

__all__ = [
    "RULES",
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
