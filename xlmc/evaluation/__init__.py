"""Graph of formulas → one callable over blocks of trials, by the engine of one's choice."""
