"""Trees written with as few brackets as Excel's precedence allows, and read back."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.formula import ir, parse

UNION, COMPARISON, JOIN, SUM, PRODUCT, POWER, PERCENT, PREFIX, INTERSECTION, RANGE, SPILL = range(11)
LEVELS = {",": UNION, "&": JOIN, "^": POWER, " ": INTERSECTION, ":": RANGE}
LEVELS |= {"+": SUM, "-": SUM, "*": PRODUCT, "/": PRODUCT}
LEVELS |= dict.fromkeys(["=", "<", ">", "<=", ">=", "<>"], COMPARISON)


def reference(row, column, sheet):
    return ir.Reference(ir.Corner(row, column), None, sheet)


LEAVES = {
    ir.Number(1.5): "1.5",
    ir.Text("a"): '"a"',
    ir.Logical(True): "TRUE",
    ir.ErrorLiteral(ErrorCode.NA): "#N/A",
    reference(1, 1, "S s"): "'S s'!A1",  # quoted: `Rate:S!A1` would be a 3-D reference
    reference(2, 2, "S s"): "'S s'!B2",
    ir.Name("Rate"): "Rate",
    ir.Call("PI", ()): "PI()",
}


def written(tree, least=UNION):
    """The text of a tree; in brackets where it binds less tightly than `least`."""
    text, level = _written(tree)
    return text if level >= least else f"({text})"


def _written(tree):
    match tree:
        case ir.Binary(",", left, right):  # as in a list, the rest of which is one operand
            return f"{written(left, UNION + 1)},{written(right)}", UNION
        case ir.Binary(operator, left, right):
            level = LEVELS[operator]
            return f"{written(left, level)}{operator}{written(right, level + 1)}", level
        case ir.Unary("%", operand):
            return f"{written(operand, PERCENT)}%", PERCENT
        case ir.Unary(operator, operand):
            return f"{operator}{written(operand, PREFIX)}", PREFIX
        case ir.Call("SINGLE", (operand,)):
            return f"@{written(operand, PREFIX)}", PREFIX
        case ir.Call("ANCHORARRAY", (operand,)):
            return f"{written(operand, SPILL)}#", SPILL
        case ir.Call("F", arguments):
            return f"F({','.join(written(argument, UNION + 1) for argument in arguments)})", SPILL
    return LEAVES[tree], SPILL


def larger(parts):
    return st.one_of(
        st.builds(ir.Binary, st.sampled_from(sorted(LEVELS)), parts, parts),
        st.builds(ir.Unary, st.sampled_from("+-%"), parts),
        st.builds(ir.Call, st.sampled_from(["SINGLE", "ANCHORARRAY"]), st.tuples(parts)),
        st.builds(ir.Call, st.just("F"), st.lists(parts, min_size=1, max_size=3).map(tuple)),
    )


@settings(max_examples=400, deadline=None)
@given(st.recursive(st.sampled_from(list(LEAVES)), larger, max_leaves=12))
def test_brackets_stand_only_where_precedence_needs_them(tree):
    assert parse(written(tree)) == tree


@settings(max_examples=200, deadline=None)
@given(st.recursive(st.sampled_from(list(LEAVES)), larger, max_leaves=8))
def test_more_brackets_change_nothing(tree):
    text = written(tree)
    assert parse(f"(({text}))") == tree
    assert parse(f"F(({text}),1.5)") == ir.Call("F", (tree, ir.Number(1.5)))
