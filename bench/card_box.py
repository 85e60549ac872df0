"""A box of cubes in motion on an NVIDIA card: arrays, which kernels there set up, and steps."""

import array
import ctypes

from common.errors import InputError

EDGE, STEP = 0.01, 5e-4  # of cubes, m; s
VELOCITY, DENSITY = (0.1, 0.05, -0.1), 1000.0  # m/s, kg/m^3
REALS = {"float": ("f", ctypes.c_float), "double": ("d", ctypes.c_double)}
FORCE = "tl_perturbation_force"

# Sets up the arrays of a box with n cubes along an edge: nodes and elements in order, x first. Node
# i of an edge has begin(i) elements before it and own(i) around it.
SET_UP = """
extern "C" __device__ int own(int i, int n) { return i == 0 || i == n ? 1 : 2; }
extern "C" __device__ int begin(int i) { return i == 0 ? 0 : 2 * i - 1; }

extern "C" __global__ void set_up_elements(long long count, int n, const REAL* one, int numbers,
                                           REAL* constants, int* places) {
  const long long e = blockIdx.x * (long long)blockDim.x + threadIdx.x;
  if (e >= count) return;
  const int x = e % n, y = e / n % n, z = e / n / n;
  for (int k = 0; k < numbers; ++k) constants[k * count + e] = one[k];
  for (int I = 0; I < 8; ++I) {
    const int i = x + (I % 4 == 1 || I % 4 == 2), j = y + (I % 4 > 1), k = z + I / 4;
    places[I * count + e] = 4 * (i + (n + 1) * (j + (n + 1) * k));
  }
}

extern "C" __global__ void set_up_nodes(long long count, int n, REAL mass, const REAL* v,
                                        int* first, int* slots, int* first_constraint,
                                        int* components, int* angles, REAL* inverse_mass,
                                        REAL* increment) {
  const long long node = blockIdx.x * (long long)blockDim.x + threadIdx.x;
  if (node > count) return;
  const long long elements = (long long)n * n * n, foot = (n + 1) * (n + 1);
  first_constraint[node] = 3 * (node < foot ? node : foot);
  if (node == count) {
    first[node] = 8 * elements;
    return;
  }
  const int x = node % (n + 1), y = node / (n + 1) % (n + 1), z = node / (n + 1) / (n + 1);
  int slot = 4 * n * n * begin(z) + (2 * n * begin(y) + begin(x) * own(y, n)) * own(z, n);
  first[node] = slot;
  for (int k = z - 1; k <= z; ++k)
    for (int j = y - 1; j <= y; ++j)
      for (int i = x - 1; i <= x; ++i) {
        if (i < 0 || j < 0 || k < 0 || i == n || j == n || k == n) continue;
        const int right = x - i, back = y - j, above = z - k;
        const int corner = 4 * above + (back ? 3 - right : right);
        slots[slot++] = 3 * corner * elements + (i + (long long)n * (j + (long long)n * k));
      }
  inverse_mass[node] = 1 / (mass * own(x, n) * own(y, n) * own(z, n));
  for (int i = 0; i < 3; ++i) {
    if (node >= foot) increment[4 * node + i] = v[i];
    if (node < foot) components[3 * node + i] = i, angles[3 * node + i] = 4;
  }
}

extern "C" __global__ void triad(long long count, REAL* a, const REAL* b, const REAL* c) {
  const long long e = blockIdx.x * (long long)blockDim.x + threadIdx.x;
  if (e < count) a[e] = b[e] + REAL(0.5) * c[e];
}
"""


