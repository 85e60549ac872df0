"""What each number of the page is: one list, from which axes, heads and their table are made.

A number has one name, unit and definition wherever it is shown, and one command that makes it.
"""

from dataclasses import dataclass

from sandglass_report import style

VERIFY = "sandglass verify --json build/verdicts.json"
LEAST_PLAIN = 1e-3  # smaller values are written with a power of ten
FLOPS = "sandglass flops --json build/flops.json"


@dataclass(frozen=True)
class Quantity:
    """A number of the page. name: in axes and prose; head: of a column of a table.

    unit: of its values where they are shown as plain numbers, empty if each states its own.
    field: where it is in the file that the command writes.
    """

    name: str
    head: str
    unit: str
    definition: str
    field: str
    command: str = VERIFY
    scale: float = 1.0  # from the stored value, in SI units or a fraction, to the unit

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
    "simulated": Quantity(
        "wall time per simulated second",
        "per simulated second",
        "s",
        "Wall time that one thread takes for a second of simulated time: the time of a step of "
        "the whole mesh with its checks, over the mean step of the case’s own damped motion with "
        "this method. Below 1 s it keeps up with real time. A condensed method has no steps: it "
        "computes a thousand answers.",
        "seconds_per_simulated_second",
    ),
    "step": Quantity(
        "wall time per step of the whole mesh",
        "per step",
        "s",
        "Wall time per element and step, times the elements of the mesh.",
        "ns_per_element_step × elements",
    ),
    "equilibrium": Quantity(
        "wall time to equilibrium",
        "to equilibrium",
        "s",
        "Wall time of the search for static equilibrium, including multigrid cycles, while other "
        "runs shared the machine; quasi-static cases only. For another program it includes set-up.",
        "equilibrium_seconds",
    ),
    "ns": Quantity(
        "wall time per element and step",
        "per element and step",
        "ns",
        "Median over batches of explicit steps on the case’s own mesh, all methods in turn, one "
        "thread; bars span the middle half of the batches.",
        "ns_per_element_step, ns_lower_quartile, ns_upper_quartile",
    ),
    "check_ns": Quantity(
        "wall time of checks per element and step",
        "checks",
        "ns",
        "Every few steps a run checks that the body is valid and how long the next steps may be; "
        "this is the time of a check, divided by the elements and the steps between checks.",
        "check_ns_per_element_step",
    ),
    "mean_step": Quantity(
        "mean step of the motion",
        "mean step",
        "ms",
        "Simulated time over number of steps, in the case’s own damped motion with this method.",
        "mean_step_seconds",
        scale=1000.0,
    ),
    "stable_step": Quantity(
        "undeformed stable step",
        "undeformed step",
        "ms",
        "The longest stable step of central differences in the undeformed shape.",
        "stable_step",
        scale=1000.0,
    ),
    "evaluations": Quantity(
        "evaluations of the search",
        "evaluations",
        "",
        "How often the search for equilibrium evaluated the forces of the whole mesh.",
        "evaluations",
    ),
    "motion": Quantity(
        "wall time of the motion",
        "motion",
        "s",
        "Wall time of the whole motion; dynamic cases only.",
        "motion_seconds",
    ),
    "steps": Quantity(
        "steps of the motion",
        "steps",
        "",
        "Explicit steps of the whole motion.",
        "steps",
    ),
    "operations": Quantity(
        "operations per element and step",
        "operations",
        "",
        "Additions, multiplications, divisions and other operations of an element in one step, "
        "counted by running the kernel with a counting number type.",
        "operations",
    ),
    "max": Quantity(
        "largest error over all nodes",
        "max",
        "%",
        "The largest distance of a node from its position in the reference, over the largest "
        "imposed displacement; in a motion, the largest over time.",
        "max_relative_error",
        scale=100.0,
    ),
    "profile": Quantity(
        "largest error on the profile line",
        "profile",
        "%",
        "The same, over the nodes of the case’s profile line.",
        "profile_relative_error",
        scale=100.0,
    ),
    "rms": Quantity(
        "root mean square error",
        "rms",
        "%",
        "The root mean square of these distances over all nodes.",
        "rms_relative_error",
        scale=100.0,
    ),
    "hourglass_energy_ratio": Quantity(
        "hourglass energy over strain energy",
        "hourglass",
        "%",
        "The energy in the hourglass control over the strain energy of the answer.",
        "hourglass_energy_ratio",
        scale=100.0,
    ),
    "residual": Quantity(
        "residual",
        "residual",
        "",
        "The unbalanced force over the reaction where the search ended.",
        "residual",
    ),
    "kappa": Quantity(
        "hourglass stiffness κ",
        "κ",
        "",
        "The factor of the perturbation’s hourglass stiffness; auto is the value from the "
        "material.",
        "kappa",
    ),
    "control": Quantity(
        "operations of the hourglass control",
        "the control",
        "",
        "The operations that the hourglass control needs: as the paper writes it, and as the "
        "kernel runs it.",
        "total, of part hourglass in form paper or kernel",
        FLOPS,
    ),
    "times_ours": Quantity(
        "times as long as Sandglass",
        "×",
        "",
        "The time of another program for a step, a simulated second or the equilibrium, over the "
        "time of the closest method of Sandglass on the same machine.",
        "ns_per_element_step, time_step, seconds_to_rest",
        "results/submit.py",
    ),
    "golden_to_truth": Quantity(
        "distance of the golden from the truth",
        "golden to truth",
        "%",
        "The golden’s error to the truth, computed from the two stored answers for this page.",
        "displacement",
        "reference/regenerate",
        scale=100.0,
    ),
    "truths_error": Quantity(
        "the truth’s own error",
        "truth’s own error",
        "%",
        "An estimate from truths on two meshes.",
        "discretisation_error_max, discretisation_error_rms",
        "reference/regenerate",
        scale=100.0,
    ),
    "ratio": Quantity(
        "computed over published",
        "ratio",
        "",
        "The computed displacement of a set over the published value, or over the truth’s.",
        "ratio, ratio_to_truth",
    ),
    "distance": Quantity(
        "distance from the published value",
        "distance",
        "%",
        "The difference between computed and published value, over the published value.",
        "ratio",
        scale=100.0,
    ),
    "map": Quantity(
        "error in a cell of a failure map",
        "error",
        "%",
        "The largest error over all nodes to the golden’s element, both with the properties of "
        "that cell.",
        "symptoms.error",
        "sandglass stability CASE --json build/stability/CASE.json",
        scale=100.0,
    ),
    "growth": Quantity(
        "seconds and evaluations to equilibrium",
        "seconds",
        "s",
        "Wall time from the model to equilibrium, and evaluations of Sandglass or iterations of "
        "Newton’s method, over the number of elements; one thread.",
        "seconds, evaluations, iterations",
        "bench/growth.py --json reports/figures/growth.json",
    ),
    "refinement": Quantity(
        "error to the truth over time",
        "error",
        "%",
        "Error to the stored truth at the nodes of the case’s own mesh, over wall time from the "
        "model to equilibrium.",
        "error_max, error_rms, seconds",
        "bench/refinement.py --json reports/figures/refinement.json",
        scale=100.0,
    ),
}

# The axes of the main chart, by the name of the Point's field; the first one is shown first.
COSTS = ("simulated", "step", "equilibrium")
FIGURES = ("max", "profile", "rms")
# The columns of the table of all runs, after the errors: attributes of a Run.
RUN_NUMBERS = (
    "hourglass_energy_ratio",
    "stable_step",
    "mean_step",
    "operations",
    "ns",
    "check_ns",
    "simulated",
    "evaluations",
    "equilibrium",
    "steps",
    "motion",
    "residual",
)
