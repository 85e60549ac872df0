#pragma once

#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "assembly/element_block.hpp"
#include "assembly/method_entry.hpp"
#include "assembly/strip_walk.hpp"
#include "base/hot_loop.hpp"
#include "element/method_traits.hpp"
#include "material/material_axes.hpp"
#include "material/memory.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

/// The elements of one mesh in as many bodies as `Number` has lanes, body l in lane l. A node's values stand
/// side by side, so that nothing is gathered or transposed.
template <class Number>
class BatchForce {
 public:
  BatchForce() = default;
  BatchForce(const BatchForce&) = delete;
  BatchForce& operator=(const BatchForce&) = delete;
  virtual ~BatchForce() = default;

  /// The order of rows, for one element at a time.
  virtual const Layout& layout() const = 0;

  /// Sets `force` to the internal forces (N) of displacements u (m): three numbers for each row. Allocates
  /// nothing.
  virtual void evaluate(std::span<const Number> u, std::span<Number> force) const = 0;

  /// What limits the step of each body.
  struct Extremes {
    Number frequency_square;  ///< an upper bound of the largest, 1/s^2
    Number jacobian;          ///< the smallest det F; not a number if one is not finite
  };

  /// At displacements u (m). Allocates nothing.
  virtual Extremes extremes(std::span<const Number> u) const = 0;
};

/// The law of a material, called.
inline CalledLaw called_law(const Materials& materials, std::size_t material) {
  return elastic_law(kernel_law(materials.list[material]));
}

/// The laws of the materials of several bodies, one in each lane.
template <class Number>
auto laws_of_bodies(std::span<const Materials> bodies) {
  std::vector<CalledLawOf<Pack<double, Lanes<Number>::width>>> laws;
  for (std::size_t m = 0; m < bodies.front().list.size(); ++m) {
    std::vector<CalledLaw> own;
    for (const Materials& materials : bodies) own.push_back(called_law(materials, m));
    laws.emplace_back(std::span<const CalledLaw>(own));
  }
  return laws;
}

/// The loop of a time step, for kernels whose forces follow from displacements alone. The mesh has no
/// material axes. An element has one set of constants for all bodies, which are read once, if `Constant` is a
/// plain number, and one for each body if it is `Number`.
template <class Method, class Law, class Number, class Constant>
class BatchLoop final : public BatchForce<Number> {
  using Kernel = FormulationOf<Method, Law>;
  using Called = FormulationOf<Method, CalledLaw>;
  using Element = typename Kernel::template Element<Number>;
  using Real = typename Lanes<Number>::Scalar;
  static constexpr std::size_t numbers = sizeof(Element) / sizeof(Number);
  static constexpr const MaterialAxes<Number>* no_axes = nullptr;
  static_assert(!Kernel::needs_increment && !Kernel::needs_coordinates && !Kernel::averages_over_nodes &&
                !Kernel::remembers);

 public:
  /// `bodies` have the materials that all share, or those of each, as `Constant` demands.
  BatchLoop(const Mesh& mesh, std::span<const Materials> bodies, std::vector<Law> laws,
            const HourglassSettings& settings)
      : layout_(make_layout(mesh, 1, SpareRows::where_needed, bodies.front().of_element)),
        laws_(std::move(laws)) {
    for (const Material& material : bodies.front().list) densities_.push_back(material.density);
    constants_.reserve(layout_.packs());
    for (const auto& group : layout_.groups) {
      for (std::size_t k = 0; k < group.packs; ++k) {
        auto& constants = constants_.emplace_back();
        for (int lane = 0; lane < Lanes<Constant>::width; ++lane) {
          const CalledLaw law = called_law(bodies[static_cast<std::size_t>(lane)], group.material);
          const auto own = std::bit_cast<std::array<Real, numbers>>(element_block<Called, Real>(
              mesh, layout_, layout_.node_of_row, group.first_face + k, [&](int) { return law; }, settings));
          for (std::size_t n = 0; n < numbers; ++n) Lanes<Constant>::set(constants[n], lane, own[n]);
        }
      }
    }
  }

  const Layout& layout() const override { return layout_; }

  void evaluate(std::span<const Number> u, std::span<Number> force) const override {
    std::fill(force.begin(), force.end(), Number(Real(0)));
    layout_.for_each_run(0, layout_.groups.size(), [&](std::size_t first, std::size_t last) {
      add_forces(first, last, u.data(), force.data());
    });
  }

  typename BatchForce<Number>::Extremes extremes(std::span<const Number> u) const override {
    typename BatchForce<Number>::Extremes all{Number(Real(0)), Number(std::numeric_limits<Real>::max())};
    for (std::size_t g = 0; g < layout_.groups.size(); ++g) widen(all, g, u.data());
    return all;
  }

 private:
  auto gather_from(const Number* u) const {
    return [this, u](std::size_t face, std::size_t /*material*/) { return face_at(u, face); };
  }

  static ElementMotion<Number> between(const FaceModes<Number>& lower, const FaceModes<Number>& upper) {
    ElementMotion<Number> motion;
    motion.u = modes_between(lower, upper);
    return motion;
  }

