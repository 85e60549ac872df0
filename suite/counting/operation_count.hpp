#pragma once

#include <array>
#include <bit>

#include "counting/element_work.hpp"
#include "element/formulation.hpp"
#include "element/hourglass_none.hpp"
#include "material/material_axes.hpp"
#include "material/memory.hpp"
#include "material/small_strain.hpp"
#include "math/rows.hpp"

/// Operations per element and step, counted by running the kernels themselves on counting numbers.
namespace sandglass {

namespace detail {

/// The tally at the first call of a law, and the operations counted inside its calls.
struct CallRecord {
  const Operations& tally;
  bool called = false;
  Operations before = {};
  Operations inside = {};
};

/// A law that records the operations of its calls.
template <class Law>
class ObservedLaw {
 public:
  static constexpr LawTraits traits{.isotropic = false};  // it observes small_strain_stress, too

  ObservedLaw(const Law& law, CallRecord& record) : law_(law), record_(record) {}

  // clang-format off
  template <class H> auto piola(const H& h) const { return observed([&] { return law_.piola(h); }); }
  template <class T, class H, class C> auto weighted_piola(const T& V, const H& h, const C& c, const T& p) const { return observed([&] { return law_.weighted_piola(V, h, c, p); }); }
  template <class T, class H, class C> auto weighted_kirchhoff(const T& V, const H& h, const C& c, const T& p) const { return observed([&] { return law_.weighted_kirchhoff(V, h, c, p); }); }
  template <class T> Tensor<T> small_strain_stress(const Tensor<T>& e) const { return observed([&] { return sandglass::small_strain_stress(law_, e); }); }
  template <class T> requires TakesAllPoints<Law, T> void weighted_piola(std::size_t n, const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* VP) const { observed([&] { law_.weighted_piola(n, at, H, VP); return 0; }); }
  template <class T> auto pressure(const T& j) const { return observed([&] { return law_.pressure(j); }); }
  // clang-format on

  auto at_point(std::size_t q) const {
    auto law = sandglass::at_point(law_, q);
    return ObservedLaw<decltype(law)>(law, record_);
  }

 private:
  template <class Call>
  auto observed(Call call) const {
    const Operations start = record_.tally;
    if (!record_.called) record_.before = start;
    record_.called = true;
    auto result = call();
    record_.inside = record_.inside + (record_.tally - start);
    return result;
  }

  Law law_;
  CallRecord& record_;
};

}  // namespace detail

namespace detail {

/// An aggregate of numbers with a tally.
template <class Aggregate>
Aggregate counted(Operations& tally, double value) {
  constexpr std::size_t numbers = sizeof(Aggregate) / sizeof(Counted);
  std::array<Counted, numbers> entries;
  for (std::size_t n = 0; n < numbers; ++n) {
    entries[n] = Counted(value * (1.0 + 1e-3 * static_cast<double>(n)), tally);
  }
  return std::bit_cast<Aggregate>(entries);
}

/// The constants of a cube, if the kernel has any, with a tally.
template <class Kernel, class Law>
auto counted_constants(const Law& law, Operations& tally) {
  using Element = typename Kernel::template Element<double>;
  using CountedElement = typename Kernel::template Element<Counted>;
  if constexpr (std::is_empty_v<Element>) {
    return CountedElement{};
  } else {
    constexpr std::size_t numbers = sizeof(CountedElement) / sizeof(Counted);
    const auto plain =
        std::bit_cast<std::array<double, numbers>>(Kernel::precompute(0.5 * corner_signs, law, {}));
    std::array<Counted, numbers> constants;
    for (std::size_t n = 0; n < numbers; ++n) constants[n] = Counted(plain[n], tally);
    return std::bit_cast<CountedElement>(constants);
  }
}

/// The modes of an element in a strip; the lower face's are known from the previous element.
inline Modes<Counted> modes_in_strip(const FaceModes<Counted>& lower, Operations& tally, double value) {
  const auto upper = counted<FaceVectors<Counted>>(tally, value);
  return modes_between(lower, to_face_modes(upper));
}

/// The first pass of kernels that average over nodes, and the second pass's gather of its result: the lower
/// face is known from the previous element.
template <class Kernel>
std::array<Counted, 8> averages(const typename Kernel::template Element<Counted>& element,
                                Operations& tally) {
  ElementMotion<Counted> motion;
  motion.u = modes_in_strip(counted<FaceModes<Counted>>(tally, 1e-3), tally, 2e-3);
  const auto volumes = Kernel::nodal_volumes(motion, element);
  const auto carried = counted<NodalVolumes<Counted>>(tally, 1.0);
  auto dilatation = counted<std::array<Counted, 8>>(tally, 1e-3);
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Counted change = carried.change[4 + corner] + volumes.change[corner];
    dilatation[4 + corner] = change / (carried.reference[4 + corner] + volumes.reference[corner]);
  }
  return dilatation;
}

}  // namespace detail

/// The operations of one element in one step, as in the assembly: in a strip, where the modes of a face serve
/// both its elements. They do not depend on the values, since kernels have no branches.
template <class Kinematics, class Hourglass, class Law>
OperationCount count_operations(const Law& law) {
  using Kernel = Formulation<Kinematics, Hourglass, Law>;
  Operations tally;
  const auto element = detail::counted_constants<Kernel>(law, tally);
  const auto lower = detail::counted<FaceModes<Counted>>(tally, 1e-3);
  const auto carried = detail::counted<FaceModes<Counted>>(tally, 1.0);

  ElementMotion<Counted> motion;
  motion.u = detail::modes_in_strip(lower, tally, 2e-3);
  if constexpr (Kernel::needs_increment) motion.increment = detail::modes_in_strip(lower, tally, 1e-4);
  motion.inverse_step = Counted(1e3, tally);
  if constexpr (Kernel::needs_coordinates) motion.X = detail::modes_in_strip(lower, tally, 1.0);
  OperationCount count;
  if constexpr (Kernel::averages_over_nodes) motion.dilatation = detail::averages<Kernel>(element, tally);
  typename Kernel::template History<Counted> history;
  if constexpr (Kernel::remembers) {
    history = detail::counted<typename Kernel::template History<Counted>>(tally, 1e-2);
    count.bytes += static_cast<long>(2 * sizeof(typename Kernel::template History<double>));
  }
  const auto axes = detail::counted<MaterialAxes<Counted>>(tally, 1.0);
  const auto law_at_step = at_step(law, 1e-3);
  const auto oriented = with_axes(law_at_step, &axes);
  detail::CallRecord record{tally};
  const detail::ObservedLaw observed(recalling(oriented, history.law), record);
  const auto now = Kernel::deformation(motion, element);
  const auto f = Kinematics::template force<Hourglass>(now, element.body, element.hourglass,
                                                       history.hourglass, observed);
  from_face_modes(carried + lower_face(f));
  upper_face(f);

  count.gradient = record.before;
  count.law = record.inside;
  count.total = tally;
  using Element = typename Kernel::template Element<double>;
  count.bytes += Kernel::passes *
                 static_cast<long>((std::is_empty_v<Element> ? 0 : sizeof(Element)) + 4 * sizeof(Place));
  count.force = tally - count.gradient - count.law;
  if constexpr (Hourglass::traits.active) {
    const OperationCount without = count_operations<Kinematics, NoHourglassControl>(law);
    count.hourglass = tally - without.total;
    count.gradient = without.gradient;
    count.force = without.force;
  }
  return count;
}

}  // namespace sandglass
