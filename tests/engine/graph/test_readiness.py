from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from xlmc.engine.graph.readiness import order_by_need
from xlmc.engine.numpy.numpy_engine import NumpyProgram


@st.composite
def graphs(draw):
    """Node -> the nodes that it reads, each below it; below 0 lies what is there from the start."""
    size = draw(st.integers(1, 40))
    return {node: draw(st.lists(st.integers(-3, node - 1), max_size=3)) for node in range(size)}


def most_waiting(order, reads, keep):
    """The most values that are computed and still to be read, counted anew at every node."""
    counts = []
    for at in range(len(order)):
        later = {used for node in order[at + 1 :] for used in reads[node]} | set(keep)
        counts.append(len({*order[:at]} & ({*later} | {*reads[order[at]]}) | {order[at]}))
    return max(counts)


@given(graphs(), st.data())
def test_every_node_follows_what_it_reads(reads, data):
    keep = data.draw(st.lists(st.sampled_from([*reads])))
    order = order_by_need([*reads], reads, keep, enough=0)
    assert sorted(order) == sorted(reads)
    at = {node: position for position, node in enumerate(order)}
    assert all(at[used] < at[node] for node in reads for used in reads[node] if used >= 0)
    assert most_waiting(order, reads, keep) <= most_waiting([*reads], reads, keep)


def test_an_order_that_is_good_enough_stays():
    reads = {0: [], 1: [], 2: [], 3: [0], 4: [1], 5: [2]}
    assert order_by_need([0, 1, 2, 3, 4, 5], reads, [], enough=4) == [0, 1, 2, 3, 4, 5]
    assert order_by_need([0, 1, 2, 3, 4, 5], reads, [], enough=3) == [0, 3, 1, 4, 2, 5]


def buffers(lower, rows):
    """How many arrays a program of so many time steps writes to: speed, distance, and the sum of a column."""
    cells = {"A1": 1.0, "B1": "=A1", "C1": 0.0, "D1": "=SIN(A1)"}
    for row in range(2, rows + 1):
        before = row - 1
        cells |= {f"B{row}": f"=B{before}*0.9+COS(A1*{row})", f"C{row}": f"=C{before}+B{row}*0.1"}
        cells[f"D{row}"] = f"=D{before}*C{row}/(1+EXP(-A1/{row}))"
    cells["E1"] = f"=SUM(C2:C{rows})+D{rows}"
    lowering, targets = lower(cells, ["A1"], ["E1"])
    return len(NumpyProgram.of(lowering, [], targets, frozenset()).allocate(1))


def test_what_waits_does_not_depend_on_the_number_of_time_steps(lower):
    assert buffers(lower, 150) == buffers(lower, 200) < 20
