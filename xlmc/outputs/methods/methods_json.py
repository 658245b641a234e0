"""A study of methods as JSON."""

from __future__ import annotations

from typing import Any

from xlmc.analysis.studies.methods import STATISTICS, Curve, Runs, Study, need, recommendation
from xlmc.analysis.studies.methods.need import choice, worst_error
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import finite
from xlmc.outputs.methods.methods_tables import cannot, floor_of

__all__ = ["study_json"]


def study_json(study: Study) -> dict[str, Any]:
    """Everything that was measured, as JSON holds it."""
    reference = study.reference
    best = choice(study) if study.varying else None
    chosen = best and best.chosen
    return {
        "workbook": study.model.workbook.name,
        "accuracy": study.accuracy[0],
        "seed": study.seed,
        "reference": {
            "trials": reference.trials,
            "accepted": reference.accepted,
            "sampling": reference.sampling,
            "engine": reference.engine,
            "seconds": reference.seconds,
            "acceptance": _estimate(reference.acceptance),
            "forecasts": {
                name: {
                    each: {
                        "value": finite(getattr(answer, each)),
                        "error": finite(getattr(reference.errors[name], each)),
                    }
                    for each in STATISTICS
                }
                for name, answer in reference.answers.items()
            },
            "widths": {name: finite(width) for name, width in reference.widths.items()},
            "own_errors_of_widths": {each: finite(floor_of(study, each)) for each in STATISTICS},
            "independent_trials": {
                "trials": study.ladder[-1],
                "errors": {
                    name: {each: finite(reference.theory(name, each, study.ladder[-1])) for each in STATISTICS}
                    for name in reference.answers
                },
            },
        },
        "recommended": chosen and chosen.method.key,
        "cheapest": [curve.method.key for curve in best.cheapest] if best else [],
        "methods": [_curve(study, curve) for curve in study.every],
        "not_used": dict(study.absent),
        "ended_early": study.ended or None,
        "recommendation": recommendation(study),
    }


def _curve(study: Study, curve: Curve) -> dict[str, Any]:

    drawn = curve not in study.once
    wanted = need(study, curve) if drawn and study.varying else None
    near = worst_error(study, curve) if curve.answers and study.varying and not drawn else None
    return {
        "method": curve.method.key,
        "name": curve.method.name,
        "cannot": cannot(study, curve.method),
        "remarks": list(curve.remarks),
        "setup_seconds": curve.setup,
        "bounds": {name: {"least": least, "most": most} for name, (least, most) in curve.ranges.items()},
        "bounds_at": [
            {"forecast": name, "end": end, "assumptions": dict(point)} for (name, end), point in curve.ends.items()
        ],
        "runs": [_of_length(study, runs, drawn) for runs in curve.lengths],
        "slopes": {
            each: {"trials": finite(curve.slope(each, "budget")), "seconds": finite(curve.slope(each, "seconds"))}
            for each in STATISTICS
        },
        "needs": wanted
        and {"trials": finite(wanted.trials), "seconds": finite(wanted.seconds), "reaches": wanted.reaches},
        "near_enough": near and near.reaches,
    }


def _of_length(study: Study, runs: Runs, drawn: bool) -> dict[str, Any]:

    return {
        "trials": runs.budget if drawn else None,
        "seconds": finite(runs.seconds),
        "seconds_median": finite(runs.usual),
        "seconds_measured": runs.measured,
        "evaluations": runs.evaluations,
        "effective": runs.effective,
        "failed": runs.failed,
        "acceptance_error": None if runs.acceptance is None else finite(runs.acceptance.value),
        "errors_of_widths": {each: finite(runs.shares[each]) for each in STATISTICS},
        "errors": {
            forecast.name: {
                each: {
                    "rms": finite(runs.errors[forecast.name, each].value),
                    "error": finite(runs.errors[forecast.name, each].error),
                    "bias": finite(runs.errors[forecast.name, each].bias),
                }
                for each in STATISTICS
            }
            for forecast in study.model.forecasts
        },
    }


def _estimate(estimate: Estimate) -> dict[str, float | None]:
    return {"value": finite(estimate.value), "error": finite(estimate.error)}
