"""So that `python -m mainspring.cli` is the command line too."""

import sys

from mainspring.cli import main

sys.exit(main())
