from __future__ import annotations

from templates.description import Equation
from templates.vehicles import for_both


def test_a_pattern_becomes_one_equation_for_each_vehicle():
    pattern = Equation("V{j}_i", "V{j}i", "{who} speed", "ft/s", "<|->V{k}_f", "eq (<15|16>)", "<only here|>")
    first, second = for_both(("Truck", "Car"), [pattern])
    assert (first.symbol, first.formula, first.reference, first.note) == ("V1_i", "V2_f", "eq (15)", "only here")
    assert (second.symbol, second.formula, second.reference, second.note) == ("V2_i", "-V1_f", "eq (16)", "")
    assert (first.name, second.name) == ("Truck speed", "Car speed")


def test_what_is_not_a_pattern_stays_as_it_is():
    plain = Equation("e_n", "e_n", "Restitution", "", "a<b", "eq (9)")
    assert for_both(("Truck", "Car"), [plain]) == (plain,)
