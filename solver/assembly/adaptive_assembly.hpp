#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "assembly/chunk_sum.hpp"
#include "assembly/element_block.hpp"
#include "assembly/face_gather.hpp"
#include "assembly/internal_force.hpp"
#include "assembly/prefetch.hpp"
#include "assembly/strips.hpp"
#include "base/type_list.hpp"
#include "element/method_traits.hpp"

namespace sandglass {

template <class Levels, class Law, class Number>
class AdaptiveAssembly;

/// All elements of an adaptive method, each at one of its levels. The elements of a chunk that share a level
/// stand in groups of their own, so that loops stay monomorphic and packs full; a chunk is grouped anew when
/// the level of one of its elements changes. Kernels remember nothing.
template <class... Methods, class Law, class Number>
class AdaptiveAssembly<TypeList<Methods...>, Law, Number> final
    : public InternalForce<typename Lanes<Number>::Scalar> {
  static constexpr int width = Lanes<Number>::width;
  static constexpr std::size_t top = sizeof...(Methods) - 1;
  using Real = typename Lanes<Number>::Scalar;
  using Faces = FaceModes<Number>;

  /// The elements of a chunk at one level.
  template <class Kernel>
  struct Part : ElementGroups {
    using Element = typename Kernel::template Element<Number>;
    std::vector<Element> blocks;
  };

  /// One part for each level.
  using Parts = std::tuple<Part<FormulationOf<Methods, Law>>...>;

  struct Plan final : Grouping {
    std::vector<Real> levels;
    std::vector<std::shared_ptr<const Parts>> chunks;
  };

 public:
  AdaptiveAssembly(const Mesh& mesh, const Law& law, const HourglassSettings& settings, int threads)
      : mesh_(mesh),
        neighbours_(mesh),
        layout_(make_layout(mesh, width, SpareRows::everywhere)),
        coordinates_(centred_coordinates<Real>(mesh.points, layout_)),
        law_(law),
        settings_(settings),
        threads_(threads) {
    for (const auto& chunk : layout_.chunks) elements_.push_back(layout_.elements_of(chunk));
    rest_.u.resize(layout_.rows());
    rest_.increment.resize(layout_.rows());
    rest_.levels.resize(mesh.cells.size());
    regroup(rest_);
    streams_ = layout_.levels() * sizeof(std::get<0>(Parts{}).blocks[0]) > cached_bytes;
  }

  const Layout& layout() const override { return layout_; }
  State<Real> rest() const override { return rest_; }
  bool needs_increment() const override { return false; }

  void evaluate(State<Real>& state, Rows<Real>& force) const override {
    const Plan& plan = plan_of(state);
    sum_over_chunks(layout_, threads_, force, [&](std::size_t c) {
      std::apply([&](const auto&... part) { (add_part(part, state.u, numbers_of(force)), ...); },
                 *plan.chunks[c]);
    });
  }

  Adaptation adapt(State<Real>& state, const Rows<Real>& mobility, double length,
                   double demoting_length) const override {
    std::vector<std::array<double, top>> defects(mesh_.cells.size());
    in_parallel(layout_.chunks.size(), threads_,
                [&](std::size_t c) { measure_defects(layout_.chunks[c], state.u, mobility, defects); });
    std::vector<std::size_t> wanted(defects.size());
    for (std::size_t e = 0; e < defects.size(); ++e) {
      const auto level = static_cast<std::size_t>(state.levels[e]);
      const std::size_t needed = cheapest(defects[e], length), kept = cheapest(defects[e], demoting_length);
      wanted[e] = needed > level ? needed : demoting_length > 0.0 ? std::min(kept, level) : level;
    }
    for (const auto& elements : elements_) fill_lanes(elements, defects, wanted);
    Adaptation changes;
    for (std::size_t e = 0; e < wanted.size(); ++e) {
      const auto level = static_cast<Real>(wanted[e]);
      if (level > state.levels[e]) ++changes.promoted;
      if (level < state.levels[e]) ++changes.demoted;
      state.levels[e] = level;
    }
    if (changes.promoted + changes.demoted > 0) regroup(state);
    return changes;
  }

  void regroup(State<Real>& state) const override {
    const auto* before = static_cast<const Plan*>(state.grouping.get());
    for (const Real level : state.levels) {
      if (!(level >= Real(0) && level <= Real(top)) || level != std::floor(level)) {
        throw InputError("checkpoint: 'element level' must hold levels of the method");
      }
    }
    auto plan = std::make_shared<Plan>();
    plan->levels = state.levels;
    for (std::size_t c = 0; c < elements_.size(); ++c) {
      const bool same =
          before != nullptr && std::all_of(elements_[c].begin(), elements_[c].end(), [&](int e) {
            return before->levels[static_cast<std::size_t>(e)] == state.levels[static_cast<std::size_t>(e)];
          });
      plan->chunks.push_back(same ? before->chunks[c] : parts_of(c, state.levels));
    }
    state.grouping = std::move(plan);
  }

  StrainEnergies energies(const State<Real>& state) const override {
    StrainEnergies sum;
    for_each_element(state, [&]<class Kernel>(const ElementMotion<Number>& motion, const auto& element,
                                              const auto& for_each_lane) {
      const auto energy = Kernel::energy(motion, element, {}, law_);
      for_each_lane([&](std::size_t /*e*/, int lane) {
        sum.strain += static_cast<double>(Lanes<Number>::get(energy.strain, lane));
        sum.hourglass += static_cast<double>(Lanes<Number>::get(energy.hourglass, lane));
      });
    });
    return sum;
  }

  void hourglass_energy_densities(const State<Real>& state, std::span<double> densities) const override {
    per_element(
        state, densities, [&]<class Kernel>(const ElementMotion<Number>& motion, const auto& element) {
          return Kernel::energy(motion, element, {}, law_).hourglass / Kernel::volume(motion, element);
        });
  }

  void jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    per_element(state, jacobians, []<class Kernel>(const ElementMotion<Number>& motion, const auto& element) {
      return Kernel::mean_jacobian(motion, element);
    });
  }

