"""A tool moves a set of nodes of a soft body, 60 frames per second, and feels the reaction.

    PYTHONPATH=build/release/python /usr/bin/python3 python/example.py CASE SET X Y Z

X Y Z is the final displacement (m), reached after one second.
"""

import sys

import numpy as np
import sandglass


def main(case, driven, *end):
    body = sandglass.Simulation(case, precision="float")
    u = body.displacements  # a view of the solver's array: always current
    end = np.array(end, dtype=float)
    for frame in range(1, 61):
        t = frame / 60
        body.move(driven, end * t**3 * (10 - 15 * t + 6 * t**2))
        body.advance(1 / 60)
        if frame % 10 == 0:
            largest = np.linalg.norm(u, axis=1).max()
            force = np.linalg.norm(body.reaction(driven))
            print(f"{body.time:.2f} s: largest displacement {largest:.4f} m, force {force:.4f} N")


if __name__ == "__main__":
    main(*sys.argv[1:])
