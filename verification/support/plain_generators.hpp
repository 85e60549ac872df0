#pragma once

#include <tuple>
#include <type_traits>
#include <vector>

#include "mesh/generators.hpp"

namespace sandglass::verification {

/// A generator of the list with plain parameters, set through its own declarations: lengths differ so that
/// swapped axes are noticed, counts are small.
template <class Generator>
Generator plain_generator() {
  Generator generator;
  const auto set = [](auto& value, bool required) {
    using Value = std::remove_reference_t<decltype(value)>;
    if (!required) return;
    if constexpr (std::is_same_v<Value, double>) {
      value = 0.7;
    } else if constexpr (std::is_same_v<Value, int>) {
      value = 3;
    } else {
      for (std::size_t n = 0; n < value.size(); ++n) {
        value[n] = static_cast<typename Value::value_type>(2 + static_cast<int>(n));
      }
    }
  };
  std::apply([&](const auto&... p) { (set(generator.*(p.member), p.required), ...); },
             Generator::parameters());
  return generator;
}

/// One of every generator of the list.
inline std::vector<AnyGenerator> plain_generators() {
  std::vector<AnyGenerator> all;
  for_each_type(Generators{}, [&]<class Generator>() { all.emplace_back(plain_generator<Generator>()); });
  return all;
}

}  // namespace sandglass::verification
