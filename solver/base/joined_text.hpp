#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace sandglass {

namespace detail {

template <const std::string_view&... parts>
inline constexpr auto joined_characters = [] {
  std::array<char, (parts.size() + ...)> text{};
  auto* end = text.begin();
  ((end = std::copy(parts.begin(), parts.end(), end)), ...);
  return text;
}();

}  // namespace detail

/// Constant texts, concatenated at compile time.
template <const std::string_view&... parts>
inline constexpr std::string_view joined_text{detail::joined_characters<parts...>.data(),
                                              detail::joined_characters<parts...>.size()};

}  // namespace sandglass
