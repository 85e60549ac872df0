"""Sandglass, an explicit solver for soft solids: arrays in, arrays out.

`Body` takes a mesh, a material and loads; `Body.solve` returns a `Solution`. `Simulation` steps a
body by hand. `choose`, `verify`, `score` and others are the commands of the program. Laws,
generators, loads and settings are classes with the parameters of the case file:
`help(sandglass.NeoHookean)` lists them, and `sandglass.tables.CLASSES` has them all.
"""

import _sandglass
from _sandglass import ComputationError, InputError, Simulation, __version__
from sandglass import commands, tables
from sandglass.batch import Batch
from sandglass.body import Body
from sandglass.commands import *  # noqa: F401, F403
from sandglass.gradient import Gradient
from sandglass.mesh import Mesh
from sandglass.solution import Solution
from sandglass.tables import *  # noqa: F401, F403

InputError.__doc__ = "Wrong arguments: the message names argument, value and rule."
ComputationError.__doc__ = (
    "A failed computation: the message names the time, the elements or the load."
)
for _each in (ComputationError, InputError, Simulation):
    _each.__module__ = "sandglass"

__all__ = [
    "Batch",
    "Body",
    "ComputationError",
    "Gradient",
    "InputError",
    "Mesh",
    "Simulation",
    "Solution",
    "__version__",
    "tables",
    *commands.__all__,
    *tables.__all__,
]
del _each, _sandglass
