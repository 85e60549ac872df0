#include "solve/resident.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forces/contact_force.hpp"

namespace sandglass {

namespace {

template <class Real>
NodalProblem<Real> nodal_problem(const Model& model, const Leapfrog<Real>& leapfrog) {
  const Scene& scene = model.scene();
  const Layout& layout = leapfrog.body().layout();
  NodalProblem<Real> problem;
  problem.inverse_masses.resize(layout.rows());
  problem.dead_loads = dead_loads(scene.forces);
  problem.angles = scene.angles.size();
  problem.curves = scene.curves.size();
  for (std::size_t r = 0; r < layout.nodes; ++r)
    problem.inverse_masses[r] = static_cast<Real>(1.0 / model.masses()[at(layout.node_of_row[r])]);
  for (const auto& [node, component, path, group] : scene.constraints) {
    const int row = layout.row_of_node[at(node)];
    problem.constraints.push_back({at(row), at(component), path.share, path.angle, model.masses()[at(node)]});
  }
  for (const auto& force : scene.forces) {
    for (FaceForces& own : force->face_forces()) problem.face_forces.push_back(std::move(own));
  }
  return problem;
}

}  // namespace

std::string why_not_resident(const Scene& scene) {
  const auto contacts = contacts_of(scene.forces);
  if (!contacts.empty()) return fmt::format("[[{}]] acts on it", contacts.front()->traits().name);
  if (!scene.ties.empty()) return "it has ties or hanging nodes";
  if (scene.settings.dynamics.subcycles > 1) return "dynamics.subcycles > 1 lets small elements take others";
  for (const auto& force : scene.forces) {
    if (force->dead_loads().empty() && force->face_forces().empty())
      return fmt::format("[[{}]] acts on it", force->traits().name);
  }
  return {};
}

template <class Real>
ResidentMotion<Real>::ResidentMotion(const Model& model, const StateKeeper<Real>& keeper,
                                     const Leapfrog<Real>& leapfrog)
    : state_(keeper.resident(nodal_problem(model, leapfrog))) {}

template <class Real>
void ResidentMotion<Real>::begin(const Body<Real>& body, const std::vector<double>& driving) {
  steps_.clear();
  last_step_ = body.state().step;
  body_ = body.leave();
  for (std::size_t k = 0; k < driving.size(); ++k) body_.driving[k] = static_cast<Real>(driving[k]);
  state_->write(body_);
}

template <class Real>
void ResidentMotion<Real>::submit() {
  if (steps_.empty()) return;
  state_->take(steps_);
  last_step_ = steps_.back().step;
  steps_.clear();
}

template <class Real>
bool ResidentMotion<Real>::is_healthy() {
  submit();
  return state_->is_healthy();
}

template <class Real>
void ResidentMotion<Real>::bring(Body<Real>& body, double factor, double time, std::vector<double>& driving,
                                 std::vector<double>& works) {
  submit();
  state_->read(body_);
  body.arrive(body_, last_step_, factor, time);
  for (std::size_t k = 0; k < driving.size(); ++k) {
    driving[k] = static_cast<double>(body_.driving[k]);
    works[k] += static_cast<double>(body_.works[k]);
  }
}

template <class Real>
std::unique_ptr<ResidentMotion<Real>> resident_motion(const Model& model, const InternalForce<Real>& elements,
                                                      const Leapfrog<Real>& leapfrog) {
  const auto* keeper = dynamic_cast<const StateKeeper<Real>*>(&elements);
  if (keeper == nullptr || !why_not_resident(model.scene()).empty()) return nullptr;
  return std::make_unique<ResidentMotion<Real>>(model, *keeper, leapfrog);
}

template class ResidentMotion<double>;
template class ResidentMotion<float>;
template std::unique_ptr<ResidentMotion<double>> resident_motion(const Model&, const InternalForce<double>&,
                                                                 const Leapfrog<double>&);
template std::unique_ptr<ResidentMotion<float>> resident_motion(const Model&, const InternalForce<float>&,
                                                                const Leapfrog<float>&);

}  // namespace sandglass
