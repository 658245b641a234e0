"""What `stress.py` measures, part by part; the tests in tests/stress use the same parts at a smaller size."""
