#pragma once

#include <array>
#include <bit>
#include <optional>

#include "element/formulation.hpp"
#include "element/hourglass_none.hpp"
#include "element/hourglass_perturbation.hpp"
#include "math/counted.hpp"

/// Operations per element and step, counted by running the kernels themselves on counting numbers.
namespace sandglass {

/// What one evaluation of an element's force costs, by part.
struct OperationCount {
  Operations gradient;   ///< from nodal displacements to displacement gradients
  Operations law;        ///< from displacement gradients to stresses
  Operations force;      ///< from stresses to nodal forces
  Operations hourglass;  ///< what the hourglass control adds to an element without it
  Operations total;
  long bytes = 0;  ///< constants of the element in double and its eight node numbers, read once per step
};

namespace detail {

/// A law that notes how the tally stands when it is called and when it returns.
template <class Law>
class ObservedLaw {
 public:
  ObservedLaw(const Law& law, const Operations& tally) : law_(law), tally_(tally) {}

  // clang-format off
  template <class H> auto piola(const H& h) const { return observed([&] { return law_.piola(h); }); }
  template <class H> auto isochoric_piola(const H& h) const { return observed([&] { return law_.isochoric_piola(h); }); }
  template <class T> auto pressure(const T& j) const { return observed([&] { return law_.pressure(j); }); }
  // clang-format on

  /// The tally before the first call, and all that was counted inside of calls.
  Operations before() const { return before_.value_or(Operations{}); }
  Operations inside() const { return inside_; }

 private:
  template <class Call>
  auto observed(Call call) const {
    const Operations start = tally_;
    if (!before_) before_ = start;
    auto result = call();
    inside_ = inside_ + (tally_ - start);
    return result;
  }

  const Law& law_;
  const Operations& tally_;
  mutable std::optional<Operations> before_;
  mutable Operations inside_;
};

}  // namespace detail

/// Counts one force evaluation of a formulation. The count does not depend on the values: kernels have no
/// branches.
template <class Kinematics, class Hourglass, class Law>
OperationCount count_operations(const Law& law) {
  using Kernel = Formulation<Kinematics, Hourglass, Law>;
  constexpr std::size_t numbers = sizeof(typename Kernel::template Element<double>) / sizeof(double);
  Operations tally;
  const auto plain =
      std::bit_cast<std::array<double, numbers>>(Kernel::precompute(0.5 * corner_signs, law, {}));
  std::array<Counted, numbers> constants;
  for (std::size_t n = 0; n < numbers; ++n) constants[n] = Counted(plain[n], tally);
  const auto element = std::bit_cast<typename Kernel::template Element<Counted>>(constants);
  NodalVectors<Counted> u;
  for (int n = 0; auto& entry : u.entries) entry = Counted(1e-3 * ++n, tally);

  const detail::ObservedLaw<Law> observed(law, tally);
  Kinematics::template force<Hourglass>(u, element.body, element.hourglass, observed);
  OperationCount count{.gradient = observed.before(), .law = observed.inside(), .total = tally};
  count.bytes = static_cast<long>(numbers * sizeof(double) + 8 * sizeof(int));
  count.force = tally - count.gradient - count.law;
  if constexpr (Hourglass::active) {
    const OperationCount without = count_operations<Kinematics, NoHourglassControl>(law);
    count.hourglass = tally - without.total;
    count.gradient = without.gradient;
    count.force = without.force;
  }
  return count;
}

/// Eq. 14 as the paper writes it: Table I counts 360.
inline Operations count_paper_hourglass_force() {
  Operations tally;
  NodalVectors<Counted> u;
  Matrix<Counted, 8, 4> gamma;
  for (auto& entry : u.entries) entry = Counted(1e-3, tally);
  for (auto& entry : gamma.entries) entry = Counted(0.5, tally);
  paper_hourglass_force(u, gamma, Counted(2.0, tally));
  return tally;
}

}  // namespace sandglass
