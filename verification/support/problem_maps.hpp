#pragma once

#include <fmt/ranges.h>

#include <numbers>
#include <numeric>

#include "forces/formula.hpp"
#include "support/orderings.hpp"
#include "support/problem.hpp"
#include "support/random_hexahedra.hpp"

/// Problems derived from others, whose answers are known from theirs.
namespace sandglass::verification {

/// Another problem for the same body, and the position and units of its answer: displacements are `length` Q
/// u, those of node n belong to node `node_of[n]` of the first problem.
struct Mapped {
  Problem problem;
  Tensor<double> Q = identity<double>();
  std::vector<int> node_of = {};  ///< empty: nodes keep their numbers
  double length = 1.0, speed = 1.0, energy = 1.0;

  NodalField back(const NodalField& field, double unit) const {
    NodalField result(field.size());
    for (std::size_t n = 0; n < field.size(); ++n) {
      const Vector u = linear(transpose(Q), field[n]);
      for (std::size_t i = 0; i < 3; ++i) result[node(n)][i] = u[i] / unit;
    }
    return result;
  }

 private:
  std::size_t node(std::size_t n) const { return n < node_of.size() ? at(node_of[n]) : n; }
};

/// Turned or mirrored by Q about the origin, then moved. If single components are imposed, Q must map axes to
/// axes.
inline Mapped placed(Problem problem, const Tensor<double>& Q, const Vector& shift = {}) {
  const double handed = determinant(Q);
  const auto polar = [&](Vector& v) { v = linear(Q, v); };
  const auto axial = [&](Vector& v) {
    v = linear(Q, v);
    multiply(v, handed);
  };
  const auto place = [&](Vector& X) {
    polar(X);
    for (std::size_t i = 0; i < 3; ++i) X[i] += shift[i];
  };
  for (Vector& X : problem.mesh.points) place(X);
  if (handed < 0.0) {
    for (Hexahedron& c : problem.mesh.cells) c = {c[1], c[0], c[3], c[2], c[5], c[4], c[7], c[6]};
  }
  Case& d = problem.description;
  for (auto& imposed : d.displacements) {
    polar(imposed.value);
    const auto before = imposed.components;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (std::abs(Q(i, j)) > 0.9) imposed.components[at(i)] = before[at(j)];
      }
    }
  }
  for (auto& turned : d.rotations) {
    axial(turned.axis);
    if (turned.center) place(*turned.center);
    polar(turned.displacement);
  }
  for (auto& force : d.forces.of<DeadForce>()) {
    polar(force.total);
    axial(force.moment);
  }
  for (auto& gravity : d.forces.of<Gravity>()) polar(gravity.value);
  for (auto& start : d.velocities) {
    polar(start.value);
    axial(start.spin);
  }
  for (auto& material : d.materials) {
    if (auto* uniform = std::get_if<UniformFibres>(&material.fibres)) {
      polar(uniform->fibre);
      if (uniform->sheet) polar(*uniform->sheet);
    } else if (auto* listed = std::get_if<ListedFibres>(&material.fibres)) {
      for (Vector& fibre : listed->fibres) polar(fibre);
      for (Vector& sheet : listed->sheets) polar(sheet);
    }
  }
  return {std::move(problem), Q};
}

/// A permutation of 0 to n - 1.
inline std::vector<int> shuffled(std::size_t n, RandomGeometry& random) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = n; k > 1; --k)
    std::swap(order[k - 1], order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(k)))]);
  return order;
}

/// The sets after number n becomes place[n].
inline void renumber(std::map<std::string, std::vector<int>>& sets, const std::vector<int>& place) {
  for (auto& [name, members] : sets) {
    for (int& member : members) member = place[at(member)];
    std::sort(members.begin(), members.end());
  }
}

/// The same with nodes in another order.
inline Mapped with_other_node_numbers(Problem problem, RandomGeometry& random) {
  const std::vector<int> place = shuffled(problem.mesh.points.size(), random);
  Mapped mapped{std::move(problem)};
  mapped.node_of.resize(place.size());
  Mesh& mesh = mapped.problem.mesh;
  const NodalField points = mesh.points;
  for (std::size_t n = 0; n < place.size(); ++n) {
    mapped.node_of[at(place[n])] = static_cast<int>(n);
    mesh.points[at(place[n])] = points[n];
  }
  for (Hexahedron& cell : mesh.cells) {
    for (int& node : cell) node = place[at(node)];
  }
  renumber(mapped.problem.sets, place);
  return mapped;
}

/// The same with elements in another order.
inline Mapped with_other_cell_numbers(Problem problem, RandomGeometry& random) {
  const std::vector<int> place = shuffled(problem.mesh.cells.size(), random);
  const auto moved = [&](auto& values) {
    const auto before = values;
    for (std::size_t e = 0; e < before.size(); ++e) values[at(place[e])] = before[e];
  };
  moved(problem.mesh.cells);
  renumber(problem.element_sets, place);
  for (auto& material : problem.description.materials) {
    if (auto* listed = std::get_if<ListedFibres>(&material.fibres)) {
      moved(listed->fibres);
      moved(listed->sheets);
    }
  }
  return {std::move(problem)};
}

