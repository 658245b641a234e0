"""What the bundle starts."""

from multiprocessing import freeze_support

from xlmc.cli import main

if __name__ == "__main__":
    freeze_support()
    main()
