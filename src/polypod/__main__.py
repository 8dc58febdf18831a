"""`python -m polypod`: the command line."""

import sys

from polypod.cli import main

if __name__ == "__main__":
    sys.exit(main())
