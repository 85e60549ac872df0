#include "solve/subcycling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "math/row_loops.hpp"
#include "mesh/mesh_part.hpp"

namespace sandglass {

namespace {

/// For each node itself, or the nodes that it follows.
class FreeNodes {
 public:
  explicit FreeNodes(const Scene& scene) : tie_of_(scene.mesh.points.size(), nullptr) {
    for (const Tie& tie : scene.ties) tie_of_[at(tie.node)] = &tie;
  }

  /// Calls use(n) for the free nodes that any of `nodes` depends on.
  template <class Nodes, class Use>
  void for_each(const Nodes& nodes, const Use& use) const {
    for (const int node : nodes) {
      if (tie_of_[at(node)] == nullptr) {
        use(node);
      } else {
        for (const auto& share : tie_of_[at(node)]->mean_of) use(share.node);
      }
    }
  }

 private:
  std::vector<const Tie*> tie_of_;
};

/// The division in which elements with a stable step below a limit (s) are small.
Division divide(const Scene& scene, const FreeNodes& free, std::span<const double> steps, double limit) {
  const auto& cells = scene.mesh.cells;
  const std::vector<bool> no_elements(cells.size(), false);
  Division division{std::vector<bool>(scene.mesh.points.size(), false), no_elements, no_elements};
  for (std::size_t e = 0; e < cells.size(); ++e) {
    if (steps[e] < limit) free.for_each(cells[e], [&](int n) { division.is_small[at(n)] = true; });
  }
  for (std::size_t e = 0; e < cells.size(); ++e) {
    free.for_each(cells[e], [&](int n) {
      (division.is_small[at(n)] ? division.in_part : division.on_large_nodes)[e] = true;
    });
  }
  return division;
}

/// The smallest of the steps of the marked elements.
StableStep smallest(std::span<const double> steps, const std::vector<bool>& marked) {
  StableStep found{std::numeric_limits<double>::infinity(), -1};
  for (std::size_t e = 0; e < steps.size(); ++e) {
    if (marked[e] && !(steps[e] >= found.step)) found = {steps[e], static_cast<int>(e)};
  }
  return found;
}

/// A number of small steps.
struct Plan {
  int substeps;
  StableStep stable;
  double work;  ///< evaluations of elements per second; infinite for a given step that is not stable

