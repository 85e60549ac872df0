#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "assembly/chunk_sum.hpp"
#include "assembly/element_plans.hpp"
#include "assembly/face_motion.hpp"
#include "assembly/internal_force.hpp"
#include "assembly/strip_walk.hpp"
#include "base/error.hpp"
#include "base/hot_loop.hpp"
#include "base/type_list.hpp"
#include "element/method_traits.hpp"
#include "element/replaced_pressure.hpp"
#include "material/called_tangent.hpp"

namespace sandglass {

template <class Levels, class Number>
class LevelledElements;

/// The elements of a mesh, each at one of the levels of its method; a method that is not adaptive has one
/// level. The elements of a chunk at the same level form groups, in blocks of as many elements as `Number`
/// has lanes, so that each loop runs one kernel with full packs. Everything here is independent of the law.
///
/// Loops run along the strips of a group: the nodes of a face are gathered once, their modes serve the
/// elements on both sides, and the forces of both are scattered together.
template <class... Methods, class Number>
class LevelledElements<TypeList<Methods...>, Number> : public InternalForce<typename Lanes<Number>::Scalar> {
 protected:
  static constexpr int width = Lanes<Number>::width;
  static constexpr std::size_t top = sizeof...(Methods) - 1;
  using Real = typename Lanes<Number>::Scalar;
  using Faces = FaceModes<Number>;

  /// A method's elements with the law of their set-up; what is used here does not depend on the law.
  template <class Method>
  using KernelOf = FormulationOf<Method, CalledLaw>;

  static constexpr bool adapts = top > 0;
  static constexpr bool uses_increment = (KernelOf<Methods>::needs_increment || ...);
  static constexpr bool uses_coordinates = (KernelOf<Methods>::needs_coordinates || ...);
  static constexpr bool averages_over_nodes = (KernelOf<Methods>::averages_over_nodes || ...);

  template <class Method>
  using Part = ElementPart<Method, Number>;
  using Plans = ElementPlans<TypeList<Methods...>, Number>;
  using Plan = typename Plans::Plan;
  using Parts = typename Plans::Parts;

 public:
  LevelledElements(const Mesh& mesh, const Materials& materials, const HourglassSettings& settings,
                   const Team& team)
      : layout_(std::make_shared<Layout>(make_layout(mesh, width,
                                                     adapts ? SpareRows::everywhere : SpareRows::where_needed,
                                                     materials.of_element, team))),
        plans_(mesh, materials, settings, layout_),
        alike_(numbers_of_alike(materials)) {
    if constexpr (uses_coordinates || adapts) {
      coordinates_ = centred_coordinates<Real>(mesh.points, *layout_);
    }
    constexpr std::size_t cached_bytes = std::size_t{2} << 20U;  // that a core may keep in its own caches
    using Cheapest = typename std::tuple_element_t<0, Parts>::Element;
    streams_ = layout_->packs() * sizeof(Cheapest) > cached_bytes;
  }

  const Layout& layout() const override { return *layout_; }
  bool needs_increment() const override { return uses_increment; }

  State<Real> undeformed() const override {
    State<Real> state;
    state.u.resize(layout_->rows());
    state.increment.resize(layout_->rows());
    state.levels = plans_.undeformed();
    return state;
  }

  std::vector<double> levels(const State<Real>& state) const override {
    const auto& levels = plan_of(state).levels;
    return {levels.begin(), levels.end()};
  }

  void set_levels(State<Real>& state, const std::vector<double>& levels) const override {
    if constexpr (adapts) {
      std::vector<std::size_t> wanted;
      for (const double level : levels) {
        if (!(level >= 0.0 && level <= static_cast<double>(top)) || level != std::floor(level)) {
          throw InputError("checkpoint: 'element level' must contain levels of the method");
        }
        wanted.push_back(static_cast<std::size_t>(level));
      }
      regroup(state, std::move(wanted));
    }
  }

  void replace_pressures(const State<Real>& state, std::span<const Real> p, std::span<const double> lambdas,
                         Rows<Real>& force, std::span<Real> defect) const override {
    const Plan& plan = plan_of(state);
    const std::vector<Real> volumes = volumes_around_nodes(state);
    sum_over_chunks(*layout_, numbers_of(force), [&](std::size_t c) {
      std::apply(
          [&](const auto&... part) {
            (add_pressures(part, state, volumes.data(), p, lambdas, numbers_of(force), defect), ...);
          },
          *plan.chunks[c]);
    });
  }

  void jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    per_element(state, jacobians, []<class Method>(const auto& motion, const auto& element, BlockPlace) {
      return KernelOf<Method>::mean_jacobian(motion, element);
    });
  }

