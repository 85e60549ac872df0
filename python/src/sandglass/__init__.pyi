from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from types import SimpleNamespace
from typing import Any, Literal

from numpy import float64, int32
from numpy.typing import ArrayLike, NDArray

from sandglass import tables as tables
from sandglass.tables import *
from sandglass.tables import Table

__version__: str

_Doubles = NDArray[float64]
_Path = str | PathLike[str]
_Progress = bool | Callable[[float], object] | None
_Quantity = float | str
_Law = Table | Sequence[Table]
_Sets = Mapping[str, Any] | None  # arrays of members, or rules

class InputError(ValueError): ...
class ComputationError(RuntimeError): ...

class Mesh:
    points: _Doubles
    cells: NDArray[int32]
    sets: dict[str, NDArray[int32]]
    element_sets: dict[str, NDArray[int32]]
    def __init__(
        self,
        points: ArrayLike,
        cells: ArrayLike,
        sets: Mapping[str, ArrayLike] | None = ...,
        element_sets: Mapping[str, ArrayLike] | None = ...,
    ) -> None: ...
    @classmethod
    def read(cls, file: _Path, spacing: ArrayLike | None = ...) -> Mesh: ...
    @classmethod
    def of(cls, mesh: object) -> Mesh: ...
    @classmethod
    def of_meshio(cls, mesh: Any) -> Mesh: ...
    @classmethod
    def of_vtk(cls, grid: Any) -> Mesh: ...
    def save(self, file: _Path) -> None: ...

class Body:
    mesh: Mesh
    material: _Law
    tables: list[Table]
    sets: dict[str, Any]
    element_sets: dict[str, Any]
    name: str
    requirement: str
    def __init__(
        self,
        mesh: object,
        material: _Law,
        tables: Sequence[Table] = ...,
        *,
        sets: _Sets = ...,
        element_sets: _Sets = ...,
        name: str = ...,
        requirement: str = ...,
    ) -> None: ...
    @classmethod
    def read(cls, file: _Path) -> Body: ...
    @classmethod
    def of_toml(cls, text: str, mesh: object = ...) -> Body: ...
    def solve(
        self,
        *,
        threads: int = ...,
        device: str = ...,
        progress: _Progress = ...,
        sleep: _Quantity | None = ...,
        against: Literal["truth"] | None = ...,
        **method: float | str | None,
    ) -> Solution: ...
    def simulation(
        self,
        *,
        precision: Literal["double", "float"] = ...,
        method: str | None = ...,
        kappa: float | None = ...,
        damping: float | None = ...,
        step_fraction: float | None = ...,
        threads: int = ...,
        device: str = ...,
    ) -> Simulation: ...
    def batch(
        self,
        bodies: int,
        *,
        precision: Literal["double", "float"] = ...,
        method: str | None = ...,
        kappa: float | None = ...,
        damping: float | None = ...,
        step_fraction: float | None = ...,
        threads: int = ...,
    ) -> Batch: ...
    def save(self, file: _Path) -> None: ...

class Solution:
    name: str
    points: _Doubles
    cells: NDArray[int32]
    sets: dict[str, NDArray[int32]]
    element_sets: dict[str, NDArray[int32]]
    history: dict[str, _Doubles]
    summary: dict[str, float | str]
    def __init__(self, answer: Any, name: str, laws: Any) -> None: ...
    def __len__(self) -> int: ...
    def frame(self, number: int = ...) -> dict[str, Any]: ...
    @property
    def times(self) -> _Doubles: ...
    @property
    def displacements(self) -> _Doubles: ...
    @property
    def displacement(self) -> _Doubles: ...
    @property
    def velocity(self) -> _Doubles: ...
    @property
    def stress(self) -> _Doubles: ...
    @property
    def volume_ratio(self) -> _Doubles: ...
    @property
    def reactions(self) -> dict[str, _Doubles]: ...
    @property
    def energies(self) -> dict[str, float]: ...
    def estimate(self, against: Literal["golden", "truth"] = ...) -> tuple[float, float]: ...
    def gradient(
        self,
        displacement: ArrayLike | None = ...,
        reactions: Mapping[str, ArrayLike] | None = ...,
        *,
        materials: bool = ...,
        points: bool = ...,
    ) -> Gradient: ...
    def sensitivity(
        self,
        materials: Mapping[str, ArrayLike] | Sequence[Mapping[str, ArrayLike]] | None = ...,
        *,
        forces: ArrayLike | None = ...,
        imposed: ArrayLike | None = ...,
    ) -> _Doubles: ...
    def to_vtk(self, frame: int = ...) -> Any: ...
    def plot(
        self, field: str = ..., *, frame: int = ..., scale: float = ..., ax: Any = ...
    ) -> Any: ...
    def save(self, file: _Path) -> None: ...

class Gradient:
    materials: tuple[dict[str, Any], ...] | None
    stiffness: _Doubles
    forces: _Doubles
    imposed: _Doubles
    points: _Doubles | None
    velocities: _Doubles | None
    damping: float | None
    def __init__(
        self,
        materials: tuple[dict[str, Any], ...] | None,
        stiffness: _Doubles,
        forces: _Doubles,
        imposed: _Doubles,
        points: _Doubles | None,
        velocities: _Doubles | None = ...,
        damping: float | None = ...,
    ) -> None: ...

