"""`python -m fracparticles` is the command line."""

import sys

from fracparticles.command_line.cli import main

if __name__ == "__main__":
    sys.exit(main())
