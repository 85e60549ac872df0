#include <limits>

#include "answer.hpp"
#include "arguments.hpp"
#include "batches.hpp"
#include "commands.hpp"
#include "commands/execution_options.hpp"
#include "either_precision.hpp"
#include "sandglass/simulation.hpp"

namespace py = pybind11;

namespace sandglass {
namespace {

using Vector = std::array<double, 3>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

using AnySimulation = EitherPrecision<Simulation>;

std::unique_ptr<AnySimulation> copy(AnySimulation& self) {
  return self.with([](const auto& simulation) { return std::make_unique<AnySimulation>(simulation); });
}

py::ssize_t signed_size(std::size_t size) {
  return static_cast<py::ssize_t>(size);
}

/// A read-only view of numbers of a simulation, which keeps it alive: `rows` rows, `stride` numbers apart; of
/// one dimension if `width` is one.
template <class Number>
py::array view(const py::object& owner, const Number* data, std::size_t rows, std::size_t width,
               std::size_t stride) {
  std::vector<py::ssize_t> shape{signed_size(rows), signed_size(width)};
  std::vector<py::ssize_t> strides{signed_size(stride * sizeof(Number)), sizeof(Number)};
  if (width == 1) {
    shape.pop_back();
    strides.pop_back();
  }
  py::array array(py::dtype::of<Number>(), std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A view of `get(simulation)`, a span of rows or of numbers.
template <class Number, std::size_t width, class Get>
py::array view_of(const py::object& self, const Get& get) {
  return self.cast<AnySimulation&>().with([&](const auto& simulation) {
    const auto rows = get(simulation);
    return view(self, reinterpret_cast<const Number*>(rows.data()), rows.size(), width, width);
  });
}

py::array displacements(const py::object& self) {
  return self.cast<AnySimulation&>().with([&](const auto& simulation) {
    const auto u = simulation.displacements();
    return view(self, u.data, u.rows, 3, u.stride);
  });
}

using Arrays = std::map<std::string, py::object>;

/// A dict from names to arrays.
Arrays arrays(const char* name, const py::object& given) {
  try {
    return given.cast<Arrays>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + " must be a dict from names to arrays");
  }
}

/// Anything that NumPy takes for an array.
py::array array_of(const std::string& name, const py::object& object) {
  if (py::array array = py::array::ensure(object)) return array;
  throw py::type_error(name + " must be an array, but is a " +
                       py::str(py::type::of(object).attr("__name__")).cast<std::string>());
}

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

void require_shape(bool right, const std::string& name, const py::array& array, const char* shape) {
  if (!right) throw InputError(name + " must have the shape " + shape + ", but has " + shape_of(array));
}

/// Throws a TypeError unless the entries are of one of the kinds of NumPy: "i", "u" or "f".
void require_kind(const std::string& name, const py::array& array, std::string_view kinds, const char* rule) {
  if (kinds.find(array.dtype().kind()) != std::string_view::npos || array.size() == 0) return;
  throw py::type_error(name + " must be an array of " + rule + ", but has the dtype " +
                       py::str(array.dtype()).cast<std::string>());
}

Doubles real(const std::string& name, const py::object& object) {
  const py::array array = array_of(name, object);
  require_kind(name, array, "iuf", "numbers");
  return array;
}

Integers whole(const std::string& name, const py::object& object) {
  const py::array array = array_of(name, object);
  require_kind(name, array, "iu", "integers");
  return array;
}

double number_of(const std::string& /*name*/, double number) {
  return number;
}
int number_of(const std::string& name, std::int64_t node) {
  if (node >= 0 && node <= std::numeric_limits<int>::max()) return static_cast<int>(node);
  throw InputError(name + ": " + std::to_string(node) + " is not a node number");
}

/// The rows of an array of shape (n, width).
template <class Row, class T, int flags>
std::vector<Row> rows_of(const std::string& name, const py::array_t<T, flags>& array, const char* shape) {
  require_shape(array.ndim() == 2 && array.shape(1) == signed_size(std::tuple_size_v<Row>), name, array,
                shape);
  std::vector<Row> rows(static_cast<std::size_t>(array.shape(0)));
  const T* entry = array.data();
  for (Row& row : rows) {
    for (auto& number : row) number = number_of(name, *entry++);
  }
  return rows;
}

/// The entries of the arrays of sets, which are called `kind` in messages.
std::map<std::string, std::vector<int>> sets_of(const char* kind, const Arrays& arrays) {
  std::map<std::string, std::vector<int>> sets;
  for (const auto& [name, members] : arrays) {
    const std::string title = std::string(kind) + " '" + name + "'";
    const Integers numbers = whole(title, members);
    require_shape(numbers.ndim() == 1, title, members, "(n,)");
    auto& set = sets[name];
    for (py::ssize_t k = 0; k < numbers.size(); ++k) set.push_back(number_of(title, numbers.at(k)));
  }
  return sets;
}

/// The arguments of a method, of which one has this name.
Arguments named(const char* name, const py::object& value) {
  py::dict given;
  given[name] = value;
  return Arguments(given);
}

void move(AnySimulation& self, const py::object& set_name, const py::object& given) {
  const std::string set = named("set", set_name).text("set");
  const Doubles displacement = real("displacement", given);
  self.with([&](auto& simulation) {
    if (displacement.ndim() == 1 && displacement.size() == 3) {
      simulation.move(set, Vector{displacement.at(0), displacement.at(1), displacement.at(2)});
    } else {
      simulation.move(set, rows_of<Vector>("displacement", displacement, "(3,) or (nodes of the set, 3)"));
    }
  });
}

/// Precision and settings from keywords; the first throws TypeError for a keyword that is none.
Arguments with_defaults(const py::kwargs& given) {
  using namespace pybind11::literals;
  py::dict all("precision"_a = "double", "method"_a = py::none(), "kappa"_a = py::none(),
               "damping"_a = py::none(), "step_fraction"_a = py::none(), "threads"_a = 1, "device"_a = "cpu");
  for (const auto& [name, value] : given) {
    if (!all.contains(name)) {
      throw py::type_error(py::str(name).cast<std::string>() +
                           " is not a setting of a simulation; allowed: " +
                           py::str(", ").attr("join")(all).cast<std::string>());
    }
    all[name] = value;
  }
  return Arguments(all);
}

SimulationSettings settings(const Arguments& given) {
  const int threads = given.integer("threads");
  require_count("threads", threads, 1024);
  return {given.optional("method", &Arguments::text),
          given.optional("kappa", &Arguments::number),
          given.optional("damping", &Arguments::number),
          given.optional("step_fraction", &Arguments::number),
          threads,
          given.text("device")};
}

std::unique_ptr<AnySimulation> of_file(const py::object& case_file, const py::kwargs& keywords) {
  const std::filesystem::path file = named("case", case_file).path("case");
  const Arguments given = with_defaults(keywords);
  return std::make_unique<AnySimulation>(given.text("precision"), file, settings(given));
}

std::unique_ptr<AnySimulation> of_mesh(const py::object& points, const py::object& cells,
                                       const py::object& sets, const py::object& case_text,
                                       const py::object& element_sets, const py::kwargs& keywords) {
  const Arguments given = with_defaults(keywords);
  return std::make_unique<AnySimulation>(
      given.text("precision"),
      mesh_arrays(points, cells, arrays("sets", sets), arrays("element_sets", element_sets)),
      named("case_text", case_text).text("case_text"), settings(given));
}

constexpr const char* about_simulation =
    R"(A moving body that can be driven, advanced and inspected step by step.

    simulation = sandglass.Simulation("my-beam.toml", precision="float", damping=20.0)
    u = simulation.displacements
    simulation.move("moved", (0.03, 0, 0))
    simulation.advance(1 / 60)

The case file is one for `sandglass run`; the body starts undeformed, at rest or with the case's initial velocities.
Keywords: `precision`, "double" or "float"; `method`, `kappa`, `damping` (1/s) and `step_fraction`, the longest step over
the stable one, override the case's; a `time_step` of the case is the longest step; `threads` (1); `device="opencl"`
takes the steps on another processor, where the body stays between calls. Arrays are read-only views of the simulation's
own: they show its current state and keep it alive. Only one thread may use it at a time; `advance` releases the GIL.)";

constexpr const char* about_mesh =
    R"(A simulation on the given mesh.

`points` (n, 3) in m, `cells` (m, 8) in VTK order, `sets` a dict from names to nodes, `element_sets` one from names to
elements; `case_text` is the text of a case file without [mesh].)";

}  // namespace

