"""The numbers of the page, defined in quantities.toml: axes, heads and their table follow.

A number has one name, unit and definition wherever it is shown, and one command that makes it.
"""

from dataclasses import dataclass
from pathlib import Path

from common.files import read_toml
from sandglass_report import style

VERIFY = "sandglass verify --json build/verdicts.json"
LEAST_PLAIN = 1e-3  # smaller values are written with a power of ten


@dataclass(frozen=True)
class Quantity:
    """A number of the page. name: in axes and prose; head: of a column of a table.

    unit: of its values where they are shown as plain numbers, empty if each states its own.
    field: where it is in the file that the command writes.
    """

    name: str
    head: str
    definition: str
    field: str
    unit: str = ""
    command: str = VERIFY
    scale: float = 1.0  # from the stored value, in SI units or as a fraction, to the unit

    @property
    def title(self):
        """The title of an axis."""
        return f"{self.name}, {self.unit}" if self.unit else self.name

    @property
    def column(self):
        """The head of a column of plain numbers."""
        return f"{self.head}, {self.unit}" if self.unit else self.head

    def shown(self, value):
        """A stored value as text in the unit; empty for None."""
        if value is None:
            return ""
        if isinstance(value, int) and self.scale == 1.0:
            return str(value)
        value = self.scale * value
        return style.plain(value) if value == 0 or abs(value) >= LEAST_PLAIN else style.power(value)


QUANTITIES = {
    name: Quantity(**keys) for name, keys in read_toml(Path(__file__).with_suffix(".toml")).items()
}

# The axes of the main chart, by the name of the Point's field; the first one is shown first.
COSTS = ("simulated", "step", "equilibrium")
FIGURES = ("max", "profile", "rms")
# The columns of the table of all runs, after the errors: attributes of a Run.
RUN_NUMBERS = """
hourglass_energy_ratio stable_step mean_step operations ns check_ns simulated evaluations
equilibrium steps motion residual
""".split()
