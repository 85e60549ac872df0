#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "material/point_load.hpp"
#include "material/quadratic_volume.hpp"

/// Laws with memory. Such a law states `remembers` and has a `Memory<T>`, its state at each integration
/// point, and becomes a law that elements use like an elastic one in two steps: `at_step(dt)` gives the law
/// for a step of time, and `recalling(memory)` of the result gives the law at a point. The functions here do
/// this for any law; a law without memory is returned unchanged.
namespace sandglass {

/// The memory of a law that has none.
template <class T>
struct NoMemory {};

namespace detail {

template <class Law, class T>
struct MemoryOf {
  using type = NoMemory<T>;
};
template <class Law, class T>
requires(Law::traits.remembers) struct MemoryOf<Law, T> {
  using type = typename Law::template Memory<T>;
};

}  // namespace detail

/// The memory of a law at an integration point.
template <class Law, class T>
using MemoryOf = typename detail::MemoryOf<Law, T>::type;

/// Whether a law's stress depends on more than the deformation.
template <class Law>
inline constexpr bool law_remembers = Law::traits.remembers;

/// The memories of all points of an element; empty for a law without memory.
template <class Memory, int count>
struct PointMemories {
  static constexpr auto points = static_cast<std::size_t>(count);
  std::array<Memory, points> point;
};
template <class T, int count>
struct PointMemories<NoMemory<T>, count> {};

/// The law for a step of `seconds`, infinite in quasi-static runs. Everything that depends on the step alone
/// is computed here, once for all elements.
template <class Law>
constexpr auto at_step(const Law& law, double seconds) {
  if constexpr (law_remembers<Law>) {
    return law.at_step(seconds);
  } else {
    return law;
  }
}

/// A law at a step with the memories of an element of several points.
template <class LawAtStep, class Memories>
class RecallingLaw : public VolumeOfElastic<RecallingLaw<LawAtStep, Memories>> {
 public:
  RecallingLaw(const LawAtStep& law, Memories& memories) : law_(law), memories_(memories) {}

  const auto& elastic() const { return law_.elastic(); }

  /// The law at integration point q.
  auto at_point(std::size_t q) const { return law_.recalling(memories_.point[q]); }

  /// V P (Pa m^3) at all points, for elastic laws that take them in one call.
  template <class T>
  requires TakesAllPoints<typename LawAtStep::Elastic, T>
  void weighted_piola(std::size_t count, const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* VP) const {
    std::array<PointLoad<T>, Memories::points> alone;  // the isochoric stress of the elastic law, Pa
    for (std::size_t q = 0; q < Memories::points; ++q) alone[q] = {T(1), at[q].change, T(0)};
    law_.elastic().weighted_piola(count, alone.data(), H, VP);
    for (std::size_t q = 0; q < Memories::points; ++q) {
      VP[q] = at_point(q).decayed_piola(VP[q], at[q].V, H[q], at[q].change, at[q].p);
    }
  }

 private:
  const LawAtStep& law_;
  Memories& memories_;
};

/// The law for an element with these memories: bound to the memory of its only point, or, if there are
/// several, to be bound by `at_point`.
template <class LawAtStep, class Memories>
constexpr decltype(auto) recalling(const LawAtStep& law, Memories& memories) {
  if constexpr (std::is_empty_v<Memories>) {
    return (law);
  } else if constexpr (Memories::points == 1) {
    return law.recalling(memories.point[0]);
  } else {
    return RecallingLaw<LawAtStep, Memories>(law, memories);
  }
}

/// The law at integration point q of an element.
template <class Law>
constexpr decltype(auto) at_point(const Law& law, std::size_t q) {
  if constexpr (requires { law.at_point(q); }) {
    return law.at_point(q);
  } else {
    return (law);
  }
}

}  // namespace sandglass
