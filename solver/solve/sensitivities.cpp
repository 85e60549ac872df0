#include "solve/sensitivities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "problem/shape_slopes.hpp"
#include "solve/law_parameters.hpp"
#include "solve/stability.hpp"

namespace sandglass {

namespace {

NodalField zeros(const StaticTangent& tangent) {
  return NodalField(tangent.displacements().size());
}

/// Adds the derivative of the elements' forces (N) along a change of the parameters of the laws.
void add_change_of_forces(const StaticTangent& tangent, const std::vector<std::vector<double>>& parameters,
                          NodalField& forces) {
  const Materials& own = tangent.model().scene().materials;
  double length = INFINITY;  // of the path
  bool upwards = false;
  for (std::size_t m = 0; m < parameters.size(); ++m) {
    const std::vector<ParameterStep> steps = parameter_steps(own.list[m].law);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (parameters[m][k] == 0.0) continue;
      length = std::min(length, steps[k].length / std::abs(parameters[m][k]));
      upwards = upwards || steps[k].upwards;
    }
  }
  if (!std::isfinite(length)) return;
  for (const DifferenceTerm& term : difference_formula(upwards)) {
    Materials materials = own;
    for (std::size_t m = 0; m < parameters.size(); ++m) {
      std::vector<double> by = parameters[m];
      for (double& each : by) each *= term.offset * length;
      materials.list[m].law = with_moved_parameters(own.list[m].law, by);
    }
    for_each_element_slope(
        tangent.model(), materials, tangent.levels(), tangent.displacements(), zeros(tangent),
        [&](std::size_t e, const ElementSlopes& f) {
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

[[noreturn]] void refuse_derivatives(const std::string& why) {
  throw InputError(fmt::format("derivatives: {}", why));
}

void require_differentiable_forces(const Model& model) {
  for (const ContactForce* contact : contacts_of(model.scene().forces)) {
    refuse_derivatives(
        fmt::format("[[{}]] is not supported; allowed: a case without it", contact->traits().name));
  }
  const bool path =
      std::visit([](const auto& elements) { return elements->needs_increment(); }, model.internal_force());
  if (path) {
    refuse_derivatives(
        fmt::format("method '{}' has no potential, as its forces depend on the path; allowed: a Total "
                    "Lagrangian method",
                    model.choice().method));
  }
  if (model.choice().precision != Precision::double_precision)
    refuse_derivatives("precision = 'float' is too coarse; it must be 'double'");
}

void require_differentiable(const Model& model, const Relaxation& answer) {
  require_differentiable_forces(model);
  const Scene& scene = model.scene();
  const MethodEntry& method = method_named(model.choice().method);
  for (const auto& force : scene.forces) {
    if (force->traits().no_potential.empty()) continue;
    refuse_derivatives(fmt::format("[[{}]] is not supported, for {}; allowed: forces with a potential",
                                   force->traits().name, force->traits().no_potential));
  }
  if (leaves_hourglass_modes(model.choice())) {
    refuse_derivatives(
        fmt::format("method '{}' does not resist hourglass modes, so its stiffness is singular; allowed: "
                    "a method that does",
                    method.name));
  }
  if (!in_equilibrium(answer)) throw ComputationError("derivatives: the answer is not in equilibrium");
  const bool decides = std::ranges::all_of(
      scene.materials.list, [](const Material& material) { return splits_volume(material.law); });
  if (answer.stability == Stability::not_decided && decides && !method.is_linear)
    throw ComputationError("derivatives: " + stability_text(answer));
}

Gradient gradient(StaticTangent& tangent, const NodalField& of_displacements, const NodalField& of_reactions,
                  const Wanted& wanted) {
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
  PowerDerivativeSum powers(tangent.model(), tangent.levels(), wanted.parameters);
  const Layout& layout = double_elements(tangent.model()).layout();
  powers.add(to_rows<double>(tangent.displacements(), layout), to_rows<double>(v, layout));
  found.by_elements = powers.sum();
  if (!wanted.points) return found;
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
