#include "solve/sensitivities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "problem/shape_slopes.hpp"

namespace sandglass {

namespace {

/// A difference formula of second order: sum_k weight_k f(x + offset_k h) / h.
struct Term {
  double offset, weight;
};
constexpr std::array<Term, 2> central{{{-1.0, -0.5}, {1.0, 0.5}}};
constexpr std::array<Term, 3> forward{{{0.0, -1.5}, {1.0, 2.0}, {2.0, -0.5}}};

/// How far parameters are moved, over the scale on which laws vary with them. Its square is the error; a
/// shorter step would lose parameters that act on small strains only in the rounding of the others' forces.
constexpr double share_of_scale = 1e-4;

/// A step of a parameter, and whether it must go upwards, because the parameter is near the least allowed.
struct Step {
  double length;
  bool upwards;
};

template <class P>
Step step_of(const P& parameter, double value, double shear_modulus) {
  constexpr double near = 0.1;
  const Range& range = parameter.range;
  const double below = value - range.low, above = range.high - value;
  const double unit = parameter.unit == "Pa" ? shear_modulus : 1.0;
  if (!range.low_open && below < near * unit) return {share_of_scale * std::min(unit, above), true};
  const double scale = std::min(below, above);
  return {share_of_scale * (std::isfinite(scale) ? scale : std::max(std::abs(value), unit)), false};
}

double shear_modulus(const AnyLaw& any_law) {
  return std::visit([](const auto& law) { return law.shear_modulus(); }, any_law);
}

std::vector<Step> steps_of(AnyLaw law) {
  const double modulus = shear_modulus(law);
  std::vector<Step> steps;
  for_each_parameter(law, [&](const auto& p, double value) { steps.push_back(step_of(p, value, modulus)); });
  return steps;
}

/// Adds numbers to the parameters of a law.
AnyLaw moved(AnyLaw law, const std::vector<double>& by) {
  std::size_t k = 0;
  for_each_parameter(law, [&](const auto&, double& value) { value += by[k++]; });
  return law;
}

NodalField zeros(const StaticTangent& tangent) {
  return NodalField(tangent.displacements().size());
}

/// Calls visit(e, f) with the forces (N) of each element.
template <class Visit>
void for_each_force(const StaticTangent& tangent, const Materials& materials, const Visit& visit) {
  for_each_element_slope(tangent.model(), materials, tangent.levels(), tangent.displacements(),
                         zeros(tangent), visit);
}

/// The power of an element's forces at nodal velocities v.
double power(const Hexahedron& cell, const ElementSlopes& f, const NodalField& v) {
  double sum = 0.0;
  for (int I = 0; I < f.rows; ++I) {
    for (int i = 0; i < 3; ++i) sum += f(I, i).value * v[at(cell[at(I)])][at(i)];
  }
  return sum;
}

/// The derivatives of the power of the elements' forces by the parameters of the laws.
std::vector<std::vector<double>> by_parameters(const StaticTangent& tangent, const NodalField& v) {
  const Materials& own = tangent.model().scene().materials;
  const auto steps = by_material(own, [](const Material& material) { return steps_of(material.law); });
  std::vector<std::vector<double>> derivatives;
  std::size_t most = 0;
  for (const auto& each : steps) {
    derivatives.emplace_back(each.size(), 0.0);
    most = std::max(most, each.size());
  }
  for (std::size_t k = 0; k < most; ++k) {  // all materials together, as an element has one
    for (const bool upwards : {false, true}) {
      const auto moves = [&](std::size_t m) { return k < steps[m].size() && steps[m][k].upwards == upwards; };
      bool any = false;
      for (std::size_t m = 0; m < steps.size(); ++m) any = any || moves(m);
      if (!any) continue;
      const std::span<const Term> formula = upwards ? std::span<const Term>(forward) : central;
      for (const Term& term : formula) {
        Materials materials = own;
        for (std::size_t m = 0; m < steps.size(); ++m) {
          if (!moves(m)) continue;
          std::vector<double> by(steps[m].size(), 0.0);
          by[k] = term.offset * steps[m][k].length;
          materials.list[m].law = moved(own.list[m].law, by);
        }
        for_each_force(tangent, materials, [&](std::size_t e, const ElementSlopes& f) {
          const std::size_t m = own.of(e);
          if (!moves(m)) return;
          derivatives[m][k] +=
              term.weight / steps[m][k].length * power(tangent.model().scene().mesh.cells[e], f, v);
        });
      }
    }
  }
  return derivatives;
}

/// Adds the derivative of the elements' forces (N) along a change of the parameters of the laws.
void add_change_of_forces(const StaticTangent& tangent, const std::vector<std::vector<double>>& parameters,
                          NodalField& forces) {
  const Materials& own = tangent.model().scene().materials;
  double length = INFINITY;  // of the path
  bool upwards = false;
  for (std::size_t m = 0; m < parameters.size(); ++m) {
    const std::vector<Step> steps = steps_of(own.list[m].law);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (parameters[m][k] == 0.0) continue;
      length = std::min(length, steps[k].length / std::abs(parameters[m][k]));
      upwards = upwards || steps[k].upwards;
    }
  }
  if (!std::isfinite(length)) return;
  const std::span<const Term> formula = upwards ? std::span<const Term>(forward) : central;
  for (const Term& term : formula) {
    Materials materials = own;
    for (std::size_t m = 0; m < parameters.size(); ++m) {
      std::vector<double> by = parameters[m];
      for (double& each : by) each *= term.offset * length;
      materials.list[m].law = moved(own.list[m].law, by);
    }
    for_each_force(tangent, materials, [&](std::size_t e, const ElementSlopes& f) {
      scatter_add(f, tangent.model().scene().mesh.cells[e], forces,
                  [&](const Dual<double>& component) { return term.weight / length * component.value; });
    });
  }
}

/// The components of constraints of a field; all others are zero.
NodalField constrained(const StaticTangent& tangent, const NodalField& field) {
  NodalField own = zeros(tangent);
  for (const Constraint& c : tangent.model().scene().constraints)
    own[at(c.node)][at(c.component)] = field[at(c.node)][at(c.component)];
  return own;
}

void add(double factor, const NodalField& x, NodalField& y) {
  for (std::size_t n = 0; n < x.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) y[n][i] += factor * x[n][i];
  }
}

}  // namespace

