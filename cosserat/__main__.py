"""`python -m cosserat`."""

import sys

from cosserat.cli import main

if __name__ == "__main__":
    sys.exit(main())