  /// Adds the forces of groups `first` to `last` - 1, which are of one material.
  SANDGLASS_HOT_LOOP void add_forces(std::size_t first, std::size_t last, const Number* u,
                                     Number* force) const {
    const auto law = law_of(layout_.groups[first].material);
    walk_strips(
        layout_, first, last, gather_from(u),
        [&](const auto& lower, const auto& upper, const StripPlace& at) {
          const Element element = in_all_lanes(constants_[at.pack]);
          typename Kernel::template History<Number> none;
          return on_faces(Kernel::force(Kernel::deformation(between(lower, upper), element), element, none,
                                        with_axes(law, no_axes)));
        },
        [&](const FaceModes<Number>& sum, std::size_t face) { add_to_face(sum, force, face); });
  }

  SANDGLASS_HOT_LOOP void widen(typename BatchForce<Number>::Extremes& all, std::size_t group,
                                const Number* u) const {
    const std::size_t material = layout_.groups[group].material;
    const auto law = law_of(material);
    const Number share_of_density(static_cast<Real>(share_of_node(densities_[material])));
    walk_strips(layout_, group, group + 1, gather_from(u),
                [&](const auto& lower, const auto& upper, const StripPlace& at) {
                  const Element element = in_all_lanes(constants_[at.pack]);
                  const ElementMotion<Number> motion = between(lower, upper);
                  const typename Kernel::template History<Number> none;
                  const Number mass = share_of_density * Kernel::volume(motion, element);
                  all.frequency_square =
                      max(all.frequency_square,
                          Kernel::stiffness_bound(motion, element, none, with_axes(law, no_axes)) / mass);
                  const Number jacobian = Kernel::smallest_jacobian(motion, element);
                  all.jacobian = min(all.jacobian, jacobian) + Number(Real(0)) * jacobian;
                });
  }

  /// A copy that no store can alias, so that moduli are computed once.
  auto law_of(std::size_t material) const {
    return at_step(laws_[material], std::numeric_limits<double>::infinity());
  }

  /// The constants of an element in all lanes. An element consists of numbers alone; through a
  /// pointer, for GCC would copy the result of a bit_cast to the stack.
  static Element in_all_lanes(const std::array<Constant, numbers>& constants) {
    Element element;
    auto* const lanes = reinterpret_cast<Number*>(&element);
    for (std::size_t n = 0; n < numbers; ++n) lanes[n] = Number(constants[n]);
    return element;
  }

  /// The first number of a corner of a face: a place counts four numbers for each row.
  std::size_t at(std::size_t face, int corner) const {
    return std::size_t{*layout_.places(face, static_cast<std::size_t>(corner))} / 4 * 3;
  }

  FaceModes<Number> face_at(const Number* u, std::size_t face) const {
    FaceVectors<Number> corners;
    for (int c = 0; c < 4; ++c) {
      const Number* at_corner = u + at(face, c);
      for (int i = 0; i < 3; ++i) corners(c, i) = at_corner[i];
    }
    return to_face_modes(corners);
  }

  void add_to_face(const FaceModes<Number>& modes, Number* force, std::size_t face) const {
    const FaceVectors<Number> corners = from_face_modes(modes);
    for (int c = 0; c < 4; ++c) {
      Number* at_corner = force + at(face, c);
      for (int i = 0; i < 3; ++i) at_corner[i] = at_corner[i] + corners(c, i);
    }
  }

  Layout layout_;
  std::vector<double> densities_;                         // kg/m^3, of each material
  std::vector<Law> laws_;                                 // of each material
  std::vector<std::array<Constant, numbers>> constants_;  // of each element, in the order of the loop
};

template <class Method, class Number>
std::unique_ptr<BatchForce<Number>> assemble_batch(const Mesh& mesh, std::span<const Materials> bodies,
                                                   const HourglassSettings& settings) {
  const auto with = [&]<class Form>(std::type_identity<Form>) -> std::unique_ptr<BatchForce<Number>> {
    const auto loop = [&]<class Constant, class Law>(std::type_identity<Constant>, std::vector<Law> laws) {
      return std::make_unique<BatchLoop<Form, Law, Number, Constant>>(mesh, bodies, std::move(laws),
                                                                      settings);
    };
    using Real = typename Lanes<Number>::Scalar;
    using Shared = std::type_identity<Real>;
    // Without a control they are geometry alone, the same for all bodies.
    using Own = std::type_identity<std::conditional_t<Method::Hourglass::traits.active, Number, Real>>;
    if (bodies.size() > 1) return loop(Own{}, laws_of_bodies<Number>(bodies));
    const KernelLaws laws = kernel_laws(bodies.front());
    if (const auto* known = std::get_if<std::vector<NeoHookean>>(&laws)) return loop(Shared{}, *known);
    return loop(Shared{}, std::get<std::vector<CalledLaw>>(laws));
  };
  if (shapes_in(mesh) == Shapes::parallelepipeds)
    return with(std::type_identity<OnParallelepipeds<Method>>{});
  return with(std::type_identity<Method>{});
}

}  // namespace sandglass