  bool is_better_than(const Plan& other) const {
    return std::pair(work, -stable.step) < std::pair(other.work, -other.stable.step);
  }
};

/// The plan with the least work and at most this many small steps; `given` (s) is a prescribed step, or 0 for
/// the stable one.
Plan best_plan(std::span<const double> steps, const Division& division, int most, double given) {
  const StableStep small = smallest(steps, division.in_part);
  const StableStep large = smallest(steps, division.on_large_nodes);
  const auto elements = static_cast<double>(steps.size());
  const auto part = static_cast<double>(std::count(division.in_part.begin(), division.in_part.end(), true));
  const auto plan = [&](int p) {
    const StableStep by_small{small.step * Substeps(p).reach(), small.element};
    const StableStep by_large{large.step * (p > 1 ? Substeps::share_of_large : 1.0), large.element};
    const StableStep stable = by_small.step < by_large.step ? by_small : by_large;
    const double evaluations = elements + (p > 1 ? p * part : 0.0);
    return Plan{p, stable,
                stable.step < given ? std::numeric_limits<double>::infinity()
                                    : evaluations / (given > 0.0 ? given : stable.step)};
  };
  Plan best = plan(1);
  for (int p = 2; p <= most; ++p) {
    if (const Plan next = plan(p); next.is_better_than(best)) best = next;
  }
  return best;
}

void require_bare_elements(const MethodChoice& choice, bool needs_increment, bool has_history) {
  const MethodEntry& method = method_named(choice.method);
  const auto refuse = [&](const char* what) {
    throw InputError(
        fmt::format("dynamics.subcycles: with method '{}' {}; allowed: 1, or a method and laws whose forces "
                    "depend only on displacements",
                    method.name, what));
  };
  if (method.adapts()) refuse("elements change their levels");
  if (needs_increment) refuse("forces depend on the last step");
  if (has_history) refuse("and this law, elements remember steps, or share averages over nodes");
}

/// Forces that follow the body are evaluated once per step, which is too long for light nodes.
void require_bare_faces(const Scene& scene, const FreeNodes& free, const std::vector<bool>& is_small) {
  for (const auto& force : scene.forces) {
    if (!force->dead_loads().empty()) continue;
    free.for_each(force->nodes(), [&](int n) {
      if (!is_small[at(n)]) return;
      throw InputError(
          fmt::format("dynamics.subcycles: [[{}]] acts on node {}, which belongs to small elements; "
                      "allowed: 1, or a mesh that is refined elsewhere",
                      force->traits().name, n));
    });
  }
}

}  // namespace

template <class Real>
Subcycling<Real>::Subcycling(const Model& model, const InternalForce<Real>& elements,
                             const Rows<Real>& inverse_masses)
    : most_substeps_(model.scene().settings.dynamics.subcycles) {
  const Scene& scene = model.scene();
  const State<Real> undeformed = elements.undeformed();
  require_bare_elements(model.choice(), elements.needs_increment(), !undeformed.history.empty());
  std::vector<double> bounds(model.element_masses().size());
  elements.stiffness_bounds(undeformed, bounds);
  const std::vector<double> steps = stable_steps(model, bounds);
  const FreeNodes free(scene);
  const auto plan_of = [&](const Division& division) {
    return best_plan(steps, division, most_substeps_, scene.settings.dynamics.time_step);
  };
  division_ = divide(scene, free, steps, 0.0);
  Plan best = plan_of(division_);
  // Splits halve the steps of elements: limits are between those of one split and the next.
  const double least = *std::min_element(steps.begin(), steps.end());
  for (int size = 1; std::sqrt(2.0) * size < most_substeps_; size *= 2) {
    Division division = divide(scene, free, steps, std::sqrt(2.0) * size * least);
    const Plan next = plan_of(division);
    if (!next.is_better_than(best)) continue;
    best = next;
    division_ = std::move(division);
  }
  if (best.substeps == 1) return;
  require_bare_faces(scene, free, division_.is_small);
  build_part(model, elements.layout(), inverse_masses);
}

template <class Real>
void Subcycling<Real>::build_part(const Model& model, const Layout& layout,
                                  const Rows<Real>& inverse_masses) {
  const Scene& scene = model.scene();
  const MeshPart part = part_of_mesh(scene.mesh, division_.in_part);
  part_ = std::get<std::unique_ptr<InternalForce<Real>>>(
      make_internal_force(part.mesh, materials_of(scene.materials, part.element_of), model.choice()));
  state_ = part_->undeformed();
  mobility_ = force_ = mean_ = rest_ = Rows<Real>(state_.u.size());
  whole_row_.resize(part.node_of.size());
  for (std::size_t r = 0; r < whole_row_.size(); ++r) {
    const int node = part.node_of[at(part_->layout().node_of_row[r])];
    whole_row_[r] = static_cast<std::uint32_t>(layout.row_of_node[at(node)]);
    if (division_.is_small[at(node)]) mobility_[r] = inverse_masses[whole_row_[r]];
  }
  Ties to_small;
  for (const auto& [node, mean_of] : scene.ties) {
    Tie tie{part.part_of[at(node)], {}};
    for (const auto& [to, weight] : mean_of) {
      if (division_.is_small[at(to)]) tie.mean_of.push_back({part.part_of[at(to)], weight});
    }
    if (!tie.mean_of.empty()) to_small.push_back(std::move(tie));
  }
  ties_ = RowTies<Real>(to_small, part_->layout());
}

template <class Real>
StableStep Subcycling<Real>::choose_substeps(std::span<const double> element_steps, double given_step) {
  const int most = part_ == nullptr ? 1 : most_substeps_;
  const Plan plan = best_plan(element_steps, division_, most, given_step);
  if (plan.substeps != substeps_.count()) substeps_ = Substeps(plan.substeps);
  return plan.stable;
}

/// Adds the force before the k-th small step to the mean, and the forces from outside the part to the force.
template <class Real>
void Subcycling<Real>::add_to_mean(std::size_t k) {
  const auto before = static_cast<Real>(k > 0 ? 1 : 0), share = static_cast<Real>(substeps_.weight(k));
  Real *mean = numbers_of(mean_), *force = numbers_of(force_);
  const Real* rest = numbers_of(rest_);
  part_->layout().row_blocks.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t n = first; n < last; ++n) {
      mean[n] = before * mean[n] + share * force[n];
      force[n] += rest[n];
    }
  });
}

/// Takes the k-th small step: tied nodes move with the small nodes that they follow, others are held.
template <class Real>
void Subcycling<Real>::move(std::size_t k) {
  const auto keep = static_cast<Real>(substeps_.keep(k));
  const auto gain = static_cast<Real>(-substeps_.gain(k) * step_ * step_);
  Real *u = numbers_of(state_.u), *increment = numbers_of(state_.increment);
  const Real *mobility = numbers_of(mobility_), *force = numbers_of(force_);
  const auto for_each_number = [&](const auto& move_number) {
    part_->layout().row_blocks.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
      for (std::size_t n = first; n < last; ++n) move_number(n);
    });
  };
  ties_.hand_on(force_);
  for_each_number([=](std::size_t n) { increment[n] = keep * increment[n] + gain * mobility[n] * force[n]; });
  ties_.follow(state_.increment);
  for_each_number([=](std::size_t n) { u[n] += increment[n]; });
}

template <class Real>
void Subcycling<Real>::average(const Rows<Real>& u, Rows<Real>& force) {
  const std::size_t rows = whole_row_.size(), count = at(substeps_.count());
  if (count == 1) return;
  for (std::size_t r = 0; r < rows; ++r) state_.u[r] = u[whole_row_[r]];
  part_->evaluate(state_, force_);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t i = 0; i < 3; ++i) rest_[r][i] = force[whole_row_[r]][i] - force_[r][i];
  }
  add_to_mean(0);
  for (std::size_t k = 1; k < count; ++k) {
    move(k - 1);
    part_->evaluate(state_, force_);
    add_to_mean(k);
  }
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t i = 0; i < 3; ++i) force[whole_row_[r]][i] = rest_[r][i] + mean_[r][i];
  }
}

template class Subcycling<double>;
template class Subcycling<float>;

}  // namespace sandglass