  void smallest_jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    per_element(state, jacobians, []<class Kernel>(const ElementMotion<Number>& motion, const auto& element) {
      return Kernel::smallest_jacobian(motion, element);
    });
  }

  void stiffness_bounds(const State<Real>& state, std::span<double> bounds) const override {
    per_element(state, bounds, [&]<class Kernel>(const ElementMotion<Number>& motion, const auto& element) {
      return Kernel::stiffness_bound(motion, element, {}, law_);
    });
  }

 private:
  static const Plan& plan_of(const State<Real>& state) { return static_cast<const Plan&>(*state.grouping); }

  /// The lowest level whose defect is no longer than `length`.
  static std::size_t cheapest(const std::array<double, top>& defects, double length) {
    std::size_t level = 0;
    while (level < top && !(defects[level] <= length)) ++level;
    return level;
  }

  /// Lanes of a chunk that a level leaves empty are computed with the others: the elements of the level below
  /// that come nearest to needing it take them. As many lanes as packs have, whatever `Number` is, so that
  /// the levels are the same for all.
  static void fill_lanes(const std::vector<int>& elements,
                         const std::vector<std::array<double, top>>& defects,
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

  std::shared_ptr<const Parts> parts_of(std::size_t c, const std::vector<Real>& levels) const {
    auto parts = std::make_shared<Parts>();
    Real level = 0;
    std::apply([&](auto&... part) { (fill_part(part, c, levels, level++), ...); }, *parts);
    return parts;
  }

  template <class Kernel>
  void fill_part(Part<Kernel>& part, std::size_t c, const std::vector<Real>& levels, Real level) const {
    std::vector<int> chosen;
    std::copy_if(elements_[c].begin(), elements_[c].end(), std::back_inserter(chosen),
                 [&](int e) { return levels[static_cast<std::size_t>(e)] == level; });
    static_cast<ElementGroups&>(part) = groups_within(layout_, layout_.chunks[c], mesh_, neighbours_, chosen);
    part.blocks.resize(part.levels());
    for (const auto& group : part.groups) {
      for (std::size_t k = 0; k < group.levels; ++k) {
        part.blocks[group.first_level + k] = element_block<Kernel, Number>(
            mesh_, part, layout_.node_of_row, group.first_face + k, law_, settings_);
      }
    }
  }

  /// Adds the forces of a part. For `flatten` see ElementAssembly.
  template <class Kernel>
  [[gnu::flatten, gnu::aligned(64)]] void add_part(const Part<Kernel>& part, const Rows<Real>& u,
                                                   Real* force) const {
    const Law law = law_;  // a copy that no store can alias
    typename Kernel::template History<Number> none;
    for (const auto& group : part.groups) {
      Faces lower = gather_face_modes<Number>(u, part, group.first_face);
      Faces carried{};
      for (std::size_t k = 0; k < group.levels; ++k) {
        const auto& element = part.blocks[group.first_level + k];
        if (streams_ && group.first_level + k + levels_ahead < part.blocks.size()) {
          prefetch(part.blocks.data() + group.first_level + k + levels_ahead, sizeof(element));
        }
        const Faces upper = gather_face_modes<Number>(u, part, group.first_face + k + 1);
        const Modes<Number> f =
            Kernel::force(Kernel::deformation(motion_between(lower, upper), element), element, none, law);
        scatter_face_modes(carried + lower_face(f), force, part, group.first_face + k);
        carried = upper_face(f);
        lower = upper;
      }
      scatter_face_modes(carried, force, part, group.first_face + group.levels);
    }
  }

  static ElementMotion<Number> motion_between(const Faces& lower, const Faces& upper) {
    ElementMotion<Number> motion;
    motion.u = modes_between(lower, upper);
    return motion;
  }

  /// Sets defects[e][level] (m) for the elements of a chunk; see `adapt`. Constants of all levels are
  /// computed anew from the coordinates: few are at hand.
  void measure_defects(const Layout::Chunk& chunk, const Rows<Real>& u, const Rows<Real>& mobility,
                       std::vector<std::array<double, top>>& defects) const {
    for (std::size_t g = chunk.first; g < chunk.last; ++g) {
      const auto& group = layout_.groups[g];
      for (std::size_t k = 0; k < group.levels; ++k) {
        const std::size_t face = group.first_face + k;
        const auto squares = squared_defects(u, mobility, face);
        for (int lane = 0; lane < width; ++lane) {
          const int e = layout_.elements[(group.first_level + k) * width + static_cast<std::size_t>(lane)];
          if (e < 0) continue;
          for (std::size_t level = 0; level < top; ++level) {
            defects[static_cast<std::size_t>(e)][level] =
                std::sqrt(static_cast<double>(Lanes<Number>::get(squares[level], lane)));
          }
        }
      }
    }
  }

  /// Squares (m^2) of the defects of the elements between a face of the layout and the next.
  [[gnu::flatten]] std::array<Number, top> squared_defects(const Rows<Real>& u, const Rows<Real>& mobility,
                                                           std::size_t face) const {
    const auto modes = [&](const Rows<Real>& rows) {
      return modes_between(gather_face_modes<Number>(rows, layout_, face),
                           gather_face_modes<Number>(rows, layout_, face + 1));
    };
    ElementMotion<Number> motion;
    motion.u = modes(u);
    const Modes<Number> x = modes(coordinates_);
    const NodalVectors<Number> mobilities =
        nodes_of(gather_face_vectors<Number>(mobility, layout_, face),
                 gather_face_vectors<Number>(mobility, layout_, face + 1));
    const std::array<Modes<Number>, top + 1> forces{force_at<FormulationOf<Methods, Law>>(motion, x)...};
    std::array<Number, top> squares;
    for (std::size_t level = 0; level < top; ++level) {
      const NodalVectors<Number> difference = from_modes(forces[level] - forces[top]);
      squares[level] = Number(Real(0));
      for (int I = 0; I < 8; ++I) {
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
  Modes<Number> force_at(const ElementMotion<Number>& motion, const Modes<Number>& x) const {
    const auto element = Kernel::template constants<Number>(x, law_, settings_);
    typename Kernel::template History<Number> none;
    return Kernel::force(Kernel::deformation(motion, element), element, none, law_);
  }

  /// Calls visit.operator()<Kernel>(motion, element, for_each_lane) for every block of every part;
  /// for_each_lane calls back with the number of the element in each lane that has one.
  template <class Visit>
  void for_each_element(const State<Real>& state, const Visit& visit) const {
    const auto visit_part = [&]<class Kernel>(const Part<Kernel>& part) {
      for (const auto& group : part.groups) {
        for (std::size_t k = 0; k < group.levels; ++k) {
          const std::size_t level = group.first_level + k, face = group.first_face + k;
          const auto motion = motion_between(gather_face_modes<Number>(state.u, part, face),
                                             gather_face_modes<Number>(state.u, part, face + 1));
          visit.template operator()<Kernel>(motion, part.blocks[level], [&](const auto& use) {
            for (int lane = 0; lane < width; ++lane) {
              const int e = part.elements[level * width + static_cast<std::size_t>(lane)];
              if (e >= 0) use(static_cast<std::size_t>(e), lane);
            }
          });
        }
      }
    };
    for (const auto& parts : plan_of(state).chunks) {
      std::apply([&](const auto&... part) { (visit_part(part), ...); }, *parts);
    }
  }

  /// Sets values[e] for every element to its lane of evaluate.operator()<Kernel>(motion, element).
  template <class Evaluate>
  void per_element(const State<Real>& state, std::span<double> values, const Evaluate& evaluate) const {
    for_each_element(state, [&]<class Kernel>(const ElementMotion<Number>& motion, const auto& element,
                                              const auto& for_each_lane) {
      const Number value = evaluate.template operator()<Kernel>(motion, element);
      for_each_lane(
          [&](std::size_t e, int lane) { values[e] = static_cast<double>(Lanes<Number>::get(value, lane)); });
    });
  }

  Mesh mesh_;
  NodeElements neighbours_;
  Layout layout_;                           // of all elements
  std::vector<std::vector<int>> elements_;  // of each chunk
  Rows<Real> coordinates_;
  Law law_;
  HourglassSettings settings_;
  int threads_;
  State<Real> rest_;
  bool streams_ = false;  // constants do not stay in the cache from step to step
};

}  // namespace sandglass