/// The same with each element's corners listed from another one on.
inline Mapped with_turned_corners(Problem problem, RandomGeometry& random) {
  const auto orderings = proper_orderings();
  for (Hexahedron& cell : problem.mesh.cells) {
    const auto& ordering = *std::next(orderings.begin(), static_cast<int>(random.uniform(0.0, 24.0)));
    const Hexahedron before = cell;
    for (std::size_t I = 0; I < 8; ++I) cell[I] = before[at(ordering[I])];
  }
  return {std::move(problem)};
}

/// In other units: a length of 1 becomes L, a time of 1 becomes T, a mass of 1 becomes M.
inline Mapped in_other_units(Problem problem, double L, double T, double M) {
  const double force = M * L / T / T, stress = force / L / L;
  for (Vector& X : problem.mesh.points) multiply(X, L);
  Case& d = problem.description;
  for (auto& imposed : d.displacements) multiply(imposed.value, L);
  for (auto& turned : d.rotations) {
    multiply(turned.displacement, L);
    if (turned.center) multiply(*turned.center, L);
  }
  for (auto& load : d.forces.of<DeadForce>()) {
    multiply(load.total, force);
    multiply(load.moment, force * L);
  }
  for (auto& load : d.forces.of<Pressure>()) load.value *= stress;
  for (auto& load : d.forces.of<Gravity>()) multiply(load.value, L / T / T);
  for (auto& support : d.forces.of<Support>()) {
    support.stiffness *= stress / L;
    support.damping *= stress / L * T;
  }
  for (auto& start : d.velocities) {
    multiply(start.value, L / T);
    multiply(start.spin, 1.0 / T);
  }
  for (auto& material : d.materials) {
    material.density *= M / L / L / L;
    std::visit(
        [&]<class Law>(Law& law) {
          const auto change = [&](const auto& key) {
            law.*key.member *= key.unit == "Pa" ? stress : key.unit == "s" ? T : 1.0;
          };
          std::apply([&](const auto&... key) { (change(key), ...); }, Law::parameters());
        },
        material.law);
  }
  if (!d.quasi_static) {
    for_each_curve(d, [&](LoadCurve& curve) { multiply(curve.times, T); });
  }
  for (double* time : {&d.dynamics.duration, &d.dynamics.time_step, &d.dynamics.ramp_time}) *time *= T;
  d.dynamics.damping /= T;
  Mapped mapped{std::move(problem)};
  mapped.length = L;
  mapped.speed = L / T;
  mapped.energy = force * L;
  return mapped;
}

/// With one of the materials split into two equal ones; none if it has only one element.
inline std::optional<Mapped> with_a_split_material(Problem problem, RandomGeometry& random) {
  auto& materials = problem.description.materials;
  const std::size_t k = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(materials.size())));
  const auto of_element = problem.scene().materials.of_element;
  const bool refined = !problem.description.refinements.empty();
  std::vector<int> members;
  if (!materials[k].elements.empty()) {
    members = problem.element_sets.at(materials[k].elements);
  } else {
    if (refined && materials.size() > 1) return std::nullopt;  // of_element is that of the parts
    for (std::size_t e = 0; e < problem.mesh.cells.size(); ++e) {
      if (of_element.empty() || refined || of_element[e] == k) members.push_back(static_cast<int>(e));
    }
  }
  if (members.size() < 2) return std::nullopt;
  auto &one = problem.element_sets["one half"], &other = problem.element_sets["other half"];
  one = {members.front()};
  other = {members.back()};
  for (std::size_t n = 1; n + 1 < members.size(); ++n)
    (random.uniform(0.0, 1.0) < 0.5 ? one : other).push_back(members[n]);
  std::sort(other.begin(), other.end());
  materials.push_back(materials[k]);
  materials[k].elements = "one half";
  materials.back().elements = "other half";
  return Mapped{std::move(problem)};
}

/// With every load split into two at the same place, .3 and .7 of it.
inline Mapped with_split_loads(Problem problem) {
  const auto split = [](auto& loads, const auto& take) {
    const auto before = loads;
    for (auto& load : loads) take(load, 0.3);
    for (auto load : before) {
      take(load, 0.7);
      loads.push_back(load);
    }
  };
  Case& d = problem.description;
  split(d.forces.of<DeadForce>(), [&](DeadForce& load, double share) {
    multiply(load.total, share);
    multiply(load.moment, share);
  });
  split(d.forces.of<Pressure>(), [&](Pressure& load, double share) { load.value *= share; });
  split(d.forces.of<Gravity>(), [&](Gravity& load, double share) { multiply(load.value, share); });
  split(d.forces.of<Support>(), [&](Support& load, double share) {
    load.stiffness *= share;
    load.damping *= share;
  });
  split(d.velocities, [&](InitialVelocity& start, double share) {
    multiply(start.value, share);
    multiply(start.spin, share);
  });
  return {std::move(problem)};
}

