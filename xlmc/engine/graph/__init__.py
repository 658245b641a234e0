"""Formulas become one directed graph of nodes, each computed once: what every engine evaluates."""
