"""From the graph of formulas to one callable over blocks of trials, by the chosen engine."""
