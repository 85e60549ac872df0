"""Makes the package of exchange/ importable, and that of the solver's command line."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "verification")]
