"""All results of a run as one JSON document; docs/json.md describes it, `results.schema.json` defines it.

JSON holds no NaN and no infinity: null stands for them, and an estimate says why.
"""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.record.definition_tables import correlations_met
from xlmc.analysis.results.record.errors_met import errors_met, lost_sentences
from xlmc.analysis.results.statements.in_words import cutoffs_text, evidence_text, limits_text, parameters_text
from xlmc.analysis.results.statements.pairs import pairs_of
from xlmc.analysis.results.statements.run_in_words import UNWEIGHTED, discards_of, status
from xlmc.analysis.results.statements.scenarios_in_words import changes_text
from xlmc.analysis.results.statements.sentences import certainties, statements
from xlmc.analysis.studies.scenario_answers import (
    ForecastAnswer,
    ScenarioAnswers,
    impossible_scenarios,
    scenario_answers,
)
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.seal import sealed_json
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.writer import write_workbook
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.number_styles import as_programs_read
from xlmc.montecarlo.statistics import Estimate, proportion
from xlmc.montecarlo.statistics.estimate import finite
from xlmc.outputs.filter_effect import Marginal, filter_effect_of
from xlmc.outputs.summary import BaseCase, base_case

if TYPE_CHECKING:
    from xlmc.analysis.results.record.definition_tables import CorrelationMet
    from xlmc.analysis.results.statements.pairs import Pair
    from xlmc.montecarlo.definitions.definitions import Assumption, Filter
    from xlmc.montecarlo.diagnostics.agreement import Agreement, Answer, ItemAgreement
    from xlmc.montecarlo.diagnostics.checking import CheckResult
    from xlmc.montecarlo.diagnostics.weighing import Weighting
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "FORMAT",
    "NO_ERROR",
    "NO_VALUE",
    "SCHEMA",
    "STATISTICS",
    "UNBOUNDED",
    "VERSION",
    "check_json_path",
    "document",
    "estimate_json",
    "save_json",
    "scenario_json",
]

FORMAT: Final = "xlmc results"

VERSION: Final = 1

SCHEMA: Final = Path(__file__).with_name("results.schema.json")

NO_VALUE: Final = "not defined for these trials"

NO_ERROR: Final = "no standard error can be given"

UNBOUNDED: Final = "so few trials do not bound the interval"

STATISTICS: Final = (
    "mean",
    "median",
    "mode",
    "standard_deviation",
    "variance",
    "skewness",
    "kurtosis",
    "coefficient_of_variation",
    "minimum",
    "maximum",
    "range_width",
    "mean_standard_error",
)

Json = dict[str, Any]

_EstimateJson = dict[str, float | str | None]


@as_programs_read()
def document(simulation: RunResult, *, command: str | None = None) -> Json:
    """Return the results of a run, every number as it is in Python and on the sheets.

    Args:
        simulation: the finished run.
        command: what the person typed, for the record.
    """
    base, scenarios = base_case(simulation), [scenario_json(each) for each in scenario_answers(simulation)]
    return {
        "format": FORMAT,
        "version": VERSION,
        "warnings": simulation.warnings,
        "checks": [_check(each) for each in simulation.checks],
        "record": make_record(simulation, command).as_dict(),
        "trials": _trials(simulation),
        "forecasts": [_forecast(result, base) for result in simulation.results.values()],
        "filters": [_filter(simulation, index, each) for index, each in enumerate(simulation.model.filters)],
        "forecast_filters": [
            {
                "name": each.filter.name,
                "only_for": each.forecast,
                "cell": str(each.filter.cell),
                "limits": limits_text(each.filter),
                "because": each.filter.because,
                "discarded": each.trials,
                "share": estimate_json(each.share),
            }
            for each in discards_of(simulation)
        ],
        "weights": _weights(simulation.weighting),
        "evidence": None if simulation.agreement is None else _evidence(simulation.agreement),
        "assumptions": [_assumption(simulation, each) for each in simulation.model.assumptions],
        "statements": [_as_json(each) for each in statements(simulation)],
        "pairs": [] if simulation.weighting is not None else [_pair(each) for each in pairs_of(simulation)],
        "sensitivity": None if simulation.weighting is not None else _sensitivity(simulation),
        "correlations": [_correlation(met) for met in correlations_met(simulation)],
        "errors": [
            {"in": met.kind, "name": met.name, "cell": str(met.cell), "error": met.error, "trials": met.trials}
            | {"from": None if met.root is None else f"{met.root[0]} {met.root[1].text}"}
            for met in errors_met(simulation)
        ],
        "base_case": None if base is None else {"rejected_by": list(base.rejected_by)},
        **({"scenarios": scenarios} if scenarios else {}),
        **({"impossible_scenarios": dict(impossible)} if (impossible := impossible_scenarios(simulation)) else {}),
        "notices": [
            {"message": notice.message, "where": None if notice.where is None else str(notice.where)}
            for notice in simulation.notices
        ],
    }