class Box:
    """A box with n cubes along an edge on a card, in motion."""

    def __init__(self, card, functions, precision, n, one):
        """one: the constants of a cube, an array of numbers."""
        self.card, self.n, self.precision = card, n, precision
        self.elements, self.nodes, self.constraints = n**3, (n + 1) ** 3, 3 * (n + 1) ** 2
        self.functions, self.numbers = functions, len(one)
        self._arrays = {}
        self._sizes = self._bytes_of_arrays(len(one))
        needed = sum(self._sizes.values())
        if needed > card.free_bytes():
            raise InputError(f"{needed / 1e9:.3g} GB are more than the card has free")
        for name, size in self._sizes.items():
            self._arrays[name] = card.zeros(size)
        self._write("one", one)
        self._write("v", self._numbers(VELOCITY))
        of = self._arrays.__getitem__
        self._launch(
            "set_up_elements", self.elements, n, of("one"), len(one), of("constants"), of("places")
        )
        names = ["first", "slots", "first_constraint", "components", "angles"]
        names += ["inverse_mass", "increment"]
        mass = REALS[precision][1](DENSITY * EDGE**3 / 8)
        self._launch(
            "set_up_nodes", self.nodes, n, mass, of("v"), *map(of, names), items=self.nodes + 1
        )
        # keep, -gain, no factors, one, 1 / step, nine for the angle of the path; see move_nodes.
        # Velocities are increments over a second at first.
        of_step = [1.0, 1.0 / STEP, *[0.0] * 9]
        self._write(
            "steps", self._numbers([STEP, -(STEP**2) / 2, *of_step, 1, -(STEP**2), *of_step])
        )

    def _numbers(self, values):
        return array.array(REALS[self.precision][0], values)

    def _write(self, name, numbers):
        self.card.write(self._arrays[name], numbers.tobytes())

    def _bytes_of_arrays(self, numbers):
        """The bytes of the arrays, by name."""
        real = ctypes.sizeof(REALS[self.precision][1])
        row, nodes, slots = 4 * real, self.nodes, 8 * self.elements
        of_constraint = {"components": 4, "angles": 4, "shares": 4 * real}
        of_constraint |= {name: real for name in ("reaction", "driving", "work")}
        sizes = {"one": numbers * real, "v": 3 * real, "steps": 26 * real, "none": 64}
        sizes |= {"constants": numbers * real * self.elements, "places": 4 * slots}
        sizes |= {"f": 24 * real * self.elements, "slots": 4 * slots}
        sizes |= {name: 4 * (nodes + 1) for name in ("first", "first_load", "first_constraint")}
        sizes |= {name: row * nodes for name in ("u", "increment", "force")}
        sizes |= {name: size * self.constraints for name, size in of_constraint.items()}
        return sizes | {"inverse_mass": real * nodes}

    def bytes_of_step(self):
        """What a step moves at least, each array once, as OpenClState::traffic_of counts it."""
        real = ctypes.sizeof(REALS[self.precision][1])
        row = 4 * real
        of_elements = self.elements * (24 * real + 8 * 4 + self.numbers * real) + self.nodes * row
        of_nodes = self.nodes * (3 * 4 + real + 4 * row) + 8 * self.elements * (4 + 3 * real)
        return of_elements + of_nodes + self.constraints * (2 * 4 + 9 * real)

    def _launch(self, name, count, *arguments, items=None):
        as_types = [ctypes.c_int(each) if isinstance(each, int) else each for each in arguments]
        self.card.launch(self.functions[name], items or count, ctypes.c_longlong(count), *as_types)

    def evaluate(self):
        """Queues the forces of elements."""
        of = self._arrays.__getitem__
        self._launch(FORCE, self.elements, of("places"), of("u"), of("constants"), of("f"))

    def move(self, after, to):
        """Queues the end of a step and the next one: where their numbers are, or -1."""
        of = self._arrays.__getitem__
        loads = [0, of("first_load"), *[of("none")] * 3]  # load_slots, load_factors and g are empty
        ends = ["components", "angles", "shares", "inverse_mass", "u", "increment", "force"]
        ends += ["none", "none", "reaction", "driving", "work"]
        gather = [of("steps"), self.elements, of("first"), of("slots"), of("f")]
        self._launch(
            "move_nodes",
            self.nodes,
            after,
            to,
            *gather,
            *loads,
            of("first_constraint"),
            *map(of, ends),
        )

    def start(self):
        """Takes the first step, from rest in the mesh and the initial velocities."""
        self.move(-1, 0)

    def steps(self, count):
        """Queues so many more steps."""
        for _ in range(count):
            self.evaluate()
            self.move(13, 13)

    def end(self):
        """Ends the last step: the reactions are those of its end."""
        self.evaluate()
        self.move(13, -1)

    def bytes_of(self, name):
        """The bytes of an array."""
        return self.card.read(self._arrays[name], self._sizes[name])

    def values(self, name):
        """The numbers of an array."""
        numbers = array.array(REALS[self.precision][0])
        numbers.frombytes(self.bytes_of(name))
        return numbers

    def displacements(self):
        """Of all nodes (m), components of a node after each other."""
        rows = self.values("u")
        return [rows[4 * node + i] for node in range(self.nodes) for i in range(3)]

    def release(self):
        """Gives the memory back."""
        for each in self._arrays.values():
            self.card.release(each)
