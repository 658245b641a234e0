"""Trials of candidates: each is the workbook with the candidate's values typed in, on the same draws."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.loop import candidates as module
from xlmc.montecarlo.loop.candidates import CandidateTrials
from xlmc.montecarlo.model.loading import build_model

D1, D2 = Cell("S", 1, 4), Cell("S", 2, 4)
NUMBER = Decision("d", D1, (2.0, 5.0, 9.0), D1)
OTHER = Decision("e", D2, (1.0, 3.0), D2)
TEXT = Decision("t", D1, (0.0, 1.0), D1, contents=("steel", "wood"))


@pytest.fixture
def trials(workbook):
    """`trials(cells, decisions)`: of a book in which A1 is uniform from 0 to 1, and D1 and D2 are decided on."""

    def make(cells, decisions=(NUMBER,), wanted=((0, None),), jobs=1, seed=5):
        book = workbook({"A1": "=RiskUniform(0,1)", "D1": 2.0, "D2": 1.0, **cells})
        return CandidateTrials(build_model(book, Path("book.xlsx")), decisions, "numpy", seed, wanted, jobs)

    return make


def rows(computed):
    return [each.columns[0] for each in computed]


def test_candidates_share_their_draws(trials):
    made = trials({"B1": '=RiskOutput("y")+A1*D1+D2'}, (NUMBER, OTHER))
    assert not made.by_typing
    assert made.computed == 0
    first, second, third = rows(made.forecasts([(2.0, 1.0), (5.0, 1.0), (5.0, 3.0)], 0, 1000))
    assert made.computed == 3000
    draws = (first - 1.0) / 2.0
    assert second == pytest.approx(1.0 + 5.0 * draws)
    assert third == pytest.approx(3.0 + 5.0 * draws)
    assert draws.min() >= 0.0
    assert draws.max() < 1.0
    assert abs(draws.mean() - 0.5) < 5 / np.sqrt(12 * 1000)
    assert len(np.unique(draws)) == 1000
    assert rows(made.forecasts([(2.0, 1.0)], 900, 1000))[0].tolist() == first[900:].tolist()
    assert made.computed == 3100


@pytest.mark.parametrize(("cuts", "jobs"), [([0, 1000], 2), ([0, 600, 1000], 1), ([0, 64, 128, 300, 1000], 3)])
def test_trials_do_not_depend_on_portions(trials, monkeypatch, cuts, jobs):
    cells = {"B1": '=RiskOutput("y")+A1*D1'}
    whole = rows(trials(cells).forecasts([(2.0,), (5.0,), (9.0,)], 0, 1000))
    monkeypatch.setattr(module, "_BLOCK", 256)
    made = trials(cells, jobs=jobs)
    parts = [rows(made.forecasts([(2.0,), (5.0,), (9.0,)], *ends)) for ends in pairwise(cuts)]
    assert [np.concatenate(each).tolist() for each in zip(*parts, strict=True)] == [each.tolist() for each in whole]


@pytest.mark.parametrize(
    ("start", "stop", "size"), [(0, 1 << 14, 1 << 14), (0, 1 << 20, 1 << 14), (0, 1000, 512), (64, 1000, 64),
                                (256, 1000, 256), (0, 3, 64), (1 << 13, 1 << 14, 1 << 13)],
)  # fmt: skip
def test_sizes_of_blocks(trials, start, stop, size):
    made = trials({"B1": '=RiskOutput("y")+A1*D1'})
    assert made._block_size(start, stop) == size


def test_decisions_that_cannot_be_inputs_are_typed(trials):
    """How many cells OFFSET reads must be known before the run."""
    made = trials({"A2": 10.0, "A3": 100.0, "B1": '=RiskOutput("y")+SUM(OFFSET(A1,0,0,D1,1))'},
                  (Decision("d", D1, (1.0, 2.0, 3.0), D1),))  # fmt: skip
    assert made.by_typing
    one, two, three = rows(made.forecasts([(1.0,), (2.0,), (3.0,)], 0, 500))
    assert two == pytest.approx(one + 10.0)
    assert three == pytest.approx(one + 110.0)


def test_a_model_that_differs_by_more_than_its_input_is_typed(trials):
    """The mean of a distribution itself is worked out as the book is read, with the number that is typed then."""
    made = trials({"B1": '=RiskOutput("y")+A1+RiskTheoMean(RiskUniform(0,D1))'})
    assert made.by_typing
    two, five, nine = rows(made.forecasts([(2.0,), (5.0,), (9.0,)], 0, 100))
    assert five == pytest.approx(two + 1.5)
    assert nine == pytest.approx(two + 3.5)


def test_numbers_that_are_read_as_texts_are_inputs(trials):
    made = trials({"B1": '=RiskOutput("y")+A1+LEN(D1&"")'}, (Decision("d", D1, (2.0, 55.0, 999.0), D1),))
    assert not made.by_typing
    one, two, three = rows(made.forecasts([(2.0,), (55.0,), (999.0,)], 0, 100))
    assert two == pytest.approx(one + 1)
    assert three == pytest.approx(one + 2)


def test_texts_are_typed_beside_numbers(trials):
    made = trials({"B1": '=RiskOutput("y")+A1*D2*IF(D1="wood",10,1)'}, (TEXT, OTHER))
    computed = made.forecasts([(0.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)], 0, 300)
    steel, wood, three, both = rows(computed)
    assert wood == pytest.approx(10 * steel)
    assert three == pytest.approx(30 * steel)
    assert both == pytest.approx(3 * steel)
    assert made.computed == 1200
    again = rows(made.forecasts([(0.0, 1.0)], 64, 300))
    assert again[0].tolist() == steel[64:].tolist()
    assert made.computed == 1200 + 236


def test_what_is_not_possible_has_no_numbers(trials):
    """A normal distribution has no standard deviation below 0: of typed values and of texts that lead to it."""
    cells = {"A2": "=RiskNormal(0,D3)", "D3": "=D1-5", "B1": '=RiskOutput("y")+A2+SUM(OFFSET(A1,0,0,D1*0+1,1))'}
    made = trials({**cells, "D1": 9.0}, (NUMBER,))
    computed = made.forecasts([(2.0,), (9.0,)], 0, 200)
    assert np.isnan(computed[0].columns).all()
    assert not np.isnan(computed[1].columns).any()
    texts = trials({"A2": '=RiskNormal(0,IF(D1="wood",1,-1))', "D1": "wood", "B1": '=RiskOutput("y")+A2'}, (TEXT,))
    steel, wood = texts.forecasts([(0.0,), (1.0,)], 0, 200)
    assert np.isnan(steel.columns).all()
    assert not np.isnan(wood.columns).any()


def test_lost_trials(trials):
    """The logarithm of A1 - 0.5 is an error in half of the trials, and those have no number."""
    made = trials({"B1": '=RiskOutput("y")+LN(A1-0.5)*D1'})
    for computed in made.forecasts([(2.0,), (5.0,)], 0, 1000):
        assert abs(computed.lost - 500) < 5 * np.sqrt(250)
        assert np.isnan(computed.columns[0]).sum() == computed.lost
    assert [each.lost for each in made.forecasts([(2.0,)], 0, 0)] == [0]


def test_answers_that_are_texts(trials):
    """1 where the answer is the text that is wanted, 0 where it is another one, which may be all."""
    cells = {"B1": '=RiskOutput("y")+A1*D1', "B2": '=IF(RiskOutput("z")+A1*D1>0.6,"good","bad")'}
    wanted = ((0, None), (1, "good"), (1, "bad"), (1, "ugly"))
    computed = trials(cells, wanted=wanted).forecasts([(2.0,), (5.0,)], 0, 500)
    for each in computed:
        y, good, bad, ugly = each.columns
        assert good.tolist() == (y > 0.6).tolist()
        assert bad.tolist() == (y <= 0.6).tolist()
        assert ugly.tolist() == [0.0] * 500
        assert each.lost == 0


def test_what_is_looked_at(trials):
    """Each decision has its least, its middle and its largest value in one of three candidates."""
    made = trials({"B1": '=RiskOutput("y")+A1*D1'}, (NUMBER, OTHER))
    assert made._looked_at() == [(2.0, 3.0), (5.0, 3.0), (9.0, 1.0)]


def test_draws_that_depend_on_a_decision(trials):
    """The parameters of a draw may be decided on: then nothing of it stays from candidate to candidate."""
    made = trials({"A2": "=RiskUniform(0,D1)", "B1": '=RiskOutput("y")+A2'})
    two, five, again = rows(made.forecasts([(2.0,), (5.0,), (2.0,)], 0, 400))
    assert five == pytest.approx(2.5 * two)
    assert again.tolist() == two.tolist()


def test_kept_draws_are_limited(trials, monkeypatch):
    """With room for no more than one block, the others are drawn again, and are the same."""
    cells = {"B1": '=RiskOutput("y")+A1*D1'}
    whole = rows(trials(cells).forecasts([(2.0,), (5.0,)], 0, 1000))
    monkeypatch.setattr(module, "_BLOCK", 64)
    monkeypatch.setattr(module, "_MOST_BYTES", 1)
    few = rows(trials(cells).forecasts([(2.0,), (5.0,)], 0, 1000))
    assert [each.tolist() for each in few] == [each.tolist() for each in whole]
