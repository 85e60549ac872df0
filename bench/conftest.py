"""Makes the modules of bench/ and reference/ importable, also where FEniCSx is not installed."""

import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import time_to_rest  # noqa: E402, F401  (it sets the path to reference/)

logging.disable(logging.INFO)
