#include "batches.hpp"

#include <map>

#include "answer.hpp"
#include "arguments.hpp"
#include "commands/execution_options.hpp"
#include "copied.hpp"
#include "either_precision.hpp"
#include "sandglass/batch.hpp"

namespace py = pybind11;

namespace sandglass {
namespace {

using AnyBatch = EitherPrecision<Batch>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Arrays = std::map<std::string, py::object>;

template <class Use>
auto with(AnyBatch& batch, const Use& use) {
  return batch.with(use, "batch");
}

std::unique_ptr<AnyBatch> made(const py::object& points, const py::object& cells, const Arrays& sets,
                               const Arrays& element_sets, const std::string& text, const py::dict& given) {
  const Arguments arguments(given);
  const int bodies = arguments.integer("bodies"), threads = arguments.integer("threads");
  require_count("bodies", bodies, 1'000'000);
  require_count("threads", threads, 1024);
  const SimulationSettings settings{arguments.optional("method", &Arguments::text),
                                    arguments.optional("kappa", &Arguments::number),
                                    arguments.optional("damping", &Arguments::number),
                                    arguments.optional("step_fraction", &Arguments::number), threads};
  return std::make_unique<AnyBatch>(arguments.text("precision"),
                                    mesh_arrays(points, cells, sets, element_sets), text,
                                    static_cast<std::size_t>(bodies), settings);
}

/// Displacements (bodies, 3), or (bodies, nodes of the set, 3).
void move_bodies(AnyBatch& self, const std::string& set, const Doubles& displacements) {
  with(self, [&](auto& batch) {
    const auto* row = reinterpret_cast<const std::array<double, 3>*>(displacements.data());
    const auto each = displacements.ndim() == 3 ? static_cast<std::size_t>(displacements.shape(1)) : 0;
    for (std::size_t b = 0; b < batch.bodies(); ++b) {
      if (displacements.ndim() == 2) {
        batch.move(b, set, row[b]);
      } else {
        batch.move(b, set, std::span(row + b * each, each));
      }
    }
  });
}

/// Calls apply(batch, body, number) for each body.
template <class Apply>
void for_each_body(AnyBatch& self, const Doubles& numbers, const Apply& apply) {
  with(self, [&](auto& batch) {
    for (std::size_t b = 0; b < batch.bodies(); ++b) apply(batch, b, numbers.data()[b]);
  });
}

py::array displacements_of_bodies(AnyBatch& self) {
  return with(self, [](const auto& batch) {
    Doubles all(
        {static_cast<py::ssize_t>(batch.bodies()), static_cast<py::ssize_t>(batch.nodes()), py::ssize_t{3}});
    auto* row = reinterpret_cast<std::array<double, 3>*>(all.mutable_data());
    for (std::size_t b = 0; b < batch.bodies(); ++b) {
      for (std::size_t n = 0; n < batch.nodes(); ++n) *row++ = batch.displacement(b, n);
    }
    return py::array(all);
  });
}

py::array reactions_of_bodies(AnyBatch& self, const std::string& set) {
  return with(self, [&](const auto& batch) {
    std::vector<std::array<double, 3>> rows;
    for (std::size_t b = 0; b < batch.bodies(); ++b) rows.push_back(batch.reaction(b, set));
    return py::array(copied<double>(rows, {count(rows), 3}));
  });
}

}  // namespace

void add_batches(py::module_& m) {
  using namespace pybind11::literals;
  py::class_<AnyBatch>(m, "Batch", "Many bodies of one case; see sandglass.Batch.")
      .def(py::init(&made), "points"_a, "cells"_a, "sets"_a, "element_sets"_a, "case_text"_a, "arguments"_a)
      .def("move", &move_bodies, "set"_a, "displacements"_a, "Targets of driven nodes.")
      .def(
          "scale_stiffness",
          [](AnyBatch& self, const Doubles& factors) {
            for_each_body(self, factors,
                          [](auto& batch, std::size_t b, double f) { batch.scale_stiffness(b, f); });
          },
          "factors"_a, "Factors of all moduli.")
      .def(
          "set_parameters",
          [](AnyBatch& self, const std::vector<std::map<std::string, std::vector<double>>>& materials) {
            with(self, [&](auto& batch) { batch.set_parameters(materials); });
          },
          "materials"_a, py::call_guard<py::gil_scoped_release>(), "Parameters of laws.")
      .def(
          "impose",
          [](AnyBatch& self, const Doubles& factors) {
            for_each_body(self, factors, [](auto& batch, std::size_t b, double f) { batch.impose(b, f); });
          },
          "factors"_a, "Load factors.")
      .def(
          "advance",
          [](AnyBatch& self, double seconds) { with(self, [&](auto& batch) { batch.advance(seconds); }); },
          "seconds"_a, py::call_guard<py::gil_scoped_release>(), "Advances in time.")
      .def("displacements", &displacements_of_bodies, "Displacements, m, (bodies, nodes, 3).")
      .def("reactions", &reactions_of_bodies, "set"_a, "Reactions, N, (bodies, 3).")
      .def(
          "nodes",
          [](AnyBatch& self, const std::string& set) {
            return with(self, [&](const auto& batch) {
              const auto nodes = batch.nodes(set);
              return copied<int>(nodes, {count(nodes)});
            });
          },
          "set"_a, "The nodes of a set.")
      .def_property_readonly(
          "time", [](AnyBatch& self) { return with(self, [](const auto& batch) { return batch.time(); }); })
      .def_property_readonly("step_size", [](AnyBatch& self) {
        return with(self, [](const auto& batch) { return batch.step_size(); });
      });
}

}  // namespace sandglass