class Simulation:
    def __init__(
        self,
        case: _Path,
        *,
        precision: Literal["double", "float"] = ...,
        method: str | None = ...,
        kappa: float | None = ...,
        damping: float | None = ...,
        step_fraction: float | None = ...,
        threads: int = ...,
        device: str = ...,
    ) -> None: ...
    @staticmethod
    def of_mesh(
        points: ArrayLike,
        cells: ArrayLike,
        sets: Mapping[str, ArrayLike],
        case_text: str,
        *,
        precision: Literal["double", "float"] = ...,
        method: str | None = ...,
        kappa: float | None = ...,
        damping: float | None = ...,
        step_fraction: float | None = ...,
        threads: int = ...,
        device: str = ...,
        element_sets: Mapping[str, ArrayLike] = ...,
    ) -> Simulation: ...
    def move(self, set: str, displacement: ArrayLike) -> None: ...
    def impose(self, factor: float) -> None: ...
    def advance(self, seconds: float) -> None: ...
    def settle(self) -> int: ...
    def save_checkpoint(self, file: _Path) -> None: ...
    def resume(self, file: _Path) -> None: ...
    def reaction(self, set: str) -> _Doubles: ...
    def moment(self, obstacle: str) -> _Doubles: ...
    def nodes(self, set: str) -> NDArray[int32]: ...
    def copy(self) -> Simulation: ...
    @property
    def displacements(self) -> NDArray[Any]: ...
    @property
    def rows(self) -> NDArray[int32]: ...
    @property
    def points(self) -> _Doubles: ...
    @property
    def cells(self) -> NDArray[int32]: ...
    @property
    def time(self) -> float: ...
    @property
    def step_size(self) -> float: ...

_OfBodies = Mapping[str, ArrayLike] | Sequence[Mapping[str, ArrayLike]]

class Batch:
    bodies: int
    def __init__(self, batch: Any, bodies: int, laws: Any) -> None: ...
    def __len__(self) -> int: ...
    def scale_stiffness(self, factors: ArrayLike) -> None: ...
    def set_parameters(self, materials: _OfBodies) -> None: ...
    def impose(self, factors: ArrayLike) -> None: ...
    def move(self, set: str, displacements: ArrayLike) -> None: ...
    def advance(self, seconds: float) -> None: ...
    def run(
        self,
        seconds: float,
        frames: int,
        *,
        stiffness: ArrayLike | None = ...,
        materials: _OfBodies | None = ...,
        factors: ArrayLike | None = ...,
        driven: Mapping[str, ArrayLike] | None = ...,
    ) -> _Doubles: ...
    @property
    def displacements(self) -> _Doubles: ...
    def reaction(self, set: str) -> _Doubles: ...
    def nodes(self, set: str) -> NDArray[int32]: ...
    @property
    def time(self) -> float: ...
    @property
    def step_size(self) -> float: ...

class Record(SimpleNamespace): ...

_Case = Body | _Path

def cases() -> list[Record]: ...
def methods() -> list[Record]: ...
def axes() -> list[Record]: ...
def choose(
    case: _Case,
    *,
    tolerance: _Quantity = ...,
    against: Literal["golden", "truth"] | None = ...,
    realtime: bool = ...,
    budget: _Quantity | None = ...,
    methods: Sequence[str] = ...,
    threads: int = ...,
    all: bool = ...,
    progress: _Progress = ...,
) -> Record: ...
def verify(
    *cases: _Case,
    precision: Literal["double", "float"] = ...,
    device: str = ...,
    costs: bool = ...,
    threads: int = ...,
    results: _Path | None = ...,
    progress: _Progress = ...,
) -> Record: ...
def score(
    displacement: Solution | ArrayLike | _Path,
    case: _Case,
    *,
    name: str | None = ...,
    field: str = ...,
    tolerance: float = ...,
    progress: _Progress = ...,
) -> Record: ...
def estimate(
    answer: Solution | Body, *, against: Literal["golden", "truth"] = ...
) -> tuple[float, float]: ...
def flops() -> Record: ...
def kernels(
    method: str,
    case: _Case,
    *,
    dialect: str = ...,
    precision: Literal["double", "float"] | None = ...,
    material: int | None = ...,
    step: bool = ...,
    constants: _Path | None = ...,
) -> str: ...
def write_mesh(
    case: _Case,
    output: _Path,
    *,
    format: str = ...,
    deck: str = ...,
    element: str = ...,
    hourglass: float | None = ...,
) -> Record: ...
def stability(
    case: _Case,
    *,
    maps: Sequence[str] = ...,
    values: Sequence[str] = ...,
    methods: Sequence[str] = ...,
    folder: _Path | None = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Record: ...
def bench(
    *cases: _Case,
    rest: bool = ...,
    bodies: int | None = ...,
    elements: Sequence[int] = ...,
    cubes: Sequence[int] = ...,
    threads: Sequence[int] = ...,
    methods: Sequence[str] = ...,
    precision: Sequence[str] = ...,
    device: str = ...,
    repetitions: int | None = ...,
    progress: _Progress = ...,
) -> Record: ...
