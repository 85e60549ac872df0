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

std::size_t at(int n) {
  return static_cast<std::size_t>(n);
}

/// Small nodes, and the elements that depend on them or on others, directly or because their nodes are tied.
struct Division {
  std::vector<bool> is_small;        ///< nodes that are not tied
  std::vector<bool> in_part;         ///< elements that depend on small nodes
  std::vector<bool> on_large_nodes;  ///< elements that depend on others

  std::size_t elements() const {
    return static_cast<std::size_t>(std::count(in_part.begin(), in_part.end(), true));
  }
};

/// What elements depend on: of each node itself, or the nodes that it follows.
class Dependence {
 public:
  explicit Dependence(const Scene& scene) : scene_(scene), tie_of_(scene.mesh.points.size(), nullptr) {
    for (const Tie& tie : scene.ties) tie_of_[at(tie.node)] = &tie;
  }

  /// The division where elements are small whose stable step is below a limit (s).
  Division at_limit(std::span<const double> element_steps, double limit) const {
    const auto& cells = scene_.mesh.cells;
    Division division{std::vector<bool>(tie_of_.size(), false), std::vector<bool>(cells.size(), false),
                      std::vector<bool>(cells.size(), false)};
    for (std::size_t e = 0; e < cells.size(); ++e) {
      if (element_steps[e] >= limit) continue;
      for (const int node : cells[e]) for_each_free(node, [&](int n) { division.is_small[at(n)] = true; });
    }
    for (std::size_t e = 0; e < cells.size(); ++e) {
      for (const int node : cells[e]) {
        for_each_free(node, [&](int n) {
          (division.is_small[at(n)] ? division.in_part : division.on_large_nodes)[e] = true;
        });
      }
    }
    return division;
  }

  /// Calls use(n) for a node, or for those that it follows.
  template <class Use>
  void for_each_free(int node, const Use& use) const {
    if (tie_of_[at(node)] == nullptr) {
      use(node);
    } else {
      for (const auto& share : tie_of_[at(node)]->mean_of) use(share.node);
    }
  }

 private:
  const Scene& scene_;
  std::vector<const Tie*> tie_of_;
};

/// The smallest step of the marked elements.
StableStep smallest(std::span<const double> steps, const std::vector<bool>& marked) {
  StableStep found{std::numeric_limits<double>::infinity(), -1};
  for (std::size_t e = 0; e < steps.size(); ++e) {
    if (marked[e] && !(steps[e] >= found.step)) found = {steps[e], static_cast<int>(e)};
  }
  return found;
}

/// The stable steps of the elements on small nodes, and of those on others.
struct StableSteps {
  StableStep small, large;

  StableStep with(const Substeps& substeps) const {
    StableStep by_small = small, by_large = large;
    if (substeps.count() > 1) {
      by_small.step *= substeps.reach();
      by_large.step *= Substeps::share_of_large;
    }
    return by_small.step < by_large.step ? by_small : by_large;
  }
};

/// The number of small steps with the least work per second, and that work (evaluations of elements per s);
/// for a given step the smallest stable number.
struct Cheapest {
  int substeps = 1;
  double work = std::numeric_limits<double>::infinity();
};

Cheapest cheapest(const StableSteps& stable, double elements, double part_elements, int most, double given) {
  Cheapest best;
  for (int p = 1; p <= most; ++p) {
    const double step = stable.with(Substeps(p)).step;
    const double work = (elements + (p > 1 ? p * part_elements : 0.0)) / (given > 0.0 ? given : step);
    if (step >= given && work < best.work) best = {p, work};
  }
  return best;
}

void require_bare_elements(const MethodChoice& choice, bool needs_increment, bool has_history) {
  const MethodEntry& method = method_named(choice.method);
  const auto refuse = [&](const char* what) {
    throw InputError(
        fmt::format("dynamics.subcycles: with method '{}' {}; allowed: 1, or a method and laws whose forces "
                    "depend on displacements alone",
                    method.name, what));
  };
  if (method.adapts()) refuse("elements change their levels");
  if (needs_increment) refuse("forces depend on the last step");
  if (has_history) refuse("and this law, elements remember steps, or share averages over nodes");
}

}  // namespace

