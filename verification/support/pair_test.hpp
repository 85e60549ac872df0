#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "support/exact_stress.hpp"
#include "support/method_test.hpp"
#include "support/sample_law.hpp"

namespace sandglass::verification {

/// A law by its name, with sensible parameters; see `sample_law<Law>`.
inline AnyLaw sample_law(std::string_view name, double poisson_ratio,
                         double young_modulus = sample_young_modulus) {
  AnyLaw law;
  with_named_type(Laws{}, name, [&]<class Law>() { law = sample_law<Law>(poisson_ratio, young_modulus); });
  return law;
}

inline double bulk_modulus_of(const AnyLaw& any_law) {
  return std::visit([](const auto& law) { return law.bulk_modulus(); }, any_law);
}

inline double young_modulus_of(const AnyLaw& any_law) {
  return std::visit([](const auto& law) { return young_modulus_of(law); }, any_law);
}

/// The factor for loads in tests of large motions: where pressure is averaged, laws that do not split it off
/// bear strains of a few percent (nu = .45).
inline double bearable_load(const AnyLaw& law) {
  return splits_volume(law) ? 1.0 : 0.1;
}

/// Whether a method averages pressure in its elements, or in those of one of its levels.
inline bool averages_pressure(const MethodEntry& method) {
  bool any = false;
  with_named_type(Methods{}, method.name, [&]<class Method>() {
    for_each_type(LevelsOf<Method>{},
                  [&]<class Level>() { any = any || Level::Kinematics::traits.averages_pressure; });
  });
  return any;
}

/// Whether a homogeneous state of large strain may be unstable although method and law are sound by
/// themselves: where a pressure is averaged that the law does not split off (see StVenantKirchhoff), and
/// where compressed fibres may buckle into uncontrolled hourglass modes.
inline bool may_give_way(const MethodEntry& method, const AnyLaw& law) {
  return (averages_pressure(method) && !splits_volume(law)) ||
         (leaves_hourglass_modes({.method = std::string(method.name)}) && has_fibres(law));
}

/// A method and a law by name.
struct MethodAndLaw {
  std::string_view method, law;

  std::string label() const { return test_label(std::string(method) + " " + std::string(law)); }
};

inline void PrintTo(const MethodAndLaw& pair, std::ostream* out) {
  *out << pair.label();
}

/// A test of pairs of methods and laws, compiled once; see `MethodTest`.
class PairTest : public ::testing::TestWithParam<MethodAndLaw> {
 protected:
  const MethodEntry& method = method_named(GetParam().method);

  static MethodChoice choice() { return {.method = std::string(GetParam().method)}; }
  static AnyLaw law(double poisson_ratio = 0.45, double young_modulus = sample_young_modulus) {
    return sample_law(GetParam().law, poisson_ratio, young_modulus);
  }
};

/// The parameters of a test of the pairs in a list.
template <class... EveryPair>
auto each_of_pairs(TypeList<EveryPair...> /*list*/) {
  return ::testing::ValuesIn(std::vector<MethodAndLaw>{{EveryPair::Method::name, EveryPair::Law::name}...});
}

/// A pair's names in the name of a test.
inline std::string pair_label(const ::testing::TestParamInfo<MethodAndLaw>& info) {
  return info.param.label();
}

}  // namespace sandglass::verification
