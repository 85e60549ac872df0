#include "base/names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace sandglass {

namespace {

constexpr std::string_view digits = "0123456789";

/// Levenshtein distance, with swapped neighbours as one edit.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last, row(b.size() + 1);  // the rows of i - 2, i - 1 and i
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U), last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

std::string_view without_dashes(std::string_view name) {
  return name.substr(std::min(name.find_first_not_of('-'), name.size()));
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string best;
  const std::string_view bare = without_dashes(name);
  // With more than about a third of the letters wrong, or all of a short name, it is another word, not a
  // typo.
  std::size_t best_distance = std::min(std::max<std::size_t>(3, bare.size() / 3 + 1), bare.size());
  for (const auto& candidate : known) {
    const std::size_t distance = edit_distance(bare, without_dashes(candidate));
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::string near = nearest_name(name, known);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  const std::string near = nearest_name(name, known);
  const std::string hint = near.empty() ? "" : fmt::format("did you mean '{}'? ", near);
  constexpr std::size_t many = 16, few = 3;  // one line of a terminal
  if (known.size() <= many) return fmt::format("{}known: {}", hint, fmt::join(known, ", "));
  std::vector<std::string> by_distance = known;
  const auto distance = [&](const std::string& other) {
    return edit_distance(without_dashes(name), without_dashes(other));
  };
  std::stable_sort(by_distance.begin(), by_distance.end(),
                   [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  by_distance.resize(few);
  return fmt::format("{}nearest of {}: {}", hint, known.size(), fmt::join(by_distance, ", "));
}

std::string decimal_comma_hint(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.rfind(',') != comma) return "";
  std::string_view whole = text.substr(0, comma);
  if (whole.starts_with('-') || whole.starts_with('+')) whole.remove_prefix(1);
  const bool is_number = !whole.empty() && whole.find_first_not_of(digits) == std::string_view::npos &&
                         text.find_first_of(digits, comma) == comma + 1;
  if (!is_number) return "";
  std::string pointed(text);
  pointed[comma] = '.';
  return fmt::format("; did you mean {}, with a decimal point?", pointed);
}

}  // namespace sandglass