template <class Real>
Subcycling<Real>::Subcycling(const Model& model, const InternalForce<Real>& elements)
    : threads_(model.choice().threads), most_substeps_(model.scene().description.dynamics.subcycles) {
  const State<Real> undeformed = elements.undeformed();
  require_bare_elements(model.choice(), elements.needs_increment(), !undeformed.history.empty());
  std::vector<double> bounds(model.element_masses().size());
  elements.stiffness_bounds(undeformed, bounds);
  const std::vector<double> steps = stable_steps(model, bounds);
  const Dependence dependence(model.scene());
  const auto cheapest_of = [&](const Division& division, int most) {
    return cheapest({smallest(steps, division.in_part), smallest(steps, division.on_large_nodes)},
                    static_cast<double>(steps.size()), static_cast<double>(division.elements()), most,
                    model.scene().description.dynamics.time_step);
  };
  Division best = dependence.at_limit(steps, 0.0);
  Cheapest choice = cheapest_of(best, 1);
  // Splits halve the steps of elements: limits are between those of one split and the next.
  const double least = *std::min_element(steps.begin(), steps.end());
  for (double limit = std::sqrt(2.0) * least; limit < most_substeps_ * least; limit *= 2.0) {
    Division division = dependence.at_limit(steps, limit);
    const Cheapest next = cheapest_of(division, most_substeps_);
    if (next.work >= choice.work) continue;
    choice = next;
    best = std::move(division);
  }
  in_part_ = std::move(best.in_part);
  on_large_nodes_ = std::move(best.on_large_nodes);
  if (choice.substeps == 1) return;
  require_bare(model, best.is_small);
  build_part(model, elements.layout(), best.is_small);
}

/// Their forces are evaluated once in a step, which is too long for light nodes.
template <class Real>
void Subcycling<Real>::require_bare(const Model& model, const std::vector<bool>& is_small) const {
  const Dependence dependence(model.scene());
  const auto require = [&](const Quadrilateral& face, const char* what) {
    for (const int node : face) {
      dependence.for_each_free(node, [&](int n) {
        if (!is_small[at(n)]) return;
        throw InputError(fmt::format(
            "dynamics.subcycles: a {} acts on node {}, which belongs to small elements; allowed: 1, "
            "or a mesh that is refined elsewhere",
            what, n));
      });
    }
  };
  for (const FacePressure& pressure : model.scene().pressures) require(pressure.face, "pressure");
  for (const FaceSupport& support : model.scene().supports) require(support.face, "support");
}

template <class Real>
void Subcycling<Real>::build_part(const Model& model, const Layout& layout,
                                  const std::vector<bool>& is_small) {
  const Scene& scene = model.scene();
  const MeshPart part = part_of_mesh(scene.mesh, in_part_);
  part_elements_ = part.element_of.size();
  part_ = std::get<std::unique_ptr<InternalForce<Real>>>(
      make_internal_force(part.mesh, materials_of(scene.materials, part.element_of), model.choice()));
  state_ = part_->undeformed();
  const std::size_t rows = state_.u.size();
  mobility_ = rest_ = force_ = sum_ = Rows<Real>(rows);
  is_tied_.assign(rows, false);
  const auto row_of = [&](int node) {  // in the part, of a node of the whole
    return static_cast<std::uint32_t>(part_->layout().row_of_node[at(part.part_of[at(node)])]);
  };
  const auto whole_row_of = [&](int node) {
    return static_cast<std::uint32_t>(layout.row_of_node[at(node)]);
  };
  whole_row_.resize(part.node_of.size());
  for (const int node : part.node_of) {
    whole_row_[row_of(node)] = whole_row_of(node);
    if (!is_small[at(node)]) continue;
    for (std::size_t i = 0; i < 3; ++i)
      mobility_[row_of(node)][i] = static_cast<Real>(1.0 / model.masses()[at(node)]);
  }
  for (const auto& [node, component, path] : scene.constraints) {
    if (part.part_of[at(node)] >= 0) mobility_[row_of(node)][at(component)] = Real(0);
  }
  for (const auto& [node, mean_of] : scene.ties) {
    if (part.part_of[at(node)] < 0) continue;
    is_tied_[row_of(node)] = true;
    for (const auto& [to, weight] : mean_of) {
      const auto share = static_cast<Real>(weight);
      if (is_small[at(to)])
        to_small_.push_back({row_of(node), row_of(to), share});
      else
        to_others_.push_back({row_of(node), whole_row_of(to), share});
    }
  }
}

