"""The careful path, which the engines fall back to and must equal, and the slow engine `formulas`."""
