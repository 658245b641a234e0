"""xlmc: Monte Carlo simulation of Excel workbooks, without Excel."""

__version__ = "0.1.0"
