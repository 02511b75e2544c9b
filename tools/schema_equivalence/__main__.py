import sys

from tools.schema_equivalence.cli import main

sys.exit(main())
