#include "derivatives.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/names.hpp"
#include "copied.hpp"

namespace py = pybind11;

namespace sandglass {
namespace {

void require_finite(const char* argument, const std::string& name, double value) {
  if (!std::isfinite(value)) throw InputError(fmt::format("{}: '{}' must be finite", argument, name));
}

/// The arrays of `sg.Gradient`; None for those that the answer does not have.
py::dict named(const Gradient& found, const Materials& materials) {
  const auto& [parameters, scales] = found.by_elements;
  py::list laws;
  for (std::size_t m = 0; m < parameters.size(); ++m) {
    const auto names = parameter_names(materials.list[m].law);
    py::dict own;
    for (std::size_t k = 0; k < names.size(); ++k) own[py::str(names[k])] = parameters[m][k];
    laws.append(own);
  }
  const auto array = [](const NodalField& f) { return f.empty() ? py::none() : py::object(field(f)); };
  const bool motion = !found.velocities.empty();
  py::dict all;
  all["materials"] = laws.empty() ? py::object(py::none()) : py::tuple(laws);
  all["stiffness"] = numbers(scales);
  all["forces"] = field(found.forces);
  all["imposed"] = field(found.imposed);
  all["points"] = array(found.points);
  all["velocities"] = array(found.velocities);
  all["damping"] = motion ? py::object(py::float_(found.damping)) : py::none();
  return all;
}

}  // namespace

py::dict gradient(const Model& model, const TakenSteps& steps, const std::vector<Frame>& frames,
                  const py::object& displacements, const Wanted& wanted) {
  require_differentiable_motion(model);
  const std::size_t nodes = model.scene().mesh.points.size();
  std::map<std::size_t, NodalField> of_u;
  std::size_t last = 0;
  if (!displacements.is_none()) {
    const py::array given = py::array::ensure(displacements);
    if (!given) throw py::error_already_set();
    if (given.ndim() != 3 || given.shape(0) != static_cast<py::ssize_t>(frames.size())) {
      throw InputError(fmt::format("displacement must have the shape ({}, {}, 3), but has {}", frames.size(),
                                   nodes, py::str(given.attr("shape")).cast<std::string>()));
    }
    for (std::size_t k = 0; k < frames.size(); ++k) {
      NodalField of_frame = nodal_field("displacement", given[py::int_(k)], nodes);
      if (std::ranges::all_of(of_frame, [](const Vector& row) { return row == Vector{}; })) continue;
      of_u[steps.until(frames[k].time)] = std::move(of_frame);
      last = k;
    }
  }
  const py::gil_scoped_release others;
  const Gradient found = gradient_of_motion(model, steps.all(), of_u, frames[last].u, wanted);
  const py::gil_scoped_acquire again;
  return named(found, model.scene().materials);
}

NodalField nodal_field(const char* name, const py::object& given, std::size_t nodes) {
  if (given.is_none()) return {};
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const py::array any = py::array::ensure(given);
  if (!any) PyErr_Clear();
  if (!any || std::string_view("iuf").find(any.dtype().kind()) == std::string_view::npos)
    throw py::type_error(std::string(name) + " must be an array of numbers");
  const Doubles array(any);
  const bool fits =
      array.ndim() == 2 && array.shape(1) == 3 && array.shape(0) == static_cast<py::ssize_t>(nodes);
  if (!fits) {
    throw InputError(std::string(name) + " must have the shape (" + std::to_string(nodes) + ", 3), but has " +
                     py::str(array.attr("shape")).cast<std::string>());
  }
  const double* const first = array.data();
  if (!std::all_of(first, first + 3 * nodes, [](double x) { return std::isfinite(x); }))
    throw InputError(std::string(name) + " must be finite");
  NodalField field(nodes);
  std::copy(first, first + 3 * nodes, field.data()->data());
  return field;
}

template <class Use>
auto Derivatives::with_tangent(const Use& use) {
  const py::gil_scoped_release others;
  const std::lock_guard alone(busy_);
  if (!tangent_) {
    require_differentiable(model_, answer_);
    tangent_.emplace(model_, answer_.u, levels_);
  }
  return use(*tangent_);
}

py::dict Derivatives::gradient(const py::object& displacements,
                               const std::map<std::string, Vector>& reactions, const Wanted& wanted) {
  const std::size_t nodes = scene().mesh.points.size();
  NodalField of_u = nodal_field("displacement", displacements, nodes);
  of_u.resize(nodes);
  const NodalField of_R = of_reactions(reactions);
  const Gradient found =
      with_tangent([&](StaticTangent& tangent) { return sandglass::gradient(tangent, of_u, of_R, wanted); });
  return named(found, scene().materials);
}

py::array Derivatives::sensitivity(const std::vector<std::map<std::string, double>>& materials,
                                   const py::object& forces, const py::object& imposed) {
  const std::size_t nodes = scene().mesh.points.size();
  const Perturbation along{parameters(materials), nodal_field("forces", forces, nodes),
                           nodal_field("imposed", imposed, nodes)};
  return field(with_tangent([&](StaticTangent& tangent) { return change_of_displacements(tangent, along); }));
}

NodalField Derivatives::of_reactions(const std::map<std::string, Vector>& reactions) const {
  NodalField all(scene().mesh.points.size());
  for (const auto& [name, weights] : reactions) {
    for (const double weight : weights) require_finite("reactions", name, weight);
    bool known = false;
    for (const DrivenSet& set : scene().driven) {
      if (set.name != name) continue;
      known = true;
      for (const std::size_t k : set.constraints) {
        const Constraint& c = scene().constraints[k];
        all[at(c.node)][at(c.component)] += weights[at(c.component)];
      }
    }
    if (known) continue;
    std::vector<std::string> names;
    for (const DrivenSet& set : scene().driven) names.push_back(set.name);
    throw InputError(
        fmt::format("reactions: '{}' is no driven set; allowed: {}", name, fmt::join(names, ", ")));
  }
  return all;
}

std::vector<std::vector<double>> Derivatives::parameters(
    const std::vector<std::map<std::string, double>>& materials) const {
  if (materials.empty()) return {};
  const auto& list = scene().materials.list;
  if (materials.size() != list.size()) {
    throw InputError(fmt::format("materials: {} were given; it must be one for each of the {} of the body",
                                 materials.size(), list.size()));
  }
  std::vector<std::vector<double>> all;
  for (std::size_t m = 0; m < list.size(); ++m) {
    const auto names = parameter_names(list[m].law);
    all.emplace_back(names.size(), 0.0);
    for (const auto& [name, change] : materials[m]) {
      require_parameter(list[m].law, name, "materials");
      const auto place = std::find(names.begin(), names.end(), name);
      require_finite("materials", name, change);
      all.back()[static_cast<std::size_t>(place - names.begin())] = change;
    }
  }
  return all;
}

}  // namespace sandglass