std::vector<std::string_view> parameter_names(const AnyLaw& law) {
  std::vector<std::string_view> names;
  AnyLaw copy = law;
  for_each_parameter(copy, [&](const auto& p, double) { names.push_back(p.name); });
  return names;
}

void require_differentiable(const Model& model, const Relaxation& answer) {
  const Scene& scene = model.scene();
  const MethodEntry& method = method_named(model.choice().method);
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("derivatives: {}", why)); };
  for (const ContactForce* contact : contacts_of(scene.forces))
    refuse(fmt::format("[[{}]] is not supported; allowed: a case without it", contact->traits().name));
  for (const auto& force : scene.forces) {
    if (force->traits().no_potential.empty()) continue;
    refuse(fmt::format("[[{}]] is not supported, for {}; allowed: forces with a potential",
                       force->traits().name, force->traits().no_potential));
  }
  const bool path =
      std::visit([](const auto& elements) { return elements->needs_increment(); }, model.internal_force());
  if (path) {
    refuse(
        fmt::format("method '{}' has no potential, as its forces depend on the path; allowed: a Total "
                    "Lagrangian method",
                    method.name));
  }
  if (!method.controls_hourglass || method.damps_only) {
    refuse(
        fmt::format("method '{}' does not resist hourglass modes, so its stiffness is singular; allowed: "
                    "a method that does",
                    method.name));
  }
  if (model.choice().precision != Precision::double_precision)
    refuse("precision = 'float' is too coarse; it must be 'double'");
  if (!in_equilibrium(answer)) throw ComputationError("derivatives: the answer is not in equilibrium");
  const bool decides = std::ranges::all_of(
      scene.materials.list, [](const Material& material) { return splits_volume(material.law); });
  if (answer.stability == Stability::not_decided && decides && !method.is_linear)
    throw ComputationError("derivatives: " + stability_text(answer));
}

Gradient gradient(StaticTangent& tangent, const NodalField& of_displacements, const NodalField& of_reactions,
                  Shape shape) {
  // With v = dJ/dR on constrained components, and K v = -dJ/du on the others, dJ = v . (df_int - df).
  NodalField v = tangent.followed(constrained(tangent, of_reactions));
  NodalField b = of_displacements;
  add(1.0, tangent.product(v), b);
  for (auto& row : b) {
    for (double& component : row) component = -component;
  }
  add(1.0, tangent.solve(b), v);
  Gradient found;
  found.imposed = tangent.product(v);
  add(1.0, tangent.handed_on(of_displacements), found.imposed);
  found.imposed = constrained(tangent, found.imposed);
  found.forces = zeros(tangent);
  add(-1.0, v, found.forces);
  const Scene& scene = tangent.model().scene();
  found.scales.resize(scene.mesh.cells.size());
  for_each_force(tangent, scene.materials, [&](std::size_t e, const ElementSlopes& f) {
    found.scales[e] = power(scene.mesh.cells[e], f, v);
  });
  found.parameters = by_parameters(tangent, v);
  if (shape == Shape::constant) return found;
  found.points = zeros(tangent);
  for_each_shape_derivative(tangent.model(), tangent.levels(), tangent.displacements(), v,
                            [&](std::size_t e, const NodalVectors<double>& own) {
                              scatter_add(own, scene.mesh.cells[e], found.points);
                            });
  std::vector<double> factors;
  for (const LoadCurve& curve : scene.curves) factors.push_back(curve.at(1.0, 1.0));
  add_slopes_of_forces(-1.0, scene, factors, {tangent.displacements(), {}, v}, found.points);
  add_slopes_of_rotations(scene, 1.0, found.imposed, found.points);
  return found;
}

NodalField change_of_displacements(StaticTangent& tangent, const Perturbation& perturbation) {
  NodalField b = zeros(tangent), du = zeros(tangent);
  if (!perturbation.parameters.empty()) add_change_of_forces(tangent, perturbation.parameters, b);
  for (auto& row : b) {
    for (double& component : row) component = -component;
  }
  if (!perturbation.forces.empty()) add(1.0, perturbation.forces, b);
  if (!perturbation.imposed.empty()) {
    du = tangent.followed(constrained(tangent, perturbation.imposed));
    add(-1.0, tangent.product(du), b);
  }
  add(1.0, tangent.solve(b), du);
  return du;
}

}  // namespace sandglass
