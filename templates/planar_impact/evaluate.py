"""The equations of the imperial workbook once more, by hand in NumPy: its compiled cells are held to them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["evaluate"]

Value = NDArray[np.generic]
Values = dict[str, Value]


def evaluate(inputs: Mapping[str, ArrayLike]) -> Values:
    """Every equation of the template but the optional ones.

    Args:
        inputs: symbol -> (n,) or a number, of every assumption and constant, in units of the sheet (lb, ft, in, deg).

    Returns:
        symbol -> (n,) or 0-d, for every equation: ft/s, lb·s, rad/s inside, mph and deg in the answers; the checks are
        boolean. A quantity that is undefined in a trial is NaN or infinite there.
    """
    v: Values = {symbol: np.asarray(value, dtype=float) for symbol, value in inputs.items()}
    with np.errstate(divide="ignore", invalid="ignore"):
        for step in (_run_out, _impact_speeds, _delta_v, _yaw, _restitution, _answers, _force, _energy, _checks):
            v |= step(v)
    return {symbol: value for symbol, value in v.items() if symbol not in inputs}


def _sin(degrees: Value) -> Value:
    return np.sin(np.radians(degrees))


def _cos(degrees: Value) -> Value:
    return np.cos(np.radians(degrees))


def _run_out(v: Values) -> Values:
    new = {}
    for j in (1, 2):
        x, y, sine, cosine = v[f"x_{j}"], v[f"y_{j}"], _sin(v[f"alpha_{j}"]), _cos(v[f"alpha_{j}"])
        new |= {
            f"m_{j}": v[f"w_{j}"] / v["g"],
            f"V{j}_f": np.sqrt(2 * v["g"] * v[f"f_{j}"] * v[f"s_{j}"]),
            f"a_{j}": -(x * cosine + y * sine) / v["in_per_ft"],
            f"b_{j}": -(x * sine - y * cosine) / v["in_per_ft"],
        }
    return new


def _impact_speeds(v: Values) -> Values:
    delta = v["alpha_1"] - v["alpha_2"]
    sin_delta = _sin(delta)
    p = {j: v[f"m_{j}"] * v[f"V{j}_f"] * _sin(v[f"beta_{j}"] - v[f"alpha_{j}"]) for j in (1, 2)}
    first = v["V1_f"] * _sin(v["beta_1"] - v["alpha_2"]) + p[2] / v["m_1"]
    second = v["V2_f"] * _sin(v["beta_2"] - v["alpha_1"]) + p[1] / v["m_2"]
    return {
        "delta_alpha": delta,
        "sin_delta": sin_delta,
        "p_1": p[1],
        "p_2": p[2],
        "V1_i": first / sin_delta,
        "V2_i": -second / sin_delta,
    }


def _delta_v(v: Values) -> Values:
    along = -(v["p_1"] + v["p_2"]) / (2 * _sin(v["delta_alpha"] / 2))
    across = (v["p_1"] - v["p_2"]) / (2 * _cos(v["delta_alpha"] / 2))
    mean = (v["alpha_1"] + v["alpha_2"]) / 2
    p_x = along * _cos(mean) - across * _sin(mean)
    p_y = along * _sin(mean) + across * _cos(mean)
    total = np.sqrt(along**2 + across**2)
    new = {"P_along": along, "P_across": across, "mean_alpha": mean, "P_x": p_x, "P_y": p_y, "P_total": total}
    for j, sign in ((1, 1), (2, -1)):
        mass = v[f"m_{j}"]
        new |= {f"dV_{j}": total / mass, f"dV{j}_x": sign * p_x / mass, f"dV{j}_y": sign * p_y / mass}
    return new


def _yaw(v: Values) -> Values:
    change = {
        1: (v["P_x"] * v["b_1"] - v["P_y"] * v["a_1"]) / v["I_1"],
        2: (v["P_y"] * v["a_2"] - v["P_x"] * v["b_2"]) / v["I_2"],
    }
    new = {}
    for j in (1, 2):
        before = np.radians(v[f"omega{j}_deg"])
        new |= {f"d_omega_{j}": change[j], f"omega{j}_i": before, f"omega{j}_f": before + change[j]}
    return new


def _restitution(v: Values) -> Values:
    def contact(j: int, when: str) -> tuple[Value, Value]:
        """Velocity (X, Y) of vehicle j's contact point, before (`i`) or after (`f`)."""
        speed, yaw = v[f"V{j}_{when}"], v[f"omega{j}_{when}"]
        heading = v[f"alpha_{j}"] if when == "i" else v[f"beta_{j}"]
        return speed * _cos(heading) + v[f"b_{j}"] * yaw, speed * _sin(heading) - v[f"a_{j}"] * yaw

    (x1i, y1i), (x2i, y2i) = contact(1, "i"), contact(2, "i")
    (x1f, y1f), (x2f, y2f) = contact(1, "f"), contact(2, "f")
    new = {"V_sep_x": x1f - x2f, "V_sep_y": y2f - y1f, "V_close_x": x2i - x1i, "V_close_y": y1i - y2i}
    sine, cosine = _sin(v["gamma_t"]), _cos(v["gamma_t"])
    for when in ("sep", "close"):
        x, y = new[f"V_{when}_x"], new[f"V_{when}_y"]
        new |= {f"V_{when}_n": x * sine + y * cosine, f"V_{when}_t": y * sine - x * cosine}
    return new | {"e_n": new["V_sep_n"] / new["V_close_n"], "e_t": new["V_sep_t"] / new["V_close_t"]}


