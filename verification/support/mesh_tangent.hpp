#pragma once

#include "element/element_motion.hpp"
#include "support/derivatives.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {

/// The exact tangent stiffness df/du of a whole mesh for any method: every element runs on dual numbers, one
/// after the other, without layout and packs. The mesh goes from the undeformed shape to u in one step; the
/// tangent is that of a further step.
template <class Kernel, class Law>
class MeshTangent {
 public:
  MeshTangent(const Mesh& mesh, const Law& law, const HourglassSettings& settings, const NodalField& u)
      : mesh_(mesh), law_(law), u_(u) {
    for (const auto& cell : mesh.cells) {
      elements_.push_back(dual_element<Kernel>(Kernel::precompute(gather(mesh.points, cell), law, settings)));
    }
    const NodalField nowhere(u.size());
    dilatation_at_u_ = dilatations(nowhere);
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      ElementMotion<D> motion = motion_of(e, nowhere, dilatation_at_u_, 0.0);
      motion.increment = motion.u;
      histories_.emplace_back();
      if constexpr (Kernel::remembers) histories_.back() = {};
      Kernel::force(Kernel::deformation(motion, elements_[e]), elements_[e], histories_.back(), law_);
    }
  }

  /// The smallest det F at the integration points of all elements, at u.
  double smallest_jacobian() const {
    const NodalField nowhere(u_.size());
    double smallest = INFINITY;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const auto motion = motion_of(e, nowhere, dilatation_at_u_, 0.0);
      smallest = std::min(smallest, Kernel::smallest_jacobian(motion, elements_[e]).value);
    }
    return smallest;
  }

  /// df/du v (N) of a further step; v in m, the inverse step in 1/s is zero if static.
  NodalField along(const NodalField& v, double inverse_step = 0.0) const {
    const auto dilatation = dilatations(v);
    NodalField df(v.size());
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const auto motion = motion_of(e, v, dilatation, inverse_step);
      if (!feels(motion)) continue;
      auto history = histories_[e];
      const auto f = slope(
          from_modes(Kernel::force(Kernel::deformation(motion, elements_[e]), elements_[e], history, law_)));
      for (int I = 0; I < 8; ++I) {
        for (int i = 0; i < 3; ++i) df[index(mesh_.cells[e][index(I)])][index(i)] += f(I, i);
      }
    }
    return df;
  }

  /// The whole tangent over the square roots of the masses (kg), M^(-1/2) K M^(-1/2), by rows, 1/s^2.
  std::vector<double> over_masses(const std::vector<double>& masses, double inverse_step = 0.0) const {
    const std::size_t size = 3 * u_.size();
    std::vector<double> K(size * size);
    NodalField v(u_.size());
    for (std::size_t n = 0; n < size; ++n) {
      v[n / 3][n % 3] = 1.0;
      const NodalField column = along(v, inverse_step);
      v[n / 3][n % 3] = 0.0;
      for (std::size_t m = 0; m < size; ++m) {
        K[m * size + n] = column[m / 3][m % 3] / std::sqrt(masses[m / 3] * masses[n / 3]);
      }
    }
    return K;
  }

 private:
  using Element = typename Kernel::template Element<D>;
  using History = typename Kernel::template History<D>;

  NodalVectors<D> moved(std::size_t e, const NodalField& v) const {
    return verification::along(gather(u_, mesh_.cells[e]), gather(v, mesh_.cells[e]));
  }

  /// Volume change over volume around each node; zero unless elements use it.
  std::vector<D> dilatations(const NodalField& v) const {
    std::vector<D> change(u_.size()), rest(u_.size());
    if constexpr (Kernel::averages_over_nodes) {
      for (std::size_t e = 0; e < elements_.size(); ++e) {
        ElementMotion<D> motion{};
        motion.u = to_modes(moved(e, v));
        const NodalVolumes<D> volumes = Kernel::nodal_volumes(motion, elements_[e]);
        for (std::size_t I = 0; I < 8; ++I) {
          const std::size_t node = index(mesh_.cells[e][I]);
          change[node] = change[node] + volumes.change[I];
          rest[node] = rest[node] + volumes.reference[I];
        }
      }
      for (std::size_t n = 0; n < change.size(); ++n) change[n] = change[n] / rest[n];
    }
    return change;
  }

  ElementMotion<D> motion_of(std::size_t e, const NodalField& v, const std::vector<D>& dilatation,
                             double inverse_step) const {
    const NodalVectors<double> direction = gather(v, mesh_.cells[e]);
    ElementMotion<D> motion{};
    motion.u = to_modes(moved(e, v));
    motion.increment = to_modes(verification::along(NodalVectors<double>{}, direction));
    motion.X = to_modes(constant(gather(mesh_.points, mesh_.cells[e])));
    motion.inverse_step = D(inverse_step);
    for (std::size_t I = 0; I < 8; ++I) motion.dilatation[I] = dilatation[index(mesh_.cells[e][I])];
    return motion;
  }

  /// Whether a direction moves a node of an element; most elements are unaffected if it moves one node.
  static bool feels(const ElementMotion<D>& motion) {
    const auto moves = [](const D& x) { return x.slope != 0.0; };
    return std::ranges::any_of(motion.u.entries, moves) || std::ranges::any_of(motion.dilatation, moves);
  }

  const Mesh& mesh_;
  const Law& law_;
  const NodalField& u_;
  std::vector<Element> elements_;
  std::vector<History> histories_;
  std::vector<D> dilatation_at_u_;
};

}  // namespace sandglass::verification