def save_json(simulation: RunResult, path: Path, *, command: str | None = None, overwrite: bool = False) -> Path:
    """Write the document, and behind it the seal by which xlmc knows it again.

    Args:
        simulation: the finished run.
        path: where to; untouched results of the same workbook are replaced.
        command: what the person typed, for the record.
        overwrite: replace any other file too.

    Returns:
        The path.

    Raises:
        TakenError: the file is not ours to replace.
        WorkbookError: the file cannot be written, or does not end in `.json`.
    """
    check_json_path(path)
    target = Target(path, simulation.model.workbook.name, overwrite, read=simulation.model.files)
    target.check()
    write_workbook(path, sealed_json(document(simulation, command=command), target.book), target.check)
    return path


def check_json_path(path: Path) -> None:
    """Refuse to write JSON over what is none.

    Raises:
        WorkbookError: the name does not end in `.json`.
    """
    if path.suffix.casefold() != ".json":
        raise WorkbookError("JSON is written to a .json file", where=path, hint=f"Name it {path.stem + '.json'!r}")


def scenario_json(each: ScenarioAnswers) -> Json:
    """Return the answers of a scenario, or of the workbook itself."""
    return {
        "name": None if each.scenario is None else each.scenario.name,
        "changes": "" if each.scenario is None else changes_text(each.scenario, each.run.model.definitions),
        "note": "" if each.scenario is None else each.scenario.note,
        "warnings": each.warnings,
        "paired": each.paired,
        "run": each.run.trials,
        "accepted": each.run.accepted,
        "acceptance": estimate_json(each.acceptance),
        "acceptance_difference": _estimate_or_none(each.acceptance_difference),
        "forecasts": [_scenario_forecast(answer) for answer in each.forecasts],
    }


def _scenario_forecast(answer: ForecastAnswer) -> Json:
    answers = {"mean": answer.mean, "low": answer.low, "high": answer.high, "above": answer.above}
    asked = answer.forecast
    described = {"name": asked.name, "units": asked.units, "share": asked.central, "threshold": asked.threshold}
    return described | {
        key: {
            "estimate": _estimate_or_none(value),
            "difference": _estimate_or_none(answer.differences.get(key)),
        }
        for key, value in answers.items()
    }


def _estimate_or_none(estimate: Estimate | None) -> _EstimateJson | None:
    return None if estimate is None else estimate_json(estimate)


def _trials(simulation: RunResult) -> Json:
    return {
        "run": simulation.trials,
        "accepted": simulation.accepted,
        "acceptance": estimate_json(simulation.acceptance),
        "lost_to_errors": simulation.error_trials,
        "undecided": simulation.tally.by_error,
        "losses": lost_sentences(simulation),
        "ended_by": simulation.stopped.by,
        "ended_when": simulation.stopped.sentence,
    }


def _forecast(result: ForecastResult, base: BaseCase | None) -> Json:
    definition, description = result.definition, result.statistics
    low, high = description.central
    above = description.probability_above
    return {
        "name": definition.name,
        "cell": str(definition.cell),
        "units": definition.units,
        "report_to": definition.report_to,
        "kind": result.kind.value,
        "number_format": result.form.code,
        "yes": None if result.yes is None else estimate_json(result.yes),
        "categories": [{"text": text, "share": estimate_json(each)} for text, each in result.categories.items()],
        "role": definition.role.value,
        "trials": description.trials,
        "statistics": {name: estimate_json(getattr(description, name)) for name in STATISTICS},
        "percentiles": [
            {"percent": percent, **estimate_json(each)} for percent, each in description.percentiles.items()
        ],
        "central_range": {"share": definition.central, "low": estimate_json(low), "high": estimate_json(high)},
        "certainty": None
        if above is None
        else {"threshold": definition.threshold, "probability_above": estimate_json(above)},
        "certainties": [_as_json(each) for each in certainties(result)],
        "base_case": None if base is None else base.texts.get(definition.name, finite(base.forecasts[definition.name])),
        "without_number": {error: count for error, count in sorted(result.faults.items()) if count},
    }


def _filter(simulation: RunResult, index: int, each: Filter) -> Json:
    tally, filters = simulation.tally, simulation.model.filters
    rejected, only = int(tally.rejected[index]), int(tally.only[index])
    together = zip(filters, tally.together[index].tolist(), strict=True)
    return {
        "name": each.name,
        "cell": str(each.cell),
        "limits": limits_text(each),
        "because": each.because,
        "rejected": rejected,
        "share": estimate_json(proportion(rejected, simulation.trials)),
        "only": only,
        "share_only": estimate_json(proportion(only, simulation.trials)),
        "also_by": {other.name: count for other, count in together if other is not each},
        "errors": sum(tally.errors[index].values()),
    }


def _weights(weighting: Weighting | None) -> Json | None:
    if weighting is None:
        return None
    described = {"mean": weighting.mean, "largest": weighting.largest, "effective_trials": weighting.effective}
    return {**described, "left_out": UNWEIGHTED}


