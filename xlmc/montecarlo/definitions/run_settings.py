"""What a run may be asked for: a row for each setting.

How to add a setting: give `Settings` and `RunOptions` its field, and write its row into `SETTINGS`. The command line,
`xlmc_settings`, the record, saved runs, `xlmc replay` and the command that repeats a run read all that they need here;
`RunArguments` names it for type checkers. Describe the option in docs/command-line.md and the setting in
docs/workbooks.md. What ends a run is a goal: see `stopping`.
"""

from __future__ import annotations

from dataclasses import dataclass
from operator import attrgetter
from typing import Any, Final, Literal

from xlmc.engine.engines import ENGINES
from xlmc.montecarlo.definitions.evidence_methods import EVIDENCE_METHODS
from xlmc.montecarlo.definitions.number_styles import STYLES, style_key
from xlmc.montecarlo.definitions.setting_kinds import Kind, Names, Seconds, Switch, Whole, Word
from xlmc.montecarlo.definitions.stopping import MOST_TRIALS, NO_GOAL, RARE, Stopping
from xlmc.montecarlo.sampling.sampling_methods import METHODS

__all__ = ["DETAILED", "ENDS", "SETTINGS", "USUAL", "Setting", "Settings", "check_settings"]

ENDS: Final = "stopping."
"""What the field of a setting of the end of the run begins with."""

DETAILED: Final = 20
"""Forecasts that sensitivity, charts and page tell of, unless asked otherwise: nobody looks at hundreds of charts."""


@dataclass(frozen=True, slots=True)
class Settings:
    """What a run is a function of, beside the workbook itself.

    Attributes:
        trials: how many; at most, where `stopping` has a goal or a time.
        stopping: what else ends the run.
        evidence: how evidence without a limit is used: one of `EVIDENCE_METHODS`; empty where nothing is said, or
            where a run has no such evidence.
        lognorm: whose `RiskLognorm` is meant, `@RISK` (also where it is empty) or `XLRisk`.
        scenarios: whether the workbook's scenarios are run, too, and compared with it.
        detailed: how many forecasts, from the first on, sensitivity, charts and page tell of; 0 for `DETAILED`.
        number_style: the signs of thousands and decimals where people read numbers, one of `STYLES`; empty for the
            usual ones.
    """

    trials: int = 200_000
    seed: int = 999
    sampling: str = "mc"
    engine: str = "numpy"
    stopping: Stopping = NO_GOAL
    lognorm: str = ""
    scenarios: bool = False
    evidence: str = ""
    detailed: int = 0
    number_style: str = ""


USUAL: Final = Settings()
"""The defaults, for what neither the workbook nor the command says."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A row: all that is known of one setting.

    Attributes:
        key: its argument of `Model.simulate`, and its key in the record, where `recorded_as` has no other.
        heading: its row of `xlmc_settings`; empty where a workbook cannot say it.
        label: of its entry in the record.
        kind: what values it has, how the record holds them, and how a command says them.
        repeat: whether the command that repeats a run says it: wherever the run has it, where the workbook says
            something else, or never, as only the workbook can say it.
        field: of `Settings`; empty where the key is.
        options: of the command line; empty where it has none.
        help: a sentence there.
        blank: it may be left unset; its entry is then empty.
        sparse: the record has no entry of it while it is unset.
        recorded_as: its key in the record; empty where `key` is.
    """

    key: str
    heading: str
    label: str
    kind: Kind
    repeat: Literal["always", "unlike the workbook", "never"]
    field: str = ""
    options: tuple[str, ...] = ()
    help: str = ""
    blank: bool = False
    sparse: bool = False
    recorded_as: str = ""

    def of(self, settings: object) -> Any:
        """Return its value in `Settings`, or in `RunOptions`, which have the same fields."""
        return attrgetter(self.field or self.key)(settings)

    @property
    def entry_key(self) -> str:
        """Return the key of its entry in the record."""
        return self.recorded_as or self.key


def _samplings() -> dict[str, str]:
    return {name: method.key for method in METHODS.values() for name in (method.key, *method.also)}


