"""How cells change with the assumptions: first and second derivatives, exact to rounding where a function has a rule.

Forward mode: one sweep over the graph of nodes carries, beside every node's value, its derivatives with respect to the
assumptions that reach it (`jet`). The rule of a function says in a few lines what becomes of them; each family of rules
is a file. A function without a rule is differentiated by differences of its own body's values (`numerical`).
"""

from xlmc.engine.passes.derivatives.derivative import Derivative, Derivatives, Kink, Numerical, Undefined

__all__ = ["Derivative", "Derivatives", "Kink", "Numerical", "Undefined"]
