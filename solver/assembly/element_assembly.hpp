#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "assembly/chunk_sum.hpp"
#include "assembly/element_block.hpp"
#include "assembly/face_gather.hpp"
#include "assembly/internal_force.hpp"
#include "assembly/prefetch.hpp"
#include "element/element_motion.hpp"
#include "material/memory.hpp"
#include "math/lanes.hpp"

namespace sandglass {

/// All elements of one formulation, their constants computed once, in blocks of as many elements as `Number`
/// computes at a time: a pack for speed, a plain number for comparison. The loop runs along the strips of the
/// layout: a face's nodes are gathered once, their modes serve the elements on both sides, and the forces of
/// both leave together.
template <class Kernel, class Law, class Number>
class ElementAssembly final : public InternalForce<typename Lanes<Number>::Scalar> {
  static constexpr int width = Lanes<Number>::width;
  using Real = typename Lanes<Number>::Scalar;
  using ElementBlock = typename Kernel::template Element<Number>;
  using HistoryBlock = typename Kernel::template History<Number>;

 public:
  ElementAssembly(const Mesh& mesh, const Law& law, const HourglassSettings& settings, int threads)
      : layout_(make_layout(mesh, width)), law_(law), threads_(threads) {
    blocks_.resize(layout_.levels());
    for (const auto& group : layout_.groups) {
      for (std::size_t k = 0; k < group.levels; ++k) {
        blocks_[group.first_level + k] = element_block<Kernel, Number>(mesh, layout_, layout_.node_of_row,
                                                                       group.first_face + k, law, settings);
      }
    }
    streams_ = blocks_.size() * (sizeof(ElementBlock) + sizeof(HistoryBlock)) > cached_bytes;
    if constexpr (Kernel::needs_coordinates) {
      coordinates_ = centred_coordinates<Real>(mesh.points, layout_);
    }
  }

  const Layout& layout() const override { return layout_; }

  State<Real> rest() const override {
    State<Real> state{Rows<Real>(layout_.rows()), Rows<Real>(layout_.rows()), {}, {}};
    if constexpr (Kernel::averages_over_nodes) state.volumes.resize(layout_.rows());
    if constexpr (Kernel::remembers) state.history.resize(blocks_.size() * history_numbers);
    return state;
  }

  bool needs_increment() const override { return Kernel::needs_increment; }

  void evaluate(State<Real>& state, Rows<Real>& force) const override {
    if constexpr (Kernel::averages_over_nodes) sum_volumes(state.u, state.volumes);
    sum_over_chunks(layout_, threads_, force, [&](std::size_t c) { add_chunk(c, state, numbers_of(force)); });
  }

  StrainEnergies energies(const State<Real>& state) const override {
    StrainEnergies sum;
    const auto law = at_step(law_, state.step);
    for_each_level(state, [&](std::size_t level, const ElementMotion<Number>& motion) {
      const auto energy = Kernel::energy(motion, blocks_[level], history(state, level), law);
      for (int lane = 0; lane < width; ++lane) {
        if (element_at(level, lane) < 0) continue;
        sum.strain += static_cast<double>(Lanes<Number>::get(energy.strain, lane));
        sum.hourglass += static_cast<double>(Lanes<Number>::get(energy.hourglass, lane));
      }
    });
    return sum;
  }

  void hourglass_energy_densities(const State<Real>& state, std::span<double> densities) const override {
    const auto law = at_step(law_, state.step);
    per_element(state, densities, [&](std::size_t level, const ElementMotion<Number>& motion) {
      const auto energy = Kernel::energy(motion, blocks_[level], history(state, level), law);
      return energy.hourglass / Kernel::volume(motion, blocks_[level]);
    });
  }

  void jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    per_element(state, jacobians, [&](std::size_t level, const ElementMotion<Number>& motion) {
      return Kernel::mean_jacobian(motion, blocks_[level]);
    });
  }

