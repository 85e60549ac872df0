#pragma once

#include <fmt/format.h>

#include <array>
#include <bit>
#include <memory>
#include <optional>
#include <vector>

#include "assembly/layout.hpp"
#include "base/error.hpp"
#include "element/hourglass_settings.hpp"
#include "element/method_traits.hpp"
#include "material/called_law.hpp"
#include "material/material_axes.hpp"
#include "math/pack.hpp"

namespace sandglass {

namespace detail {

/// Throws InputError if the kernel does not accept an element with coordinates X (m).
template <class Kernel>
void require_accepted(const NodalVectors<double>& X) {
  if (Kernel::accepts(X)) return;
  Vector centre{};
  for (int I = 0; I < X.rows; ++I) {
    for (int i = 0; i < X.columns; ++i) centre[at(i)] += X(I, i) / X.rows;
  }
  throw InputError(
      fmt::format("mesh: the element with centre ({:.6g}, {:.6g}, {:.6g}) does not suit the method; {}; "
                  "repair the mesh or choose another method",
                  centre[0], centre[1], centre[2], Kernel::demand));
}

}  // namespace detail

/// The constants of the elements between a face of the groups and the next one, one element per lane,
/// computed in double precision and rounded. law_of(lane) is the law of an element.
template <class Kernel, class Number, class LawOf>
typename Kernel::template Element<Number> element_block(const Mesh& mesh, const ElementGroups& groups,
                                                        const std::vector<int>& node_of_row, std::size_t face,
                                                        const LawOf& law_of,
                                                        const HourglassSettings& settings) {
  using Element = typename Kernel::template Element<double>;
  using Block = typename Kernel::template Element<Number>;
  constexpr std::size_t numbers = sizeof(Element) / sizeof(double);
  static_assert(sizeof(Block) == numbers * sizeof(Number),
                "an element's constants must all be of its number type");
  std::array<Number, numbers> block;
  for (int lane = 0; lane < Lanes<Number>::width; ++lane) {
    NodalVectors<double> X;
    for (int I = 0; I < X.rows; ++I) {
      const auto corner = static_cast<std::size_t>(I);
      const auto row = static_cast<std::size_t>(groups.places(face + corner / 4, corner % 4)[lane]) / 4;
      const Vector& point = mesh.points[static_cast<std::size_t>(node_of_row[row])];
      for (int i = 0; i < 3; ++i) X(I, i) = point[static_cast<std::size_t>(i)];
    }
    detail::require_accepted<Kernel>(X);
    const auto constants =
        std::bit_cast<std::array<double, numbers>>(Kernel::precompute(X, law_of(lane), settings));
    for (std::size_t n = 0; n < numbers; ++n) {
      Lanes<Number>::set(block[n], lane, static_cast<typename Lanes<Number>::Scalar>(constants[n]));
    }
  }
  return std::bit_cast<Block>(block);
}

/// The axes of the elements in the lanes of a block, those of space in spare lanes; none without axes of
/// elements.
template <class Number>
std::optional<MaterialAxes<Number>> axes_of_block(const std::vector<MaterialAxes<double>>& of_elements,
                                                  const int* elements) {
  if (of_elements.empty()) return std::nullopt;
  MaterialAxes<Number> axes;
  for (int lane = 0; lane < Lanes<Number>::width; ++lane) {
    const auto own = elements[lane] < 0 ? identity<double>() : of_elements[at(elements[lane])];
    for (std::size_t n = 0; n < own.entries.size(); ++n) {
      Lanes<Number>::set(axes.entries[n], lane, static_cast<typename Lanes<Number>::Scalar>(own.entries[n]));
    }
  }
  return axes;
}

/// The elements of a chunk at one level: the groups `first` to `last` - 1, with the constants of their
/// blocks.
template <class Method, class Number>
struct ElementPart {
  using Element = typename FormulationOf<Method, CalledLaw>::template Element<Number>;

  std::shared_ptr<const ElementGroups> groups;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t first_block = 0;  // index of the first group's first block among those of `groups`
  std::vector<Element> blocks;
  std::vector<MaterialAxes<Number>> axes;  // of the blocks; empty: those of space

  const Element& block(std::size_t pack) const { return blocks[pack - first_block]; }

  const MaterialAxes<Number>* axes_at(std::size_t pack) const {
    return axes.empty() ? nullptr : &axes[pack - first_block];
  }

  /// Calls use(e, lane) for the lanes of a pack that have an element, e its number.
  template <class Use>
  void for_each_lane(std::size_t pack, const Use& use) const {
    for (int lane = 0; lane < Lanes<Number>::width; ++lane) {
      const int e = groups->elements[pack * Lanes<Number>::width + static_cast<std::size_t>(lane)];
      if (e >= 0) use(static_cast<std::size_t>(e), lane);
    }
  }
};

}  // namespace sandglass
