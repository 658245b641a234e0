"""The time-stepped books of `books.py` hand-written in NumPy: the yardstick for large, plain books.

The equations are those of `books.write_march`, step by step, for any number of steps, as a careful NumPy programmer
writes them for this one model: one block of trials at a time, small enough for the cache, and arrays that are allocated
once; what does not change from step to step is computed once a block; the sine and cosine of a slope are looked up with
the road, because there are as many slopes as the road has rows. A distance is found in the road by `searchsorted`, or,
because the road has a row every 10 ft, by dividing by 10 (`guess`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from books import CELLS_A_STEP, MARCH, ROAD_STEP, SECONDS, G, road
from numpy.typing import NDArray

__all__ = ["HIGH", "LOW", "SEARCHES", "buffered", "road_columns", "simulate", "steps_of"]

Array = NDArray[np.float64]
Kernel = Callable[[Array], Array]
"""Inputs (12, n) in the order of MARCH, which it may overwrite -> the forecast, (1, n)."""

LOW = np.array([low for *_, low, _ in MARCH])
HIGH = np.array([high for *_, high in MARCH])
SEARCHES = ("searchsorted", "guess")
AVERAGED = 5
"""Steps over which the demand is averaged."""


def steps_of(cells: int) -> tuple[int, float]:
    """Time steps of a book of so many cells, and seconds in each."""
    steps = cells // CELLS_A_STEP
    return steps, SECONDS / steps


def road_columns() -> tuple[Array, Array, Array, Array]:
    """Row by row where the road's rows begin in ft, the factor of the friction, cosine and sine of the slope."""
    begins, grade, factor = np.array(road()).T
    slope = np.arctan(grade / 100)
    return begins, factor.copy(), np.cos(slope), np.sin(slope)


def simulate(trials: int, seed: int, chunk: int, cells: int, search: str = "guess") -> Array:
    """Monte Carlo of the book of so many cells, one thread: the forecast, (1, trials)."""
    rng = np.random.Generator(np.random.SFC64(seed))
    evaluate = buffered(chunk, cells, search)
    low, width = LOW[:, None], (HIGH - LOW)[:, None]
    inputs, answers = np.empty((len(LOW), chunk)), np.empty((1, trials))
    for start in range(0, trials, chunk):
        rng.random(out=inputs)
        inputs *= width
        inputs += low
        part = answers[:, start : start + chunk]
        part[:] = evaluate(inputs)[:, : part.shape[1]]
    return answers


def buffered(n: int, cells: int, search: str) -> Kernel:
    """A kernel for `n` trials.

    Args:
        n: trials at once.
        cells: formula cells of the time steps.
        search: one of SEARCHES.
    """
    steps, dt = steps_of(cells)
    begins, factors, cosines, sines = road_columns()
    demands = np.empty((AVERAGED, n))
    spare, square, spare_square, distance, x, y, energy, work, wanted, drag, t, u, v = np.empty((13, n))
    row = np.empty(n, dtype=np.intp)
    mul, add, sub, div, least, most = np.multiply, np.add, np.subtract, np.divide, np.minimum, np.maximum

    def find_row() -> None:
        if search == "searchsorted":
            sub(begins.searchsorted(distance, "right"), 1, out=row)
            return
        # Right to the last bit: the last number before a row begins gives a quotient that does not round up to the row.
        div(distance, ROAD_STEP, out=t)
        least(t, len(begins) - 1, out=t)
        np.copyto(row, t, casting="unsafe")

    def evaluate(inputs: Array) -> Array:
        before, friction, reaction, rise, fade_speed, fade, steer, decay, wheelbase, understeer, weight, heading = (
            inputs
        )
        now, square_before, square_now = spare, square, spare_square
        for array in (distance, x, y, energy, work):
            array.fill(0.0)
        mul(before, before, out=square_before)
        div(steer, wheelbase, out=steer)
        div(-1.0, decay, out=decay)
        time = 0.0
        for step in range(steps):
            time += dt
            find_row()
            # What the tyres hold: the friction here, less where it has faded.
            factors.take(row, out=wanted, mode="clip")
            mul(wanted, friction, out=wanted)
            sub(before, fade_speed, out=t)
            most(t, 0.0, out=t)
            mul(t, fade, out=t)
            sub(1.0, t, out=t)
            mul(wanted, t, out=wanted)
            # Drag: braking times that, on the slope.
            sub(time, reaction, out=t)
            div(t, rise, out=t)
            most(t, 0.0, out=t)
            least(t, 1.0, out=t)
            mul(t, wanted, out=drag)
            cosines.take(row, out=t, mode="clip")
            mul(drag, t, out=drag)
            sines.take(row, out=t, mode="clip")
            add(drag, t, out=drag)
            # Speed; u: the distance of this step; the energy lost in it.
            mul(drag, -G * dt, out=now)
            add(now, before, out=now)
            most(now, 0.1, out=now)
            add(before, now, out=u)
            mul(u, dt / 2, out=u)
            add(distance, u, out=distance)
            mul(now, now, out=square_now)
            sub(square_before, square_now, out=t)
            mul(t, weight, out=t)
            mul(t, 0.5 / G, out=t)
            add(energy, t, out=energy)
            add(work, t, out=work)
            # t: yaw rate.
            mul(understeer, square_now, out=t)
            add(t, 1.0, out=t)
            div(steer, t, out=t)
            mul(t, now, out=t)
            mul(decay, time, out=v)
            np.exp(v, out=v)
            mul(t, v, out=t)
            # Demand of the tyres, from drag and lateral acceleration.
            mul(t, now, out=v)
            mul(v, 1 / G, out=v)
            mul(v, v, out=v)
            mul(drag, drag, out=drag)
            add(v, drag, out=v)
            np.sqrt(v, out=demands[step % AVERAGED])
            # Heading and place, the place over dt.
            mul(t, dt, out=t)
            add(heading, t, out=heading)
            np.cos(heading, out=t)
            mul(t, now, out=t)
            add(x, t, out=x)
            np.sin(heading, out=t)
            mul(t, now, out=t)
            add(y, t, out=y)
            # Work of sliding: what the mean demand is above what the tyres hold.
            count = min(step + 1, AVERAGED)
            add.reduce(demands[:count], axis=0, out=t)
            mul(t, 1 / count, out=t)
            sub(t, wanted, out=t)
            most(t, 0.0, out=t)
            mul(t, weight, out=t)
            mul(t, u, out=t)
            add(work, t, out=work)
            before, now, square_before, square_now = now, before, square_now, square_before
        add(energy, work, out=t)
        div(t, weight, out=t)
        mul(x, x, out=u)
        mul(y, y, out=v)
        add(u, v, out=u)
        np.sqrt(u, out=u)
        mul(u, dt, out=u)
        return add(t, u, out=inputs[0])[None]

    return evaluate