/// With tables of two points replaced by formulas; none without such tables.
inline std::optional<Mapped> with_formulas(Problem problem) {
  bool any = false;
  for_each_curve(problem.description, [&](LoadCurve& curve) {
    if (curve.times.size() != 2) return;
    const std::string formula =
        fmt::format("max(min({0} + ({1} - {0}) * t / {2}, max({0}, {1})), min({0}, {1}))", curve.factors[0],
                    curve.factors[1], curve.times[1]);
    curve = {.formula = Formula(formula)};
    any = true;
  });
  if (!any) return std::nullopt;
  return Mapped{std::move(problem)};
}

/// The text of a case file without [mesh]; none if fibres are listed, which would need a file.
inline std::optional<std::string> text_of(const Problem& problem) {
  const Case& d = problem.description;
  std::string text = fmt::format("[case]\nname = 'random'\nrequirement = '-'\nanswer = '{}'\n",
                                 d.quasi_static ? "quasi-static" : "dynamic");
  const auto put = [&]<class... Values>(fmt::format_string<Values...> format, Values&&... values) {
    text += fmt::format(format, std::forward<Values>(values)...) + "\n";
  };
  const auto put_parameters = [&](const auto& owner) {
    const auto put_key = [&]<class Owner, class Value>(const Parameter<Owner, Value>& key) {
      const Value& value = owner.*key.member;
      if constexpr (std::is_same_v<Value, LoadCurve>) {
        if (!value.times.empty()) put("times = {}\nfactors = {}", value.times, value.factors);
      } else if constexpr (requires { Value::value_type::parameters(); }) {
        if (!value.empty()) throw std::logic_error("random problems have no lists of tables");
      } else if constexpr (std::is_enum_v<Value>) {
        put("{} = '{}'", key.name, words_of(value)[static_cast<std::size_t>(value)]);
      } else if constexpr (std::is_same_v<Value, std::string>) {
        put("{} = '{}'", key.name, value);
      } else {
        put("{} = {}", key.name, value);
      }
    };
    std::apply([&](const auto&... key) { (put_key(key), ...); }, owner.parameters());
  };
  for (const auto& material : d.materials) {
    if (std::holds_alternative<ListedFibres>(material.fibres)) return std::nullopt;
    put("{}\nlaw = '{}'\ndensity = {}", d.materials.size() > 1 ? "[[materials]]" : "[material]",
        name_of(material.law), material.density);
    if (!material.elements.empty()) put("elements = '{}'", material.elements);
    if (splits_volume(material.law))
      put("volumetric = '{}'",
          std::visit([]<class Part>(const Part&) { return Part::name; }, material.volume));
    std::visit(put_parameters, material.law);
    if (const auto* fibres = std::get_if<UniformFibres>(&material.fibres))
      put("fibre_direction = {}\nsheet_direction = {}", fibres->fibre, *fibres->sheet);
  }
  for (const auto& rule : d.refinements)
    put("[[refine]]\n{} = '{}'", rule.around.empty() ? "elements" : "around",
        rule.around.empty() ? rule.elements : rule.around);
  for (const auto& tie : d.ties) put("[[tie]]\nset = '{}'\nelements = '{}'", tie.set, tie.elements);
  for (const auto& imposed : d.displacements) {
    std::string components;
    for (std::size_t i = 0; i < 3; ++i) components += imposed.components[i] ? std::string(1, "xyz"[i]) : "";
    put("[[displacement]]\nset = '{}'\nvalue = {}\ncomponents = '{}'", imposed.set, imposed.value,
        components);
  }
  for (const auto& turned : d.rotations)
    put("[[rotation]]\nset = '{}'\naxis = {}\nangle = {}\ndisplacement = {}", turned.set, turned.axis,
        turned.angle * 180.0 / std::numbers::pi, turned.displacement);
  d.forces.for_each([&]<class Force>(const Force& force) {
    put("[[{}]]", Force::name);
    put_parameters(force);
  });
  for (const auto& start : d.velocities) put("[[velocity]]\nvalue = {}\nspin = {}", start.value, start.spin);
  put("[relaxation]");
  put_parameters(d.relaxation);
  if (!d.quasi_static) {
    put("[dynamics]");
    put_parameters(d.dynamics);
  }
  put("[method]\nname = '{}'", problem.choice.method);
  if (problem.choice.kappa) put("kappa = {}", *problem.choice.kappa);
  return text;
}

}  // namespace sandglass::verification