SETTINGS: Final[dict[str, Setting]] = {
    row.key: row
    for row in (
        Setting(
            key="trials",
            heading="Trials",
            label="Trials at most",
            kind=Whole(1, MOST_TRIALS, "{} trials were asked for", f"Give 1 to {MOST_TRIALS:,}"),
            repeat="always",
            options=("-n", "--trials"),
            help="Trials to run.  [default: the book's, else 200000]",
        ),
        Setting(
            key="seed",
            heading="Seed",
            label="Seed",
            kind=Whole(0, None, "the seed {} is negative", "Give a whole number from 0 up", as_text=True),
            repeat="always",
            options=("--seed",),
            help="Seed: the number that the random draws start from.  [default: the book's, else 999]",
        ),
        Setting(
            key="sampling",
            heading="Sampling",
            label="Sampling",
            kind=Word(lambda: METHODS, "There is no sampling method {}", also=_samplings),
            repeat="unlike the workbook",
            options=("--sampling",),
            help="; ".join(f"{method.key}: {method.name}" for method in METHODS.values())
            + ".  [default: the book's, else mc]",
        ),
        Setting(
            key="engine",
            heading="Engine",
            label="Engine",
            kind=Word(lambda: ENGINES, "There is no engine {}", suggest=True),
            repeat="unlike the workbook",
            options=("--engine",),
            help="; ".join(f"{each.key}: {each.what}" if each.what else each.key for each in ENGINES.values())
            + ".  [default: the book's, else numpy]",
        ),
        Setting(
            key="lognorm",
            heading="Lognorm",
            label="RiskLognorm is that of",
            kind=Word(
                lambda: ("@RISK", "XLRisk"),
                "There is no RiskLognorm of a program {}",
                hint="Use @RISK (mean and std dev of the draw) or XLRisk (of its logarithm)",
            ),
            repeat="never",
            blank=True,
        ),
        Setting(
            key="evidence",
            heading="Evidence",
            label="Evidence by",
            kind=Word(lambda: EVIDENCE_METHODS, "{} is not a method to use evidence"),
            repeat="unlike the workbook",
            options=("--evidence",),
            help="How evidence with a normal or lognormal error is used: rejection: it rejects trials; weights: it"
            " weights them; auto: the run's first trials decide.  [default: the book's, else auto]",
            blank=True,
            sparse=True,
        ),
        Setting(
            key="scenarios",
            heading="",
            label="Scenarios are run, too",
            kind=Switch(),
            repeat="unlike the workbook",
            options=("--scenarios",),
            help="Also run the scenarios of the table xlmc_scenarios, and compare their answers with the book's own.",
            blank=True,
            sparse=True,
        ),
        Setting(
            key="detailed",
            heading="Detailed forecasts",
            label="Forecasts with charts and sensitivity",
            kind=Whole(1, None, "Charts and sensitivity of {} forecasts were asked for", "Give 1 or more"),
            repeat="unlike the workbook",
            options=("--detailed",),
            help=f"Forecasts, from the first on, with charts and sensitivity.  [default: the book's, else {DETAILED}]",
            blank=True,
            sparse=True,
        ),
        Setting(
            key="number_style",
            heading="Number style",
            label="Number style",
            kind=Word(
                lambda: STYLES,
                "There is no number style {}",
                hint=f"Type one of these as a text, with an apostrophe before it: {';  '.join(STYLES)}",
                spelling=style_key,
            ),
            repeat="unlike the workbook",
            options=("--number-style",),
            help="How numbers are written: 1,234.5 or 1.234,5 and so on.  [default: the book's, else 1,234.5]",
            blank=True,
            sparse=True,
        ),
        Setting(
            key="forecasts",
            heading="Look at",
            label="Of these forecasts",
            kind=Names(),
            repeat="always",
            field=f"{ENDS}forecasts",
            options=("--for",),
            help="The forecast whose precision or digits count; may be given several times.  [default: all]",
            blank=True,
            recorded_as="for",
        ),
        Setting(
            key="time_limit",
            heading="Time limit",
            label="Seconds at most",
            kind=Seconds(),
            repeat="always",
            field=f"{ENDS}seconds",
            options=("--time-limit",),
            help="End the run after 60s, 5m or 1h30m.",
            blank=True,
        ),
        Setting(
            key="rare",
            heading="Rare",
            label="Search for rare trials",
            kind=Word(lambda: RARE, "{} is not a method to look for rare trials"),
            repeat="always",
            field=f"{ENDS}rare",
            options=("--rare",),
            help="Where accepted trials are rare, learn where they are and draw there.  [default: auto: if -n would not"
            " be enough]",
            blank=True,
        ),
    )
}
"""Setting by its key, in the order in which help, records and commands list them."""


def check_settings(settings: Settings) -> None:
    """Refuse a setting that no run has.

    Raises:
        SimulationError: one is out of its range.
    """
    for row in SETTINGS.values():
        value = row.of(settings)
        if value or not row.blank:
            row.kind.check(value)