  void smallest_jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    per_element(state, jacobians, [&](std::size_t level, const ElementMotion<Number>& motion) {
      return Kernel::smallest_jacobian(motion, blocks_[level]);
    });
  }

  void stiffness_bounds(const State<Real>& state, std::span<double> bounds) const override {
    const auto law = at_step(law_, state.step);
    per_element(state, bounds, [&](std::size_t level, const ElementMotion<Number>& motion) {
      return Kernel::stiffness_bound(motion, blocks_[level], history(state, level), law);
    });
  }

 private:
  using Faces = FaceModes<Number>;

  /// A face's part of an `ElementMotion`.
  struct FaceMotion {
    Faces u;
    Faces increment;
    Faces X;
    std::array<Number, 4> dilatation;
  };

  /// Sets each row of `volumes` to the change of volume around the node and to that volume at rest (m^3), a
  /// third number unused.
  void sum_volumes(const Rows<Real>& u, Rows<Real>& volumes) const {
    sum_over_chunks(layout_, threads_, volumes,
                    [&](std::size_t c) { add_volumes(c, u, numbers_of(volumes)); });
  }

  /// Adds those of one chunk, as `add_chunk` does forces.
  [[gnu::flatten, gnu::aligned(64)]] void add_volumes(std::size_t c, const Rows<Real>& u,
                                                      Real* volumes) const {
    const Layout::Chunk chunk = layout_.chunks[c];
    for (std::size_t g = chunk.first; g < chunk.last; ++g) {
      const Layout::Group group = layout_.groups[g];
      Faces lower = gather_rows(u, group.first_face);
      NodalVolumes<Number> carried{};
      for (std::size_t k = 0; k < group.levels; ++k) {
        const Faces upper = gather_rows(u, group.first_face + k + 1);
        ElementMotion<Number> motion;
        motion.u = modes_between(lower, upper);
        const auto own = Kernel::nodal_volumes(motion, blocks_[group.first_level + k]);
        scatter_volumes(carried, own, group.first_face + k, volumes);
        carried = own;
        lower = upper;
      }
      scatter_volumes(carried, NodalVolumes<Number>{}, group.first_face + group.levels, volumes);
    }
  }

  /// Adds to the rows of a face what the element below and the one above have there.
  void scatter_volumes(const NodalVolumes<Number>& below, const NodalVolumes<Number>& above, std::size_t face,
                       Real* volumes) const {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      scatter_add<Number>({below.change[4 + corner] + above.change[corner],
                           below.rest[4 + corner] + above.rest[corner], Number(Real(0))},
                          volumes, layout_.places(face, corner));
    }
  }

  std::array<Number, 4> gather_dilatations(const Rows<Real>& volumes, std::size_t face) const {
    std::array<Number, 4> dilatations;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto [change, rest, unused] = gather<Number>(numbers_of(volumes), layout_.places(face, corner));
      dilatations[corner] = change / rest;
    }
    return dilatations;
  }

  /// Adds the forces of one chunk. Without `flatten` the compiler leaves small matrix functions out of line,
  /// which costs a third of the time.
  [[gnu::flatten, gnu::aligned(64)]] void add_chunk(std::size_t c, State<Real>& state, Real* force) const {
    const Layout::Chunk chunk = layout_.chunks[c];
    const auto law = at_step(law_, state.step);  // a copy that no store can alias: moduli are computed once
    const bool timeless = !(state.step < std::numeric_limits<double>::infinity());
    const Number inverse_step(static_cast<Real>(1.0 / state.step));
    for (std::size_t g = chunk.first; g < chunk.last; ++g) {
      const Layout::Group group = layout_.groups[g];
      FaceMotion lower = gather_face(state, state.volumes, group.first_face);
      Faces carried{};
      for (std::size_t k = 0; k < group.levels; ++k) {
        const std::size_t level = group.first_level + k;
        const FaceMotion upper = gather_face(state, state.volumes, group.first_face + k + 1);
        if (streams_) prefetch_level(state, level + levels_ahead);
        HistoryBlock remembered = history(state, level);
        if (timeless) remembered.law = {};  // nothing of it counts, and a trial that failed may have left it
        const Modes<Number> f =
            Kernel::force(Kernel::deformation(between(lower, upper, inverse_step), blocks_[level]),
                          blocks_[level], remembered, law);
        keep_history(remembered, state, level);
        scatter_face(carried + lower_face(f), group.first_face + k, force);
        carried = upper_face(f);
        lower = upper;
      }
      scatter_face(carried, group.first_face + group.levels, force);
    }
  }

  /// Asks for the constants and the history of a level.
  void prefetch_level(const State<Real>& state, std::size_t level) const {
    if (level >= blocks_.size()) return;
    prefetch(blocks_.data() + level, sizeof(ElementBlock));
    if constexpr (Kernel::remembers) {
      prefetch(state.history.data() + level * history_numbers, sizeof(HistoryBlock));
    }
  }

  Faces gather_rows(const Rows<Real>& rows, std::size_t face) const {
    return gather_face_modes<Number>(rows, layout_, face);
  }

  FaceMotion gather_face(const State<Real>& state, const Rows<Real>& volumes, std::size_t face) const {
    FaceMotion motion;
    motion.u = gather_rows(state.u, face);
    if constexpr (Kernel::needs_increment) motion.increment = gather_rows(state.increment, face);
    if constexpr (Kernel::needs_coordinates) motion.X = gather_rows(coordinates_, face);
    if constexpr (Kernel::averages_over_nodes) motion.dilatation = gather_dilatations(volumes, face);
    return motion;
  }

  static ElementMotion<Number> between(const FaceMotion& lower, const FaceMotion& upper,
                                       const Number& inverse_step) {
    ElementMotion<Number> motion;
    motion.inverse_step = inverse_step;
    motion.u = modes_between(lower.u, upper.u);
    if constexpr (Kernel::needs_increment) motion.increment = modes_between(lower.increment, upper.increment);
    if constexpr (Kernel::needs_coordinates) motion.X = modes_between(lower.X, upper.X);
    if constexpr (Kernel::averages_over_nodes) {
      std::copy(lower.dilatation.begin(), lower.dilatation.end(), motion.dilatation.begin());
      std::copy(upper.dilatation.begin(), upper.dilatation.end(), motion.dilatation.begin() + 4);
    }
    return motion;
  }

  void scatter_face(const Faces& forces, std::size_t face, Real* force) const {
    scatter_face_modes(forces, force, layout_, face);
  }

  static constexpr std::size_t history_numbers = sizeof(HistoryBlock) / sizeof(Real);

  HistoryBlock history(const State<Real>& state, std::size_t level) const {
    HistoryBlock block;
    if constexpr (Kernel::remembers) {
      std::memcpy(&block, state.history.data() + level * history_numbers, sizeof block);
    }
    return block;
  }

  void keep_history(const HistoryBlock& block, State<Real>& state, std::size_t level) const {
    if constexpr (Kernel::remembers) {
      std::memcpy(state.history.data() + level * history_numbers, &block, sizeof block);
    }
  }

  int element_at(std::size_t level, int lane) const {
    return layout_.elements[level * width + static_cast<std::size_t>(lane)];
  }

  /// Calls visit(level, motion) for every block.
  template <class Visit>
  void for_each_level(const State<Real>& state, const Visit& visit) const {
    const Number inverse_step(static_cast<Real>(1.0 / state.step));
    Rows<Real> volumes;
    if constexpr (Kernel::averages_over_nodes) {
      volumes.resize(layout_.rows());
      sum_volumes(state.u, volumes);
    }
    for (const auto& group : layout_.groups) {
      FaceMotion lower = gather_face(state, volumes, group.first_face);
      for (std::size_t k = 0; k < group.levels; ++k) {
        const FaceMotion upper = gather_face(state, volumes, group.first_face + k + 1);
        visit(group.first_level + k, between(lower, upper, inverse_step));
        lower = upper;
      }
    }
  }

  /// Sets values[e] for every element of the mesh to its lane of evaluate(level, motion).
  template <class Evaluate>
  void per_element(const State<Real>& state, std::span<double> values, const Evaluate& evaluate) const {
    for_each_level(state, [&](std::size_t level, const ElementMotion<Number>& motion) {
      const Number value = evaluate(level, motion);
      for (int lane = 0; lane < width; ++lane) {
        const int e = element_at(level, lane);
        if (e >= 0)
          values[static_cast<std::size_t>(e)] = static_cast<double>(Lanes<Number>::get(value, lane));
      }
    });
  }

  Layout layout_;
  std::vector<ElementBlock> blocks_;
  Rows<Real> coordinates_;  // only where the kernel needs them
  Law law_;
  int threads_;
  bool streams_ = false;  // constants do not stay in the cache from step to step
};

}  // namespace sandglass