template <class Real>
StableStep Subcycling<Real>::choose_substeps(std::span<const double> element_steps, double given_step) {
  if (part_ == nullptr) return smallest(element_steps, std::vector<bool>(element_steps.size(), true));
  const StableSteps stable{smallest(element_steps, in_part_), smallest(element_steps, on_large_nodes_)};
  const auto elements = static_cast<double>(element_steps.size());
  const auto part_elements = static_cast<double>(part_elements_);
  const int count = cheapest(stable, elements, part_elements, most_substeps_, given_step).substeps;
  if (count != substeps_.count()) substeps_ = Substeps(count);
  return stable.with(substeps_);
}

/// Sets the force of the part at its present displacements, handed on by tied rows to small nodes.
template <class Real>
void Subcycling<Real>::evaluate() {
  part_->evaluate(state_, force_);
  for (const auto& [tied, to, weight] : to_small_) {
    for (std::size_t i = 0; i < 3; ++i) force_[to][i] += weight * force_[tied][i];
  }
}

/// Takes the k-th small step.
template <class Real>
void Subcycling<Real>::move(std::size_t k) {
  const auto keep = static_cast<Real>(substeps_.keep(k));
  const auto gain = static_cast<Real>(-substeps_.gain(k) * step_ * step_);
  const auto share = static_cast<Real>(substeps_.weight(k));
  Real *u = numbers_of(state_.u), *increment = numbers_of(state_.increment), *sum = numbers_of(sum_);
  const Real *mobility = numbers_of(mobility_), *rest = numbers_of(rest_), *force = numbers_of(force_);
  for_each_block(4 * mobility_.size(), threads_, [=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t n = first; n < last; ++n) {
      sum[n] += share * force[n];
      increment[n] = keep * increment[n] + gain * mobility[n] * (rest[n] + force[n]);
      u[n] += increment[n];
    }
  });
  for (const auto& [tied, to, weight] : to_small_) {
    for (std::size_t i = 0; i < 3; ++i) state_.u[tied][i] += weight * state_.increment[to][i];
  }
}

template <class Real>
void Subcycling<Real>::average(const Rows<Real>& u, Rows<Real>& force) {
  if (substeps_.count() == 1) return;
  const std::size_t nodes = whole_row_.size(), last = at(substeps_.count()) - 1;
  for (std::size_t r = 0; r < nodes; ++r) state_.u[r] = u[whole_row_[r]];
  evaluate();
  for (std::size_t r = 0; r < nodes; ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      rest_[r][i] = force[whole_row_[r]][i] - force_[r][i];
      sum_[r][i] = -force_[r][i];
    }
  }
  for (std::size_t k = 0; k < last; ++k) {
    move(k);
    evaluate();
  }
  const auto share = static_cast<Real>(substeps_.weight(last));
  for (std::size_t r = 0; r < nodes; ++r) {
    for (std::size_t i = 0; i < 3; ++i) sum_[r][i] += share * force_[r][i];
    if (is_tied_[r]) continue;
    for (std::size_t i = 0; i < 3; ++i) force[whole_row_[r]][i] += sum_[r][i];
  }
  for (const auto& [tied, to, weight] : to_others_) {
    for (std::size_t i = 0; i < 3; ++i) force[to][i] += weight * sum_[tied][i];
  }
}

template class Subcycling<double>;
template class Subcycling<float>;

}  // namespace sandglass
