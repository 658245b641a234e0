"""What every run of the tests has, of whichever folder: see `tests/session`."""

pytest_plugins = (
    "both_ends",
    "cases",
    "costliest",
    "example_profiles",
    "not_tested",
    "process_costs",
    "tree_guard",
    "work_stealing",
)