MeshArrays mesh_arrays(const py::object& points, const py::object& cells, const Arrays& sets,
                       const Arrays& element_sets) {
  return {rows_of<Vector>("points", real("points", points), "(n, 3)"),
          rows_of<std::array<int, 8>>("cells", whole("cells", cells), "(m, 8)"), sets_of("set", sets),
          sets_of("element set", element_sets)};
}

}  // namespace sandglass

PYBIND11_MODULE(_sandglass, m) {
  using namespace sandglass;
  using namespace pybind11::literals;
  m.doc() = "Sandglass, an explicit solver for soft solids, step by step.";
  m.attr("__version__") = SANDGLASS_VERSION;

  py::register_exception<InputError>(m, "InputError", PyExc_ValueError);
  py::register_exception<ComputationError>(m, "ComputationError", PyExc_RuntimeError);

  add_answers(m);
  add_commands(m);
  add_batches(m);

  py::class_<AnySimulation>(m, "Simulation", about_simulation)
      .def(py::init(&of_file), "case"_a)
      .def_static("of_mesh", &of_mesh, about_mesh, "points"_a, "cells"_a, "sets"_a, "case_text"_a,
                  py::kw_only(), "element_sets"_a = py::dict())
      .def("move", &move, "set"_a, "displacement"_a,
           "Sets the position of the driven nodes of a set at the end of the next `advance`: one "
           "displacement (m) for all of them, or one row for each node of `nodes(set)`. Components "
           "that the case does not impose on the set stay as they are. With the name of an obstacle, "
           "its displacement in addition to its path in the case.")
      .def(
          "impose",
          [](AnySimulation& self, const py::object& given) {
            const double factor = named("factor", given).number("factor");
            self.with([&](auto& s) { s.impose(factor); });
          },
          "factor"_a,
          "Sets the position of all driven nodes at the end of the next `advance`: the case's "
          "displacements at a load factor, which is 1 at the end of the loading curve. The case's "
          "forces reach the same factor.")
      .def(
          "advance",
          [](AnySimulation& self, const py::object& given) {
            const double seconds = named("seconds", given).number("seconds");
            const py::gil_scoped_release others;
            self.with([&](auto& s) { s.advance(seconds); });
          },
          "seconds"_a,
          "Advances in time, in equal steps of at most `step_size`; driven nodes and forces change "
          "linearly to their new values. Raises ComputationError, which names the time and the elements, if "
          "elements are inverted or no longer finite; the body is then back in its last state that was "
          "found whole, at `time`, and may move elsewhere.")
      .def(
          "settle", [](AnySimulation& self) { return self.with([](auto& s) { return s.settle(); }); },
          py::call_guard<py::gil_scoped_release>(),
          "Moves the body to its static equilibrium with driven nodes and forces at their new values, and "
          "stops it there; the time stays. Returns the number of evaluations of the internal forces. "
          "Raises ComputationError if no equilibrium is found.")
      .def(
          "save_checkpoint",
          [](AnySimulation& self, const py::object& given) {
            const std::string file = named("file", given).path("file");
            self.with([&](const auto& s) { s.save(file); });
          },
          "file"_a,
          "Writes the state to a file, from which `resume` continues, also in another process. The file is "
          "replaced as a whole or not at all. Raises InputError or ComputationError if that fails.")
      .def(
          "resume",
          [](AnySimulation& self, const py::object& given) {
            const std::string file = named("file", given).path("file");
            self.with([&](auto& s) { s.resume(file); });
          },
          "file"_a,
          "Takes the state that `save_checkpoint` of a simulation of the same case, mesh and settings wrote; "
          "it continues with the same bits. Raises InputError for a damaged file and for one of another "
          "simulation, with the differences.")
      .def(
          "reaction",
          [](AnySimulation& self, const py::object& given) {
            const std::string set = named("set", given).text("set");
            return py::array_t<double>(py::cast(self.with([&](const auto& s) { return s.reaction(set); })));
          },
          "set"_a, "The force (N) that holds or drives a set of nodes, or of an obstacle on the body.")
      .def(
          "moment",
          [](AnySimulation& self, const py::object& given) {
            const std::string name = named("obstacle", given).text("obstacle");
            return py::array_t<double>(py::cast(self.with([&](const auto& s) { return s.moment(name); })));
          },
          "obstacle"_a,
          "The moment (N m) of the force of an obstacle on the body, about the obstacle's `point` where it "
          "is.")
      .def(
          "nodes",
          [](const py::object& self, const py::object& given) {
            const std::string set = named("set", given).text("set");
            return view_of<int, 1>(self, [&](const auto& s) { return s.nodes(set); });
          },
          "set"_a, "The nodes of a set, sorted.")
      .def("copy", &copy, "An independent copy.")
      .def_property_readonly(
          "displacements", &displacements,
          "Displacements (m), one row per node in the order of the time loop: node n is in row `rows[n]`, "
          "so displacements[rows] is a copy in node order.")
      .def_property_readonly(
          "rows",
          [](const py::object& self) {
            return view_of<int, 1>(self, [](const auto& s) { return s.row_of_node(); });
          },
          "The row of each node in `displacements`.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return view_of<double, 3>(self, [](const auto& s) { return s.points(); });
          },
          "The undeformed positions of the nodes (m), in the numbering of the mesh.")
      .def_property_readonly(
          "cells",
          [](const py::object& self) {
            return view_of<int, 8>(self, [](const auto& s) { return s.cells(); });
          },
          "The nodes of each hexahedron, in VTK order.")
      .def_property_readonly(
          "time", [](AnySimulation& self) { return self.with([](const auto& s) { return s.time(); }); },
          "The simulated time (s).")
      .def_property_readonly(
          "step_size",
          [](AnySimulation& self) { return self.with([](const auto& s) { return s.step_size(); }); },
          "The longest step allowed at present (s).");
}
