"""The programs that bench/peers.py times. A new one is a module here and an entry in PROGRAMS."""

from rivals.calculix import CalculiX
from rivals.febio import FEBio
from rivals.fenicsx import FEniCSx
from rivals.niftysim import NiftySim
from rivals.openradioss import OpenRadioss

# By the names of their decks, or by their own.
PROGRAMS = {one.deck: one for one in (CalculiX, FEBio, FEniCSx, NiftySim, OpenRadioss)}
