"""So that `python -m mainspring` is the command line."""

import sys

from mainspring.cli import main

sys.exit(main())
