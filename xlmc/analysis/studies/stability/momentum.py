"""The paper's equations of momentum, recognised in cells, and their forms that lose no digits.

    (15)  V1 = (m1·V1f·SIN(β1-α2) - m2·V2f·SIN(α2-β2)) / (m1·SIN(α1-α2))
    (16)  V2 = (m1·V1f·COS(β1) + m2·V2f·COS(β2) - m1·V1·COS(α1)) / (m2·COS(α2))
    (16′) V2 = -(V2f·SIN(β2-α1) + m1/m2·V1f·SIN(β1-α1)) / SIN(α1-α2)                 no COS(α2), no V1
    (17)  Δω = m/I·Vf·(COS(β)·b - SIN(β)·a) - m/I·V·(COS(α)·b - SIN(α)·a)
    (17′) Δω = m/I·((Vf·COS(β) - V·COS(α))·b - (Vf·SIN(β) - V·SIN(α))·a)               one subtraction of speeds
    (20)  ΔV = Vf·COS(β) - V·COS(α), and with SIN
    (20′) from p1 = m1·V1f·SIN(β1-α1), p2 = m2·V2f·SIN(β2-α2), δ = α1-α2: the impulse along and across the mean course,
          -(p1+p2)/(2·SIN(δ/2)) and (p1-p2)/(2·COS(δ/2))                              no difference of speeds

A form is shown only after 50 digits have confirmed it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from xlmc.analysis.studies.stability.case import Case
from xlmc.analysis.studies.stability.formula_trees import factors, terms
from xlmc.excel.formula import ir

__all__ = ["Momentum", "angle_of", "components", "sine", "spin", "times"]

Tree = ir.Expression


def times(*parts: Tree) -> Tree:
    """Write a product."""
    built = parts[0]
    for part in parts[1:]:
        built = ir.Binary("*", built, part)
    return built


def angle_of(tree: Tree, function: str) -> Tree | None:
    """Return the angle of `COS(angle)`, RADIANS included; None if the tree is another function."""
    return tree.arguments[0] if isinstance(tree, ir.Call) and tree.name == function else None


def _bare(angle: Tree) -> tuple[Tree, bool]:
    """Return an angle without RADIANS, and whether it stood in that."""
    match angle:
        case ir.Call("RADIANS", (inner,)):
            return inner, True
        case _:
            return angle, False


def _in_radians(angle: Tree, in_degrees: bool) -> Tree:
    return ir.Call("RADIANS", (angle,)) if in_degrees else angle


def sine(left: Tree, right: Tree) -> Tree:
    """Write the sine of a difference of two angles, subtracted in degrees where they are in degrees."""
    (a, degrees), (b, also) = _bare(left), _bare(right)
    if degrees and also:
        return ir.Call("SIN", (_in_radians(ir.Binary("-", a, b), True),))
    return ir.Call("SIN", (ir.Binary("-", left, right),))


@dataclass(frozen=True, slots=True)
class Momentum:
    """What (15) names: masses, speeds after the impact, and the angles before and after it, as they stand in cells."""

    masses: tuple[Tree, Tree]
    speeds: tuple[Tree, Tree]
    before: tuple[Tree, Tree]
    after: tuple[Tree, Tree]
    in_degrees: bool


def _known_momentum(case: Case) -> Iterator[Momentum]:
    """Every cell that is (15), either vehicle first."""
    for cell in case.cells:
        momentum = _momentum(case.trees.formula(cell))
        if momentum is not None:
            yield momentum
            mass, speed = momentum.masses[1], momentum.speeds[1]  # which of two factors is which, nothing says
            yield replace(momentum, masses=(momentum.masses[0], speed), speeds=(momentum.speeds[0], mass))


def _momentum(tree: Tree) -> Momentum | None:
    above, below = factors(tree)
    sines = [part for part in below if angle_of(part, "SIN") is not None]
    mass = [part for part in below if angle_of(part, "SIN") is None]
    if len(sines) != 1 or len(mass) != 1 or len(above) != 1 or len(terms(above[0])) != 2:
        return None
    course = _difference(angle_of(sines[0], "SIN"))
    parts = [_sine_term(term) for _, term in terms(above[0])]
    own = [part for part in parts if part is not None and mass[0] in part[0]]
    other = [part for part in parts if part is not None and mass[0] not in part[0]]
    if course is None or len(own) != 1 or len(other) != 1:
        return None
    (own_factors, own_angle), (other_factors, other_angle) = own[0], other[0]
    speed = [part for part in own_factors if part != mass[0]]
    first, second, degrees = course
    after_own = [one for one in own_angle[:2] if one not in (first, second)]
    after_other = [one for one in other_angle[:2] if one not in (first, second)]
    if len(speed) != 1 or len(other_factors) != 2 or len(after_own) != 1 or len(after_other) != 1:
        return None
    masses, speeds = (mass[0], other_factors[0]), (speed[0], other_factors[1])
    return Momentum(masses, speeds, (first, second), (after_own[0], after_other[0]), degrees)


def _difference(angle: Tree | None) -> tuple[Tree, Tree, bool] | None:
    """Return the two angles of a difference, and whether in degrees."""
    if angle is None:
        return None
    bare, degrees = _bare(angle)
    if not (isinstance(bare, ir.Binary) and bare.operator == "-"):
        return None
    (left, also), (right, too) = _bare(bare.left), _bare(bare.right)
    return left, right, degrees or (also and too)


def _sine_term(tree: Tree) -> tuple[list[Tree], tuple[Tree, Tree, bool]] | None:
    """Split a term `m·V·SIN(β-α)`: what stands before the sine, and its angles."""
    above, below = factors(tree)
    sines = [part for part in above if angle_of(part, "SIN") is not None]
    if below or len(sines) != 1:
        return None
    angles = _difference(angle_of(sines[0], "SIN"))
    rest = [part for part in above if part not in (*sines, ir.Number(-1.0))]
    return None if angles is None else (rest, angles)


def components(case: Case, tree: Tree) -> Iterator[Tree]:
    """(20′) for a cell that is (20), with COS or with SIN: for either vehicle of every (15) that there is."""
    function = next((name for name in ("COS", "SIN") if _is_change(tree, name)), None)
    if function is None:
        return
    for known in _known_momentum(case):
        for vehicle in (0, 1):
            yield _component(known, vehicle, function)


def _is_change(tree: Tree, function: str) -> bool:
    """Whether it is `Vf·COS(β) - V·COS(α)`."""
    result = terms(tree)
    if sorted(sign for sign, _ in result) != [-1, 1]:
        return False
    return all(any(angle_of(part, function) is not None for part in factors(term)[0]) for _, term in result)


def _component(known: Momentum, vehicle: int, function: str) -> Tree:
    """`±(along·COS(mean) - across·SIN(mean))/m`, or with SIN and COS."""
    two = ir.Number(2.0)
    momenta = [
        times(mass, speed, ir.Call("SIN", (_in_radians(ir.Binary("-", after, before), known.in_degrees),)))
        for mass, speed, before, after in zip(known.masses, known.speeds, known.before, known.after, strict=True)
    ]
    half = ir.Binary("/", ir.Binary("-", *known.before), two)
    mean = _in_radians(ir.Binary("/", ir.Binary("+", *known.before), two), known.in_degrees)

    def of_half(name: str) -> Tree:
        return times(two, ir.Call(name, (_in_radians(half, known.in_degrees),)))

    along = ir.Binary("/", ir.Unary("-", ir.Binary("+", *momenta)), of_half("SIN"))
    across = ir.Binary("/", ir.Binary("-", *momenta), of_half("COS"))
    cosine, sine_ = ir.Call("COS", (mean,)), ir.Call("SIN", (mean,))
    if function == "COS":
        impulse = ir.Binary("-", times(along, cosine), times(across, sine_))
    else:
        impulse = ir.Binary("+", times(along, sine_), times(across, cosine))
    quotient = ir.Binary("/", impulse, known.masses[vehicle])
    return ir.Unary("-", quotient) if vehicle else quotient


def spin(tree: Tree) -> Tree | None:
    """(17′) for a cell that is (17), with or without a yaw rate added; None if it is not."""
    result = terms(tree)
    arms = [(sign, _arm(term)) for sign, term in result]
    swept = [(sign, arm) for sign, arm in arms if arm is not None]
    if sorted(sign for sign, _ in swept) != [-1, 1]:
        return None
    (_, after), (_, before) = sorted(swept, key=lambda each: -each[0])
    if (after.along, after.across) != (before.along, before.across):
        return None
    shared = [part for part in after.above if part in before.above]
    below = [part for part in after.below if part in before.below]
    own = [[part for part in arm.above if part not in shared] for arm in (after, before)]
    if not shared or below != after.below or below != before.below or any(len(speed) != 1 for speed in own):
        return None

    def change(name: str) -> Tree:
        return ir.Binary(
            "-",
            times(own[0][0], ir.Call(name, (after.angle,))),
            times(own[1][0], ir.Call(name, (before.angle,))),
        )

    factor = times(*shared)
    for part in below:
        factor = ir.Binary("/", factor, part)
    turn = ir.Binary("-", times(change("COS"), after.along), times(change("SIN"), after.across))
    built = times(factor, turn)
    for (sign, term), (_, arm) in zip(result, arms, strict=True):
        if arm is None:
            built = ir.Binary("+" if sign > 0 else "-", built, term)
    return built


@dataclass(frozen=True, slots=True)
class _Arm:
    """`above / below · (COS(angle)·along - SIN(angle)·across)`."""

    above: list[Tree]
    below: list[Tree]
    angle: Tree
    along: Tree
    across: Tree


def _arm(tree: Tree) -> _Arm | None:
    above, below = factors(tree)
    for index, part in enumerate(above):
        pair = terms(part)
        if len(pair) == 2:
            cosine, sine_ = (_with(pair, name) for name in ("COS", "SIN"))
            if cosine and sine_ and cosine[0] > 0 > sine_[0] and cosine[1] == sine_[1]:
                return _Arm(above[:index] + above[index + 1 :], below, cosine[1], cosine[2], sine_[2])
    return None


def _with(pair: Sequence[tuple[int, Tree]], function: str) -> tuple[int, Tree, Tree] | None:
    """Return the term with the function in it: its sign, the angle, and what else it is."""
    for sign, term in pair:
        above, below = factors(term)
        angles = [angle for part in above if (angle := angle_of(part, function)) is not None]
        rest = [part for part in above if angle_of(part, function) is None]
        if len(angles) == 1 and len(rest) == 1 and not below:
            return sign, angles[0], rest[0]
    return None