  void smallest_jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    per_element(state, jacobians, []<class Method>(const auto& motion, const auto& element, BlockPlace) {
      return smallest_jacobian<Method>(motion, element);
    });
  }

 protected:
  static const Plan& plan_of(const State<Real>& state) { return static_cast<const Plan&>(*state.levels); }

  /// Gives the elements new levels.
  void regroup(State<Real>& state, std::vector<std::size_t> levels) const {
    state.levels = plans_.at_levels(std::move(levels), plan_of(state));
  }

  const std::vector<std::vector<int>>& elements_of_chunks() const { return plans_.elements_of_chunks(); }

  using FaceMotion = sandglass::FaceMotion<Number>;

  /// Of `volumes` only those of the elements' own and like materials are used.
  template <class Method>
  FaceMotion gather_face(const ElementGroups& groups, const State<Real>& state, const Real* volumes,
                         std::size_t material, std::size_t face) const {
    FaceMotion motion;
    motion.u = gather_face_modes<Number>(state.u, groups, face);
    if constexpr (KernelOf<Method>::needs_increment) {
      motion.increment = gather_face_modes<Number>(state.increment, groups, face);
    }
    if constexpr (KernelOf<Method>::needs_coordinates) {
      motion.X = gather_face_modes<Number>(coordinates_, groups, face);
    }
    if constexpr (KernelOf<Method>::averages_over_nodes) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto [change, reference, unused] =
            gather<Number>(volumes + alike_[material] * volumes_of_each(), groups.places(face, corner));
        motion.dilatation[corner] = change / reference;
      }
    }
    return motion;
  }

  /// The numbers in `sum_volumes` of materials that are alike, and of all; none unless volumes are averaged.
  std::size_t volumes_of_each() const { return averages_over_nodes ? 4 * layout_->rows() : 0; }
  std::size_t volume_numbers() const {
    return (*std::max_element(alike_.begin(), alike_.end()) + 1) * volumes_of_each();
  }

  /// Sets, for one material after the other, each row of `volumes`, four numbers, to the change of volume of
  /// this material around the node and to its reference volume (m^3). Volumes of different materials have no
  /// common pressure: averaged together, forces would not be the gradient of an energy.
  void sum_volumes(const State<Real>& state, Real* volumes) const {
    const Plan& plan = plan_of(state);
    for (std::size_t n = 0; n * volumes_of_each() < volume_numbers(); ++n) {
      Real* const own = volumes + n * volumes_of_each();
      sum_over_chunks(*layout_, own, [&](std::size_t c) {
        std::apply([&](const auto&... part) { (add_volumes(part, state, n, own), ...); }, *plan.chunks[c]);
      });
    }
  }

  std::vector<Real> volumes_around_nodes(const State<Real>& state) const {
    std::vector<Real> volumes(volume_numbers());
    if constexpr (averages_over_nodes) sum_volumes(state, volumes.data());
    return volumes;
  }

  /// A block of elements: its place along the strips, its chunk, and the axes of its elements.
  struct BlockPlace : StripPlace {
    std::size_t chunk;
    const MaterialAxes<Number>* axes;
    const ElementGroups* groups;
  };

  /// Calls visit.operator()<Method>(motion, element, place, for_each_lane) for every block of own elements,
  /// where for_each_lane(use) calls use(e, lane) for each lane with the number of its element.
  template <class Visit>
  void for_each_block(const State<Real>& state, const Visit& visit) const {
    const std::vector<Real> volumes = volumes_around_nodes(state);
    const std::tuple<Visitor<Methods>...> visitors{
        [&visit](const auto& motion, const auto& part, const auto& at) {
          visit.template operator()<Methods>(motion, part.block(at.pack), at,
                                             [&](const auto& use) { part.for_each_lane(at.pack, use); });
        }...};
    for (std::size_t c = layout_->own_chunks.first; c < layout_->own_chunks.last; ++c) {
      const Parts& parts = *plan_of(state).chunks[c];
      (visit_blocks(std::get<Part<Methods>>(parts), c, state, volumes.data(),
                    std::get<Visitor<Methods>>(visitors)),
       ...);
    }
  }

  /// Sets values[e] for every own element to its lane of evaluate.operator()<Method>(motion, element, place).
  template <class Evaluate>
  void per_element(const State<Real>& state, std::span<double> values, const Evaluate& evaluate) const {
    for_each_block(state, [&]<class Method>(const ElementMotion<Number>& motion, const auto& element,
                                            BlockPlace place, const auto& for_each_lane) {
      const Number value = evaluate.template operator()<Method>(motion, element, place);
      for_each_lane(
          [&](std::size_t e, int lane) { values[e] = static_cast<double>(Lanes<Number>::get(value, lane)); });
    });
  }

  /// Runs at every check of a motion.
  template <class Method, class Element, class HourglassHistory>
  SANDGLASS_HOT_LOOP static Number stiffness_bound(const ElementMotion<Number>& motion,
                                                   const Element& element, const HourglassHistory& remembered,
                                                   const CalledTangent<Number>& law) {
    return KernelOf<Method>::stiffness_bound(motion, element, {.hourglass = remembered}, law);
  }

  std::shared_ptr<const Layout> layout_;  // of all elements
  Plans plans_;
  std::vector<std::size_t> alike_;  // see numbers_of_alike
  Rows<Real> coordinates_;          // only if kernels need them, or adaptive methods
  bool streams_ = false;            // whether constants do not remain in the cache from step to step

 private:
  /// Adds the nodal volumes of a part's elements of materials with a number, in the order of the forces.
  template <class Method>
  SANDGLASS_HOT_LOOP void add_volumes(const Part<Method>& part, const State<Real>& state, std::size_t alike,
                                      Real* volumes) const {
    if constexpr (KernelOf<Method>::averages_over_nodes) {
      const ElementGroups& groups = *part.groups;
      for (std::size_t g = part.first; g < part.last; ++g) {
        if (alike_[groups.groups[g].material] != alike) continue;
        walk_strips(
            groups, g, g + 1,
            [&](std::size_t face, std::size_t /*material*/) {
              return gather_face_modes<Number>(state.u, groups, face);
            },
            [&](const Faces& lower, const Faces& upper, const StripPlace& at) {
              ElementMotion<Number> motion;
              motion.u = modes_between(lower, upper);
              return on_faces(KernelOf<Method>::nodal_volumes(motion, part.block(at.pack)));
            },
            [&](const FaceVolumes<Number>& sum, std::size_t face) {
              for (std::size_t corner = 0; corner < 4; ++corner) {
                scatter_add<Number>({sum.change[corner], sum.reference[corner], Number(Real(0))}, volumes,
                                    groups.places(face, corner));
              }
            });
      }
    }
  }

  /// The part of `replace_pressures` of the elements of a part.
  template <class Method>
  SANDGLASS_HOT_LOOP void add_pressures(const Part<Method>& part, const State<Real>& state,
                                        const Real* volumes, std::span<const Real> p,
                                        std::span<const double> lambdas, Real* force,
                                        std::span<Real> defect) const {
    const ElementGroups& groups = *part.groups;
    const Number inverse_step(static_cast<Real>(1.0 / state.step));
    walk_strips(
        groups, part.first, part.last,
        [&](std::size_t face, std::size_t material) {
          return gather_face<Method>(groups, state, volumes, material, face);
        },
        [&](const FaceMotion& lower, const FaceMotion& upper, const StripPlace& at) {
          const auto lambda = static_cast<Real>(lambdas[at.material]);
          Number own(Real(0));
          part.for_each_lane(at.pack, [&](std::size_t e, int lane) { Lanes<Number>::set(own, lane, p[e]); });
          const auto replaced = replace_pressure<Method>(
              motion_between<KernelOf<Method>>(lower, upper, inverse_step), part.block(at.pack).body, own,
              Number(lambda), Number(Real(1) / lambda), plans_.setup_of(at.material).law);
          part.for_each_lane(at.pack, [&](std::size_t e, int lane) {
            defect[e] = Lanes<Number>::get(replaced.defect, lane);
          });
          return on_faces(replaced.force);
        },
        [&](const Faces& sum, std::size_t face) { scatter_face_modes(sum, force, groups, face); });
  }

  /// Runs at every check of a motion or a search.
  template <class Method, class Element>
  SANDGLASS_HOT_LOOP static Number smallest_jacobian(const ElementMotion<Number>& motion,
                                                     const Element& element) {
    return KernelOf<Method>::smallest_jacobian(motion, element);
  }

  /// What is done with the motion of a block of elements, without a type of its own, so that all uses share
  /// one loop.
  template <class Method>
  using Visitor = std::function<void(const ElementMotion<Number>&, const Part<Method>&, const BlockPlace&)>;

  template <class Method>
  SANDGLASS_HOT_LOOP void visit_blocks(const Part<Method>& part, std::size_t chunk, const State<Real>& state,
                                       const Real* volumes, const Visitor<Method>& visit) const {
    const Number inverse_step(static_cast<Real>(1.0 / state.step));
    walk_strips(
        *part.groups, part.first, part.last,
        [&](std::size_t face, std::size_t material) {
          return gather_face<Method>(*part.groups, state, volumes, material, face);
        },
        [&](const FaceMotion& lower, const FaceMotion& upper, const StripPlace& at) {
          visit(motion_between<KernelOf<Method>>(lower, upper, inverse_step), part,
                {at, chunk, part.axes_at(at.pack), part.groups.get()});
        });
  }
};

}  // namespace sandglass
