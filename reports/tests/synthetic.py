"""A tiny data set of the report's inputs: a box with two methods, a kappa curve and a failure."""

import json
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import h5py
import numpy as np

from make_report import main

HASHES = {"case_hash": "0123456789abcdef", "mesh_hash": "fedcba9876543210"}
CASE = Path(__file__).with_name("column.toml").read_text()
RECORDS = json.loads(Path(__file__).with_name("records.json").read_text())
UNIT = 0.5  # the length of the imposed displacement, m


def box(nx, ny, nz):
    """Points (n, 3) of a box of unit cubes, and its cells (m, 8) in VTK order."""
    x, y, z = np.meshgrid(range(nx + 1), range(ny + 1), range(nz + 1), indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()]).astype(float)
    number = np.arange(len(points)).reshape(nx + 1, ny + 1, nz + 1)
    ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cells = [
        [number[i + a, j + b, k + c] for c in (0, 1) for a, b in ring]
        for i in range(nx)
        for j in range(ny)
        for k in range(nz)
    ]
    return points, np.array(cells)


@dataclass
class DataSet:
    """Writes the inputs into a folder; fields and methods let a test spoil them."""

    folder: Path

    def __post_init__(self):
        self.points, self.cells = box(2, 2, 3)
        self.sets = {
            "bottom": np.flatnonzero(self.points[:, 2] == 0),
            "top": np.flatnonzero(self.points[:, 2] == 3),
            "edge": np.flatnonzero((self.points[:, 0] == 0) & (self.points[:, 1] == 0))[::-1],
        }
        self.answer = self.points[:, 2:] / 3 * np.array([0.3, 0.0, 0.4])
        for name in ("cases", "reference/golden", "reference/truth", "results"):
            (self.folder / name).mkdir(parents=True)
        (self.folder / "cases/column.toml").write_text(CASE, encoding="utf-8")
        self.write_reference("golden", self.answer)
        self.records = [
            self.run("tl-none", 0.2),
            self.run("tl-perturbation", 0.002, kappa=0.0065, auto=True),
            self.run("tl-perturbation", 0.004, kappa=0.02),
        ]
        failed = self.run("tl-full", 0.0) | {
            "status": "failed: <inverted>",
            "finding": "inverted",
            "golden": None,
        }
        (self.folder / "results/column.tl-full.h5").unlink()
        self.records.append(failed)
        self.published = []
        self.limits = [dict(RECORDS["limit"])]
        self.write_verdicts()

    def run(self, method, error, kappa=None, auto=False):
        """Writes a result file whose largest error is `error`; returns its record."""
        inner = (self.points[:, 2] > 0) & (self.points[:, 2] < 3)
        shift = np.where(inner & (self.points.sum(axis=1) % 2 == 0), error * UNIT, 0.0)
        u = self.answer + shift[:, None] * [1.0, 0.0, 0.0]
        suffix = "" if kappa is None or auto else f".{kappa!r}"
        with h5py.File(self.folder / f"results/column.{method}{suffix}.h5", "w") as file:
            file["mesh/points"], file["mesh/cells"] = self.points, self.cells
            for name, nodes in self.sets.items():
                file[f"mesh/sets/{name}"] = nodes
            file["frames/0000/displacement"] = np.zeros_like(u)
            file["frames/0001/displacement"] = u
            for key, value in HASHES.items():
                file.attrs[key] = np.bytes_(value)
        figures = {
            "max_relative_error": error,
            "profile_relative_error": error,
            "rms_relative_error": float(np.sqrt(np.mean((shift / UNIT) ** 2))),
        }
        second = 160e-9 * len(self.cells) / RECORDS["run"]["mean_step_seconds"]
        own = {"method": method, "kappa": kappa, "kappa_is_auto": auto, "golden": figures}
        return RECORDS["run"] | own | {"seconds_per_simulated_second": second}

    @staticmethod
    def tip(method, ratio, variant="short", status="ok", to_truth=None, programs=()):
        """A record of a run with a published value, -2, perhaps with values of other programs."""
        value = {"source": "a book", "ratio": ratio, "ratio_to_truth": to_truth, "published": -2.0}
        value |= {"set": "tip", "component": "z", "programs": list(programs)}
        value |= {"scatter": None, "of": "end", "golden": None}
        value["computed"] = None if ratio is None else -2.0 * ratio
        record = {"method": method, "kappa": None, "kappa_is_auto": False, "status": status}
        record |= {"equilibrium_seconds": 0.5, "motion_seconds": None}
        return record | {
            "finding": None,
            "family": "beam",
            "variants": [variant],
            "values": [value],
        }

    def write(self, name, document):
        """Writes a JSON file of another command; `name` may have a folder."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(json.dumps(document), encoding="utf-8")

    @staticmethod
    def row(method, seconds, error, **changed):
        """A row of `sandglass choose --all --json` on the case's own mesh, in double."""
        own = {"rung": f"{method} {changed}", "method": method, "seconds": seconds, "error": error}
        own["seconds_per_simulated_second"] = 1e3 * seconds
        return RECORDS["row"] | own | changed

    @staticmethod
    def choices(rows, reference="golden", tolerance=0.01, case="column"):
        """The document of `sandglass choose --all --json`."""
        return {
            "revision": "abc",
            "case": case,
            "tolerance": tolerance,
            "reference": {"name": reference},
            "rungs": rows,
        }

    @staticmethod
    def timing(method, ns, case="ellipsoid-indentation", elements=2200, **changed):
        """A record of `sandglass bench --json`."""
        second = 1e-9 * ns * elements / RECORDS["timing"]["mean_step_seconds"] if ns else None
        own = {"case": case, "elements": elements, "method": method, "ns_per_element_step": ns}
        return RECORDS["timing"] | own | {"seconds_per_simulated_second": second} | changed

    @staticmethod
    def count(method, total, part="hourglass", form="kernel"):
        """A record of `sandglass flops --json`."""
        return {"method": method, "law": "l", "form": form, "part": part, "total": total}

    def write_reference(self, kind, displacement, **attributes):
        """Writes a golden or truth for the case."""
        with h5py.File(self.folder / f"reference/{kind}/column.h5", "w") as file:
            file["displacement"] = displacement
            for key, value in (HASHES | attributes).items():
                file.attrs[key] = value

    def write_verdicts(self):
        """Writes verdicts.json from the records and limits as they are."""
        document = {"version": "0", "compiler": "none", "processor": "none", "revision": "abc"}
        document |= {"records": self.records, "limits": self.limits, "published": self.published}
        (self.folder / "verdicts.json").write_text(json.dumps(document), encoding="utf-8")

    def make(self):
        """Makes the page. Returns its text."""
        assert main(self.arguments) == 0
        return self.page.read_text(encoding="utf-8")

    @property
    def page(self):
        """The path of the page."""
        return self.folder / "report/index.html"

    @property
    def arguments(self):
        """The command line for these inputs."""
        return [
            f"--verdicts={self.folder}/verdicts.json",
            f"--results={self.folder}/results",
            f"--cases={self.folder}/cases",
            f"--reference={self.folder}/reference",
            f"--bench={self.folder}/bench.json",
            f"--flops={self.folder}/flops.json",
            f"--curves={self.folder}/curves",
            f"--maps={self.folder}/maps",
            f"--submissions={self.folder}/submissions",
            f"--kept-maps={self.folder}/kept-maps",
            f"--pictures={self.folder}/pictures",
            f"--claims={self.folder}/claims.toml",
            f"--mutants={self.folder}/RESULTS.md",
            f"--root={self.folder}",
            f"--output={self.page}",
        ]


class Axes:
    """Records the plotted data."""

    def __init__(self):
        self.lines = []

    def plot(self, x, y, *words, **options):
        self.lines.append((x, y))

    def __getattr__(self, name):
        return mock.MagicMock()
