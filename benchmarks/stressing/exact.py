"""What the forms should give: momentum solved by Cramer's rule with 80 digits, and how evidence moves the answer.

Nothing here knows a form: the directions are vectors, the two speeds solve the two equations of momentum (1), (2), and
everything else follows from the definitions. The inputs are the very floating-point numbers that xlmc was given.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from mpmath import mp, mpf

__all__ = ["ANSWERS", "DIGITS", "Evidence", "conditioning", "exact", "forward"]

DIGITS: Final = 80
STEP: Final = mpf(10) ** -30

Evidence = Mapping[str, Any]
"""By the names of `forms.INPUTS`."""

Vector = tuple[Any, Any]


def _direction(degrees: Any) -> Vector:
    return mp.cospi(mpf(degrees) / 180), mp.sinpi(mpf(degrees) / 180)


def _cross(a: Vector, b: Vector) -> Any:
    return a[0] * b[1] - a[1] * b[0]


def _dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1]


def _solved(e: Evidence) -> dict[str, Any]:
    u = {j: _direction(e[f"alpha_{j}"]) for j in (1, 2)}
    after = {j: tuple(e[f"V{j}_f"] * c for c in _direction(e[f"beta_{j}"])) for j in (1, 2)}
    total = tuple(e["m_1"] * after[1][i] + e["m_2"] * after[2][i] for i in (0, 1))
    speed = {1: _cross(total, u[2]) / e["m_1"] / _cross(u[1], u[2])}
    speed[2] = _cross(u[1], total) / e["m_2"] / _cross(u[1], u[2])
    before = {j: tuple(speed[j] * c for c in u[j]) for j in (1, 2)}
    change = {j: tuple(after[j][i] - before[j][i] for i in (0, 1)) for j in (1, 2)}
    turn = {j: e[f"m_{j}"] * (change[j][0] * e[f"b_{j}"] - change[j][1] * e[f"a_{j}"]) / e[f"I_{j}"] for j in (1, 2)}
    sliding = [
        _tangential(e, *(tuple(v[j][i] + w[j] * (e[f"b_{j}"], -e[f"a_{j}"])[i] for i in (0, 1)) for j in (1, 2)))
        for v, w in ((before, {1: 0, 2: 0}), (after, turn))
    ]
    return {"u": u, "speed": speed, "change": change, "turn": turn, "sliding": sliding}


def _tangential(e: Evidence, first: Vector, second: Vector) -> Any:
    """How fast contact point 1 moves along the tangent beside contact point 2."""
    return _dot((first[0] - second[0], first[1] - second[1]), _direction(e["gamma_t"]))


def _force_direction(result: Mapping[str, Any]) -> Any:
    change, heading = result["change"][1], result["u"][1]
    force = -change[0], -change[1]
    return mp.degrees(mp.atan2(_cross(heading, force), _dot(heading, force)))


ANSWERS: Final[Mapping[str, Callable[[dict[str, Any]], Any]]] = {
    "V1_i": lambda result: result["speed"][1],
    "V2_i": lambda result: result["speed"][2],
    "d_omega_1": lambda result: result["turn"][1],
    "dV_1": lambda result: mp.hypot(*result["change"][1]),
    "PDOF_1": _force_direction,
    "e_t": lambda result: -result["sliding"][1] / result["sliding"][0],
}
"""By the rewritten cell of each form. A blow pushes vehicle 1 along its ΔV and comes from the other side: −ΔV."""


def exact(evidence: Evidence) -> dict[str, Any]:
    """Every answer, of evidence taken as the exact numbers that it is."""
    with mp.workdps(DIGITS):
        result = _solved({name: mpf(value) for name, value in evidence.items()})
        return {name: answer(result) for name, answer in ANSWERS.items()}


def conditioning(evidence: Evidence) -> dict[str, float]:
    """How far each answer moves, relative to itself (a direction: to 180°), when every quantity moves by so much.

    The quantities are those that no rounding in degrees blurs: masses, speeds, places, and of the directions the
    differences from vehicle 1's approach, and that approach. The sum of |q ∂f/∂q / f| over them, which is what one
    rounding of each would do: no form can be asked to do better than a small multiple of it.
    """
    with mp.workdps(DIGITS):
        held = {name: mpf(value) for name, value in evidence.items()}
        base = {name: answer(_solved(held)) for name, answer in ANSWERS.items()}
        quantities = _quantities(held)
        moved = dict.fromkeys(base, mpf(0))
        for name, value in quantities.items():
            result = _solved(_evidence({**quantities, name: value * (1 + STEP)}))
            for answer, compute in ANSWERS.items():
                scale = mpf(180) if answer == "PDOF_1" else base[answer]
                apart = compute(result) - base[answer]
                if answer == "PDOF_1":
                    apart = (apart + 180) % 360 - 180
                moved[answer] += abs(apart / STEP / scale) if scale else mp.inf
        return {name: float(total) for name, total in moved.items()}


def _quantities(e: Evidence) -> dict[str, Any]:
    turned = {f"beta_{j}": e[f"beta_{j}"] - e[f"alpha_{j}"] for j in (1, 2)}
    return {**e, **turned, "alpha_2": e["alpha_1"] - e["alpha_2"]}


def _evidence(q: Mapping[str, Any]) -> dict[str, Any]:
    second = q["alpha_1"] - q["alpha_2"]
    return {**q, "alpha_2": second, "beta_1": q["alpha_1"] + q["beta_1"], "beta_2": second + q["beta_2"]}


def forward(
    alphas: tuple[float, float], speeds: tuple[float, float], masses: tuple[float, float], impulse: Vector
) -> dict[str, float]:
    """The evidence that a crash leaves: departure directions near the approaches, and speeds, as floats.

    Args:
        alphas: approach directions, degrees.
        speeds: before.
        masses: of both.
        impulse: on vehicle 1; vehicle 2 receives the opposite.
    """
    with mp.workdps(DIGITS):
        left: dict[str, float] = {"m_1": masses[0], "m_2": masses[1]}
        for j, sign in ((1, 1), (2, -1)):
            alpha, u = alphas[j - 1], _direction(alphas[j - 1])
            after = tuple(speeds[j - 1] * u[i] + sign * impulse[i] / masses[j - 1] for i in (0, 1))
            turned = mp.degrees(mp.atan2(_cross(u, after), _dot(u, after)))
            left |= {f"alpha_{j}": alpha, f"beta_{j}": float(alpha + turned), f"V{j}_f": float(mp.hypot(*after))}
        return left
