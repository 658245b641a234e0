"""`python -m xlmc` is `xlmc`."""

from xlmc.cli import main

main()
