#include "solve/condensed_answer.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "solve/body.hpp"
#include "solve/condensed_response.hpp"
#include "solve/frame.hpp"
#include "solve/health.hpp"

namespace sandglass {

namespace {

bool moves_without_handle(const Handles& handles) {
  return std::ranges::any_of(handles.of_constraint, [](int handle) { return handle < 0; });
}

/// The forces (N) on other nodes caused by rotated sets, which no handle moves, at their final positions.
NodalField forces_of_rotations(const Model& model, const Handles& handles) {
  const Scene& scene = model.scene();
  NodalField u(scene.mesh.points.size());
  if (!moves_without_handle(handles)) return u;
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    const Constraint& c = scene.constraints[k];
    if (handles.of_constraint[k] >= 0) continue;
    u[at(c.node)][at(c.component)] = final_value(scene, c);
  }
  const Model exact(scene, {.method = model.choice().method, .kappa = model.choice().kappa});
  NodalField forces = internal_forces(exact, u);
  for (auto& force : forces) {
    for (double& component : force) component = -component;
  }
  return forces;
}

/// Displacements (m) of all nodes at the full load.
template <class Real>
Rows<Real> superposed(const Model& model, const Layout& layout) {
  const Scene& scene = model.scene();
  if (const BodyForce* other = first_not_dead(scene.forces)) {
    throw ComputationError(
        fmt::format("method '{}' superposes answers to displacements and dead loads and does not support "
                    "[[{}]]; choose another method",
                    model.choice().method, other->traits().name));
  }
  if (!scene.ties.empty()) {
    throw ComputationError(fmt::format("method '{}' does not support refined meshes; choose another method",
                                       model.choice().method));
  }
  const Handles handles = handles_of_sets(scene);
  std::vector<NodalField> loads;
  const std::vector<NodalLoad> dead = dead_loads(scene.forces);
  if (!dead.empty() || moves_without_handle(handles)) {
    loads.push_back(forces_of_rotations(model, handles));
    for (const auto& [node, force, curve] : dead) {
      const double factor = scene.curves[curve].at(1.0, 1.0);
      for (std::size_t i = 0; i < 3; ++i) loads[0][at(node)][i] += factor * force[i];
    }
  }
  const CondensedResponse<Real> response(model, handles, all_nodes(scene), loads);
  std::vector<typename CondensedResponse<Real>::Displacement> u(layout.nodes);
  const std::vector<double> full_loads(loads.size(), 1.0);
  response.displacements(final_displacements(scene, handles), u, model.choice().threads, full_loads);
  Rows<Real> rows(layout.rows());
  for (std::size_t r = 0; r < layout.nodes; ++r) {
    const auto& value = u[at(layout.node_of_row[r])];
    for (std::size_t i = 0; i < 3; ++i) rows[r][i] = value[i];
  }
  return rows;
}

/// Work (J) of the imposed displacements from the undeformed state; it does not depend on the path.
double work_of(const Scene& scene, const std::vector<double>& reactions) {
  double work = 0.0;
  for (std::size_t k = 0; k < reactions.size(); ++k) {
    work += 0.5 * reactions[k] * final_value(scene, scene.constraints[k]);
  }
  return work;
}

template <class Real>
Relaxation answer_of(const Model& model, const InternalForce<Real>& elements, Observer& observer) {
  const Scene& scene = model.scene();
  const RelaxationSettings& settings = scene.settings.relaxation;
  const NodalField no_velocity(scene.mesh.points.size());
  Body<Real> body(model, elements);
  observer.frame(frame_of(body, 0.0, no_velocity));
  HistoryRow undeformed{};
  undeformed.reactions = body.reactions_of_sets();
  observer.history(undeformed);
  constexpr auto epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());
  Relaxation result;
  if (settings.max_steps > 0) body.move_to(superposed<Real>(model, elements.layout()));
  body.impose(1.0);
  body.evaluate_forces();
  require_healthy(body, 1);
  result.u = body.field(body.state().u);
  result.energies = body.energies();
  result.residual = body.residual();
  if (settings.max_steps > 0) {
    result.steps = 1;
    result.converged = result.residual < settings.tolerance;
    result.stagnated = !result.converged && result.residual < 1e4 * epsilon;  // as in Stagnation
    result.rounded = result.stagnated && std::is_same_v<Real, float>;
    result.stability = Stability::stable;  // its stiffness has been factorised
    result.interrupted = !observer.proceed(1, 1.0, result.residual);
  }
  observer.history({1.0, 0.0, result.energies.strain, result.energies.hourglass,
                    work_of(scene, body.constraints().of_all(body.reactions())) - 0.5 * body.load_potential(),
                    result.residual, 1.0, 0.0, body.reactions_of_sets()});
  observer.frame(frame_of(body, 1.0, no_velocity));
  return result;
}

}  // namespace

Relaxation condensed_answer(const Model& model, Observer& observer) {
  return std::visit([&](const auto& elements) { return answer_of(model, *elements, observer); },
                    model.internal_force());
}

}  // namespace sandglass
