#pragma once

#include <array>
#include <span>
#include <vector>

#include "assembly/layout.hpp"
#include "assembly/state.hpp"
#include "problem/observer.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// The constraints of a scene, on rows.
template <class Real>
class RowConstraints {
 public:
  RowConstraints(const Scene& scene, const Layout& layout);

  /// The constraints of nodes whose rows this rank owns.
  const std::vector<std::size_t>& own() const { return own_; }

  /// Sets constrained components to their paths at a load factor, and their increments to the change.
  void impose(State<Real>& state, double factor);

  /// The same for displacements (m) in the order of the scene's constraints.
  void impose(State<Real>& state, std::span<const double> displacements) const;

  /// Sets constrained components to zero.
  void clear(Rows<Real>& rows) const {
    for (const auto& constraint : constraints_) rows[constraint.row][constraint.component] = Real(0);
  }

  /// Moves forces (N) on constrained components to `reactions`, in the order of the scene's constraints, and
  /// clears the increments of these components.
  void take_reactions(Rows<Real>& force, Rows<Real>& increment, std::vector<double>& reactions) const {
    for (const auto& constraint : constraints_) {
      Real& component = force[constraint.row][constraint.component];
      reactions[constraint.index] = static_cast<double>(component);
      component = Real(0);
      increment[constraint.row][constraint.component] = Real(0);
    }
  }

  /// Numbers of all ranks in the order of the scene's constraints, from ranks that each know their own.
  std::vector<double> of_all(const std::vector<double>& numbers) const;

  /// The sums of such numbers over the constraints of each driven set.
  Reactions sums_over_sets(const std::vector<double>& numbers) const;

 private:
  struct RowConstraint {
    std::size_t index;  // in the scene
    std::size_t row;
    std::size_t component;
    std::array<Real, 3> share;  // of the terms of its path, m
    std::size_t angle;

    void impose(State<Real>& state, Real displacement) const {
      Real& u = state.u[row][component];
      state.increment[row][component] += displacement - u;
      u = displacement;
    }
  };

  const Scene& scene_;
  const Ranks& ranks_;
  std::vector<std::array<Real, 3>> terms_;  // of paths of each angle, at the last factor
  std::vector<RowConstraint> constraints_;  // of rows that this rank computes
  std::vector<std::size_t> own_;
};

extern template class RowConstraints<double>;
extern template class RowConstraints<float>;

}  // namespace sandglass