def _mph(v: Values, feet_per_second: Value) -> Value:
    return feet_per_second * v["s_per_hour"] / v["ft_per_mile"]


def _answers(v: Values) -> Values:
    delta_v = {f"dV{j}_mph": _mph(v, v[f"dV_{j}"]) for j in (1, 2)}
    return delta_v | {f"V{j}_mph": _mph(v, v[f"V{j}_i"]) for j in (1, 2)}


def _force(v: Values) -> Values:
    x = v["V1_i"] * _cos(v["alpha_1"]) - v["V2_i"] * _cos(v["alpha_2"])
    y = v["V1_i"] * _sin(v["alpha_1"]) - v["V2_i"] * _sin(v["alpha_2"])
    new = {"closing_mph": _mph(v, np.sqrt(x**2 + y**2))}
    for j in (1, 2):
        sine, cosine = _sin(v[f"alpha_{j}"]), _cos(v[f"alpha_{j}"])
        forward = _mph(v, v[f"dV{j}_x"] * cosine + v[f"dV{j}_y"] * sine)
        right = _mph(v, v[f"dV{j}_x"] * sine - v[f"dV{j}_y"] * cosine)
        pdof = np.degrees(np.arctan2(right, -forward))
        clockwise = np.mod(-pdof, 360)
        new |= {
            f"dV{j}_long": forward,
            f"dV{j}_right": right,
            f"PDOF_{j}": pdof,
            f"PDOF{j}_cw": clockwise,
            f"PDOF{j}_clock": np.mod(np.floor(clockwise / 30 + 0.5) + 11, 12) + 1,
            f"d_omega{j}_deg": np.degrees(v[f"d_omega_{j}"]),
        }
    return new


def _energy(v: Values) -> Values:
    before, after = (
        sum(v[f"m_{j}"] * v[f"V{j}_{when}"] ** 2 + v[f"I_{j}"] * v[f"omega{j}_{when}"] ** 2 for j in (1, 2)) / 2
        for when in ("i", "f")
    )
    return {"E_before": before, "E_after": after, "E_lost": before - after}


def _checks(v: Values) -> Values:
    sine, cosine = _sin(v["gamma_t"]), _cos(v["gamma_t"])
    d = {j: v[f"b_{j}"] * cosine - v[f"a_{j}"] * sine for j in (1, 2)}
    approach = _mph(v, v["V_close_n"] * np.sign(d[2] - d[1]))
    checks = {
        "check_energy": v["E_lost"] >= 0,
        "check_closing": approach > 0,
        "check_angles": np.abs(v["sin_delta"]) >= _sin(np.float64(10)),
        "check_forward": (v["V1_i"] > 0) & (v["V2_i"] > 0),
        "check_restitution": (np.abs(v["e_n"]) <= 1) & (np.abs(v["e_t"]) <= 1),
        "check_friction": (np.minimum(v["f_1"], v["f_2"]) > 0) & (np.maximum(v["f_1"], v["f_2"]) <= 1.2),
    }
    every = np.logical_and.reduce(tuple(np.broadcast_arrays(*checks.values())))
    return {"d_1": d[1], "d_2": d[2], "approach_mph": approach} | checks | {"checks_hold": every}
