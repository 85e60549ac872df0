#pragma once

#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "assembly/levelled_elements.hpp"
#include "base/hot_loop.hpp"
#include "material/called_tangent.hpp"
#include "material/material_axes.hpp"
#include "material/memory.hpp"

namespace sandglass {

/// The elements of a mesh with a law for each material: all functions that do not run in every step. Laws are
/// called here, so that one class serves all elastic laws, and a second one all viscoelastic laws.
template <class Levels, class Law, class Number>
class ElementAssembly;

template <class... Methods, class Law, class Number>
class ElementAssembly<TypeList<Methods...>, Law, Number>
    : public LevelledElements<TypeList<Methods...>, Number> {
  using Base = LevelledElements<TypeList<Methods...>, Number>;

 protected:
  using Base::layout_, Base::width, Base::top;
  using typename Base::Real, typename Base::BlockPlace;
  template <class Method>
  using KernelOf = FormulationOf<Method, Law>;

  static_assert(!Base::adapts || !law_remembers<Law>,
                "the memory of one integration point does not determine that of eight");
  static constexpr bool remembers = (KernelOf<Methods>::remembers || ...);

  template <class Method>
  using HistoryBlock = typename KernelOf<Method>::template History<Number>;
  using OnlyHistory = HistoryBlock<std::tuple_element_t<0, std::tuple<Methods...>>>;
  static constexpr std::size_t history_numbers = remembers ? sizeof(OnlyHistory) / sizeof(Real) : 0;

 public:
  template <class LoopLaw>
  ElementAssembly(const Mesh& mesh, const Materials& materials, const std::vector<LoopLaw>& laws,
                  const HourglassSettings& settings, const Team& team)
      : Base(mesh, materials, settings, team), laws_(laws.begin(), laws.end()) {}

  State<Real> undeformed() const override {
    State<Real> state = Base::undeformed();
    state.history.resize(history_numbers * layout_->packs() + this->volume_numbers());
    return state;
  }

  void gather(State<Real>& state) const override {
    layout_->gather_rows(state.u.data());
    layout_->gather_rows(state.increment.data());
    layout_->gather_cells(state.history.data(), history_numbers / width);
    for (std::size_t n = 0; n < this->volume_numbers(); n += this->volumes_of_each()) {
      Real* const volumes = volumes_of(state) + n;
      layout_->gather_rows(volumes, 4);
      std::fill(volumes + 4 * layout_->nodes, volumes + 4 * layout_->rows(), Real(0));  // whatever the ranks
    }
  }

  StrainEnergies energies(const State<Real>& state) const override {
    std::vector<double> partial(2 * layout_->chunks.size());  // strain and hourglass energy of chunks
    const auto laws = laws_at(state.step);
    this->for_each_block(state, [&]<class Method>(const auto& motion, const auto& element, BlockPlace at,
                                                  const auto& for_each_lane) {
      const auto energy = KernelOf<Method>::energy(motion, element, history<Method>(state, at.pack),
                                                   with_axes(laws[at.material], at.axes));
      for_each_lane([&](std::size_t /*e*/, int lane) {
        partial[2 * at.chunk] += static_cast<double>(Lanes<Number>::get(energy.strain, lane));
        partial[2 * at.chunk + 1] += static_cast<double>(Lanes<Number>::get(energy.hourglass, lane));
      });
    });
    layout_->team.ranks->sum(partial);
    StrainEnergies sum;
    for (std::size_t c = 0; c < layout_->chunks.size(); ++c) {
      sum.strain += partial[2 * c];
      sum.hourglass += partial[2 * c + 1];
    }
    return sum;
  }

  void hourglass_energy_densities(const State<Real>& state, std::span<double> densities) const override {
    const auto laws = laws_at(state.step);
    this->per_element(
        state, densities, [&]<class Method>(const auto& motion, const auto& element, BlockPlace at) {
          using Kernel = KernelOf<Method>;
          const auto remembered = history<Method>(state, at.pack);
          return Kernel::energy(motion, element, remembered, with_axes(laws[at.material], at.axes))
                     .hourglass /
                 Kernel::volume(motion, element);
        });
  }

  void stresses(const State<Real>& state, const Rows<Real>& coordinates,
                std::span<double> stresses) const override {
    const auto laws = laws_at(0.0);
    this->for_each_block(state, [&]<class Method>(const auto& motion, const auto& element, BlockPlace at,
                                                  const auto& for_each_lane) {
      const Modes<Number> X = modes_between(gather_face_modes<Number>(coordinates, *at.groups, at.face),
                                            gather_face_modes<Number>(coordinates, *at.groups, at.face + 1));
      const Tensor<Number> sigma = KernelOf<Method>::mean_stress(
          motion, X, element, history<Method>(state, at.pack), with_axes(laws[at.material], at.axes));
      for_each_lane([&](std::size_t e, int lane) {
        for (std::size_t n = 0; n < 9; ++n) {
          stresses[9 * e + n] = static_cast<double>(Lanes<Number>::get(sigma.entries[n], lane));
        }
      });
    });
  }

  void powers(const State<Real>& state, const Rows<Real>& v, std::span<double> powers) const override {
    if constexpr (std::is_same_v<Real, double>) {
      const auto laws = laws_at(state.step);
      this->per_element(
          state, powers, [&]<class Method>(const auto& motion, const auto& element, BlockPlace at) {
            return power<Method>(motion, element, history<Method>(state, at.pack),
                                 with_axes(laws[at.material], at.axes),
                                 nodes_of(gather_face_vectors<Number>(v, *at.groups, at.face),
                                          gather_face_vectors<Number>(v, *at.groups, at.face + 1)));
          });
    } else {
      throw std::logic_error("powers of elements are computed in double precision");
    }
  }

  void stiffness_bounds(const State<Real>& state, std::span<double> bounds) const override {
    const auto laws = laws_at(state.step);
    this->per_element(
        state, bounds, [&]<class Method>(const auto& motion, const auto& element, BlockPlace at) {
          const auto remembered = history<Method>(state, at.pack);
          const auto oriented = with_axes(laws[at.material], at.axes);
          const auto& law = recalling(oriented, remembered.law);
          return Base::template stiffness_bound<Method>(motion, element, remembered.hourglass,
                                                        CalledTangent<Number>(laws_[at.material], law));
        });
  }

  Adaptation adapt(State<Real>& state, const Rows<Real>& mobility, double length,
                   double demoting_length) const override {
    Adaptation changes;
    if constexpr (Base::adapts) {
      const std::vector<std::size_t> before = Base::plan_of(state).levels;
      std::vector<Defects> defects(before.size());
      layout_->for_each_local_chunk(
          [&](std::size_t c) { measure_defects(layout_->chunks[c], state.u, mobility, defects); });
      std::vector<std::size_t> wanted = before;
      std::array<double, 2> changed{};  // promoted, demoted
      for (std::size_t c = layout_->local_chunks.first; c < layout_->local_chunks.last; ++c) {
        const std::vector<int>& elements = this->elements_of_chunks()[c];
        for (const int number : elements) {
          const auto e = static_cast<std::size_t>(number);
          const std::size_t needed = cheapest(defects[e], length),
                            kept = cheapest(defects[e], demoting_length);
          wanted[e] = needed > before[e]      ? needed
                      : demoting_length > 0.0 ? std::min(kept, before[e])
                                              : before[e];
        }
        fill_lanes(elements, defects, wanted);
        if (c >= layout_->own_chunks.last) continue;
        for (const int number : elements) {
          const auto e = static_cast<std::size_t>(number);
          if (wanted[e] != before[e]) ++changed[wanted[e] < before[e]];
        }
      }
      layout_->team.ranks->sum(changed);
      changes = {static_cast<std::size_t>(changed[0]), static_cast<std::size_t>(changed[1])};
      if (changes.promoted + changes.demoted > 0) this->regroup(state, std::move(wanted));
    }
    return changes;
  }

 protected:
  template <class Method>
  HistoryBlock<Method> history(const State<Real>& state, std::size_t block) const {
    HistoryBlock<Method> remembered;
    if constexpr (remembers) {
      std::memcpy(&remembered, state.history.data() + block * history_numbers, sizeof remembered);
    }
    return remembered;
  }

  template <class Method>
  void keep_history(const HistoryBlock<Method>& remembered, State<Real>& state, std::size_t block) const {
    if constexpr (remembers) {
      std::memcpy(state.history.data() + block * history_numbers, &remembered, sizeof remembered);
    }
  }

  /// The volumes around nodes in the history, for elements that average over nodes.
  Real* volumes_of(State<Real>& state) const {
    return state.history.data() + history_numbers * layout_->packs();
  }

  std::vector<Law> laws_;  // of each material

 private:
  /// Runs in every step of a motion's derivatives.
  template <class Method, class Element, class LawAtStep>
  SANDGLASS_HOT_LOOP static Number power(const ElementMotion<Number>& motion, const Element& element,
                                         HistoryBlock<Method> remembered, const LawAtStep& law,
                                         const NodalVectors<Number>& v) {
    using Kernel = KernelOf<Method>;
    return double_dot(
        from_modes(Kernel::force(Kernel::deformation(motion, element), element, remembered, law)), v);
  }

  auto laws_at(double step) const {
    std::vector<std::decay_t<decltype(at_step(laws_.front(), step))>> laws;
    for (const Law& law : laws_) laws.push_back(at_step(law, step));
    return laws;
  }

  /// For each level except the highest its difference from the highest, as a displacement (m); see `adapt`.
  using Defects = std::array<double, top>;

  /// The lowest level whose defect is at most `length` (m).
  static std::size_t cheapest(const Defects& defects, double length) {
    std::size_t level = 0;
    while (level < top && !(defects[level] <= length)) ++level;
    return level;
  }

  /// Fills the lanes of a chunk that a level would leave empty, since empty lanes cost as much: with the
  /// elements of the level below that are closest to needing it. The number of lanes is that of packs for
  /// every `Number`, so that all choose the same levels.
  static void fill_lanes(const std::vector<int>& elements, const std::vector<Defects>& defects,
                         std::vector<std::size_t>& wanted) {
    constexpr std::size_t lanes = Lanes<Pack<Real>>::width;
    for (std::size_t level = top; level > 0; --level) {
      std::vector<std::size_t> below;
      std::size_t at_level = 0;
      for (const int number : elements) {
        const auto e = static_cast<std::size_t>(number);
        if (wanted[e] == level) ++at_level;
        if (wanted[e] + 1 == level) below.push_back(e);
      }
      const std::size_t empty = std::min((lanes - at_level % lanes) % lanes, below.size());
      std::partial_sort(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(empty), below.end(),
                        [&](std::size_t a, std::size_t b) {
                          return std::pair(-defects[a][level - 1], a) < std::pair(-defects[b][level - 1], b);
                        });
      for (std::size_t k = 0; k < empty; ++k) wanted[below[k]] = level;
    }
  }

  /// Sets the defects of the elements of a chunk. The constants of all levels are recomputed from the
  /// coordinates, since those of most levels are not stored.
  void measure_defects(const Layout::Chunk& chunk, const Rows<Real>& u, const Rows<Real>& mobility,
                       std::vector<Defects>& defects) const {
    for_each_pack(*layout_, chunk.first, chunk.last, [&](const StripPlace& at) {
      const int* const elements = layout_->elements.data() + at.pack * width;
      const auto axes = axes_of_block<Number>(this->plans_.axes(), elements);
      const auto squares = squared_defects(u, mobility, at.face, at.material, axes ? &*axes : nullptr);
      for (int lane = 0; lane < width; ++lane) {
        if (elements[lane] < 0) continue;
        for (std::size_t level = 0; level < top; ++level) {
          defects[static_cast<std::size_t>(elements[lane])][level] =
              std::sqrt(static_cast<double>(Lanes<Number>::get(squares[level], lane)));
        }
      }
    });
  }

  /// The squares (m^2) of the defects of the elements between a face of the layout and the next one.
  SANDGLASS_HOT_LOOP std::array<Number, top> squared_defects(const Rows<Real>& u, const Rows<Real>& mobility,
                                                             std::size_t face, std::size_t material,
                                                             const MaterialAxes<Number>* axes) const {
    const auto modes = [&](const Rows<Real>& rows) {
      return modes_between(gather_face_modes<Number>(rows, *layout_, face),
                           gather_face_modes<Number>(rows, *layout_, face + 1));
    };
    ElementMotion<Number> motion;
    motion.u = modes(u);
    const Modes<Number> x = modes(this->coordinates_);
    const NodalVectors<Number> mobilities =
        nodes_of(gather_face_vectors<Number>(mobility, *layout_, face),
                 gather_face_vectors<Number>(mobility, *layout_, face + 1));
    const std::array<Modes<Number>, top + 1> forces{
        force_at<KernelOf<Methods>>(motion, x, material, axes)...};
    std::array<Number, top> squares;
    for (std::size_t level = 0; level < top; ++level) {
      const NodalVectors<Number> difference = from_modes(forces[level] - forces[top]);
      squares[level] = Number(Real(0));
      for (int I = 0; I < difference.rows; ++I) {
        Number square(Real(0));
        for (int i = 0; i < 3; ++i) {
          const Number moved = mobilities(I, i) * difference(I, i);
          square = square + moved * moved;
        }
        squares[level] = max(squares[level], square);
      }
    }
    return squares;
  }

  template <class Kernel>
  Modes<Number> force_at(const ElementMotion<Number>& motion, const Modes<Number>& x, std::size_t material,
                         const MaterialAxes<Number>* axes) const {
    const Law& law = laws_[material];
    const auto element = Kernel::template constants<Number>(x, law, this->plans_.setup_of(material).settings);
    typename Kernel::template History<Number> none;
    return Kernel::force(Kernel::deformation(motion, element), element, none, with_axes(law, axes));
  }
};

/// The distance, in packs, between computing and prefetching element constants that do not remain in a core's
/// caches from step to step: long enough for memory to respond, short enough for the first-level cache.
inline constexpr std::size_t packs_ahead = 3;

/// Prefetches `size` bytes from `start` on.
inline void prefetch(const void* start, std::size_t size) {
  constexpr std::size_t cache_line = 64;
  for (std::size_t n = 0; n < size; n += cache_line) __builtin_prefetch(static_cast<const char*>(start) + n);
}

/// The loop of a time step. `LoopLaw` is the law that the loop is compiled for: that of the assembly, or an
/// elastic law that the compiler can inline.
template <class Levels, class Law, class LoopLaw, class Number>
class ForceLoop final : public ElementAssembly<Levels, Law, Number> {
  using Base = ElementAssembly<Levels, Law, Number>;
  using typename Base::Faces, typename Base::FaceMotion, typename Base::Real;

