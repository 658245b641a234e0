"""Who is measured, one file each: `prepare(task)` loads a book and gives what answers trials and runs them.

A contestant runs in a process of its own, started by `one_contestant.py`. The files of the peers import nothing but the
peer and the standard library: they run in an environment that has neither xlmc nor NumPy.
"""
