"""Other evaluations of the same graph: bounds, derivatives, many digits, random rounding."""
