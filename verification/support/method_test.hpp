#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "assembly/method_entry.hpp"
#include "element/method_choice.hpp"
#include "solve/stability.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification {

/// A test of methods by name, compiled once; a typed test is compiled for each method.
class MethodTest : public ::testing::TestWithParam<std::string> {
 protected:
  const MethodEntry& method = method_named(GetParam());

  static MethodChoice choice(Precision precision = Precision::double_precision, int threads = 1) {
    return {.method = GetParam(), .precision = precision, .threads = threads};
  }
};

/// The parameters of a test of the methods in a list.
template <class... EveryMethod>
auto each_of(TypeList<EveryMethod...> list) {
  return ::testing::ValuesIn(names_of(list));
}

/// A method's name in the name of a test.
inline std::string method_label(const ::testing::TestParamInfo<std::string>& info) {
  return test_label(info.param);
}

/// Whether a method updates its reference configuration in every step, so that its stress depends on the
/// path.
inline bool is_updated_lagrangian(const MethodEntry& method) {
  return method.name.starts_with("ul-");
}

/// Whether a method's forces depend on displacements only; see `PathIndependentMethods`.
inline bool is_path_independent(const MethodEntry& method) {
  return std::ranges::count(names_of(PathIndependentMethods{}), method.name) > 0;
}

}  // namespace sandglass::verification
