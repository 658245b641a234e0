"""Sampling: seeded streams; Monte Carlo, Latin hypercube and scrambled Sobol; rank correlation."""