def _evidence(agreement: Agreement) -> Json:
    return {
        "verdict": agreement.verdict.value,
        "sentence": agreement.sentence,
        "remarks": agreement.remarks,
        "trials": agreement.trials,
        "past_filters": agreement.past,
        "effective_trials": agreement.effective,
        "kept_together": estimate_json(agreement.together),
        "ratio": estimate_json(agreement.ratio),
        "z_of_best_trial": agreement.best_z,
        "items": [_item(each) for each in agreement.items],
        "pressed": [_as_json(each) for each in agreement.pressed],
        "answers": [_evidence_answer(each) for each in agreement.answers],
    }


def _item(each: ItemAgreement) -> Json:
    return {
        "name": each.name,
        "cell": str(each.evidence.cell),
        "reading": each.evidence.reading,
        "error": evidence_text(each.evidence),
        "source": each.evidence.source,
        "kept_alone": estimate_json(each.alone),
        "kept_given_others": estimate_json(each.given_others),
        "ratio": estimate_json(each.ratio),
        "chance": finite(each.chance),
        "z_of_best_trial": each.best_z,
        "mean_z": each.mean_z,
        "verdict": each.verdict.value,
    }


def _evidence_answer(each: Answer) -> Json:
    return {
        "forecast": each.forecast,
        "with": each.used,
        "items": list(each.items),
        "effective_trials": each.effective,
        "mean": estimate_json(each.mean),
        "standard_deviation": estimate_json(each.standard_deviation),
        "low": estimate_json(each.low),
        "high": estimate_json(each.high),
    }


def _check(each: CheckResult) -> Json:
    return {
        "name": each.name,
        "cell": str(each.cell),
        "because": each.because,
        "base": each.base.content,
        "holds": each.holds,
        "trials": each.trials,
        "failed": each.failed,
        "share": estimate_json(each.share),
    }


def _assumption(simulation: RunResult, each: Assumption) -> Json:
    entry: Json = {
        "name": each.name,
        "cell": str(each.cell),
        "units": each.units,
        "status": status(simulation.model, each.name, each.frozen),
        "distribution": each.distribution,
        "parameters": parameters_text(each),
        "cutoffs": cutoffs_text(each),
        "base": each.base,
        "source": each.source,
        "uncertain": each.uncertain,
        "prior": None,
        "accepted": None,
        "shift": None,
        "narrowing": None,
    }
    effect = filter_effect_of(simulation, each.name)
    if effect is None:
        return entry
    return entry | {
        "prior": _marginal(effect.prior),
        "accepted": _marginal(effect.accepted),
        "shift": estimate_json(effect.shift),
        "narrowing": estimate_json(effect.narrowing),
    }


def _marginal(marginal: Marginal) -> Json:
    return {
        "trials": marginal.trials,
        "mean": estimate_json(marginal.mean),
        "standard_deviation": estimate_json(marginal.standard_deviation),
        "percentiles": [{"percent": percent, **estimate_json(each)} for percent, each in marginal.percentiles.items()],
    }


def _correlation(met: CorrelationMet) -> Json:
    return {
        "first": met.first,
        "second": met.second,
        "asked": met.asked,
        "used": None if met.used is None else finite(met.used),
        "accepted": None if met.accepted is None else estimate_json(met.accepted),
        "row": None if met.row is None else str(met.row),
    }


def _pair(pair: Pair) -> Json:
    others = (field.name for field in fields(pair) if field.name not in ("first", "second", "limit_texts"))
    return {"first": pair.first.name, "second": pair.second.name} | {
        name: _as_json(getattr(pair, name)) for name in others
    }


def _sensitivity(simulation: RunResult) -> Json:
    """Return what the detailed forecasts depend on; how many others there are only where there are some."""
    result: Json = _as_json(sensitivities(simulation))
    if not result["omitted_forecasts"]:
        del result["omitted_forecasts"]
    return result


def _as_json(value: Any) -> Any:
    """Dataclasses as objects, without the forms of numbers, tuples as lists, estimates with their reasons, and null
    for what is no number.
    """
    if isinstance(value, Estimate):
        return estimate_json(value)
    if isinstance(value, float):
        return finite(value)
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, tuple | list):
        return [_as_json(each) for each in value]
    result = ((field.name, getattr(value, field.name)) for field in fields(value))
    return {name: _as_json(each) for name, each in result if not isinstance(each, Form)}


def estimate_json(estimate: Estimate) -> _EstimateJson:
    """`{"value": …, "error": …, "low": …, "high": …}`, with a `reason` where one of them is null.

    >>> from xlmc.montecarlo.statistics import Estimate
    >>> estimate_json(Estimate(3.0, 0.5, (2.0, 4.0)))
    {'value': 3.0, 'error': 0.5, 'low': 2.0, 'high': 4.0}
    >>> estimate_json(Estimate(3.0))["reason"]
    'no standard error can be given'
    """
    low, high = estimate.interval or (None, None)
    numbers = [finite(number) for number in (estimate.value, estimate.error, low, high)]
    entry: _EstimateJson = dict(zip(("value", "error", "low", "high"), numbers, strict=True))
    if None in numbers:
        entry["reason"] = _reason(numbers[0], numbers[1], estimate.interval is not None)
    return entry


def _reason(value: float | None, error: float | None, interval: bool) -> str:
    if value is None:
        return NO_VALUE
    return UNBOUNDED if interval and error is not None else NO_ERROR
