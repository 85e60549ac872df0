#pragma once

#include <array>
#include <cstdint>
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

  /// The constraints of nodes whose rows this rank owns, and that move: others do no work.
  const std::vector<std::size_t>& moving() const { return moving_; }

  /// Sets components that are held to zero, and their increments to the change.
  void hold(State<Real>& state) const {
    for (const std::uint32_t place : held_) set(state, place, Real(0));
  }

  /// Sets components that move to their paths at a load factor, and their increments to the change.
  void impose(State<Real>& state, double factor);

  /// The same for all components and displacements (m), in the order of the scene's constraints.
  void impose(State<Real>& state, std::span<const double> displacements) const;

  /// Sets constrained components to zero.
  void clear(Rows<Real>& rows) const {
    for (const auto& constraint : constraints_) numbers_of(rows)[constraint.place] = Real(0);
  }

  /// Moves forces (N) on constrained components to `reactions`, in the order of the scene's constraints, and
  /// clears the increments of these components.
  void take_reactions(Rows<Real>& force, Rows<Real>& increment, std::vector<double>& reactions) const {
    Real *forces = numbers_of(force), *increments = numbers_of(increment);
    for (const auto& constraint : constraints_) {
      reactions[constraint.index] = static_cast<double>(forces[constraint.place]);
      forces[constraint.place] = increments[constraint.place] = Real(0);
    }
  }

  /// Numbers of all ranks in the order of the scene's constraints, from ranks that each know their own.
  std::vector<double> of_all(const std::vector<double>& numbers) const;

  /// The sums of such numbers over the constraints of each driven set.
  Reactions sums_over_sets(const std::vector<double>& numbers) const;

 private:
  struct Component {
    std::uint32_t index;  // in the scene
    std::uint32_t place;  // among the numbers of all rows
  };
  struct Moving {
    std::uint32_t place;
    std::uint32_t angle;
    std::array<Real, 3> share;  // of the terms of its path, m
  };

  static void set(State<Real>& state, std::uint32_t place, Real displacement) {
    Real& u = numbers_of(state.u)[place];
    numbers_of(state.increment)[place] += displacement - u;
    u = displacement;
  }

  const Scene& scene_;
  const Ranks& ranks_;
  std::vector<std::array<Real, 3>> terms_;  // of paths of each angle, at the last factor
  std::vector<Component> constraints_;      // of rows that this rank computes
  std::vector<Moving> paths_;               // of those that move
  std::vector<std::uint32_t> held_;         // places of the others
  std::vector<std::size_t> own_, moving_;
};

extern template class RowConstraints<double>;
extern template class RowConstraints<float>;

}  // namespace sandglass
