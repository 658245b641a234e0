"""Other readings of the same graph: bounds, derivatives, many digits, roundings at random."""
