"""Makes the modules of reference/ importable and keeps FFCx's compiler calls out of the output."""

import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
logging.disable(logging.INFO)