 public:
  ForceLoop(const Mesh& mesh, const Materials& materials, const std::vector<LoopLaw>& laws,
            const HourglassSettings& settings, const Team& team)
      : Base(mesh, materials, laws, settings, team), loop_laws_(laws) {}

  void evaluate(State<Real>& state, Rows<Real>& force) const override {
    const auto& plan = Base::plan_of(state);
    if constexpr (Base::averages_over_nodes) this->sum_volumes(state, this->volumes_of(state));
    sum_over_chunks(*this->layout_, numbers_of(force), [&](std::size_t c) {
      std::apply([&](const auto&... part) { (add_forces(part, state, numbers_of(force)), ...); },
                 *plan.chunks[c]);
    });
  }

 private:
  /// Adds the forces of a part: of runs of groups of one material.
  template <class Method>
  void add_forces(const typename Base::template Part<Method>& part, State<Real>& state, Real* force) const {
    part.groups->for_each_run(part.first, part.last, [&](std::size_t first, std::size_t last) {
      add_forces(part, first, last, loop_laws_[part.groups->groups[first].material], state, force);
    });
  }

  /// Adds the forces of groups `first` to `last` - 1 of a part.
  template <class Method>
  SANDGLASS_HOT_LOOP void add_forces(const typename Base::template Part<Method>& part, std::size_t first,
                                     std::size_t last, const LoopLaw& loop_law, State<Real>& state,
                                     Real* force) const {
    using Kernel = typename Base::template KernelOf<Method>;
    const ElementGroups& groups = *part.groups;
    const auto law =
        at_step(loop_law, state.step);  // a copy that no store can alias, so that moduli are computed once
    const bool timeless = !(state.step < std::numeric_limits<double>::infinity());
    const Number inverse_step(static_cast<Real>(1.0 / state.step));
    const Real* const volumes = this->volumes_of(state);
    const auto* const blocks = part.blocks.data();
    const std::size_t first_block = part.first_block;
    walk_strips(
        groups, first, last,
        [&](std::size_t face, std::size_t material) {
          return this->template gather_face<Method>(groups, state, volumes, material, face);
        },
        [&](const FaceMotion& lower, const FaceMotion& upper, const StripPlace& at) {
          const auto& element = blocks[at.pack - first_block];
          if (this->streams_) prefetch_block(part, state, at.pack + packs_ahead);
          auto remembered = this->template history<Method>(state, at.pack);
          if (timeless) remembered.law = {};  // irrelevant here, and possibly left by a failed trial
          const Modes<Number> f =
              Kernel::force(Kernel::deformation(motion_between<Kernel>(lower, upper, inverse_step), element),
                            element, remembered, with_axes(law, part.axes_at(at.pack)));
          this->template keep_history<Method>(remembered, state, at.pack);
          return on_faces(f);
        },
        [&](const Faces& sum, std::size_t face) { scatter_face_modes(sum, force, groups, face); });
  }

  /// Prefetches the constants and the history of a block.
  template <class Part>
  void prefetch_block(const Part& part, const State<Real>& state, std::size_t block) const {
    if (block - part.first_block >= part.blocks.size()) return;
    prefetch(part.blocks.data() + (block - part.first_block), sizeof(part.blocks[0]));
    if constexpr (Base::remembers) {
      prefetch(state.history.data() + block * Base::history_numbers, Base::history_numbers * sizeof(Real));
    }
  }

  std::vector<LoopLaw> loop_laws_;  // of each material
};

}  // namespace sandglass
